// What Inspect shows of a document: its meshes in colours, control nets, lines of parameters, combs, a section.

import type { Mesh, Shape } from "freiform";
import type { Mesh as Object3 } from "three";
import { comb, curve, dots, isoline, lattice, net, polygon, steps } from "../explore/draw";
import { ff, type DocumentJson, type ObjectJson } from "../kernel/module";
import type { Look, Space } from "../views/space";
import type { Style } from "../views/view";
import { painted, range, type Scale } from "./colours";

export type Colouring = "plain" | "faces" | "gauss" | "mean" | "bound" | "deviation";

export interface Showing {
    look: Look;
    colouring: Colouring;
    edges: boolean;
    net: boolean;
    knots: boolean;
    isolines: number;
    comb: boolean;
    joints: boolean;
    normals: boolean;
    /** A x + B y + C z + D = 0, or none. */
    plane: readonly number[] | undefined;
    /** Of the face that is chosen in the list. */
    chosen: { shape: number; face: number } | undefined;
}

export interface Model { readonly shapes: readonly Shape[]; readonly solid: readonly Shape[]; readonly document: DocumentJson; meshes: readonly Mesh[]; /** Of each of `solid` what edges it has. */ edges: readonly (readonly Float64Array[])[]; /** Fewer triangles, for when the eye moves. */ coarse?: readonly Mesh[] | undefined; deviations: readonly Float64Array[] | undefined; continuity: Continuity | undefined }

type Edge = `${"u" | "v"} ${"start" | "end"}`;
/** What the module says about joints of surfaces, and edges and knots inside of objects. */
export interface Continuity {
    readonly joints: readonly { readonly first: number; readonly first_edge?: Edge; readonly g_order: number }[];
    readonly objects: readonly { readonly edges?: readonly { readonly edge: number; readonly g_order: number }[]; readonly axes?: readonly (readonly { readonly at: number; readonly c_order: number }[])[] }[];
}

export interface Drawn { readonly objects: readonly Object3[]; readonly scale: Scale | undefined }

/** Gauss or mean curvature at every vertex, where the surface of the face is a spline. */
function curvatures(model: Model, which: "gauss" | "mean"): number[][] {
    return model.meshes.map((mesh, i) => {
        const shape = model.solid[i], out = new Array<number>(mesh.positions.length / 3).fill(NaN);
        if (!shape) return out;
        const made: Shape[] = [];
        const own = (face: number): Shape | undefined => {
            if (shape.type === "surface") return shape;
            const json = shape.json() as ObjectJson & { surface?: object; faces?: { surface: { points?: unknown } }[] };
            const surface = shape.type === "trimmed" ? json.surface : json.faces?.[face]?.surface;
            if (!surface || !("points" in surface)) return undefined;
            const it = ff().shape({ ...surface, type: "surface" } as unknown as ObjectJson);
            made.push(it);
            return it;
        };
        try {
            for (const part of mesh.parts) {
                const surface = own(part.face);
                if (!surface) continue;
                for (let k = 3 * part.first; k < 3 * (part.first + part.count); ++k) {
                    const v = mesh.indices[k] ?? 0;
                    if (!Number.isNaN(out[v])) continue;
                    out[v] = surface.grid([[mesh.uvs[2 * v] ?? 0], [mesh.uvs[2 * v + 1] ?? 0]], { curvatures: true })[which]?.[0] ?? NaN;
                }
            }
        } finally { made.forEach((s) => { s.free(); }); }
        return out;
    });
}

/** The bound of the face that each vertex belongs to. */
function bounds(model: Model): number[][] {
    return model.meshes.map((mesh) => {
        const out = new Array<number>(mesh.positions.length / 3).fill(NaN);
        for (const part of mesh.parts)
            for (let k = 3 * part.first; k < 3 * (part.first + part.count); ++k) out[mesh.indices[k] ?? 0] = part.errorBound;
        return out;
    });
}

