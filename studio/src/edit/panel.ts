// The column of tools beside the drawing: objects, numbers of what is chosen, knots, changes, construction.

import type { ObjectJson } from "freiform";
import { h, set, shown } from "../ui/dom";
import { say, t, type Text } from "../ui/language";
import { refuse } from "../ui/toast";
import { Plane } from "../views/plane";
import { run } from "../views/view";
import { clamped, editable, pointsOf, weightsOf } from "./document";
import { numbersOf, oneOf } from "./numbers";
import type { Axis } from "./tools";
import { kKinds } from "./words";
import type { Editor } from "./editor";

const number = (label: string, set: (x: number) => void): { element: HTMLElement; show: (x: number) => void } => {
    const input = h("input", { type: "number", step: "any", "aria-label": label, onchange: () => { if (Number.isFinite(input.valueAsNumber)) set(input.valueAsNumber); } });
    return { element: h("label", { class: "knob" }, h("span", {}, label), input), show: (x) => { if (input.valueAsNumber !== x) input.value = String(x); } };
};

const field = (label: Text, value: string): { element: HTMLElement; numbers: () => number[]; number: () => number } => {
    const input = h("input", { type: "text", value, "aria-label": say(label), inputmode: "decimal" });
    return { element: h("label", { class: "knob" }, h("span", {}, say(label)), input), numbers: () => numbersOf(input.value), number: () => oneOf(input.value) };
};

const kind = ({ type = "curve" }: ObjectJson): string => (kKinds[type] ? say(kKinds[type]) : type);

/** Elements with a display of their own do not heed `hidden`. */
function present(element: HTMLElement, on: boolean): void { element.style.display = on ? "" : "none"; }

/** What a reader wrote may be refused. */
function attempt(does: () => void): void { try { does(); } catch (error) { refuse(error); } }

const heading = (text: Text): HTMLElement => h("h2", {}, say(text));

export class Panel {
    readonly element: HTMLElement;
    private readonly list = h("ul", { class: "list" });
    private readonly nothing = h("p", { class: "hint" }, say(t("Noch nichts. Mit B (Stift) klicken Sie Kontrollpunkte, oder öffnen Sie eine Datei.", "Nothing yet. With B (pen) click control points, or open a file.")));
    private readonly counted = h("h2");
    private coordinates: ReturnType<typeof number>[] = [];
    private readonly weight = number(say(t("Gewicht", "weight")), (to) => { this.editor.weigh(to); });
    private readonly numbers = h("section");
    private readonly directions = (["u", "v"] as const).map((a) => h("button", { onclick: () => { this.axis = a; this.show(); } }, a));
    private readonly direction = h("div", { class: "choice", role: "group", "aria-label": say(t("Richtung", "Direction")) }, ...this.directions);
    private readonly degree = h("div", { class: "hint" });
    private readonly text: HTMLInputElement = h("input", { type: "text", "aria-label": say(t("Knoten", "Knots")), style: "width:100%", onchange: () => { attempt(() => { this.put(numbersOf(this.text.value)); }); } });
    private readonly knots = h("section", {}, heading(t("Knoten", "Knots")), this.direction, this.degree, h("label", { class: "knob" }, this.text));
    /** Takes other knots for what is shown. */
    private put: (to: number[]) => void = () => undefined;
    private strip: Plane | undefined;
    private axis: Axis = "u";

    constructor(private readonly editor: Editor) {
        this.element = h("div", { class: "tools" }, h("section", {}, heading(t("Objekte", "Objects")), this.list, this.nothing), this.numbers, this.knots, this.changes(), this.constructions());
    }

    dispose(): void { this.strip?.dispose(); }

    /** Shows what is chosen now. */
    show(): void {
        this.showObjects();
        this.showNumbers();
        this.showKnots();
    }

