// What takes long, beside the page: large models leave it fluid, and cancelling is the end of the worker.

import { load, type Mesh, type Shape } from "freiform";
import { curvatures, type Curvatures } from "./curvature";
import { edges, section } from "./edges";
import type { Meshed, News, Order, Understood } from "./module";

const tell = (news: News, transfer: Transferable[] = []): void => { postMessage(news, { transfer }); };

const kMeshed = new Set(["surface", "triangle", "trimmed", "model"]);

const kBatch = 2000;

/** Distances from the middles of all triangles to the shape. */
function asked(shape: Shape, mesh: Mesh, progress: (part: number) => void): Float64Array {
    const n = mesh.indices.length / 3, middles = new Float64Array(3 * n), out = new Float64Array(n);
    for (let k = 0; k < n; ++k)
        for (let c = 0; c < 3; ++c) {
            const corner = (m: number): number => mesh.positions[3 * (mesh.indices[3 * k + m] ?? 0) + c] ?? 0;
            middles[3 * k + c] = (corner(0) + corner(1) + corner(2)) / 3 + (mesh.origin[c] ?? 0);
        }
    for (let k = 0; k < n; k += kBatch) {
        out.set(shape.nearest(middles.subarray(3 * k, 3 * Math.min(n, k + kBatch))).distances, k);
        progress(Math.min(1, (k + kBatch) / n));
    }
    return out;
}

async function work({ module, task }: Order): Promise<void> {
    const ff = await load(module);
    if (task.kind === "run") { tell({ kind: "done", result: ff.run(task.command, task.source, task.options).json as unknown }); return; }
    if (task.kind === "read") {
        const { shapes, unit, leftOut } = ff.document(task.source);
        const result: Understood = { document: JSON.stringify(ff.json(shapes, unit)), leftOut };
        tell({ kind: "done", result });
        return;
    }
    if (task.kind === "section") { tell({ kind: "done", result: section(ff, task.source, task.plane) }); return; }
    const { source } = task;
    const shapes = ff.document(source).shapes.filter((shape) => kMeshed.has(shape.type));
    if (task.kind === "curvatures") {
        const result: Curvatures[] = task.meshes.map((mesh, i) => {
            const shape = shapes[i], at = (part: number): void => { tell({ kind: "progress", part: (i + part) / task.meshes.length }); };
            at(0);
            return shape ? curvatures(ff, shape, mesh, at) : { gauss: new Float64Array(), mean: new Float64Array() };
        });
        tell({ kind: "done", result });
        return;
    }
    const { options, also: { deviations, edges: size } } = task;
    const meshes: Mesh[] = [], distances: Float64Array[] = [], lines: Float64Array[][] = [];
    const share = deviations ? 0.3 : 1;
    for (const [i, shape] of shapes.entries()) {
        const at = (part: number): void => { tell({ kind: "progress", part: (i + part) / shapes.length }); };
        const mesh = shape.mesh({ ...options, progress: (part) => { at(share * part); } });
        meshes.push(mesh);
        if (size !== undefined) lines.push(edges(shape, mesh, size));
        if (deviations) distances.push(asked(shape, mesh, (part) => { at(share + (1 - share) * part); }));
    }
    const buffers = new Set<ArrayBufferLike>();
    for (const m of meshes) for (const a of [m.positions, m.normals, m.uvs, m.indices]) buffers.add(a.buffer);
    const result: Meshed = { meshes, edges: size === undefined ? undefined : lines, deviations: deviations ? distances : undefined };
    tell({ kind: "done", result }, [...buffers] as ArrayBuffer[]);
}

onmessage = (event: MessageEvent<Order>) => {
    work(event.data).catch((error: unknown) => {
        const it = error as { kind?: string; where?: string; reason?: string; message?: string };
        tell({ kind: "refused", refusal: { kind: it.kind ?? "error", where: it.where ?? "", message: it.reason ?? it.message ?? String(error) } });
    });
};
