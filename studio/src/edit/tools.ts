// What changes shapes: each tool is a command of the module on the objects that are chosen.

import type { CurveJson, DocumentJson, ObjectJson } from "freiform";
import { ff, type Freiform } from "../kernel/module";
import { chained, pointsOf } from "./document";

type Options = Parameters<Freiform["run"]>[2];

function objectsOf(command: Parameters<Freiform["run"]>[0], objects: readonly ObjectJson[], options: Options): ObjectJson[] {
    const json = ff().run(command, { freiform: 1, objects: [...objects] }, options).json as DocumentJson | ObjectJson;
    return "objects" in json ? (json as DocumentJson).objects : [json];
}

const converted = (object: ObjectJson, options: Options): ObjectJson[] => objectsOf("convert", [object], options);
const one = (objects: ObjectJson[], name: string | undefined): ObjectJson[] => objects.map((o) => (name && objects.length === 1 ? { ...o, name } : o));

export type Axis = "u" | "v";
const axisOf = (object: ObjectJson, axis: Axis): { axis?: string } => (object.type === "surface" ? { axis } : {});

export const elevated = (o: ObjectJson, axis: Axis): ObjectJson[] => one(converted(o, { elevate: 1, ...axisOf(o, axis) }), o.name);
export const inserted = (o: ObjectJson, at: number, axis: Axis): ObjectJson[] => one(converted(o, { insertKnots: [at], ...axisOf(o, axis) }), o.name);
export const reduced = (o: ObjectJson, tolerance: number): ObjectJson[] => one(converted(o, { reduce: tolerance }), o.name);
export const divided = (o: ObjectJson, at: number, axis: Axis): ObjectJson[] => converted(o, { split: at, ...axisOf(o, axis) });
export const reversed = (o: ObjectJson, axis: Axis): ObjectJson[] => one(converted(o, { reverse: true, ...axisOf(o, axis) }), o.name);
export const pieces = (o: ObjectJson): ObjectJson[] => converted(o, { toBezier: true });

export const revolved = (o: readonly ObjectJson[], axis: readonly number[], angle: number): ObjectJson[] => objectsOf("revolve", o, { axis, angle });
export const extruded = (o: readonly ObjectJson[], by: readonly number[]): ObjectJson[] => objectsOf("extrude", o, { by });
export const lofted = (o: readonly ObjectJson[]): ObjectJson[] => objectsOf("loft", o, { degree: Math.min(3, o.length - 1) });
export const ruled = (o: readonly ObjectJson[]): ObjectJson[] => objectsOf("ruled", o, {});

/** The surface between four curves in any order and direction that close a loop within `tolerance`. */
export function coons(o: readonly ObjectJson[], tolerance: number): ObjectJson[] {
    const left = o.slice(1) as CurveJson[], loop = [o[0] as CurveJson];
    while (left.length > 0) {
        const end = last(loop[loop.length - 1] as CurveJson);
        const k = left.findIndex((c) => near(first(c), end, tolerance) || near(last(c), end, tolerance));
        const next = k < 0 ? undefined : left.splice(k, 1)[0];
        if (!next) throw Object.assign(new Error("the curves do not close a loop"), { kind: "no_answer", where: `curve ${loop.length + 1}` });
        loop.push(near(first(next), end, tolerance) ? next : (reversed(next, "u")[0] as CurveJson));
    }
    const [south, east, north, west] = loop;
    if (!south || !east || !north || !west || loop.length !== 4) throw Object.assign(new Error("four curves are expected"), { kind: "invalid", where: "coons" });
    return objectsOf("coons", [south, reversed(north, "u")[0] as ObjectJson, reversed(west, "u")[0] as ObjectJson, east], { tolerance });
}

const first = (c: CurveJson): readonly number[] => pointsOf(c)[0] ?? [];
const last = (c: CurveJson): readonly number[] => pointsOf(c)[c.points.length - 1] ?? [];
const near = (a: readonly number[], b: readonly number[], tolerance: number): boolean => Math.hypot(...a.map((x, i) => x - (b[i] ?? 0))) <= tolerance;

/** Two curves as one: turned so that they meet, raised to one degree, and with the knot between them removed as often as the
 *  shape allows within `tolerance`. The ends that meet may be as far apart. */
export function joined(a: CurveJson, b: CurveJson, tolerance: number): ObjectJson[] {
    const gap = (p: readonly number[], q: readonly number[]): number => Math.hypot(...p.map((x, i) => x - (q[i] ?? 0)));
    const ways: [number, () => [CurveJson, CurveJson]][] = [[gap(last(a), first(b)), () => [a, b]], [gap(last(a), last(b)), () => [a, turn(b)]],
        [gap(first(a), first(b)), () => [turn(a), b]], [gap(first(a), last(b)), () => [b, a]]];
    const [distance, way] = ways.reduce((best, it) => (it[0] < best[0] ? it : best));
    if (distance > tolerance) throw Object.assign(new Error(`the nearest ends are ${distance} apart, more than the tolerance ${tolerance}`), { kind: "no_answer", where: "join" });
    let [x, y] = way();
    const degree = (c: CurveJson): number => c.degree ?? c.points.length - 1;
    const p = Math.max(degree(x), degree(y));
    if (degree(x) < p) x = converted(x, { elevate: p - degree(x) })[0] as CurveJson;
    if (degree(y) < p) y = converted(y, { elevate: p - degree(y) })[0] as CurveJson;
    const chain = chained(x, y);
    return tolerance > 0 ? reduced(chain, tolerance) : [chain];
}

const turn = (c: CurveJson): CurveJson => reversed(c, "u")[0] as CurveJson;
