// The part of the studio that makes and changes shapes.

import type { CurveJson, DocumentJson, ObjectJson } from "freiform";
import { curve, lattice, net, polygon, surface } from "../explore/draw";
import type { Shown } from "../explore/explore";
import { arena, ff, file, type Source } from "../kernel/module";
import { coalesced, h } from "../ui/dom";
import { droppable, isModel, opener, type Opened } from "../ui/files";
import { say, t, type Text } from "../ui/language";
import { notify, refuse } from "../ui/toast";
import { Plane } from "../views/plane";
import { Space } from "../views/space";
import { run, type View } from "../views/view";
import { added, drawn, editable, flat, moved, named, pointsOf, raised, removed, replaced, shifted, weighted, type Document, type Place } from "./document";
import { exportButtons } from "./export";
import { History } from "./history";
import { keyOf, kHelp, type Command } from "./keys";
import { Panel } from "./panel";
import { keep, kept } from "./store";
import * as tools from "./tools";

const kMostHandles = 600;
const kFirst: Document = { objects: [{ type: "curve", name: "curve", degree: 3, knots: [0, 0, 0, 0, 1, 2, 2, 2, 2], points: [[0, 0], [1, 2.4], [3, 3], [4.4, 0.6], [6, 1.2]] }] };

export function edit(taken: string | undefined, inspect: (what: string | Opened) => void): Shown { return new Editor(taken, inspect); }

export class Editor implements Shown {
    readonly element: HTMLElement;
    readonly chosen = new Set<number>();
    private points = new Set<string>();
    private history: History<Document>;
    private readonly panel: Panel;
    private readonly stage = h("div", { class: "stage" });
    private readonly status = h("div", { class: "status", role: "status", "aria-live": "polite" });
    private readonly pen = h("button", { "aria-pressed": "false", title: "B", onclick: () => { this.draft = this.draft ? undefined : []; this.refresh(); } }, say(t("Stift", "Pen")));
    private readonly back = h("button", { title: "Ctrl+Z", onclick: () => { this.history.undo(); } }, say(t("Rückgängig", "Undo")));
    private readonly again = h("button", { title: "Ctrl+Shift+Z", onclick: () => { this.history.redo(); } }, say(t("Wiederholen", "Redo")));
    private readonly snap = h("input", { type: "checkbox", checked: true });
    private view: View;
    private draft: number[][] | undefined;
    private clipboard: readonly ObjectJson[] = [];
    private dragged: { place: Place; from: readonly number[] } | undefined;
    private gone = false;
    private readonly draw = coalesced(() => { this.picture(); });
    private readonly onKey = (event: KeyboardEvent): void => { this.key(event); };

    constructor(taken: string | undefined, private readonly inspect: (what: string | Opened) => void) {
        this.history = this.fresh(kFirst);
        this.view = this.viewFor(!flat(this.document));
        this.panel = new Panel(this);
        this.stage.append(h("h1", { class: "unseen" }, say(t("Bearbeiten", "Edit"))), this.bar(), this.view.element, this.status);
        this.element = h("div", { style: "display:contents" }, this.stage, this.panel.element);
        droppable(this.stage, (opened) => { this.take(opened); });
        document.addEventListener("keydown", this.onKey);
        if (taken === undefined) void this.restore();
        else this.open(taken);
        this.refresh();
        this.fit();
    }

    get document(): Document { return this.history.state; }

    get places(): readonly Place[] {
        return [...this.points].map((key) => { const [object = 0, point = 0] = key.split(":").map(Number); return { object, point }; });
    }

    dispose(): void {
        this.gone = true;
        document.removeEventListener("keydown", this.onKey);
        this.view.dispose();
        this.panel.dispose();
    }

    // What the panel and keys ask for ---------------------------------------------------------------------------------

    choose(object: number, more: boolean): void {
        if (!more) { this.chosen.clear(); this.points.clear(); }
        if (more && this.chosen.has(object)) this.chosen.delete(object);
        else this.chosen.add(object);
        this.refresh();
    }

    replace(name: string, at: number, by: ObjectJson): void { this.attempt(name, () => replaced(this.document, at, by)); }

    movePlaces(name: string, to: (point: readonly number[]) => number[]): void { this.attempt(name, () => moved(this.document, this.places, to)); }

    weigh(weight: number): void { this.attempt(say(t("Gewicht", "weight")), () => weighted(this.document, this.places, weight)); }