/** The same mesh with three vertices of its own for each triangle. */
function apart(mesh: Mesh): { positions: Float32Array; normals: Float32Array; indices: Uint32Array } {
    const n = mesh.indices.length, positions = new Float32Array(3 * n), normals = new Float32Array(3 * n);
    mesh.indices.forEach((v, k) => {
        positions.set(mesh.positions.subarray(3 * v, 3 * v + 3), 3 * k);
        normals.set(mesh.normals.subarray(3 * v, 3 * v + 3), 3 * k);
    });
    return { positions, normals, indices: Uint32Array.from({ length: n }, (_, k) => k) };
}

function faceColours(mesh: Mesh, shape: number, chosen: Showing["chosen"]): Float32Array {
    const out = new Float32Array(mesh.positions.length).fill(0.42);
    mesh.parts.forEach((part, i) => {
        const own = part.colour ?? [0.3 + 0.35 * hash(i, shape, 1), 0.34 + 0.3 * hash(i, shape, 2), 0.4 + 0.3 * hash(i, shape, 3)];
        const lit = chosen?.shape === shape && chosen.face === part.face;
        for (let k = 3 * part.first; k < 3 * (part.first + part.count); ++k) out.set(lit ? [0.9, 0.25, 0.02] : own, 3 * (mesh.indices[k] ?? 0));
    });
    return out;
}

const hash = (i: number, j: number, k: number): number => (((i * 73856093) ^ (j * 19349663) ^ (k * 83492791)) >>> 0) % 1000 / 1000;

/** Draws it all anew. */
export function draw(space: Space, model: Model, showing: Showing): Drawn {
    space.clear();
    const { colouring } = showing;
    const values = colouring === "gauss" || colouring === "mean" ? curvatures(model, colouring) : colouring === "bound" ? bounds(model)
        : colouring === "deviation" ? model.deviations?.map((d) => Array.from(d)) : undefined;
    const scale = values ? range(values.flat(), colouring === "gauss" || colouring === "mean") : undefined;
    const objects = model.meshes.map((mesh, i) => {
        const list = values?.[i];
        const single = list !== undefined && colouring === "deviation";
        const split = single ? apart(mesh) : mesh;
        const colours = list && scale ? painted(single ? list.flatMap((x) => [x, x, x]) : list, scale)
            : colouring === "faces" || showing.chosen ? faceColours(mesh, i, showing.chosen) : undefined;
        return space.surface({ points: split.positions, normals: split.normals, indices: split.indices, colours, origin: mesh.origin }, { look: showing.look, edges: showing.edges });
    });
    if (!values) model.coarse?.forEach((mesh, i) => {
        const fine = objects[i], colours = colouring === "faces" || showing.chosen ? faceColours(mesh, i, showing.chosen) : undefined;
        if (fine) space.stands(space.surface({ points: mesh.positions, normals: mesh.normals, indices: mesh.indices, colours, origin: mesh.origin }, { look: showing.look }), fine);
    });
    for (const shape of model.shapes) lines(space, shape, showing);
    // Of what has no triangles the edges are all that there is to see.
    model.meshes.forEach((mesh, i) => { if (showing.knots || showing.isolines > 0 || mesh.indices.length === 0) edges(space, model.edges[i] ?? [], { colour: "ink", width: 1.4 }); });
    if (showing.joints && model.continuity) joints(space, model, model.continuity);
    if (showing.plane) section(space, model.document, showing.plane);
    return { objects, scale };
}

function lines(space: Space, shape: Shape, showing: Showing): void {
    if (shape.type === "curve") {
        curve(space, shape, { colour: "curve", width: 2.6 });
        if (showing.net) polygon(space, net(shape));
        if (showing.comb) comb(space, shape, combScale(shape));
        if (showing.knots) dots(space, inside(shape, 0).map((k) => Array.from(shape.evaluate([k]))), "aux", 8);
    } else if (shape.type === "surface") {
        const points = net(shape), columns = shape.size[1] ?? 1;
        if (showing.net) {
            lattice(space, Array.from({ length: shape.size[0] ?? 0 }, (_, i) => points.slice(i * columns, (i + 1) * columns)), { colour: "control", width: 1.1 });
            dots(space, points, "control", 5);
        }
        for (const axis of [0, 1] as const) {
            if (showing.knots) for (const k of inside(shape, axis)) isoline(space, shape, axis, k, { colour: "aux", width: 1.8 });
            const [lo, hi] = shape.domain[axis] ?? [0, 1];
            if (showing.isolines > 0) for (const k of steps(lo, hi, showing.isolines + 1)) isoline(space, shape, axis, k, { colour: "ink", width: 1 });
        }
        if (showing.normals) normals(space, shape);
    }
}

