// What is chosen: objects by number, and control points by object and number.

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

    /** Without what the document no longer has. */
    prune(document: Document): void {
        for (const i of this.objects) if (i >= document.objects.length) this.objects.delete(i);
        for (const place of this.places) if (place.point >= pointsOf(document.objects[place.object]).length) this.keys.delete(keyOf(place));
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
