// Pictures of shapes, in the words of views. What is drawn are points that the module computed.

import type { Construction, Shape } from "freiform";
import type { Make } from "../kernel/module";
import type { Space, SurfaceStyle, Triangles } from "../views/space";
import type { Point, Run, Style, View } from "../views/view";
import { local, run } from "../views/view";

export const kPalette = ["curve", "control", "aux", "violet", "hot", "gold"] as const;
export const shade = (i: number): string => kPalette[i % kPalette.length] ?? "curve";

/** n + 1 numbers from a to b. */
export const steps = (a: number, b: number, n: number): number[] => Array.from({ length: n + 1 }, (_, i) => (i === n ? b : a + ((b - a) * i) / n));

/** The control points of a shape as rows of coordinates. */
export function net(shape: Shape): number[][] {
    const d = shape.dimension;
    return Array.from({ length: shape.points.length / d }, (_, i) => Array.from(shape.points.slice(i * d, i * d + d)));
}

/** A curve as finely as a screen shows it: many equal steps in every span. */
export function curve(view: View, shape: Shape, style: Style = { colour: "curve", width: 2.6 }): void {
    view.line({ at: shape.evaluate(spread(shape, 0, 200)), dimension: shape.dimension }, style);
}

/** The values of a curve at equal steps of the parameter. */
export function samples(shape: Shape, n: number): Run {
    const [a, b] = shape.domain[0] ?? [0, 1];
    return { at: shape.evaluate(steps(a, b, n)), dimension: shape.dimension };
}

export const kPolygon: Style = { colour: "control", width: 1.3 };

export function polygon(view: View, points: readonly Point[], style: Style = kPolygon): void { view.line(run(points), style); }

export function dots(view: View, points: readonly Point[], colour: string, width = 8): void {
    if (points.length > 0) view.dots(run(points), { colour, width });
}

export function labels(view: View, points: readonly Point[], name: string, from = 0): void {
    points.forEach((p, i) => { view.label(p, name + subscript(i + from)); });
}

export const subscript = (i: number): string => Array.from(String(i)).map((c) => String.fromCharCode(0x2080 + Number(c))).join("");
export const superscript = (i: number): string => Array.from(String(i)).map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(c)] ?? c).join("");

/** A vector as an arrow from a point. */
export function arrow(view: View, from: Point, to: Point, colour: string): void {
    view.line(run([from, to]), { colour, width: 2 });
    view.dots(run([to]), { colour, width: 6 });
}

/** The value and first `order` derivatives of a curve at t. */
export function jet(shape: Shape, t: number, order: number): number[][] {
    const d = shape.dimension, all = shape.evaluate([t], { derivatives: order });
    return Array.from({ length: order + 1 }, (_, k) => Array.from(all.slice(k * d, k * d + d)));
}

/** Needles against the curvature vector, as the module's derivatives make it: (Q″ − (Q″·T) T) / |Q′|². */
export function comb(view: View, shape: Shape, scale: number, each = 24): void {
    const d = shape.dimension, at = spread(shape, 0, each * Math.max(1, new Set(shape.knots[0] ?? []).size - 1));
    const jets = shape.evaluate(at, { derivatives: 2 });
    const tips: number[][] = [];
    for (let i = 0; i < at.length; ++i) {
        const row = (k: number): number[] => Array.from(jets.slice((3 * i + k) * d, (3 * i + k + 1) * d));
        const p = row(0), v = row(1), a = row(2);
        const vv = v.reduce((sum, x) => sum + x * x, 0), av = a.reduce((sum, x, k) => sum + x * (v[k] ?? 0), 0);
        if (!(vv > 0)) continue;
        const tip = p.map((x, k) => x - (scale * ((a[k] ?? 0) - (av / vv) * (v[k] ?? 0))) / vv);
        view.line(run([p, tip]), { colour: "violet", width: 0.9, opacity: 0.8 });
        tips.push(tip);
    }
    if (tips.length > 0) view.line(run(tips), { colour: "violet", width: 1.4 });
}