/** Many lines as one object: a model has thousands. */
function edges(space: Space, all: readonly Float64Array[], style: Style): void {
    const ends: number[] = [];
    for (const line of all) for (let k = 3; k < line.length; k += 3) ends.push(...line.subarray(k - 3, k + 3));
    space.segments(ends, style);
}

/** Lines where faces meet, in the colour of the order that they reach. */
function joints(space: Space, { shapes, solid, edges: all }: Model, found: Continuity): void {
    const style = (order: number): Style => ({ colour: order < 1 ? "hot" : order < 2 ? "gold" : "aux", width: 3.5 });
    for (const { first, first_edge: edge, g_order: order } of found.joints) {
        const shape = shapes[first];
        if (shape?.type !== "surface" || !edge) continue;
        const axis = edge.startsWith("u") ? 0 : 1;
        isoline(space, shape, axis, shape.domain[axis]?.[edge.endsWith("start") ? 0 : 1] ?? 0, style(order));
    }
    found.objects.forEach(({ edges: meeting = [], axes = [] }, i) => {
        const shape = shapes[i];
        if (!shape) return;
        const own = all[solid.indexOf(shape)] ?? [];
        for (const order of new Set(meeting.map((x) => x.g_order))) edges(space, meeting.flatMap((x) => (x.g_order === order ? own[x.edge] ?? [] : [])), style(order));
        if (shape.type === "surface") axes.forEach((knots, axis) => { for (const { at, c_order: order } of knots) isoline(space, shape, axis === 0 ? 0 : 1, at, style(order)); });
    });
}

function normals(space: Space, shape: Shape): void {
    if (shape.dimension !== 3) return;
    const axes = [0, 1].map((axis) => steps(...(shape.domain[axis] ?? [0, 1]), 8)), grid = shape.grid(axes, { normals: true });
    const length = 0.06 * extent(net(shape)), ends: number[] = [];
    for (let i = 0; i < grid.points.length; i += 3) {
        const p = grid.points.slice(i, i + 3), n = grid.normals?.slice(i, i + 3) ?? [];
        ends.push(...p, ...Array.from(p, (x, k) => x + length * (n[k] ?? 0)));
    }
    space.segments(ends, { colour: "violet", width: 1.4 });
}

export function extent(points: readonly (readonly number[])[]): number {
    let size = 0;
    for (let k = 0; k < 3; ++k) {
        const at = points.map((p) => p[k] ?? 0);
        size = Math.max(size, at.reduce((a, b) => Math.max(a, b), -Infinity) - at.reduce((a, b) => Math.min(a, b), Infinity));
    }
    return size > 0 && Number.isFinite(size) ? size : 1;
}

/** So long that a circle as large as the curve has needles of a fifth of it. */
const combScale = (shape: Shape): number => extent(net(shape)) ** 2 * 0.05;

const inside = (shape: Shape, axis: number): number[] => {
    const [lo, hi] = shape.domain[axis] ?? [0, 1];
    return [...new Set(shape.knots[axis] ?? [])].filter((k) => k >= lo && k <= hi);
};

function section(space: Space, document: DocumentJson, plane: readonly number[]): void {
    const cut = ff().run("section", document, { plane }).json as DocumentJson;
    const shapes = ff().document(cut).shapes;
    try {
        for (const shape of shapes) {
            if (shape.type !== "curve") continue;
            for (const line of shape.polylines(1e-3 * extent(net(shape)))) space.line({ at: line.points, dimension: shape.dimension }, { colour: "hot", width: 4 });
        }
    } finally { shapes.forEach((shape) => { shape.free(); }); }
}
