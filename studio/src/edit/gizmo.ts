// What moves, turns and scales the chosen control points in space: an arrow, an arc and a box for each axis, a disc that
// moves and a square that scales all of it. Always as large on the screen and over everything else. Tab reaches each
// part, arrow keys move it (Shift: ten times as far). Moves snap to round numbers, turns to 5 degrees, factors to 0.05.

import { s, set, shown } from "../ui/dom";
import { say, t, type Text } from "../ui/language";
import { Handles, type Handle } from "../views/handles";
import type { Space } from "../views/space";
import { round125 } from "../views/view";
import { shifted } from "./document";
import { across, along, angleBetween, kAxes, plus, scaledAbout, stepped, three, turnedAbout, type Three, type Way } from "./transform";

/** What the gizmo works on. */
export interface Held {
    /** The middle of what is chosen and how many points that are; nothing if none is. */
    readonly middle: () => { readonly at: Three; readonly count: number } | undefined;
    readonly begin: () => void;
    readonly end: () => void;
    /** Shows the points of `begin`, taken along this way. */
    readonly carry: (name: string, way: Way, said: string) => void;
    readonly snapping: () => boolean;
}

type Kind = "move" | "turn" | "scale";
interface Part { readonly kind: Kind; /** undefined: all axes at once. */ readonly axis: number | undefined }
/** A drag: where the middle was, the part that is held, and how far it was taken. */
interface Hold { readonly part: Part; readonly middle: Three; readonly start: Three; readonly unit: number; by: number }

/** Pixels from the middle to the heads of arrows, the boxes, the arcs, and the square (to the left and down). */
const kArm = 124, kBox = 94, kArc = 66, kSquare = 34;
const kColours = ["axis-x", "axis-y", "axis-z"] as const;
const kNames: Record<Kind, Text> = { move: t("Verschieben", "move"), turn: t("Drehen", "turn"), scale: t("Vergrößern", "scale") };
const kShapes = { move: "arrow", turn: "circle", scale: "square" } as const;
const axisOf = (part: Part): Three => kAxes[part.axis ?? 2] ?? kAxes[2];

export class Gizmo {
    private readonly lines = s("g", { class: "gizmo", "aria-hidden": "true" });
    private readonly handles: Handles;
    private parts: Part[] = [];
    private hold: Hold | undefined;

    constructor(private readonly space: Space, private readonly held: Held) {
        this.handles = new Handles(space, space.overlay);
        this.handles.layer.classList.add("parts");
        space.overlay.append(this.lines, this.handles.layer);
        space.onDrawn = () => { this.place(); };
    }

    /** For what is chosen now: one point can be moved, more can also be turned and scaled. */
    show(wanted: boolean): void {
        const count = wanted ? this.held.middle()?.count ?? 0 : 0;
        const axes = [0, 1, 2];
        this.parts = count === 0 ? [] : axes.map((axis) => ({ kind: "move", axis }));
        if (count > 1) this.parts.push(...axes.map((axis): Part => ({ kind: "turn", axis })), ...axes.map((axis): Part => ({ kind: "scale", axis })),
            { kind: "move", axis: undefined }, { kind: "scale", axis: undefined });
        this.lines.replaceChildren();
        this.handles.show(this.parts.map((part) => this.handle(part)), { begin: () => { this.held.begin(); },
            end: () => { this.hold = undefined; this.held.end(); } });
        this.place();
    }

    private place(): void {
        const middle = this.middle();
        if (this.parts.length === 0) return;
        this.lines.replaceChildren(...this.parts.flatMap((part): SVGElement[] => {
            if (part.axis === undefined || part.kind === "scale") return [];
            const corners = (part.kind === "move" ? [middle, this.at(part)] : this.arc(part.axis, middle)).map((p) => this.space.project(p));
            if (!corners.flat().every(Number.isFinite)) return [];
            return [s("path", { d: `M${corners.map(([x, y]) => `${x.toFixed(1)} ${y.toFixed(1)}`).join("L")}`, style: `stroke: var(--${kColours[part.axis] ?? "ink"})` })];
        }));
        this.handles.place();
        this.parts.forEach((part, i) => { this.aim(part, this.handles.layer.children[i]); });
    }