    /** Elements stay and change what they say, here and below: so focus stays, too. */
    private showObjects(): void {
        const { document, chosen } = this.editor, { list } = this;
        while (list.children.length > document.objects.length) list.lastElementChild?.remove();
        while (list.children.length < document.objects.length) {
            const i = list.children.length;
            list.append(h("li", {}, h("button", { onclick: (event: MouseEvent) => { this.editor.choose(i, event.shiftKey || event.ctrlKey || event.metaKey); } })));
        }
        document.objects.forEach((o, i) => {
            const button = list.children[i]?.firstElementChild, text = `${o.name ?? `${kind(o)} ${i + 1}`} · ${editable(o) ? `${pointsOf(o).length} ${say(t("Punkte", "points"))}` : kind(o)}`;
            if (!button) return;
            set(button, "aria-pressed", String(chosen.has(i)));
            if (button.textContent !== text) button.textContent = text;
        });
        present(this.nothing, document.objects.length === 0);
    }

    /** Place and weight of the first point that is chosen. */
    showNumbers(): void {
        const { places, document } = this.editor, [place] = places;
        const object = place && document.objects[place.object], p = (place && pointsOf(object)[place.point]) ?? [];
        if (this.coordinates.length !== p.length) {
            this.coordinates = p.map((_, k) => number("xyzw"[k] ?? "", (to) => { this.moveTo(k, to); }));
            const fields = p.length > 0 ? [...this.coordinates, this.weight] : [];
            this.numbers.replaceChildren(...(fields.length > 0 ? [this.counted] : []), ...fields.map(({ element }) => element));
        }
        this.counted.textContent = places.length === 1 ? say(t("Punkt", "Point")) : say(t(`${places.length} Punkte`, `${places.length} points`));
        this.coordinates.forEach(({ show }, k) => { show(Number(shown(p[k] ?? 0, 10))); });
        this.weight.show((place && weightsOf(object)[place.point]) ?? 1);
    }

    /** One coordinate of the point that is chosen; several move by as much as the first. */
    private moveTo(k: number, to: number): void {
        const { editor } = this, { places } = editor, [place] = places;
        if (!place) return;
        const by = to - (pointsOf(editor.document.objects[place.object])[place.point]?.[k] ?? 0);
        if (places.length === 1) editor.movePlaces(say(t("Koordinate", "coordinate")), (q) => q.map((y, i) => (i === k ? to : y)));
        else editor.movePlaces(say(t("Verschieben", "move")), (q) => q.map((y, i) => (i === k ? y + by : y)));
    }

    private showKnots(): void {
        const { editor } = this, at = [...editor.chosen][0], object = at === undefined ? undefined : editor.document.objects[at];
        const none = at === undefined || !editable(object) || object.type === "triangle";
        present(this.knots, !none);
        if (none) { this.stripped(); return; }
        const axis = object.type === "surface" ? (this.axis === "u" ? 0 : 1) : 0;
        const size = object.type === "surface" ? (axis === 0 ? object.points.length : object.points[0]?.length ?? 0) : object.points.length;
        const degree = object.type === "surface" ? object.degrees?.[axis] ?? size - 1 : (object).degree ?? size - 1;
        const given = object.type === "surface" ? (object).knots?.[axis] : (object).knots;
        const closed = object.type !== "surface" && (object).closed === true;
        const knots = given ?? clamped(size, degree);
        this.put = (to) => {
            const next = object.type === "surface"
                ? { ...object, degrees: object.degrees ?? [object.points.length - 1, (object.points[0]?.length ?? 1) - 1], knots: [0, 1].map((a) => (a === axis ? to : object.knots?.[a as 0 | 1] ?? clamped(a === 0 ? object.points.length : object.points[0]?.length ?? 1, object.degrees?.[a as 0 | 1] ?? 1))) as [number[], number[]] }
                : { ...object, degree, knots: to };
            editor.replace(say(t("Knoten", "knots")), at, next);
        };
        present(this.direction, object.type === "surface");
        this.directions.forEach((button, a) => { set(button, "aria-pressed", String(a === axis)); });
        this.degree.textContent = `${say(t("Grad", "degree"))} ${degree} · ${size} ${say(t("Punkte", "points"))}`;
        this.text.value = knots.join(" ");
        const lo = knots[closed ? 0 : degree] ?? 0, hi = knots[closed ? knots.length - 1 : knots.length - 1 - degree] ?? 1;
        const inner = knots.map((_, i) => i).filter((i) => i > (closed ? 0 : degree) && i < (closed ? knots.length - 1 : knots.length - 1 - degree));
        if (inner.length === 0 || inner.length > 60) { this.stripped(); return; }
        const strip = this.strip ??= new Plane({ label: say(t("Knoten", "knots")), graph: true, grid: false, movable: false, height: 70 });
        if (!strip.element.isConnected) this.knots.append(strip.element);
        strip.clear();
        strip.fit([[lo, 0], [hi, 2]]);
        strip.line(run([[lo, 0], [hi, 0]]), { colour: "axis", width: 2 });
        const now = [...knots];
        strip.handles.show(inner.map((i) => ({ label: `${say(t("Knoten", "knot"))} ${i}`, shape: "diamond" as const, colour: "aux",
            at: () => [now[i] ?? 0, now.slice(0, i).filter((k) => k === now[i]).length], move: (to: number[]) => {
                const step = (hi - lo) / 200;
                now[i] = Math.min(now[i + 1] ?? hi, Math.max(now[i - 1] ?? lo, Math.round((to[0] ?? 0) / step) * step));
            } })), { end: () => { this.put(now); } });
    }

