// What hands take hold of in the editor: the control points, and in space the gizmo over those that are chosen.

import { say, t } from "../ui/language";
import type { Handle } from "../views/handles";
import { Plane } from "../views/plane";
import { Space } from "../views/space";
import type { View } from "../views/view";
import { moved, pointsOf, raised, shifted, type Document, type Place } from "./document";
import { Gizmo } from "./gizmo";
import type { History } from "./history";
import type { Selection } from "./selection";

const kMostHandles = 600;

export interface Hosted {
    readonly history: () => History<Document>;
    readonly selection: Selection;
    readonly snapping: () => boolean;
    /** Whether points are chosen beside those that are, as with Shift. */
    readonly more: () => boolean;
    /** Other points are chosen. */
    readonly chose: () => void;
    /** A movement has ended. */
    readonly settled: () => void;
}

export class Hands {
    /** Whether the gizmo is wanted. */
    gizmo = true;
    /** What is told of a movement of the gizmo while it lasts. */
    said = "";
    /** What is told if not all points can be taken hold of. */
    lacking = "";
    private view: View | undefined;
    private grips: Gizmo | undefined;
    private dragged: Place | undefined;

    constructor(private readonly host: Hosted) {}

    show(view: View): void {
        if (view !== this.view) this.grips = view instanceof Space ? this.gripsIn(view) : undefined;
        this.view = view;
        this.said = "";
        const { objects } = this.document, chosen = this.host.selection.objects;
        const count = objects.reduce((n, o) => n + pointsOf(o).length, 0);
        const shown = objects.flatMap((o, object) => (chosen.has(object) || (chosen.size === 0 && count <= kMostHandles) ? pointsOf(o).map((_, point) => ({ object, point })) : []));
        const held = shown.slice(0, kMostHandles), meant = chosen.size === 0 ? count : shown.length;
        this.lacking = held.length === meant ? "" : say(t(`${held.length} von ${meant} Punkten lassen sich greifen`, `${held.length} of ${meant} points can be taken hold of`)) + (chosen.size === 0 ? say(t(": wählen Sie ein Objekt", ": choose an object")) : "");
        view.handles.show(held.map((place) => this.handle(place)), {
            begin: () => { this.host.history().begin(); }, end: () => { this.dragged = undefined; this.host.history().end(); this.host.settled(); },
            snap: (to, event) => (this.host.snapping() && !event.altKey ? this.snapped(to) : to) });
        this.grips?.show(this.gizmo);
    }

    /** The nearest other control point within reach, or else the grid; of `all`, or of those that do not move along. */
    snapped(to: number[], all = false): number[] {
        const { view, dragged } = this;
        if (!view) return to;
        const [x, y] = view.project(to);
        for (const [object, o] of this.document.objects.entries())
            for (const [point, p] of pointsOf(o).entries()) {
                if (!all && (dragged?.object === object && dragged.point === point || this.host.selection.has({ object, point }))) continue;
                const [a, b] = view.project(p);
                if (Math.hypot(a - x, b - y) < 9) return [...p];
            }
        if (!(view instanceof Plane)) return to;
        const step = 10 ** Math.floor(Math.log10(view.unit * 24));
        return to.map((c) => Number((Math.round(c / step) * step).toPrecision(12)));
    }

    private get document(): Document { return this.host.history().state; }

    private at({ object, point }: Place): readonly number[] { return pointsOf(this.document.objects[object])[point] ?? []; }

    private handle(place: Place): Handle {
        const { selection } = this.host;
        const chose = (): void => { this.host.chose(); this.view?.handles.place(); this.grips?.show(this.gizmo); };
        return {
            label: `${this.document.objects[place.object]?.name ?? place.object + 1}, ${say(t("Punkt", "point"))} ${place.point}`,
            at: () => this.at(place), chosen: () => selection.has(place), colour: selection.objects.has(place.object) ? "hot" : "control",
            onPress: (event) => {
                if (event.shiftKey || this.host.more()) selection.toggle(place);
                else if (!selection.has(place)) selection.only(place);
                this.dragged = place;
                chose();
            },
            onKey: (event) => {
                if (event.key !== "Enter" && event.key !== " ") return;
                event.preventDefault();
                if (event.shiftKey || this.host.more()) selection.toggle(place);
                else selection.only(place);
                chose();
            },
            move: (to) => {
                const from = this.at(place), by = to.map((x, i) => x - (from[i] ?? 0));
                this.host.history().carry(say(t("Ziehen", "drag")), moved(this.document, selection.has(place) ? selection.places : [place], shifted(by)));
            },
        };
    }

    private gripsIn(space: Space): Gizmo {
        const { selection } = this.host, history = (): History<Document> => this.host.history();
        let before = this.document, places: readonly Place[] = [];
        return new Gizmo(space, {
            middle: () => {
                const count = selection.meant(this.document).length;
                return count > 0 ? { at: selection.centre(this.document), count } : undefined;
            },
            begin: () => {
                places = selection.meant(this.document);
                // What lies in the plane of x and y may be taken out of it.
                before = places.every((place) => this.at(place).length >= 3) ? this.document : raised(this.document);
                history().begin();
            },
            end: () => { this.said = ""; history().end(); this.host.settled(); },
            carry: (name, way, said) => { if (history().busy) this.said = `${name}: ${said}`; history().carry(name, moved(before, places, way)); },
            snapping: this.host.snapping });
    }
}
