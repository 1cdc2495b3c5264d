// The list of faces: first those that were refused, then all others, the chosen one marked, the next thousands on demand.

import { h } from "../ui/dom";
import { say, t } from "../ui/language";

export interface Refused { readonly where: string; readonly kind: string; readonly message: string }
export interface Face { readonly shape: number; readonly face: number; readonly text: string }
type Chosen = { readonly shape: number; readonly face: number } | undefined;

/** So many entries come at a time, as the page has to lay them all out. */
const kAtOnce = 2000;

export class Faces {
    readonly element = h("ul", { class: "list", "aria-label": say(t("Flächen", "Faces")) });
    private faces: readonly Face[] = [];
    private listed = 0;
    private chosen: Chosen;

    /** `choose` and `explain` are told what the reader asks for. */
    constructor(private readonly choose: (chosen: Chosen) => void, private readonly explain: (refused: Refused) => void) {}

    show(refused: readonly Refused[], faces: readonly Face[], chosen: Chosen): void {
        this.faces = faces;
        this.chosen = chosen;
        this.listed = 0;
        this.element.replaceChildren(...refused.map((r) => h("li", { class: "bad" }, h("button", { onclick: () => { this.explain(r); } }, `⚠ ${r.where}: ${r.message}`))));
        const at = faces.findIndex((face) => this.is(face));
        do this.more(); while (this.listed <= at);
        const mark = this.element.querySelector<HTMLElement>('[aria-pressed="true"]');
        // The list alone is scrolled: the panel stays under the hand.
        if (mark) this.element.scrollTop = mark.offsetTop - this.element.offsetTop - (this.element.clientHeight - mark.offsetHeight) / 2;
    }

    private is({ shape, face }: Face): boolean { return this.chosen?.shape === shape && this.chosen.face === face; }

    private more(): void {
        const next = this.faces.slice(this.listed, this.listed + kAtOnce);
        this.listed += next.length;
        this.element.append(...next.map((face) => this.entry(face)));
        const rest = this.faces.length - this.listed;
        if (rest === 0) return;
        const more = h("li", {}, h("button", { onclick: () => { more.remove(); this.more(); } }, say(t(`… noch ${rest}: weitere zeigen`, `… ${rest} more: show them`))));
        this.element.append(more);
    }

    private entry(face: Face): HTMLElement {
        const button = h("button", { "aria-pressed": String(this.is(face)), onclick: () => {
            const on = !this.is(face);
            this.element.querySelectorAll("[aria-pressed]").forEach((b) => { b.setAttribute("aria-pressed", "false"); });
            button.setAttribute("aria-pressed", String(on));
            this.chosen = on ? face : undefined;
            this.choose(this.chosen);
        } }, face.text);
        return h("li", {}, button);
    }
}