    change(what: "insert" | "split" | "reduce" | "elevate" | "reverse" | "bezier", { at = 0, axis = "u" as tools.Axis }): void {
        const does: Record<typeof what, (o: ObjectJson) => ObjectJson[]> = {
            insert: (o) => tools.inserted(o, at, axis), split: (o) => tools.divided(o, at, axis), reduce: (o) => tools.reduced(o, at),
            elevate: (o) => tools.elevated(o, axis), reverse: (o) => tools.reversed(o, axis), bezier: (o) => tools.pieces(o) };
        const list = this.needed(1);
        if (!list) return;
        this.attempt(what, () => {
            let now = this.document;
            for (const i of [...list].sort((a, b) => b - a)) { const o = now.objects[i]; if (o) now = replaced(now, i, ...does[what](o)); }
            return now;
        });
        this.points.clear();
        this.refresh();
    }

    join(tolerance: number): void {
        const list = this.needed(2);
        const [a, b] = list ?? [];
        if (a === undefined || b === undefined) return;
        this.attempt(say(t("Verbinden", "join")), () => {
            const made = tools.joined(this.document.objects[a] as CurveJson, this.document.objects[b] as CurveJson, tolerance);
            return added(removed(this.document, [a, b]), made);
        }, true);
    }

    make(what: "revolve" | "extrude" | "loft" | "ruled" | "coons", options: { axis?: number[]; angle?: number; by?: number[] } = {}): void {
        const list = this.needed(what === "coons" ? 4 : what === "loft" || what === "ruled" ? 2 : 1);
        if (list) this.attempt(what, () => {
            const o = list.flatMap((i) => this.document.objects[i] ?? []);
            const made = what === "revolve" ? tools.revolved(o, options.axis ?? [], options.angle ?? 360) : what === "extrude" ? tools.extruded(o, options.by ?? [])
                : what === "loft" ? tools.lofted(raised({ objects: o }).objects) : what === "ruled" ? tools.ruled(raised({ objects: o }).objects) : tools.coons(raised({ objects: o }).objects, 1e-6);
            return added(raised(this.document), made.map((m) => named(this.document, { ...m, name: what })));
        }, true);
    }

    toSpace(): void { this.attempt(say(t("In den Raum", "to space")), () => raised(this.document)); this.fit(); }

    // States ----------------------------------------------------------------------------------------------------------

    private fresh(first: Document): History<Document> {
        return new History(first, (state, settled) => {
            if (settled) keep(JSON.stringify(this.json(state))).catch(refuse);
            this.prune(state);
            this.refresh();
        });
    }

    private json(state = this.document): DocumentJson { return { freiform: 1, ...(state.unit ? { unit: state.unit } : {}), objects: [...state.objects] }; }

    private prune(state: Document): void {
        for (const i of this.chosen) if (i >= state.objects.length) this.chosen.delete(i);
        for (const key of this.points) { const [o = 0, p = 0] = key.split(":").map(Number); if (p >= pointsOf(state.objects[o]).length) this.points.delete(key); }
    }

    /** A change that the module may refuse: what it reads is checked before it becomes the state. */
    private attempt(name: string, f: () => Document, chooseNew = false): void {
        try {
            const next = f();
            if (next.objects.length > 0) arena((make) => { for (const o of next.objects) if (!this.document.objects.includes(o)) make(o); });
            const from = this.document.objects.length;
            this.history.put(name, next);
            if (chooseNew) {
                this.chosen.clear();
                this.points.clear();
                for (let i = Math.min(from, next.objects.length - 1); i < next.objects.length; ++i) this.chosen.add(i);
                this.refresh();
                this.fit();
            }
        } catch (error) {
            refuse(error);
            this.refresh();
        }
    }

    private needed(n: number): number[] | undefined {
        const list = [...this.chosen];
        if (list.length < n && this.document.objects.length === n) return this.document.objects.map((_, i) => i);
        if (list.length >= n) return list;
        refuse({ kind: "usage", message: say(t(`Dafür werden ${n} Objekte gewählt (Umschalt+Klick in der Liste).`, `This needs ${n} objects to be chosen (Shift+click in the list).`)) });
        return undefined;
    }

    /** A file: models are for looking at. */
    private take(opened: Opened): void {
        if (isModel(opened)) this.inspect(opened);
        else this.open(file(opened.name, opened.source));
    }

