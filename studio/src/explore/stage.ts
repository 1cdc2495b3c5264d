// What a page of Explore is built from: figures, knobs, a readout. A page says once how its picture follows from its
// knobs; the stage runs that before the next picture whenever something was touched.

import { arena, type DocumentJson, type Make } from "../kernel/module";
import { calm, coalesced, h, shown } from "../ui/dom";
import { say, t, type Text } from "../ui/language";
import { kindNamed, refusal } from "../ui/toast";
import type { Handle, HandleEvents } from "../views/handles";
import { Plane, type PlaneOptions } from "../views/plane";
import { Space } from "../views/space";
import type { View } from "../views/view";

export interface Page {
    readonly row: string;
    readonly title: Text;
    /** One line for the table of contents. */
    readonly gist: Text;
    readonly text: Text;
    /** In the notation of formula.ts; several lines. */
    readonly formula?: string;
    build(stage: Stage): void;
}

export interface Knob { value: number }
export interface SliderOptions { readonly min: number; readonly max: number; readonly step?: number; readonly value: number }

export class Stage {
    readonly figures = h("div", { class: "stage" });
    readonly knobs = h("div", { class: "knobs" });
    private readonly status = h("div", { class: "readout", role: "status", "aria-live": "polite" });
    private readonly views: { dispose(): void }[] = [];
    private readonly ends: (() => void)[] = [];
    private act: (make: Make) => void = () => undefined;
    private document: (() => DocumentJson) | undefined;
    private row: HTMLElement | undefined;
    /** Draws anew before the next picture. */
    readonly changed = coalesced(() => { this.draw(); });

    constructor() { this.knobs.append(this.status); }

    /** How the picture follows from the knobs. */
    update(act: (make: Make) => void): void {
        this.act = act;
        this.changed();
    }

    /** What "open in editor" opens. */
    opens(document: () => DocumentJson): void { this.document = document; }

    get opened(): (() => DocumentJson) | undefined { return this.document; }

    /** Figures until the next call of `beside` stand side by side. */
    beside(): void {
        this.row = this.row ? undefined : h("div", { class: "stage-row" });
        if (this.row) this.figures.append(this.row);
    }

    plane(options: PlaneOptions): Plane {
        const plane = new Plane(options);
        this.place(plane);
        return plane;
    }

    graph(label: Text, height = 190): Plane {
        return this.plane({ label: say(label), graph: true, movable: false, height });
    }

    space(label: Text): Space {
        const space = new Space(say(label));
        space.onColours = this.changed;
        this.place(space);
        return space;
    }

    slider(label: Text, options: SliderOptions): Knob {
        const out = h("output", {}, shown(options.value));
        const input = h("input", { type: "range", min: options.min, max: options.max, step: options.step ?? (options.max - options.min) / 500,
            value: options.value, "aria-label": say(label), oninput: () => {
                knob.value = input.valueAsNumber;
                out.textContent = shown(knob.value);
                this.changed();
            } });
        this.add(h("label", { class: "knob" }, h("span", {}, say(label)), out, input));
        let value = options.value;
        const knob = {
            get value() { return value; },
            set value(x: number) { value = x; input.value = String(x); out.textContent = shown(x); },
        };
        return knob;
    }

    choice<K extends string>(label: Text, options: Record<K, Text>, first: NoInfer<K>, chosen?: (key: K) => void): { value: K } {
        const choice: { value: K } = { value: first };
        const keys = Object.keys(options) as K[];
        const buttons = keys.map((key) => h("button", { type: "button", "aria-pressed": String(key === first), onclick: () => {
            choice.value = key;
            buttons.forEach((button, i) => { button.setAttribute("aria-pressed", String(keys[i] === key)); });
            chosen?.(key);
            this.changed();
        } }, say(options[key])));
        this.add(h("div", { role: "group", "aria-label": say(label) }, h("div", { class: "hint" }, say(label)), h("div", { class: "choice" }, ...buttons)));
        return choice;
    }

    toggle(label: Text, value: boolean): { value: boolean } {
        const toggle = { value };
        const input = h("input", { type: "checkbox", onchange: () => { toggle.value = input.checked; this.changed(); } });
        input.checked = value;
        this.add(h("label", { class: "check" }, input, say(label)));
        return toggle;
    }

    button(label: Text, act: () => void): HTMLButtonElement {
        const button = h("button", { type: "button", onclick: () => { act(); this.changed(); } }, say(label));
        this.add(button);
        return button;
    }

    add(element: HTMLElement): void { this.knobs.insertBefore(element, this.status); }

    hint(text: Text): void { this.add(h("p", { class: "hint" }, say(text))); }

    /** Lines of the readout: pairs become a table. */
    say(rows: readonly (readonly [string, string | Node])[] | string): void {
        this.status.classList.remove("refused");
        this.status.replaceChildren(typeof rows === "string" ? rows
            : h("table", {}, ...rows.map(([name, value]) => h("tr", {}, h("th", { scope: "row" }, name), h("td", {}, value)))));
    }

    /** Points that can be dragged: each changes in place, then the picture follows. */
    hold(view: View, points: number[][], names: (i: number) => string, more: Partial<Handle> = {}, events: HandleEvents = {}): void {
        view.handles.show(this.handlesOf(points, names, more), events);
    }

    handlesOf(points: number[][], names: (i: number) => string, more: Partial<Handle> = {}): Handle[] {
        return points.map((point, i) => ({ label: names(i), at: () => point,
            move: (to) => { to.forEach((x, k) => { point[k] = x; }); this.changed(); }, ...more }));
    }

    /** A slider that runs by itself once its button is pressed. */
    player(label: Text, options: SliderOptions, seconds = 4): Knob {
        const knob = this.slider(label, options);
        let before = 0, running = false;
        const step = (now: number): void => {
            if (!running || !this.figures.isConnected) return;
            const share = before === 0 ? 0 : (now - before) / (1000 * seconds);
            before = now;
            const next = knob.value + share * (options.max - options.min);
            knob.value = next > options.max ? options.min : next;
            this.changed();
            requestAnimationFrame(step);
        };
        const set = (on: boolean): void => {
            running = on;
            before = 0;
            button.setAttribute("aria-pressed", String(on));
            button.textContent = say(on ? t("Anhalten", "Pause") : t("Abspielen", "Play"));
            if (on) requestAnimationFrame(step);
        };
        const button = this.button(t("Abspielen", "Play"), () => { set(!running); });
        button.setAttribute("aria-pressed", "false");
        if (calm()) button.title = "prefers-reduced-motion";
        this.ends.push(() => { running = false; });
        return knob;
    }

    dispose(): void {
        for (const end of this.ends) end();
        for (const view of this.views) view.dispose();
    }

    private place(view: View): void {
        this.views.push(view);
        (this.row ?? this.figures).append(view.element);
    }

    private draw(): void {
        if (!this.figures.isConnected) return;
        try {
            arena(this.act);
        } catch (error) {
            const { kind, where, message } = refusal(error);
            this.status.classList.add("refused");
            this.status.replaceChildren(h("strong", {}, kindNamed(kind)), where === "" ? ": " : ` (${where}): `, message);
        }
    }
}
