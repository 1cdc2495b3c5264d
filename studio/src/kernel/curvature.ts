// Gauss and mean curvature at the vertices of meshes, where the surface of the face is a spline.

import type { Freiform, Mesh, ObjectJson, Shape } from "freiform";

/** Of a mesh what says where on its surfaces the vertices are. */
export type Places = Pick<Mesh, "uvs" | "indices" | "parts">;
/** NaN where the module has none. */
export interface Curvatures { readonly gauss: Float64Array; readonly mean: Float64Array }

/** After so many vertices the progress is told. */
const kBatch = 2000;

export function curvatures(ff: Freiform, shape: Shape, { uvs, indices, parts }: Places, progress: (part: number) => void): Curvatures {
    const n = uvs.length / 2, gauss = new Float64Array(n).fill(NaN), mean = new Float64Array(n).fill(NaN), done = new Uint8Array(n);
    // Asked once: of a model that is all of it.
    const json = shape.type === "surface" ? undefined : shape.json() as ObjectJson & { surface?: object; faces?: { surface: object }[] };
    let count = 0;
    for (const part of parts) {
        const own = json?.type === "trimmed" ? json.surface : json?.faces?.[part.face]?.surface;
        const surface = shape.type === "surface" ? shape : own && "points" in own ? ff.shape({ ...own, type: "surface" } as ObjectJson) : undefined;
        if (!surface) continue;
        for (let k = 3 * part.first; k < 3 * (part.first + part.count); ++k) {
            const v = indices[k] ?? 0;
            if (done[v]) continue;
            done[v] = 1;
            const found = surface.grid([[uvs[2 * v] ?? 0], [uvs[2 * v + 1] ?? 0]], { curvatures: true });
            gauss[v] = found.gauss?.[0] ?? NaN;
            mean[v] = found.mean?.[0] ?? NaN;
            if (++count % kBatch === 0) progress(count / n);
        }
        if (surface !== shape) surface.free();
    }
    return { gauss, mean };
}