    private open(source: Source): void {
        try {
            const { shapes, unit } = ff().document(source);
            let state: Document;
            try { state = { ...(unit ? { unit } : {}), objects: ff().json(shapes, unit).objects }; } finally { shapes.forEach((s) => { s.free(); }); }
            this.chosen.clear();
            this.points.clear();
            this.history.put(say(t("Öffnen", "open")), state);
            this.fit();
        } catch (error) { refuse(error); }
    }

    private async restore(): Promise<void> {
        const text = await kept().catch(() => undefined);
        if (text === undefined || this.gone) return;
        try {
            const state = JSON.parse(text) as Document;
            if (state.objects.length > 0) arena((make) => { state.objects.forEach((o) => make(o)); });
            this.history = this.fresh({ ...(state.unit ? { unit: state.unit } : {}), objects: state.objects });
            this.refresh();
            this.fit();
        } catch (error) { refuse(error); }
    }

    // The view --------------------------------------------------------------------------------------------------------

    private viewFor(space: boolean): View {
        if (space) {
            const view = new Space(say(t("Zeichnung im Raum", "Drawing in space")));
            view.onColours = () => { this.draw(); };
            return view;
        }
        const plane = new Plane({ label: say(t("Zeichnung", "Drawing")) });
        plane.onGround = (at, event) => { this.ground(at, event); };
        plane.onGroundDrag = (event) => event.shiftKey && !this.draft && this.frame(plane, event);
        return plane;
    }

    private refresh(): void {
        if (this.gone) return;
        if (this.history.busy) {
            this.panel.showNumbers();
            this.view.handles.place();
            this.draw();
            return;
        }
        const space = !flat(this.document);
        if (space !== this.view instanceof Space) {
            const next = this.viewFor(space);
            this.view.element.replaceWith(next.element);
            this.view.dispose();
            this.view = next;
            this.fit();
        }
        const { undo, redo } = this.history.names;
        this.back.disabled = undo === undefined;
        this.again.disabled = redo === undefined;
        this.back.title = `Ctrl+Z ${undo ?? ""}`;
        this.again.title = `Ctrl+Shift+Z ${redo ?? ""}`;
        this.pen.setAttribute("aria-pressed", String(this.draft !== undefined));
        this.panel.show();
        this.hold();
        this.draw();
    }

    private hold(): void {
        const count = this.document.objects.reduce((n, o) => n + pointsOf(o).length, 0);
        const shown = this.document.objects.flatMap((o, object) => (this.chosen.has(object) || (this.chosen.size === 0 && count <= kMostHandles) ? pointsOf(o).map((_, point) => ({ object, point })) : []));
        this.view.handles.show(shown.slice(0, kMostHandles).map((place) => this.handle(place)), {
            begin: () => { this.history.begin(); }, end: () => { this.dragged = undefined; this.history.end(); this.refresh(); },
            snap: (to, event) => (this.snap.checked && !event.altKey ? this.snapped(to) : to) });
    }

    private handle(place: Place): Parameters<View["handles"]["show"]>[0][number] {
        const key = `${place.object}:${place.point}`;
        return {
            label: `${this.document.objects[place.object]?.name ?? place.object + 1}, ${say(t("Punkt", "point"))} ${place.point}`,
            at: () => pointsOf(this.document.objects[place.object])[place.point] ?? [],
            chosen: () => this.points.has(key), colour: this.chosen.has(place.object) ? "hot" : "control",
            onPress: (event) => {
                if (event.shiftKey) { if (!this.points.delete(key)) this.points.add(key); } else if (!this.points.has(key)) this.points = new Set([key]);
                this.dragged = { place, from: pointsOf(this.document.objects[place.object])[place.point] ?? [] };
                this.panel.show();
                this.view.handles.place();
            },
            onKey: (event) => {
                if (event.key !== "Enter" && event.key !== " ") return;
                event.preventDefault();
                if (!event.shiftKey) this.points.clear();
                if (!this.points.delete(key)) this.points.add(key);
                this.panel.show();
                this.view.handles.place();
            },
            move: (to) => {
                const from = pointsOf(this.document.objects[place.object])[place.point] ?? [];
                const by = to.map((x, i) => x - (from[i] ?? 0));
                const many = this.points.has(key) ? this.places : [place];
                this.history.put(say(t("Ziehen", "drag")), moved(this.document, many, shifted(by)));
            },
        };
    }

