// How large a document is: control points say so, and the module where an object has none.

import type { ObjectJson } from "freiform";
import { ff } from "../kernel/module";
import { editable, pointsOf, type Document } from "./document";

type Corner = readonly number[];

/** Objects are values: what was asked of one is asked once. */
const asked = new WeakMap<ObjectJson, readonly Corner[]>();

/** Two corners of a box around the object; as large as the module finds it without looking closely. */
function boxOf(object: ObjectJson): readonly Corner[] {
    const known = asked.get(object);
    if (known) return known;
    let corners: readonly Corner[] = [];
    try {
        const { box } = ff().run("bounds", { freiform: 1, objects: [object] }, { accuracy: 1e300 }).json as { box?: { min: number[]; max: number[] } | null };
        if (box) corners = [box.min, box.max];
    } catch { /* What the module refuses here it refuses to draw, too, and says so there. */ }
    asked.set(object, corners);
    return corners;
}

/** Points that the box around everything is the box of. */
export const corners = (document: Document): Corner[] => document.objects.flatMap((o) => [...(editable(o) ? pointsOf(o) : boxOf(o))]);

/** The longest side of that box. */
export function extent(document: Document): number {
    const all = corners(document);
    let most = 0;
    for (let k = 0; k < 3; ++k) {
        const at = all.map((p) => p[k] ?? 0);
        if (at.length > 0) most = Math.max(most, at.reduce((a, b) => Math.max(a, b)) - at.reduce((a, b) => Math.min(a, b)));
    }
    return most > 0 ? most : 1;
}
