// What a hand chooses in space: the curve or surface under a click, the points in a frame.

import { arena } from "../kernel/module";
import { s, set } from "../ui/dom";
import type { Space } from "../views/space";
import type { Document } from "./document";

/** The surfaces in the picture, and the number of the object that each is of. */
export type Sheets = Map<ReturnType<Space["surface"]>, number>;

/** How far a click may be from a curve, in pixels, and how far a hand may move in a click. */
const kReach = 12, kStill = 3;

/** The distance of `p` from the segment between `a` and `b`. */
function away([x, y]: readonly [number, number], [ax, ay]: readonly [number, number], [bx, by]: readonly [number, number]): number {
    const dx = bx - ax, dy = by - ay, square = dx * dx + dy * dy;
    const k = square > 0 ? Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / square)) : 0;
    return Math.hypot(x - ax - k * dx, y - ay - k * dy);
}

/** The object under a pixel: the nearest curve within reach, or else the foremost surface. */
export function under(space: Space, document: Document, sheets: Sheets, tolerance: number, x: number, y: number): number | undefined {
    let found: number | undefined, least = kReach;
    arena((make) => { document.objects.forEach((o, i) => {
        if (o.type !== undefined && o.type !== "curve") return;
        const shape = make(o);
        for (const { points } of shape.polylines(tolerance)) {
            const at = (k: number): readonly [number, number] => space.project(Array.from(points.subarray(k, k + shape.dimension)));
            for (let k = shape.dimension; k < points.length; k += shape.dimension) {
                const far = away([x, y], at(k - shape.dimension), at(k));
                if (far < least) { least = far; found = i; }
            }
        }
    }); });
    if (found !== undefined) return found;
    const eye = space.sight(x, y).from;
    let first = Infinity;
    for (const [mesh, i] of sheets) {
        const hit = space.pick(x, y, mesh);
        const far = hit ? Math.hypot(...hit.point.map((c, k) => c - (eye[k] ?? 0))) : Infinity;
        if (far < first) { first = far; found = i; }
    }
    return found;
}

export interface Touched {
    /** Whether a drag that begins so draws a frame instead of moving the eye. */
    readonly framing: (event: PointerEvent) => boolean;
    readonly clicked: (x: number, y: number, event: PointerEvent) => void;
    /** A frame was drawn: `has` tells what is in it. */
    readonly framed: (has: (point: readonly number[]) => boolean) => void;
}

/** Watches clicks and frames beside all handles. */
export function watch(space: Space, touched: Touched): void {
    space.element.addEventListener("pointerdown", (event) => {
        if (event.target !== space.canvas || event.button !== 0) return;
        const framing = touched.framing(event), box = space.canvas.getBoundingClientRect();
        // The eye is not moved by what draws a frame.
        if (framing) event.stopPropagation();
        const x0 = event.clientX - box.left, y0 = event.clientY - box.top, shape = s("rect", { fill: "none", stroke: "var(--focus)", "stroke-width": 1.4, "stroke-dasharray": "5 5" });
        let moved = false, others = false;
        const corners = (e: PointerEvent): [number, number, number, number] => {
            const x = e.clientX - box.left, y = e.clientY - box.top;
            return [Math.min(x, x0), Math.min(y, y0), Math.max(x, x0), Math.max(y, y0)];
        };
        const moving = (e: PointerEvent): void => {
            if (e.pointerId !== event.pointerId) return;
            moved ||= Math.hypot(e.clientX - event.clientX, e.clientY - event.clientY) >= kStill;
            if (!moved || !framing) return;
            const [x, y, right, low] = corners(e);
            for (const [name, value] of Object.entries({ x, y, width: right - x, height: low - y })) set(shape, name, value);
            if (!shape.isConnected) space.overlay.append(shape);
        };
        const joined = (e: PointerEvent): void => { others ||= e !== event; };
        const ended = (e: PointerEvent): void => {
            if (e.pointerId !== event.pointerId) return;
            stop.abort();
            shape.remove();
            if (others || e.type === "pointercancel") return;
            if (!moved) touched.clicked(x0, y0, event);
            else if (framing) {
                const [x, y, right, low] = corners(e);
                touched.framed((point) => { const [a, b] = space.project(point); return a >= x && a <= right && b >= y && b <= low; });
            }
        };
        const stop = new AbortController(), { signal } = stop;
        window.addEventListener("pointermove", moving, { signal });
        window.addEventListener("pointerup", ended, { signal });
        window.addEventListener("pointercancel", ended, { signal });
        window.addEventListener("pointerdown", joined, { signal, capture: true });
    }, { capture: true });
}