    /** The nearest other control point within reach, or else the grid. */
    private snapped(to: number[]): number[] {
        const [x, y] = this.view.project(to), mine = this.dragged?.place;
        for (const [i, o] of this.document.objects.entries())
            for (const [k, p] of pointsOf(o).entries()) {
                if (mine?.object === i && mine.point === k || this.points.has(`${i}:${k}`)) continue;
                const [a, b] = this.view.project(p);
                if (Math.hypot(a - x, b - y) < 9) return [...p];
            }
        if (!(this.view instanceof Plane)) return to;
        const step = 10 ** Math.floor(Math.log10(this.view.unit * 24));
        return to.map((c) => Number((Math.round(c / step) * step).toPrecision(12)));
    }

    private picture(): void {
        if (this.gone) return;
        const { view } = this;
        view.clear();
        try {
            arena((make) => {
                this.document.objects.forEach((o, i) => {
                    const shape = make(o), lit = this.chosen.has(i);
                    if (shape.type === "curve") {
                        polygon(view, net(shape), { colour: lit ? "hot" : "control", width: lit ? 1.6 : 1.1 });
                        curve(view, shape, { colour: "curve", width: lit ? 4 : 2.8 });
                    } else if (view instanceof Space && shape.type === "surface") {
                        const points = net(shape), columns = shape.size[1] ?? 1;
                        surface(view, shape, { colour: lit ? "lit" : "surface" }, 36);
                        lattice(view, Array.from({ length: shape.size[0] ?? 0 }, (_, k) => points.slice(k * columns, (k + 1) * columns)), { colour: lit ? "hot" : "control", width: 1 });
                    } else if (view instanceof Space && shape.type !== "volume") {
                        const mesh = shape.mesh({ tolerance: 0.003 * size(this.document) });
                        view.surface({ points: mesh.positions, normals: mesh.normals, indices: mesh.indices, origin: mesh.origin }, { colour: lit ? "lit" : "surface" });
                    }
                });
            });
        } catch (error) { refuse(error); }
        if (this.draft) { view.line(run(this.draft.length > 0 ? this.draft : [[0, 0]]), { colour: "hot", width: 1.4, dashed: true }); view.dots(run(this.draft), { colour: "hot", width: 8 }); }
        this.status.textContent = this.draft ? say(t("Stift: klicken setzt Punkte, Eingabetaste beendet, Esc verwirft.", "Pen: a click sets a point, Enter ends, Esc discards."))
            : `${this.document.objects.length} ${say(t("Objekte", "objects"))} · ${this.points.size} ${say(t("Punkte gewählt", "points chosen"))} · ${say(t("? zeigt die Tasten", "? shows the keys"))}`;
    }

    private fit(): void {
        const all = this.document.objects.flatMap((o) => [...pointsOf(o)]);
        if (all.length > 0) { this.view.fit(all); return; }
        if (this.document.objects.length === 0) { this.view.fit([[0, 0], [6, 4]]); return; }
        const bounds = ff().run("bounds", this.json()).json as { box?: { min: number[]; max: number[] } };
        this.view.fit([bounds.box?.min ?? [0, 0, 0], bounds.box?.max ?? [1, 1, 1]]);
    }

    /** A click beside all handles: the pen sets a point, otherwise the nearest curve is chosen. */
    private ground(at: number[], event: PointerEvent): void {
        if (this.draft) {
            this.draft = [...this.draft, this.snap.checked && !event.altKey ? this.snapped(at) : at];
            this.draw();
            return;
        }
        let best: { i: number; far: number } | undefined;
        arena((make) => { this.document.objects.forEach((o, i) => {
            const far = make(o).nearest(at).distances[0] ?? Infinity;
            if (!best || far < best.far) best = { i, far };
        }); });
        const reach = this.view instanceof Plane ? 12 * this.view.unit : 0;
        if (best && best.far < reach) { this.choose(best.i, event.shiftKey); return; }
        this.chosen.clear();
        this.points.clear();
        this.refresh();
    }

