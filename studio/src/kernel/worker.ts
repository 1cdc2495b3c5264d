// Tessellation beside the page: large models leave it fluid, and cancelling is the end of the worker.

import { load, type Mesh } from "freiform";
import type { News, Order } from "./module";

const tell = (news: News, transfer: Transferable[] = []): void => { postMessage(news, { transfer }); };

const kMeshed = new Set(["surface", "triangle", "trimmed", "model"]);

async function work({ module, source, options }: Order): Promise<void> {
    const ff = await load(module);
    const shapes = ff.document(source).shapes.filter((shape) => kMeshed.has(shape.type));
    const meshes: Mesh[] = [];
    for (const [i, shape] of shapes.entries()) {
        meshes.push(shape.mesh({ ...options, progress: (part) => { tell({ kind: "progress", part: (i + part) / shapes.length }); } }));
        tell({ kind: "progress", part: (i + 1) / shapes.length });
    }
    const buffers = new Set<ArrayBufferLike>();
    for (const m of meshes) for (const a of [m.positions, m.normals, m.uvs, m.indices]) buffers.add(a.buffer);
    tell({ kind: "meshes", meshes, names: shapes.map((shape) => shape.name) }, [...buffers] as ArrayBuffer[]);
}

onmessage = (event: MessageEvent<Order>) => {
    work(event.data).catch((error: unknown) => {
        const it = error as { kind?: string; where?: string; reason?: string; message?: string };
        tell({ kind: "refused", refusal: { kind: it.kind ?? "error", where: it.where ?? "", message: it.reason ?? it.message ?? String(error) } });
    });
};
