// What a hand takes hold of: small shapes over a view that are dragged with mouse, pen or finger, or moved with the arrow
// keys after Tab (Shift: ten times as far). Each speaks its name and place to a screen reader.

import { s, set, shown } from "../ui/dom";
import { round125, type Point, type View } from "./view";

export interface Handle {
    readonly label: string;
    readonly at: () => Point;
    readonly move: (to: number[], event?: PointerEvent) => void;
    /** What arrow keys do instead of moving it on the screen: steps to the right and up, ten with Shift. */
    readonly onStep?: (right: number, up: number) => void;
    readonly shape?: "circle" | "square" | "diamond" | "arrow";
    readonly colour?: string;
    readonly chosen?: () => boolean;
    readonly onPress?: (event: PointerEvent) => void;
    readonly onKey?: (event: KeyboardEvent) => void;
}

export interface HandleEvents {
    /** Before the first and after the last of the moves that belong together. */
    readonly begin?: () => void;
    readonly end?: () => void;
    /** The place that is meant when the hand is at `to`: grids, constraints. */
    readonly snap?: (to: number[], event: PointerEvent) => number[];
}

const kShapes = {
    circle: () => s("circle", { r: 5.5 }),
    square: () => s("rect", { x: -5, y: -5, width: 10, height: 10 }),
    diamond: () => s("path", { d: "M0-7 7 0 0 7-7 0Z" }),
    arrow: () => s("g", {}, s("path", { d: "M-7-6 9 0-7 6Z" })),
};

const kSteps: Record<string, readonly [number, number]> = {
    ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1],
};

export class Handles {
    readonly layer = s("g", { class: "handles" });
    private items: { handle: Handle; element: SVGGElement }[] = [];

    constructor(private readonly view: View, private readonly host: SVGSVGElement) {}

    /** Shows these handles instead of those before; focus stays on the one of the same number. */
    show(handles: readonly Handle[], events: HandleEvents = {}): void {
        const focused = this.items.findIndex((item) => item.element === document.activeElement);
        this.layer.replaceChildren();
        this.items = handles.map((handle) => ({ handle, element: this.make(handle, events) }));
        for (const item of this.items) this.layer.append(item.element);
        this.place();
        this.items[focused]?.element.focus({ preventScroll: true });
    }

    /** Moves all of them to where their points are now. */
    place(): void {
        for (const { handle, element } of this.items) {
            const at = handle.at();
            const [x, y] = this.view.project(at);
            const visible = Number.isFinite(x) && Number.isFinite(y);
            set(element, "transform", visible ? `translate(${x.toFixed(2)} ${y.toFixed(2)})` : null);
            set(element, "visibility", visible ? null : "hidden");
            set(element, "aria-valuetext", at.map((c) => shown(c, 4)).join(", "));
            set(element, "aria-valuenow", at[0]);
            if (handle.chosen) element.classList.toggle("chosen", handle.chosen());
        }
    }

    get count(): number { return this.items.length; }

    private make(handle: Handle, events: HandleEvents): SVGGElement {
        const element = s("g", { class: "handle", tabindex: 0, role: "slider", "aria-label": handle.label,
            style: handle.colour ? `--handle: var(--${handle.colour})` : null },
            s("circle", { class: "reach", r: 14 }), kShapes[handle.shape ?? "circle"](), s("title", {}, handle.label));
        element.addEventListener("pointerdown", (event) => { this.drag(handle, element, event, events); });
        element.addEventListener("keydown", (event) => { this.step(handle, event, events); });
        return element;
    }

    private drag(handle: Handle, element: SVGGElement, event: PointerEvent, events: HandleEvents): void {
        if (event.button !== 0) return;
        event.stopPropagation();
        event.preventDefault();
        element.focus({ preventScroll: true });
        handle.onPress?.(event);
        const frame = this.host.getBoundingClientRect();
        const [px, py] = this.view.project(handle.at());
        const dx = px - (event.clientX - frame.left), dy = py - (event.clientY - frame.top);
        const pointer = event.pointerId;
        let begun = false;
        const moved = (e: PointerEvent): void => {
            if (e.pointerId !== pointer) return;
            if (!begun && Math.hypot(e.clientX - event.clientX, e.clientY - event.clientY) < 2) return;
            if (!begun) { begun = true; events.begin?.(); }
            const to = this.view.unproject(e.clientX - frame.left + dx, e.clientY - frame.top + dy, handle.at());
            handle.move(events.snap ? events.snap(to, e) : to, e);
            this.place();
        };
        const released = (e: PointerEvent): void => {
            if (e.pointerId !== pointer) return;
            window.removeEventListener("pointermove", moved);
            window.removeEventListener("pointerup", released);
            window.removeEventListener("pointercancel", released);
            if (begun) events.end?.();
        };
        window.addEventListener("pointermove", moved);
        window.addEventListener("pointerup", released);
        window.addEventListener("pointercancel", released);
    }

    private step(handle: Handle, event: KeyboardEvent, events: HandleEvents): void {
        const step = kSteps[event.key];
        if (step === undefined || event.ctrlKey || event.metaKey) {
            handle.onKey?.(event);
            return;
        }
        event.preventDefault();
        event.stopPropagation();
        if (handle.onStep) {
            const far = event.shiftKey ? 10 : 1;
            events.begin?.();
            handle.onStep(step[0] * far, -step[1] * far);
            this.place();
            events.end?.();
            return;
        }
        // About four pixels, but a round number of model units, so that places stay easy to name.
        const at = handle.at();
        const [x, y] = this.view.project(at);
        const far = this.view.unproject(x + step[0] * 100, y + step[1] * 100, at);
        const length = Math.hypot(...far.map((c, i) => c - (at[i] ?? 0)));
        if (!(length > 0)) return;
        const scale = (round125(length / 20) * (event.shiftKey ? 10 : 1)) / length;
        events.begin?.();
        handle.move(at.map((c, i) => tidy(c + ((far[i] ?? 0) - c) * scale)));
        this.place();
        events.end?.();
    }
}

/** Without the dust of many small sums. */
const tidy = (x: number): number => Number(x.toPrecision(12));