    /** A frame that chooses the points inside. */
    private frame(plane: Plane, event: PointerEvent): boolean {
        const frame = plane.element.getBoundingClientRect();
        const at = (e: PointerEvent): number[] => plane.unproject(e.clientX - frame.left, e.clientY - frame.top, []);
        const [x0 = 0, y0 = 0] = at(event);
        const moving = (e: PointerEvent): void => {
            const [x = 0, y = 0] = at(e);
            this.picture();
            plane.line(run([[x0, y0], [x, y0], [x, y], [x0, y], [x0, y0]]), { colour: "focus", width: 1.4, dashed: true });
        };
        const ended = (e: PointerEvent): void => {
            window.removeEventListener("pointermove", moving);
            window.removeEventListener("pointerup", ended);
            const [x = 0, y = 0] = at(e);
            this.document.objects.forEach((o, object) => { pointsOf(o).forEach(([a = 0, b = 0], point) => {
                if (a >= Math.min(x, x0) && a <= Math.max(x, x0) && b >= Math.min(y, y0) && b <= Math.max(y, y0)) this.points.add(`${object}:${point}`);
            }); });
            this.refresh();
        };
        window.addEventListener("pointermove", moving);
        window.addEventListener("pointerup", ended);
        return true;
    }

    // Keys ------------------------------------------------------------------------------------------------------------

    private key(event: KeyboardEvent): void {
        const target = event.target as HTMLElement;
        if (target.closest("input:not([type=checkbox]), select, textarea, dialog")) return;
        const command = keyOf(event);
        if (!command) return;
        event.preventDefault();
        this.does(command);
    }

    private does(command: Command): void {
        const acts: Record<Command, () => void> = {
            undo: () => { this.history.undo(); }, redo: () => { this.history.redo(); }, save: () => { this.element.querySelector<HTMLElement>("[data-save]")?.click(); },
            open: () => { this.element.querySelector<HTMLElement>("[data-open]")?.click(); }, all: () => {
                this.document.objects.forEach((o, i) => { this.chosen.add(i); pointsOf(o).forEach((_, k) => this.points.add(`${i}:${k}`)); });
                this.refresh();
            },
            none: () => { this.draft = undefined; this.chosen.clear(); this.points.clear(); this.refresh(); }, remove: () => { this.remove(); },
            copy: () => { this.clipboard = this.taken(); notify(say(t(`${this.clipboard.length} Objekte kopiert`, `${this.clipboard.length} objects copied`))); },
            cut: () => { this.clipboard = this.taken(); this.remove(true); }, paste: () => { this.paste(this.clipboard); }, duplicate: () => { this.paste(this.taken()); },
            fit: () => { this.fit(); }, pen: () => { this.pen.click(); }, finish: () => { this.finish(); }, help: () => { this.help(); },
            grab: () => { this.prompt(t("Verschieben um x, y, z", "Move by x, y, z"), "0 0 0", (by) => shifted(by)); },
            scale: () => { this.prompt(t("Vergrößern um den Faktor", "Scale by the factor"), "2", ([k = 1]) => this.about((p, c) => c + k * (p - c))); },
            rotate: () => { this.prompt(t("Drehen um Grad", "Turn by degrees"), "90", ([a = 0]) => this.turned(a)); },
            join: () => { this.join(1e-6); },
        };
        acts[command]();
    }

    private taken(): ObjectJson[] {
        const list = this.chosen.size > 0 ? [...this.chosen] : [...new Set(this.places.map((p) => p.object))];
        return list.flatMap((i) => this.document.objects[i] ?? []);
    }

    private remove(whole = false): void {
        const list = this.chosen.size > 0 || whole ? [...this.chosen] : [...new Set(this.places.map((p) => p.object))];
        if (list.length > 0) this.attempt(say(t("Löschen", "delete")), () => removed(this.document, list));
        this.chosen.clear();
        this.points.clear();
        this.refresh();
    }

    private paste(objects: readonly ObjectJson[]): void {
        const step = 0.05 * size(this.document);
        this.attempt(say(t("Einfügen", "paste")), () => objects.reduce((now: Document, o) => {
            const at = now.objects.length;
            const next = added(now, [named(now, o)]);
            return moved(next, pointsOf(o).map((_, point) => ({ object: at, point })), shifted([step, step]));
        }, this.document), true);
    }

    private finish(): void {
        const points = this.draft;
        if (!points) return;
        this.draft = undefined;
        if (points.length >= 2) this.attempt(say(t("Zeichnen", "draw")), () => added(this.document, [named(this.document, { ...drawn(flat(this.document) ? points : points.map((p) => [...p, 0].slice(0, 3))), name: "curve" })]), true);
        this.refresh();
    }