/** Values of all basis functions of a curve, one graph for each. */
export function graphs(view: View, shape: Shape, options: { n?: number; chosen?: number; axis?: number } = {}): void {
    const axis = options.axis ?? 0, size = shape.size[axis] ?? 0;
    const [a, b] = shape.domain[axis] ?? [0, 1];
    const at = steps(a, b, options.n ?? 240);
    const values = shape.basis(at, { axis });
    for (let i = 0; i < size; ++i) {
        const places = at.flatMap((t, k) => [t, values[k * size + i] ?? NaN]);
        const dim = options.chosen !== undefined && options.chosen !== i;
        view.line({ at: places, dimension: 2 }, { colour: shade(i), width: dim ? 1.2 : 2.2, opacity: dim ? 0.45 : 1 });
    }
}

/** The levels of de Casteljau or de Boor between the control points and the point. */
export function construction(view: View, scheme: Construction["levels"]): void {
    const last = scheme.length - 1;
    scheme.forEach((level, r) => {
        if (r === 0) return;
        if (r < last) view.line(run(level.points), { colour: shade(r + 1), width: 1.8 });
        dots(view, level.points, r === last ? "hot" : shade(r + 1), r === last ? 12 : 7);
    });
}

/** A rectangular grid of points as triangles. */
export function sheet(points: ArrayLike<number>, dimension: number, rows: number, columns: number, normals?: ArrayLike<number>): Triangles {
    const place = new Float64Array(3 * rows * columns);
    for (let i = 0; i < rows * columns; ++i)
        for (let k = 0; k < Math.min(3, dimension); ++k) place[3 * i + k] = points[i * dimension + k] ?? 0;
    const indices: number[] = [];
    for (let i = 0; i + 1 < rows; ++i)
        for (let j = 0; j + 1 < columns; ++j) {
            const a = i * columns + j, b = a + columns;
            indices.push(a, b, b + 1, a, b + 1, a + 1);
        }
    const { origin, places } = local(place);
    return { points: places, origin, indices: Uint32Array.from(indices), normals: normals ? Float32Array.from(normals) : undefined };
}

/** A surface, n steps in each direction. */
export function surface(view: Space, shape: Shape, style: SurfaceStyle = {}, n = 40): ReturnType<Space["surface"]> {
    const axes = [0, 1].map((axis) => spread(shape, axis, n));
    const grid = shape.grid(axes, { normals: shape.dimension === 3 });
    return view.surface(sheet(grid.points, shape.dimension, axes[0]?.length ?? 0, axes[1]?.length ?? 0, grid.normals), style);
}

/** Parameters with equal steps in every span, so that kinks at knots stay sharp. */
export function spread(shape: Shape, axis: number, n: number): number[] {
    const [a, b] = shape.domain[axis] ?? [0, 1];
    const breaks = [...new Set(shape.knots[axis] ?? [])].filter((k) => k >= a && k <= b);
    if (breaks.length < 2) return steps(a, b, n);
    const each = Math.max(axis === 0 && shape.parameters === 1 ? 12 : 2, Math.ceil(n / (breaks.length - 1)));
    return breaks.flatMap((k, i) => (i + 1 < breaks.length ? steps(k, breaks[i + 1] ?? k, each).slice(0, -1) : [k]));
}

/** A line of a surface with one parameter fixed. */
export function isoline(view: View, shape: Shape, axis: 0 | 1, at: number, style: Style): void {
    const along = spread(shape, 1 - axis, 60);
    const grid = shape.grid(axis === 0 ? [[at], along] : [along, [at]]);
    view.line({ at: grid.points, dimension: shape.dimension }, style);
}

/** A control net of rows and columns. */
export function lattice(view: View, points: readonly (readonly Point[])[], style: Style = kPolygon): void {
    for (const row of points) view.line(run(row), style);
    for (let j = 0; j < (points[0]?.length ?? 0); ++j) view.line(run(points.map((row) => row[j] ?? [])), style);
}

export const bezier = (make: Make, points: number[][], weights?: number[]): Shape =>
    make({ type: "curve", points, ...(weights ? { weights } : {}) });
