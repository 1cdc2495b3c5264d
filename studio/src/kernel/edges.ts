// The edges of models as lines, as finely as a screen shows them whatever the size of the model.

import type { Mesh, Shape } from "freiform";

/** How far the lines may be from the edges, in parts of the model: less than a pixel until the eye is near. */
const kFine = 1e-4;

/** The longest side of the box around a mesh; 0 if it has no vertices. */
export function width(positions: Float32Array): number {
    let size = 0;
    for (let c = 0; c < 3; ++c) {
        let low = Infinity, high = -Infinity;
        for (let k = c; k < positions.length; k += 3) {
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
