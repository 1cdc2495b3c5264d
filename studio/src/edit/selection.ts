// What is chosen: objects by number, and control points by object and number. Numbers change when objects come and go;
// what is chosen follows its object.

import type { ObjectJson } from "freiform";
import { pointsOf, type Document, type Place } from "./document";

const keyOf = ({ object, point }: Place): string => `${object}:${point}`;

export class Selection {
    readonly objects = new Set<number>();
    private readonly keys = new Set<string>();

    get size(): number { return this.keys.size; }

    get places(): readonly Place[] {
        return [...this.keys].map((key) => { const [object = 0, point = 0] = key.split(":").map(Number); return { object, point }; });
    }

    has(place: Place): boolean { return this.keys.has(keyOf(place)); }

    add(place: Place): void { this.keys.add(keyOf(place)); }

    toggle(place: Place): void { if (!this.keys.delete(keyOf(place))) this.add(place); }

    /** This point and no other. */
    only(place: Place): void {
        this.keys.clear();
        this.add(place);
    }

    clear(): void {
        this.objects.clear();
        this.keys.clear();
    }

    clearPoints(): void { this.keys.clear(); }

    all(document: Document): void {
        document.objects.forEach((o, object) => { this.objects.add(object); pointsOf(o).forEach((_, point) => { this.add({ object, point }); }); });
    }

    /** The document has become another: what is still there stays chosen, whatever its number is now. */
    follow(from: Document, to: Document): void {
        const now = successors(from.objects, to.objects), objects = [...this.objects], places = this.places;
        this.clear();
        for (const i of objects) for (const k of now[i] ?? []) this.objects.add(k);
        for (const { object, point } of places) {
            const [k, ...more] = now[object] ?? [];
            if (k !== undefined && more.length === 0 && point < pointsOf(to.objects[k]).length) this.add({ object: k, point });
        }
    }

    /** The objects that are chosen, or those of the points that are. */
    get owners(): number[] { return this.objects.size > 0 ? [...this.objects] : [...new Set(this.places.map((p) => p.object))]; }

    /** The points that are chosen, or all of the objects that are. */
    meant(document: Document): readonly Place[] {
        if (this.keys.size > 0) return this.places;
        return [...this.objects].flatMap((object) => pointsOf(document.objects[object]).map((_, point) => ({ object, point })));
    }

    /** The middle of the points that are meant. */
    centre(document: Document): [number, number, number] {
        const all = this.meant(document).map(({ object, point }) => pointsOf(document.objects[object])[point] ?? []);
        const mean = (k: number): number => all.reduce((sum, p) => sum + (p[k] ?? 0), 0) / Math.max(1, all.length);
        return [mean(0), mean(1), mean(2)];
    }
}

/** Where each of the objects is among those of the next state: itself, or what stands between the same neighbours in its
 *  place: the same changed, its pieces, or the whole that it was a piece of. */
export function successors(from: readonly ObjectJson[], to: readonly ObjectJson[]): number[][] {
    const at = new Map(to.map((o, i) => [o, i]));
    const out = from.map((o) => { const k = at.get(o); return k === undefined ? [] : [k]; });
    for (let i = 0, free = 0; i < from.length;) {
        const [same] = out[i] ?? [];
        if (same !== undefined) { free = same + 1; ++i; continue; }
        let end = i;
        while (end < from.length && out[end]?.length === 0) ++end;
        const stop = out[end]?.[0] ?? to.length, count = stop - free;
        const fits = (k: number, j: number): boolean => akin(from[i + k], to[free + j]);
        const old = from.slice(i, end).map((_, k) => k), next = to.slice(free, stop).map((_, j) => j);
        const paired = old.length === count && old.every((k) => fits(k, k));
        for (const k of old) out[i + k] = next.filter((j) => (paired ? j === k : fits(k, j))).map((j) => free + j);
        i = end;
    }
    return out;
}

/** Of one name; pieces have that of the whole and a point in front. */
function akin(a: ObjectJson | undefined, b: ObjectJson | undefined): boolean {
    const p = a?.name ?? "", q = b?.name ?? "";
    return p === q || q.startsWith(`${p}.`) || p.startsWith(`${q}.`);
}
