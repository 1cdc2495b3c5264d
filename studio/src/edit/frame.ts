// A frame that a hand draws on the plane.

import type { Plane } from "../views/plane";
import { run } from "../views/view";

/** Follows the hand from `event` until it lets go; `redraw` shows what is under the frame, `chosen` is told its corners, or
 *  `clicked` the place if the hand did not move. */
export function frame(plane: Plane, event: PointerEvent, redraw: () => void, clicked: (at: number[]) => void, chosen: (lower: readonly [number, number], upper: readonly [number, number]) => void): void {
    const box = plane.element.getBoundingClientRect();
    const at = (e: PointerEvent): number[] => plane.unproject(e.clientX - box.left, e.clientY - box.top, []);
    const [x0 = 0, y0 = 0] = at(event);
    let moved = false;
    const moving = (e: PointerEvent): void => {
        moved ||= Math.hypot(e.clientX - event.clientX, e.clientY - event.clientY) >= 3;
        if (!moved) return;
        const [x = 0, y = 0] = at(e);
        redraw();
        plane.line(run([[x0, y0], [x, y0], [x, y], [x0, y], [x0, y0]]), { colour: "focus", width: 1.4, dashed: true });
    };
    const ended = (e: PointerEvent): void => {
        window.removeEventListener("pointermove", moving);
        window.removeEventListener("pointerup", ended);
        if (!moved) { clicked(at(e)); return; }
        const [x = 0, y = 0] = at(e);
        chosen([Math.min(x, x0), Math.min(y, y0)], [Math.max(x, x0), Math.max(y, y0)]);
    };
    window.addEventListener("pointermove", moving);
    window.addEventListener("pointerup", ended);
}