    /** The head of an arrow points away from the middle. What points at the eye cannot be moved along by a hand. */
    private aim(part: Part, element: Element | undefined): void {
        if (!element || part.kind === "turn" || part.axis === undefined) return;
        const [x, y] = this.space.project(this.middle()), [a, b] = this.space.project(this.at(part));
        if (!(Math.hypot(a - x, b - y) > 16)) set(element, "visibility", "hidden");
        else if (part.kind === "move") set(element.children[1]?.firstElementChild ?? element, "transform", `rotate(${((Math.atan2(b - y, a - x) * 180) / Math.PI).toFixed(1)})`);
    }

    private middle(): Three { return this.held.middle()?.at ?? [0, 0, 0]; }

    /** Model units per pixel in the middle. */
    private unit(at: Three): number {
        const [x, y] = this.space.project(at), q = three(this.space.unproject(x + 100, y, at));
        const d = plus(q, at, -1);
        return Math.hypot(...d) / 100;
    }

    private arc(axis: number, middle: Three): Three[] {
        const u = kAxes[(axis + 1) % 3] ?? kAxes[0], v = kAxes[(axis + 2) % 3] ?? kAxes[1], r = kArc * this.unit(middle);
        return Array.from({ length: 13 }, (_, i) => { const a = (i * Math.PI) / 24; return plus(plus(middle, u, r * Math.cos(a)), v, r * Math.sin(a)); });
    }

    /** Where a part is taken hold of; what is held follows the hand. */
    private at(part: Part): Three {
        const hold = this.hold?.part.kind === part.kind && this.hold.part.axis === part.axis ? this.hold : undefined;
        const middle = this.middle(), unit = this.unit(middle);
        if (part.axis === undefined) {
            if (part.kind === "move") return middle;
            const [x, y] = this.space.project(middle), far = kSquare * (hold ? hold.by : 1);
            return three(this.space.unproject(x - far, y + far, middle));
        }
        if (part.kind === "turn") {
            const rest = this.arc(part.axis, middle)[6] ?? middle;
            return hold ? three(turnedAbout(middle, axisOf(part), hold.by)(rest)) : rest;
        }
        return plus(middle, axisOf(part), unit * (part.kind === "move" ? kArm : kBox * (hold ? hold.by : 1)));
    }

    private handle(part: Part): Handle {
        const axis = part.axis === undefined ? say(t("frei", "freely")) : say(t(`Achse ${"xyz"[part.axis] ?? ""}`, `axis ${"xyz"[part.axis] ?? ""}`));
        return {
            label: `${say(kNames[part.kind])}, ${part.axis === undefined && part.kind === "scale" ? say(t("ganz", "as a whole")) : axis}`,
            at: () => this.at(part), shape: part.kind === "move" && part.axis === undefined ? "circle" : kShapes[part.kind],
            colour: part.axis === undefined ? "ink-soft" : kColours[part.axis] ?? "ink-soft",
            move: (to, event) => { this.drag(part, to, event?.altKey === true); },
            onStep: (steps, across) => { this.step(part, steps, across); },
        };
    }

