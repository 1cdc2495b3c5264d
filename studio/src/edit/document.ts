// Documents as values: every function returns a new one and leaves the old one as it was. Nothing is computed here but
// places of control points that a hand moves; refinement and construction are the module's (tools.ts).

import type { CurveJson, ObjectJson, SurfaceJson, TriangleJson } from "freiform";

export interface Document { readonly unit?: string; readonly objects: readonly ObjectJson[] }
/** Object and control point, both by number. */
export interface Place { readonly object: number; readonly point: number }

type Editable = CurveJson | SurfaceJson | TriangleJson;

/** What has control points that can be taken hold of. */
export function editable(object: ObjectJson | undefined): object is Editable {
    return object !== undefined && (object.type === undefined || ["curve", "surface", "triangle"].includes(object.type));
}

const isSurface = (object: Editable): object is SurfaceJson => object.type === "surface";

/** All control points in one row; of a surface with v running fastest. */
export function pointsOf(object: ObjectJson | undefined): readonly number[][] {
    if (!editable(object)) return [];
    return isSurface(object) ? object.points.flat() : object.points;
}

export function weightsOf(object: ObjectJson | undefined): readonly number[] {
    if (!editable(object)) return [];
    const weights = isSurface(object) ? object.weights?.flat() : object.weights;
    return weights ?? pointsOf(object).map(() => 1);
}

/** The same object with other control points and weights, as many as before. */
export function withPoints(object: Editable, points: readonly number[][], weights?: readonly number[]): Editable {
    const given = weights?.some((w) => w !== 1) || object.weights ? { weights: weights ?? weightsOf(object) } : {};
    const rest = { ...object } as Record<string, unknown>;
    // Products with the weights that the program wrote are of the old points.
    delete rest["weighted_points"];
    if (!isSurface(object)) return { ...rest, points: [...points], ...given } as unknown as Editable;
    const columns = object.points[0]?.length ?? 1;
    const rows = <T>(all: readonly T[]): T[][] => object.points.map((_, i) => all.slice(i * columns, (i + 1) * columns));
    return { ...rest, points: rows(points), ...("weights" in given ? { weights: rows(given.weights) } : {}) } as unknown as Editable;
}

export function replaced(document: Document, at: number, ...by: readonly ObjectJson[]): Document {
    return { ...document, objects: [...document.objects.slice(0, at), ...by, ...document.objects.slice(at + 1)] };
}

/** The control points of `places` at where `to` takes them. */
export function moved(document: Document, places: readonly Place[], to: (point: readonly number[]) => number[]): Document {
    const objects = new Map<number, Set<number>>();
    for (const { object, point } of places) objects.set(object, (objects.get(object) ?? new Set()).add(point));
    let now = document;
    for (const [at, chosen] of objects) {
        const object = now.objects[at];
        if (!editable(object)) continue;
        now = replaced(now, at, withPoints(object, pointsOf(object).map((p, i) => (chosen.has(i) ? to(p) : p)), object.weights ? weightsOf(object) : undefined));
    }
    return now;
}

export const shifted = (by: readonly number[]) => (p: readonly number[]): number[] => p.map((x, i) => x + (by[i] ?? 0));

export function weighted(document: Document, places: readonly Place[], weight: number): Document {
    let now = document;
    for (const { object: at, point } of places) {
        const object = now.objects[at];
        if (editable(object)) now = replaced(now, at, withPoints(object, pointsOf(object), weightsOf(object).map((w, i) => (i === point ? weight : w))));
    }
    return now;
}

export function removed(document: Document, objects: readonly number[]): Document {
    return { ...document, objects: document.objects.filter((_, i) => !objects.includes(i)) };
}

export const added = (document: Document, objects: readonly ObjectJson[]): Document => ({ ...document, objects: [...document.objects, ...objects] });

/** A copy under a name that nothing else has. */
export function named(document: Document, object: ObjectJson): ObjectJson {
    const taken = new Set(document.objects.map((o) => o.name));
    const base = (object.name ?? object.type ?? "curve").replace(/ \d+$/, "");
    let name = base;
    for (let k = 2; taken.has(name); ++k) name = `${base} ${k}`;
    return { ...object, name };
}

/** The knots of a curve that begins and ends at its outer points, with equal spans. */
export function clamped(points: number, degree: number): number[] {
    const spans = points - degree;
    return [...new Array<number>(degree).fill(0), ...Array.from({ length: spans + 1 }, (_, i) => i), ...new Array<number>(degree).fill(spans)];
}

/** A curve with these control points, cubic if they are enough. */
export function drawn(points: readonly number[][]): CurveJson {
    const degree = Math.min(3, points.length - 1);
    return { type: "curve", degree, knots: clamped(points.length, degree), points: [...points] };
}

export const flat = (document: Document): boolean => document.objects.every((o) => editable(o) && o.type !== "surface" && pointsOf(o).every((p) => p.length <= 2));

/** Every point with three coordinates. */
export function raised(document: Document): Document {
    return { ...document, objects: document.objects.map((o) => (editable(o) ? withPoints(o, pointsOf(o).map((p) => (p.length < 3 ? [...p, ...new Array<number>(3 - p.length).fill(0)] : p)), o.weights ? weightsOf(o) : undefined) : o)) };
}

export const degreeOf = (c: CurveJson): number => c.degree ?? c.points.length - 1;

/** The knots that the ends of the domain lack for the curve to run through a control point there. */
export function loose(c: CurveJson): number[] {
    const p = degreeOf(c), knots = c.knots ?? [];
    const ends = knots.length > 0 ? [knots[p] ?? 0, knots[knots.length - 1 - p] ?? 0] : [];
    return ends.flatMap((end) => new Array<number>(Math.max(0, p - knots.filter((k) => k === end).length)).fill(end));
}

/** The same curve without what is outside of its domain. REQUIRES nothing to be loose. */
export function inside(c: CurveJson): CurveJson {
    const p = degreeOf(c), { knots } = c;
    if (!knots) return c;
    const low = knots[p] ?? 0, high = knots[knots.length - 1 - p] ?? 1, from = knots.lastIndexOf(low) - p, to = knots.indexOf(high);
    if (from === 0 && to === c.points.length) return c;
    return { ...c, knots: [low, ...knots.slice(from + 1, to + p), high], points: c.points.slice(from, to), ...(c.weights ? { weights: c.weights.slice(from, to) } : {}) };
}

/** Two curves of one degree end to end as one; the point between is that of the first. Knots of the second follow. */
export function chained(a: CurveJson, b: CurveJson): CurveJson {
    const p = degreeOf(a);
    const ka = a.knots ?? clamped(a.points.length, p), kb = b.knots ?? clamped(b.points.length, p);
    const end = ka[ka.length - 1 - p] ?? 1, start = kb[p] ?? 0;
    const knots = [...ka.slice(0, ka.length - 1), ...kb.slice(p + 1).map((k) => k - start + end)];
    const rational = a.weights ?? b.weights, wa = weightsOf(a), wb = weightsOf(b);
    const scale = (wa[wa.length - 1] ?? 1) / (wb[0] ?? 1);
    return { type: "curve", ...(a.name ? { name: a.name } : {}), degree: p, knots, points: [...a.points, ...b.points.slice(1)],
        ...(rational ? { weights: [...wa, ...wb.slice(1).map((w) => w * scale)] } : {}) };
}
