// What changes shapes: each tool is a command of the module on the objects that are chosen.

import type { CurveJson, DocumentJson, ObjectJson } from "freiform";
import { ff, type Freiform } from "../kernel/module";
import { say, t, type Text } from "../ui/language";
import { chained, degreeOf, inside, loose, pointsOf } from "./document";

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
    const [one, ...left] = o.map(ended), loop = one ? [one] : [];
    while (left.length > 0) {
        const end = last(loop[loop.length - 1] as CurveJson);
        const k = left.findIndex((c) => near(first(c), end, tolerance) || near(last(c), end, tolerance));
        const next = k < 0 ? undefined : left.splice(k, 1)[0];
        if (!next) throw refusal("no_answer", "coons", t(`Nach ${loop.length} Kurven geht es nicht weiter: die Kurven schließen keinen Umlauf.`, `After ${loop.length} curves none goes on: the curves do not close a loop.`));
        loop.push(near(first(next), end, tolerance) ? next : (reversed(next, "u")[0] as CurveJson));
    }
    const [south, east, north, west] = loop;
    if (!south || !east || !north || !west || loop.length !== 4) throw refusal("invalid", "coons", t("Vier Kurven werden erwartet.", "Four curves are expected."));
    return objectsOf("coons", [south, reversed(north, "u")[0] as ObjectJson, reversed(west, "u")[0] as ObjectJson, east], { tolerance });
}

const refusal = (kind: string, where: string, text: Text): Error => Object.assign(new Error(say(text)), { kind, where });

/** The same curve, ending at its outer control points. What has no ends is refused. */
function ended(o: ObjectJson): CurveJson {
    if (o.type !== undefined && o.type !== "curve") throw refusal("invalid", o.name ?? o.type, t("ist keine Kurve", "is no curve"));
    const c = o;
    if (c.closed) throw refusal("invalid", c.name ?? "", t("ist geschlossen und hat keine Enden", "is closed and has no ends"));
    const knots = loose(c);
    return inside(knots.length > 0 ? (converted(c, { insertKnots: knots })[0] as CurveJson) : c);
}

const first = (c: CurveJson): readonly number[] => pointsOf(c)[0] ?? [];
const last = (c: CurveJson): readonly number[] => pointsOf(c)[c.points.length - 1] ?? [];
const near = (a: readonly number[], b: readonly number[], tolerance: number): boolean => Math.hypot(...a.map((x, i) => x - (b[i] ?? 0))) <= tolerance;

/** Two curves as one: ending at their outer points, turned so that they meet, raised to one degree, and with the knot between them removed as often as the
 *  shape allows within `tolerance`. The ends that meet may be as far apart. */
export function joined(one: ObjectJson, other: ObjectJson, tolerance: number): ObjectJson[] {
    const a = ended(one), b = ended(other);
    const gap = (p: readonly number[], q: readonly number[]): number => Math.hypot(...p.map((x, i) => x - (q[i] ?? 0)));
    const ways: [number, () => [CurveJson, CurveJson]][] = [[gap(last(a), first(b)), () => [a, b]], [gap(last(a), last(b)), () => [a, turn(b)]],
        [gap(first(a), first(b)), () => [turn(a), b]], [gap(first(a), last(b)), () => [b, a]]];
    const [distance, way] = ways.reduce((best, it) => (it[0] < best[0] ? it : best));
    if (distance > tolerance) throw refusal("no_answer", "join", t(`Die nächsten Enden sind ${distance} auseinander, mehr als die Toleranz ${tolerance}.`, `The nearest ends are ${distance} apart, more than the tolerance ${tolerance}.`));
    let [x, y] = way();
    const p = Math.max(degreeOf(x), degreeOf(y));
    if (degreeOf(x) < p) x = converted(x, { elevate: p - degreeOf(x) })[0] as CurveJson;
    if (degreeOf(y) < p) y = converted(y, { elevate: p - degreeOf(y) })[0] as CurveJson;
    const chain = chained(x, y);
    return tolerance > 0 ? reduced(chain, tolerance) : [chain];
}

const turn = (c: CurveJson): CurveJson => reversed(c, "u")[0] as CurveJson;
