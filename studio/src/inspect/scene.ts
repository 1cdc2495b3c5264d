// What Inspect shows of a document: its meshes in colours, control nets, lines of parameters, combs, a section.

import type { Mesh, Shape } from "freiform";
import type { Mesh as Object3 } from "three";
import { comb, curve, dots, isoline, lattice, net, polygon, steps } from "../explore/draw";
import type { Curvatures } from "../kernel/curvature";
import type { DocumentJson } from "../kernel/module";
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
    section: boolean;
    /** Of the face that is chosen in the list. */
    chosen: { shape: number; face: number } | undefined;
}

export interface Model { readonly shapes: readonly Shape[]; readonly solid: readonly Shape[]; readonly document: DocumentJson; size: number; meshes: readonly Mesh[]; /** Of each of `solid` what edges it has. */ edges: readonly (readonly Float64Array[])[]; /** Fewer triangles, for when the eye moves. */ coarse?: readonly Mesh[] | undefined; deviations: readonly Float64Array[] | undefined; curvatures: readonly Curvatures[] | undefined; section: readonly Float64Array[] | undefined; continuity: Continuity | undefined }

type Edge = `${"u" | "v"} ${"start" | "end"}`;
/** What the module says about joints of surfaces, and edges and knots inside of objects. */
export interface Continuity {
    readonly joints: readonly { readonly first: number; readonly first_edge?: Edge; readonly g_order: number }[];
    readonly objects: readonly { readonly edges?: readonly { readonly edge: number; readonly g_order: number }[]; readonly axes?: readonly (readonly { readonly at: number; readonly c_order: number }[])[] }[];
}

/** `of`: what the surfaces of the picture depend on. */
export interface Drawn { readonly of: readonly unknown[]; readonly objects: readonly Object3[]; readonly scale: Scale | undefined; readonly section: ReturnType<Space["segments"]> }

/** The bound of the face that each vertex belongs to. */
function bounds(meshes: readonly Mesh[]): Float64Array[] {
    return meshes.map((mesh) => {
        const out = new Float64Array(mesh.positions.length / 3).fill(NaN);
        for (const part of mesh.parts)
            for (let k = 3 * part.first; k < 3 * (part.first + part.count); ++k) out[mesh.indices[k] ?? 0] = part.errorBound;
        return out;
    });
}

const kDust = 1e-9;

interface Painting { readonly scale: Scale; readonly colours: readonly Float32Array[] }

/** What was painted of meshes: most pictures show the same numbers again. */
const kept = new WeakMap<readonly Mesh[], Map<Colouring, Painting>>();

/** The colours of all vertices, if the numbers are known. */
function coloured(model: Model, by: Colouring): Painting | undefined {
    const own = kept.get(model.meshes)?.get(by);
    if (own) return own;
    const values = by === "gauss" || by === "mean" ? model.curvatures?.map((found) => found[by]) : by === "bound" ? bounds(model.meshes) : by === "deviation" ? model.deviations : undefined;
    if (!values) return undefined;
    // Curvatures that bend the whole model by less than rounding does are none.
    const scale = range(joined(values), by === "gauss" || by === "mean", kDust / model.size ** (by === "gauss" ? 2 : 1));
    // A deviation is that of a triangle, and each of its corners has it.
    const painting = { scale, colours: values.map((list) => painted(by === "deviation" ? thrice(list) : list, scale)) };
    kept.set(model.meshes, (kept.get(model.meshes) ?? new Map<Colouring, Painting>()).set(by, painting));
    return painting;
}

function joined(lists: readonly Float64Array[]): Float64Array {
    const all = new Float64Array(lists.reduce((n, list) => n + list.length, 0));
    lists.reduce((n, list) => { all.set(list, n); return n + list.length; }, 0);
    return all;
}

const thrice = (list: Float64Array): Float64Array => Float64Array.from({ length: 3 * list.length }, (_, k) => list[Math.floor(k / 3)] ?? NaN);

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

/** Draws it all; surfaces that would be those of the picture before stay. */
export function draw(space: Space, model: Model, showing: Showing, before?: Drawn): Drawn {
    const painting = coloured(model, showing.colouring);
    const of = [model.meshes, model.coarse, painting, showing.chosen, showing.colouring === "faces", showing.look, showing.edges];
    const same = before && of.every((x, i) => x === before.of[i]);
    if (same) space.clearLines();
    else space.clear();
    const objects = same ? before.objects : surfaces(space, model, showing, painting);
    for (const shape of model.shapes) lines(space, shape, showing);
    // Of what has no triangles the edges are all that there is to see.
    model.meshes.forEach((mesh, i) => { if (showing.knots || showing.isolines > 0 || mesh.indices.length === 0) space.runs(model.edges[i] ?? [], { colour: "ink", width: 1.4 }); });
    if (showing.joints && model.continuity) joints(space, model, model.continuity);
    return { objects, of, scale: painting?.scale, section: showing.section ? section(space, model) : undefined };
}

function surfaces(space: Space, model: Model, showing: Showing, painting: Painting | undefined): Object3[] {
    const { colouring } = showing;
    const objects = model.meshes.map((mesh, i) => {
        const split = painting && colouring === "deviation" ? apart(mesh) : mesh;
        const colours = painting ? painting.colours[i] : colouring === "faces" || showing.chosen ? faceColours(mesh, i, showing.chosen) : undefined;
        return space.surface({ points: split.positions, normals: split.normals, indices: split.indices, colours, origin: mesh.origin }, { look: showing.look, edges: showing.edges });
    });
    if (!painting) model.coarse?.forEach((mesh, i) => {
        const fine = objects[i], colours = colouring === "faces" || showing.chosen ? faceColours(mesh, i, showing.chosen) : undefined;
        if (fine) space.stands(space.surface({ points: mesh.positions, normals: mesh.normals, indices: mesh.indices, colours, origin: mesh.origin }, { look: showing.look }), fine);
    });
    return objects;
}

/** What is known of the section. */
export const section = (space: Space, model: Model): ReturnType<Space["segments"]> => space.runs(model.section ?? [], { colour: "hot", width: 4 });

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
        for (const order of new Set(meeting.map((x) => x.g_order))) space.runs(meeting.flatMap((x) => (x.g_order === order ? own[x.edge] ?? [] : [])), style(order));
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