    private drag(part: Part, to: readonly number[], free: boolean): void {
        const hold = this.hold ??= { part, middle: this.middle(), start: this.at(part), unit: this.unit(this.middle()), by: part.kind === "scale" ? 1 : 0 };
        const snap = this.held.snapping() && !free, axis = axisOf(part), round = round125(8 * hold.unit);
        const [x, y] = this.space.project(to), sight = this.space.sight(x, y);
        if (part.axis === undefined) { this.dragAll(hold, to, x, y, snap); return; }
        if (part.kind === "turn") {
            const angle = this.angle(hold, to, x, y);
            if (angle !== undefined) this.turn(hold, snap ? (stepped((angle * 180) / Math.PI, 5) * Math.PI) / 180 : angle);
            return;
        }
        const far = along(sight, hold.middle, axis), first = (part.kind === "move" ? kArm : kBox) * hold.unit;
        if (far === undefined) return;
        if (part.kind === "move") this.shift(plus([0, 0, 0], axis, snap ? stepped(far - first, round) : far - first));
        else this.scale(hold, snap ? stepped(far / first, 0.05) : far / first);
    }

    private dragAll(hold: Hold, to: readonly number[], x: number, y: number, snap: boolean): void {
        if (hold.part.kind === "move") {
            const by = plus(three(to), hold.middle, -1), round = round125(8 * hold.unit);
            this.shift(snap ? three(by.map((c) => stepped(c, round))) : by);
            return;
        }
        const [cx, cy] = this.space.project(hold.middle), k = Math.hypot(x - cx, y - cy) / (kSquare * Math.SQRT2);
        this.scale(hold, snap ? stepped(k, 0.05) : k);
    }

    /** Seen from the side, an arc is turned by how far the hand goes along it. */
    private angle(hold: Hold, to: readonly number[], x: number, y: number): number | undefined {
        const axis = axisOf(hold.part), here = across(this.space.sight(x, y), hold.middle, axis);
        if (here) {
            // The nearest of the angles that look the same, so that a hand may go round more than once.
            const angle = angleBetween(hold.middle, axis, hold.start, here);
            return angle + 2 * Math.PI * Math.round((hold.by - angle) / (2 * Math.PI));
        }
        const ahead = three(turnedAbout(hold.middle, axis, 0.01)(hold.start));
        const [a, b] = this.space.project(hold.start), [c, d] = this.space.project(ahead);
        const px = (c - a) / 0.01, py = (d - b) / 0.01, length = px * px + py * py;
        const [u, v] = this.space.project(to);
        return length > 1 ? ((u - a) * px + (v - b) * py) / length : undefined;
    }

    private shift(by: Three): void {
        this.held.carry(say(kNames.move), shifted(by), by.map((c) => shown(c, 4)).join(", "));
    }

    private turn(hold: Hold, angle: number): void {
        hold.by = angle;
        this.held.carry(say(kNames.turn), turnedAbout(hold.middle, axisOf(hold.part), angle), `${shown((angle * 180) / Math.PI, 4)}°`);
    }

    private scale(hold: Hold, factor: number): void {
        // What is scaled to nothing could not be taken hold of again.
        hold.by = Math.max(0.01, factor);
        const { axis } = hold.part;
        this.held.carry(say(kNames.scale), scaledAbout(hold.middle, [0, 1, 2].map((i) => (axis === undefined || axis === i ? hold.by : 1))), `× ${shown(hold.by, 4)}`);
    }

    /** One press of an arrow key: a round length of about four pixels, 1 degree, 1 percent; ten with Shift. */
    private step(part: Part, right: number, up: number): void {
        const middle = this.middle(), unit = this.unit(middle), steps = right + up;
        const hold = this.hold = { part, middle, start: this.at(part), unit, by: 0 };
        const far = round125(5 * unit);
        if (part.kind === "turn") this.turn(hold, (steps * Math.PI) / 180);
        else if (part.kind === "scale") this.scale(hold, 1 + 0.01 * steps);
        else if (part.axis !== undefined) this.shift(plus([0, 0, 0], axisOf(part), far * steps));
        else {
            const [x, y] = this.space.project(middle);
            const to = plus(three(this.space.unproject(x + (100 * right), y - (100 * up), middle)), middle, -1), length = Math.hypot(...to);
            if (length > 0) this.shift(plus([0, 0, 0], to, (far * Math.abs(steps)) / length));
        }
    }
}