    private stripped(): void {
        this.strip?.element.remove();
        this.strip?.dispose();
        this.strip = undefined;
    }

    private changes(): HTMLElement {
        const at = field(t("bei Parameter", "at parameter"), "0.5"), tolerance = field(t("Toleranz", "tolerance"), "0.001");
        const { editor } = this;
        const act = (name: Text, does: () => void, title = ""): HTMLElement => h("button", { title, onclick: () => { attempt(does); } }, say(name));
        return h("section", {}, heading(t("Ändern", "Change")), at.element, h("div", { class: "row-of" },
            act(t("Knoten einfügen", "Insert knot"), () => { editor.change("insert", { at: at.number(), axis: this.axis }); }), act(t("Teilen", "Split"), () => { editor.change("split", { at: at.number(), axis: this.axis }); })),
            tolerance.element, h("div", { class: "row-of" },
            act(t("Knoten entfernen", "Remove knots"), () => { editor.change("reduce", { at: tolerance.number() }); }),
            act(t("Verbinden", "Join"), () => { editor.join(tolerance.number()); }, "J")),
            h("div", { class: "row-of" }, act(t("Grad erhöhen", "Elevate"), () => { editor.change("elevate", { axis: this.axis }); }), act(t("Umkehren", "Reverse"), () => { editor.change("reverse", { axis: this.axis }); }),
            act(t("Bézier-Stücke", "Bézier pieces"), () => { editor.change("bezier", {}); }), act(t("In den Raum", "To space"), () => { editor.toSpace(); })));
    }

    private constructions(): HTMLElement {
        const axis = field(t("Achse: Punkt, Richtung", "Axis: point, direction"), "0 0 0 0 1 0"), angle = field(t("Winkel", "Angle"), "360"), by = field(t("Ziehen um", "Extrude by"), "0 0 1");
        const { editor } = this;
        const act = (name: Text, does: () => void): HTMLElement => h("button", { onclick: () => { attempt(does); } }, say(name));
        return h("section", {}, heading(t("Flächen machen", "Make surfaces")), axis.element, angle.element,
            h("div", { class: "row-of" }, act(t("Drehen", "Revolve"), () => { editor.make("revolve", { axis: axis.numbers(), angle: angle.number() }); })), by.element,
            h("div", { class: "row-of" }, act(t("Extrudieren", "Extrude"), () => { editor.make("extrude", { by: by.numbers() }); }), act(t("Loft", "Loft"), () => { editor.make("loft", {}); }),
                act(t("Regelfläche", "Ruled"), () => { editor.make("ruled", {}); }), act(t("Coons (vier Kurven)", "Coons (four curves)"), () => { editor.make("coons", {}); })));
    }
}
