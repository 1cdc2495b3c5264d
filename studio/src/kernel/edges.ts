// Edges of models and sections as lines, as finely as a screen shows them whatever their size.

import type { Freiform, Mesh, Shape, Source } from "freiform";

/** How far the lines may be from what they show, in parts of its size: less than a pixel until the eye is near. */
const kFine = 1e-4;

/** The longest side of the box around points; 0 if there are none. */
export function width(positions: Float32Array | Float64Array, dimension = 3): number {
    let size = 0;
    for (let c = 0; c < dimension; ++c) {
        let low = Infinity, high = -Infinity;
        for (let k = c; k < positions.length; k += dimension) {
            const x = positions[k] ?? 0;
            low = Math.min(low, x);
            high = Math.max(high, x);
        }
        size = Math.max(size, high - low);
    }
    return size;
}

/** Of a model all edges, as points after each other; `size`: of all that it stands in, for a model without faces. */
export function edges(shape: Shape, mesh: Mesh, size: number): Float64Array[] {
    if (shape.type !== "model") return [];
    try {
        return shape.polylines(kFine * (width(mesh.positions) || size)).map((line) => line.points);
    } catch (error) {
        const { kind, where, reason } = error as { kind: Mesh["refused"][0]["kind"]; where: string; reason: string };
        if (typeof reason !== "string") throw error;
        mesh.refused.push({ face: -1, name: shape.name, kind, where: where || "edges", message: reason });
        return [];
    }
}

/** Where a plane (A x + B y + C z + D = 0) meets all of a document. */
export function section(ff: Freiform, source: Source, plane: readonly number[]): Float64Array[] {
    const { shapes } = ff.document(ff.run("section", source, { plane }).json as Source);
    return shapes.flatMap((shape) => {
        if (shape.type !== "curve" || shape.dimension !== 3) return [];
        return shape.polylines(kFine * (width(shape.points, shape.dimension) || 1)).map((line) => line.points);
    });
}