    private about(f: (x: number, centre: number) => number): (p: readonly number[]) => number[] {
        const c = this.centre();
        return (p) => p.map((x, i) => f(x, c[i] ?? 0));
    }

    /** Turned in the plane of x and y about the middle of what is chosen. */
    private turned(degrees: number): (p: readonly number[]) => number[] {
        const [cx = 0, cy = 0] = this.centre(), a = (degrees * Math.PI) / 180, c = Math.cos(a), s = Math.sin(a);
        return ([x = 0, y = 0, ...rest]) => [cx + c * (x - cx) - s * (y - cy), cy + s * (x - cx) + c * (y - cy), ...rest];
    }

    private centre(): number[] {
        const all = this.meant().map(({ object, point }) => pointsOf(this.document.objects[object])[point] ?? []);
        return [0, 1, 2].map((k) => all.reduce((sum, p) => sum + (p[k] ?? 0), 0) / Math.max(1, all.length));
    }

    /** The points that are chosen, or all of the objects that are. */
    private meant(): readonly Place[] {
        if (this.points.size > 0) return this.places;
        return [...this.chosen].flatMap((object) => pointsOf(this.document.objects[object]).map((_, point) => ({ object, point })));
    }

    private prompt(label: Text, first: string, act: (numbers: number[]) => (p: readonly number[]) => number[]): void {
        if (this.meant().length === 0) { notify(say(t("Nichts ist gewählt.", "Nothing is chosen."))); return; }
        const input = h("input", { type: "text", value: first, "aria-label": say(label), style: "width:100%" });
        const dialog = h("dialog", { "aria-label": say(label) }, h("form", { method: "dialog", onsubmit: () => {
            const numbers = input.value.split(/[\s,;]+/).filter((x) => x !== "").map(Number);
            if (numbers.every(Number.isFinite)) this.attempt(say(label), () => moved(this.document, this.meant(), act(numbers)));
        } }, h("p", {}, say(label)), input));
        dialog.addEventListener("close", () => { dialog.remove(); });
        document.body.append(dialog);
        dialog.showModal();
        input.select();
    }

    private help(): void {
        const dialog = h("dialog", { "aria-label": say(t("Tasten", "Keys")) }, h("h2", {}, say(t("Tasten", "Keys"))),
            h("table", {}, ...kHelp.map(([keys, text]) => h("tr", {}, h("td", {}, h("kbd", {}, keys)), h("td", {}, say(text))))), h("form", { method: "dialog" }, h("button", { class: "primary" }, say(t("Schließen", "Close")))));
        dialog.addEventListener("close", () => { dialog.remove(); });
        document.body.append(dialog);
        dialog.showModal();
    }

    private bar(): HTMLElement {
        return h("div", { class: "bar", role: "toolbar", "aria-label": say(t("Werkzeuge", "Tools")) },
            h("button", { onclick: () => { this.attempt(say(t("Neu", "new")), () => ({ objects: [] })); } }, say(t("Neu", "New"))), opener((opened) => { this.take(opened); }),
            ...exportButtons(() => this.json(), () => this.view, () => 0.001 * size(this.document)), h("span", { class: "sep" }), this.back, this.again, h("span", { class: "sep" }), this.pen,
            h("button", { title: "Enter", onclick: () => { this.finish(); } }, say(t("Fertig", "Finish"))), h("label", { class: "check" }, this.snap, say(t("Einrasten", "Snap"))),
            h("button", { title: "F", onclick: () => { this.fit(); } }, say(t("Alles", "Fit"))), h("button", { title: "Del", onclick: () => { this.remove(); } }, say(t("Löschen", "Delete"))),
            h("button", { onclick: () => { this.inspect(JSON.stringify(this.json())); } }, say(t("Untersuchen", "Inspect"))), h("button", { title: "?", "aria-label": say(t("Tasten", "Keys")), onclick: () => { this.help(); } }, "?"));
    }
}

function size(document: Document): number {
    const all = document.objects.flatMap((o) => (editable(o) ? [...pointsOf(o)] : []));
    let most = 0;
    for (let k = 0; k < 3; ++k) {
        const at = all.map((p) => p[k] ?? 0);
        if (at.length > 0) most = Math.max(most, at.reduce((a, b) => Math.max(a, b)) - at.reduce((a, b) => Math.min(a, b)));
    }
    return most > 0 ? most : 1;
}
