// The column of tools beside the drawing: objects, numbers of what is chosen, knots, changes, construction.

import { h, shown } from "../ui/dom";
import { say, t, type Text } from "../ui/language";
import { refuse } from "../ui/toast";
import { Plane } from "../views/plane";
import { run } from "../views/view";
import { clamped, editable, pointsOf, weightsOf } from "./document";
import { numbersOf, oneOf } from "./numbers";
import type { Axis } from "./tools";
import type { Editor } from "./editor";

const number = (label: string, value: number | "", set: (x: number) => void, step = "any"): HTMLElement => {
    const input = h("input", { type: "number", step, value, "aria-label": label, onchange: () => { if (Number.isFinite(input.valueAsNumber)) set(input.valueAsNumber); } });
    return h("label", { class: "knob" }, h("span", {}, label), input);
};

const field = (label: Text, value: string): { element: HTMLElement; numbers: () => number[]; number: () => number } => {
    const input = h("input", { type: "text", value, "aria-label": say(label), inputmode: "decimal" });
    return { element: h("label", { class: "knob" }, h("span", {}, say(label)), input), numbers: () => numbersOf(input.value), number: () => oneOf(input.value) };
};

/** What a reader wrote may be refused. */
function attempt(does: () => void): void { try { does(); } catch (error) { refuse(error); } }

const heading = (text: Text): HTMLElement => h("h2", {}, say(text));

export class Panel {
    readonly element: HTMLElement;
    private readonly objects = h("section");
    private readonly numbers = h("section");
    private readonly knots = h("section");
    private strip: Plane | undefined;
    private axis: Axis = "u";

    constructor(private readonly editor: Editor) {
        this.element = h("div", { class: "tools" }, this.objects, this.numbers, this.knots, this.changes(), this.constructions());
    }

    dispose(): void { this.strip?.dispose(); }

    /** Shows what is chosen now. */
    show(): void {
        this.showObjects();
        this.showNumbers();
        this.showKnots();
    }

    private showObjects(): void {
        const { document, chosen } = this.editor;
        this.objects.replaceChildren(heading(t("Objekte", "Objects")), h("ul", { class: "list" }, ...document.objects.map((o, i) => h("li", {},
            h("button", { "aria-pressed": String(chosen.has(i)), onclick: (event: MouseEvent) => { this.editor.choose(i, event.shiftKey || event.ctrlKey || event.metaKey); } },
                `${o.name ?? `${o.type ?? "curve"} ${i + 1}`} · ${editable(o) ? `${pointsOf(o).length} ${say(t("Punkte", "points"))}` : o.type}`)))));
        if (document.objects.length === 0) this.objects.append(h("p", { class: "hint" }, say(t("Noch nichts. Mit B (Stift) klicken Sie Kontrollpunkte, oder öffnen Sie eine Datei.", "Nothing yet. With B (pen) click control points, or open a file."))));
    }

    /** Place and weight of the first point that is chosen. */
    showNumbers(): void {
        const { editor } = this, places = editor.places;
        this.numbers.replaceChildren();
        const place = places[0];
        if (!place) return;
        const object = editor.document.objects[place.object], p = pointsOf(object)[place.point], w = weightsOf(object)[place.point] ?? 1;
        if (!p) return;
        this.numbers.append(heading(places.length === 1 ? t("Punkt", "Point") : t(`${places.length} Punkte`, `${places.length} points`)));
        p.forEach((x, k) => this.numbers.append(number("xyzw"[k] ?? "", Number(shown(x, 10)), (to) => {
            if (places.length === 1) editor.movePlaces(say(t("Koordinate", "coordinate")), (q) => q.map((y, i) => (i === k ? to : y)));
            else editor.movePlaces(say(t("Verschieben", "move")), (q) => q.map((y, i) => (i === k ? y + to - x : y)));
        })));
        this.numbers.append(number(say(t("Gewicht", "weight")), w, (to) => { editor.weigh(to); }));
    }

    private showKnots(): void {
        const { editor } = this, at = [...editor.chosen][0], object = at === undefined ? undefined : editor.document.objects[at];
        this.strip?.dispose();
        this.strip = undefined;
        this.knots.replaceChildren();
        if (at === undefined || !editable(object) || object.type === "triangle") return;
        const axis = object.type === "surface" ? (this.axis === "u" ? 0 : 1) : 0;
        const size = object.type === "surface" ? (axis === 0 ? object.points.length : object.points[0]?.length ?? 0) : object.points.length;
        const degree = object.type === "surface" ? object.degrees?.[axis] ?? size - 1 : (object).degree ?? size - 1;
        const given = object.type === "surface" ? (object).knots?.[axis] : (object).knots;
        const closed = object.type !== "surface" && (object).closed === true;
        const knots = given ?? clamped(size, degree);
        const put = (to: number[]): void => {
            const next = object.type === "surface"
                ? { ...object, degrees: object.degrees ?? [object.points.length - 1, (object.points[0]?.length ?? 1) - 1], knots: [0, 1].map((a) => (a === axis ? to : object.knots?.[a as 0 | 1] ?? clamped(a === 0 ? object.points.length : object.points[0]?.length ?? 1, object.degrees?.[a as 0 | 1] ?? 1))) as [number[], number[]] }
                : { ...object, degree, knots: to };
            editor.replace(say(t("Knoten", "knots")), at, next);
        };
        const text = h("input", { type: "text", value: knots.join(" "), "aria-label": say(t("Knoten", "Knots")), style: "width:100%", onchange: () => {
            attempt(() => { put(numbersOf(text.value)); });
        } });
        this.knots.append(heading(t("Knoten", "Knots")));
        if (object.type === "surface") this.knots.append(h("div", { class: "choice", role: "group", "aria-label": say(t("Richtung", "Direction")) }, ...(["u", "v"] as const).map((a) =>
            h("button", { "aria-pressed": String(this.axis === a), onclick: () => { this.axis = a; this.show(); } }, a))));
        this.knots.append(h("div", { class: "hint" }, `${say(t("Grad", "degree"))} ${degree} · ${size} ${say(t("Punkte", "points"))}`), h("label", { class: "knob" }, text));
        const lo = knots[closed ? 0 : degree] ?? 0, hi = knots[closed ? knots.length - 1 : knots.length - 1 - degree] ?? 1;
        const inner = knots.map((_, i) => i).filter((i) => i > (closed ? 0 : degree) && i < (closed ? knots.length - 1 : knots.length - 1 - degree));
        if (inner.length === 0 || inner.length > 60) return;
        const strip = new Plane({ label: say(t("Knoten", "knots")), graph: true, grid: false, movable: false, height: 70 });
        this.strip = strip;
        this.knots.append(strip.element);
        strip.fit([[lo, 0], [hi, 2]]);
        strip.line(run([[lo, 0], [hi, 0]]), { colour: "axis", width: 2 });
        const now = [...knots];
        strip.handles.show(inner.map((i) => ({ label: `${say(t("Knoten", "knot"))} ${i}`, shape: "diamond" as const, colour: "aux",
            at: () => [now[i] ?? 0, now.slice(0, i).filter((k) => k === now[i]).length], move: (to: number[]) => {
                const step = (hi - lo) / 200;
                now[i] = Math.min(now[i + 1] ?? hi, Math.max(now[i - 1] ?? lo, Math.round((to[0] ?? 0) / step) * step));
            } })), { end: () => { put(now); } });
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
