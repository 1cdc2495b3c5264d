// The document as a picture: control polygons and nets, curves, surfaces.

import { curve, lattice, net, polygon, surface } from "../explore/draw";
import { edges } from "../kernel/edges";
import { arena } from "../kernel/module";
import { Space } from "../views/space";
import type { View } from "../views/view";
import type { Document } from "./document";
import type { Sheets } from "./pick";
import { extent } from "./size";

/** Draws it, and tells which object each of the surfaces in space is of. */
export function show(view: View, document: Document, chosen: ReadonlySet<number>): Sheets {
    const sheets: Sheets = new Map();
    const size = extent(document);
    arena((make) => {
        document.objects.forEach((o, i) => {
            const shape = make(o), lit = chosen.has(i);
            if (shape.type === "curve") {
                polygon(view, net(shape), { colour: lit ? "hot" : "control", width: lit ? 1.6 : 1.1 });
                curve(view, shape, { colour: "curve", width: lit ? 4 : 2.8 });
            } else if (view instanceof Space && shape.type === "surface") {
                const points = net(shape), columns = shape.size[1] ?? 1;
                sheets.set(surface(view, shape, { colour: lit ? "lit" : "surface" }, 36), i);
                lattice(view, Array.from({ length: shape.size[0] ?? 0 }, (_, k) => points.slice(k * columns, (k + 1) * columns)), { colour: lit ? "hot" : "control", width: 1 });
            } else if (view instanceof Space && shape.type !== "volume") {
                const mesh = shape.mesh({ tolerance: 0.003 * size });
                if (mesh.indices.length > 0) sheets.set(view.surface({ points: mesh.positions, normals: mesh.normals, indices: mesh.indices, origin: mesh.origin }, { colour: lit ? "lit" : "surface" }), i);
                // Of what has no triangles the edges are all that there is to see.
                else view.runs(edges(shape, mesh, size), { colour: lit ? "hot" : "ink", width: lit ? 2.5 : 1.5 });
            }
        });
    });
    return sheets;
}
