// The part of the studio that makes and changes shapes.

import type { DocumentJson, ObjectJson } from "freiform";
import type { Shown } from "../explore/explore";
import { arena, ff, file, type Source } from "../kernel/module";
import { coalesced, h } from "../ui/dom";
import { droppable, isModel, opener, type Opened } from "../ui/files";
import { counted, keyed, say, t, type Text } from "../ui/language";
import { lacking, notify, refuse } from "../ui/toast";
import { Plane } from "../views/plane";
import { Space } from "../views/space";
import { run, type View } from "../views/view";
import { askNumbers, showKeys } from "./dialogs";
import { added, drawn, flat, moved, named, pointsOf, raised, removed, replaced, shifted, weighted, type Document, type Place } from "./document";
import { exportButtons } from "./export";
import { frame } from "./frame";
import { Hands } from "./hands";
import { History } from "./history";
import { keyOf, type Command } from "./keys";
import { Panel } from "./panel";
import { under, watch, type Sheets } from "./pick";
import { show } from "./picture";
import type { Selection } from "./selection";
import { Session } from "./session";
import { corners, extent } from "./size";
import { keep } from "./store";
import * as tools from "./tools";
import { kAxes, scaledAbout, turnedAbout } from "./transform";
import { kChanges, kCurve, kMakes, kNothing } from "./words";

let session: Session | undefined;

export function edit(taken: string | undefined, inspect: (what: string | Opened) => void): Shown { return new Editor(session ??= new Session(), taken, inspect); }

export class Editor implements Shown {
    readonly element: HTMLElement;
    private readonly selection: Selection;
    private readonly history: History<Document>;
    private readonly panel: Panel;
    private readonly stage = h("div", { class: "stage" });
    private readonly status = h("div", { class: "status", role: "status", "aria-live": "polite" });
    private readonly pen = h("button", { "aria-pressed": "false", title: "B", onclick: () => { this.draft = this.draft ? undefined : new History<readonly number[][]>([], () => { this.refresh(); }); this.refresh(); } }, say(t("Stift", "Pen")));
    private readonly back = h("button", { title: keyed("Ctrl+Z"), onclick: () => { this.steps.undo(); } }, say(t("Rückgängig", "Undo")));
    private readonly again = h("button", { title: keyed("Ctrl+Shift+Z"), onclick: () => { this.steps.redo(); } }, say(t("Wiederholen", "Redo")));
    private readonly grips = h("button", { title: "T", onclick: () => { this.hands.gizmo = !this.hands.gizmo; this.refresh(); } }, say(t("Gizmo", "Gizmo")));
    private readonly snap = h("input", { type: "checkbox", checked: true });
    /** What is touched is chosen beside what is chosen already: Shift for hands without a keyboard. */
    private readonly several = h("button", { "aria-pressed": "false", title: keyed("Shift"), onclick: () => {
        this.several.setAttribute("aria-pressed", String(!this.more));
    } }, say(t("Mehrere", "Several")));
    private view: View;
    private readonly hands: Hands;
    /** The points of the pen while it is under way, with steps of their own. */
    private draft: History<readonly number[][]> | undefined;
    private gone = false;
    private sheets: Sheets = new Map();
    /** The state that the selection is about. */
    private seen: Document;
    private readonly draw = coalesced(() => { this.picture(); });
    private readonly onKey = (event: KeyboardEvent): void => { this.key(event); };

    constructor(private readonly session: Session, taken: string | undefined, private readonly inspect: (what: string | Opened) => void) {
        ({ history: this.history, selection: this.selection } = session);
        this.seen = this.document;
        this.history.changed = (state, settled) => { this.changed(state, settled); };
        this.view = this.viewFor(!flat(this.document));
        this.panel = new Panel(this);
        this.hands = new Hands({ history: () => this.history, selection: this.selection, snapping: () => this.snap.checked, more: () => this.more,
            chose: () => { this.panel.show(); }, settled: () => { this.refresh(); } });
        this.stage.append(h("h1", { class: "unseen" }, say(t("Bearbeiten", "Edit"))), this.bar(), this.view.element, this.status);
        this.element = h("div", { style: "display:contents" }, this.stage, this.panel.element);
        droppable(this.stage, (opened) => { this.take(opened); });
        document.addEventListener("keydown", this.onKey);
        // First, before a step replaces what was kept.
        void this.restore();
        if (taken !== undefined) this.open("", taken);
        this.refresh();
        this.fit();
    }

    get document(): Document { return this.history.state; }

    get chosen(): ReadonlySet<number> { return this.selection.objects; }

    get places(): readonly Place[] { return this.selection.places; }

    dispose(): void {
        this.gone = true;
        this.history.end();
        document.removeEventListener("keydown", this.onKey);
        this.view.dispose();
        this.panel.dispose();
    }

    // What the panel and keys ask for ---------------------------------------------------------------------------------

    choose(object: number, more: boolean): void {
        const { selection } = this;
        if (!more) selection.clear();
        if (more && selection.objects.has(object)) selection.objects.delete(object);
        else selection.objects.add(object);
        this.refresh();
    }

    replace(name: string, at: number, by: ObjectJson): void { this.attempt(name, () => replaced(this.document, at, by)); }

    movePlaces(name: string, to: (point: readonly number[]) => number[]): void { this.attempt(name, () => moved(this.document, this.places, to)); }

    weigh(weight: number): void { this.attempt(say(t("Gewicht", "weight")), () => weighted(this.document, this.places, weight)); }

    change(what: keyof typeof kChanges, { at = 0, axis = "u" as tools.Axis }): void {
        const does: Record<typeof what, (o: ObjectJson) => ObjectJson[]> = {
            insert: (o) => tools.inserted(o, at, axis), split: (o) => tools.divided(o, at, axis), reduce: (o) => tools.reduced(o, at),
            elevate: (o) => tools.elevated(o, axis), reverse: (o) => tools.reversed(o, axis), bezier: (o) => tools.pieces(o) };
        const list = this.needed(1);
        if (!list) return;
        this.attempt(say(kChanges[what]), () => {
            let now = this.document;
            for (const i of [...list].sort((a, b) => b - a)) { const o = now.objects[i]; if (o) now = replaced(now, i, ...does[what](o)); }
            return now;
        });
        this.selection.clearPoints();
        this.refresh();
    }

    join(tolerance: number): void {
        const list = this.needed(2);
        const [a, b] = list ?? [];
        if (a === undefined || b === undefined) return;
        this.attempt(say(t("Verbinden", "join")), () => {
            const made = tools.joined(this.document.objects[a] as ObjectJson, this.document.objects[b] as ObjectJson, tolerance);
            return added(removed(this.document, [a, b]), made);
        }, true);
    }

    make(what: keyof typeof kMakes, options: { axis?: number[]; angle?: number; by?: number[] } = {}): void {
        const list = this.needed(what === "coons" ? 4 : what === "loft" || what === "ruled" ? 2 : 1);
        if (list) this.attempt(say(kMakes[what][0]), () => {
            const o = list.flatMap((i) => this.document.objects[i] ?? []);
            const made = what === "revolve" ? tools.revolved(o, options.axis ?? [], options.angle ?? 360) : what === "extrude" ? tools.extruded(o, options.by ?? [])
                : what === "loft" ? tools.lofted(raised({ objects: o }).objects) : what === "ruled" ? tools.ruled(raised({ objects: o }).objects) : tools.coons(raised({ objects: o }).objects, 1e-6);
            return made.reduce((now, m) => added(now, [named(now, { ...m, name: say(kMakes[what][1]) })]), raised(this.document));
        }, true);
    }

    toSpace(): void { this.attempt(say(t("In den Raum", "to space")), () => raised(this.document)); this.fit(); }

    // States ----------------------------------------------------------------------------------------------------------

    private changed(state: Document, settled: boolean): void {
        if (settled) keep(JSON.stringify(this.json(state))).catch(refuse);
        this.selection.follow(this.seen, state);
        this.seen = state;
        this.refresh();
    }

    /** What undo and redo are about: while the pen is under way, its points. */
    private get steps(): History<readonly number[][]> | History<Document> { return this.draft ?? this.history; }

    private json(state = this.document): DocumentJson { return { freiform: 1, ...(state.unit ? { unit: state.unit } : {}), objects: [...state.objects] }; }

    /** A change that the module may refuse: what it reads is checked before it becomes the state. */
    private attempt(name: string, f: () => Document, chooseNew = false): void {
        this.history.end();
        try {
            const next = f();
            if (next.objects.length > 0) arena((make) => { for (const o of next.objects) if (!this.document.objects.includes(o)) make(o); });
            const from = this.document.objects.length;
            this.history.put(name, next);
            if (chooseNew) {
                this.selection.clear();
                for (let i = Math.min(from, next.objects.length - 1); i < next.objects.length; ++i) this.selection.objects.add(i);
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
        else this.open(opened.name, file(opened.name, opened.source));
    }

    private open(name: string, source: Source): void {
        try {
            const { shapes, unit, leftOut } = ff().document(source);
            let state: Document;
            try { state = { ...(unit ? { unit } : {}), objects: ff().json(shapes, unit).objects }; } finally { shapes.forEach((s) => { s.free(); }); }
            this.selection.clear();
            this.history.put(say(t("Öffnen", "open")), state);
            this.fit();
            lacking(name, leftOut);
        } catch (error) { refuse(error); }
    }

    /** What was kept lies below what is here already: undo leads back to it. */
    private async restore(): Promise<void> {
        await this.session.restore();
        if (!this.gone && this.history.names.undo === undefined) this.fit();
    }

    // The view --------------------------------------------------------------------------------------------------------

    private get more(): boolean { return this.several.getAttribute("aria-pressed") === "true"; }

    private viewFor(space: boolean): View {
        if (space) {
            const view = new Space(say(t("Zeichnung im Raum", "Drawing in space")));
            view.onColours = () => { this.draw(); };
            watch(view, { framing: (event) => event.shiftKey || this.more,
                clicked: (x, y, event) => { if (!this.draft) this.clicked(under(view, this.document, this.sheets, 0.003 * extent(this.document), x, y), event); },
                framed: (has) => { this.framed(has); } });
            return view;
        }
        const plane = new Plane({ label: say(t("Zeichnung", "Drawing")) });
        plane.onGround = (at, event) => { this.ground(at, event); };
        plane.onGroundDrag = (event) => (event.shiftKey || this.more) && !this.draft && this.frame(plane, event);
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
        const { undo, redo } = this.steps.names;
        this.back.disabled = undo === undefined;
        this.again.disabled = redo === undefined;
        this.back.title = `${keyed("Ctrl+Z")} ${undo ?? ""}`;
        this.again.title = `${keyed("Ctrl+Shift+Z")} ${redo ?? ""}`;
        this.grips.hidden = !space;
        this.grips.setAttribute("aria-pressed", String(this.hands.gizmo));
        this.pen.setAttribute("aria-pressed", String(this.draft !== undefined));
        this.panel.show();
        this.hands.show(this.view);
        // The pen sets points on points.
        this.view.handles.layer.style.pointerEvents = this.draft ? "none" : "";
        this.draw();
    }

    private picture(): void {
        if (this.gone) return;
        const { view } = this;
        view.clear();
        try { this.sheets = show(view, this.document, this.chosen); } catch (error) { refuse(error); }
        const points = this.draft?.state ?? [];
        if (points.length > 0) { view.line(run(points), { colour: "hot", width: 1.4, dashed: true }); view.dots(run(points), { colour: "hot", width: 8 }); }
        this.status.textContent = this.draft && view instanceof Space ? say(t("Der Stift zeichnet nur in der Ebene; hier setzt er keine Punkte. Esc legt ihn weg.", "The pen draws in the plane only; here it sets no points. Esc puts it away."))
            : this.draft ? say(t("Stift: klicken setzt Punkte, Eingabetaste beendet, Esc verwirft.", "Pen: a click sets a point, Enter ends, Esc discards."))
            : this.hands.said !== "" ? this.hands.said
            : `${counted(this.document.objects.length, t("Objekt", "object"), t("Objekte", "objects"))} · ${counted(this.selection.size, t("Punkt gewählt", "point chosen"), t("Punkte gewählt", "points chosen"))} · ${say(t("? zeigt die Tasten", "? shows the keys"))}${this.hands.lacking === "" ? "" : ` · ${this.hands.lacking}`}`;
    }

    private fit(): void {
        const all = corners(this.document);
        this.view.fit(all.length > 0 ? all : [[0, 0], [6, 4]]);
    }

    /** A click beside all handles: the pen sets a point, otherwise the nearest curve is chosen. */
    private ground(at: number[], event: PointerEvent): void {
        if (this.draft) {
            this.draft.put(say(t("Punkt", "point")), [...this.draft.state, this.snap.checked && !event.altKey ? this.hands.snapped(at, true) : at]);
            return;
        }
        let best: { i: number; far: number } | undefined;
        arena((make) => { this.document.objects.forEach((o, i) => {
            const far = make(o).nearest(at).distances[0] ?? Infinity;
            if (!best || far < best.far) best = { i, far };
        }); });
        const reach = this.view instanceof Plane ? 12 * this.view.unit : 0;
        this.clicked(best && best.far < reach ? best.i : undefined, event);
    }

    /** A click on an object, or beside all: chooses that, or nothing. */
    private clicked(object: number | undefined, event: PointerEvent): void {
        const more = event.shiftKey || this.more;
        if (object !== undefined) { this.choose(object, more); return; }
        if (!more) this.selection.clear();
        this.refresh();
    }

    /** A frame that chooses the points inside. */
    private frame(plane: Plane, event: PointerEvent): boolean {
        frame(plane, event, () => { this.picture(); }, (at) => { this.ground(at, event); }, ([x0, y0], [x1, y1]) => {
            this.framed(([a = 0, b = 0]) => a >= x0 && a <= x1 && b >= y0 && b <= y1);
        });
        return true;
    }

    private framed(has: (point: readonly number[]) => boolean): void {
        this.document.objects.forEach((o, object) => { pointsOf(o).forEach((p, point) => { if (has(p)) this.selection.add({ object, point }); }); });
        this.refresh();
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
            undo: () => { this.steps.undo(); }, redo: () => { this.steps.redo(); }, save: () => { this.element.querySelector<HTMLElement>("[data-save]")?.click(); },
            open: () => { this.element.querySelector<HTMLElement>("[data-open]")?.click(); }, all: () => { this.selection.all(this.document); this.refresh(); },
            none: () => { this.draft = undefined; this.selection.clear(); this.refresh(); }, remove: () => { this.remove(); },
            copy: () => { if (this.copy()) notify(counted(this.session.clipboard.length, t("Objekt kopiert", "object copied"), t("Objekte kopiert", "objects copied"))); },
            cut: () => { if (this.copy()) this.without(this.selection.owners); }, paste: () => { if (this.session.clipboard.length > 0) this.paste(this.session.clipboard); else notify(say(t("Nichts ist kopiert.", "Nothing was copied."))); }, duplicate: () => { this.paste(this.taken()); },
            fit: () => { this.fit(); }, pen: () => { this.pen.click(); }, finish: () => { this.finish(); }, help: showKeys, gizmo: () => { this.grips.click(); },
            grab: () => { this.prompt(t("Verschieben um x, y, z", "Move by x, y, z"), "0 0 0", (by) => shifted(by)); },
            scale: () => { this.prompt(t("Vergrößern um den Faktor", "Scale by the factor"), "2", ([k = 1]) => scaledAbout(this.selection.centre(this.document), [k, k, k])); },
            rotate: () => { this.prompt(t("Drehen um Grad", "Turn by degrees"), "90", ([a = 0]) => turnedAbout(this.selection.centre(this.document), kAxes[2], (a * Math.PI) / 180)); },
            join: () => { this.join(1e-6); },
        };
        acts[command]();
    }

    private taken(): ObjectJson[] {
        return this.selection.owners.flatMap((i) => this.document.objects[i] ?? []);
    }

    /** What is chosen; while the pen is under way, its last point. */
    private remove(): void {
        if (this.draft) this.draft.undo(); else this.without(this.selection.owners);
    }

    private without(list: readonly number[]): void {
        if (list.length > 0) this.attempt(say(t("Löschen", "delete")), () => removed(this.document, list));
        this.selection.clear();
        this.refresh();
    }

    /** What is chosen, for later; false if that is nothing. */
    private copy(): boolean {
        const taken = this.taken();
        if (taken.length === 0) { notify(say(kNothing)); return false; }
        this.session.clipboard = taken;
        return true;
    }

    private paste(objects: readonly ObjectJson[]): void {
        if (objects.length === 0) { notify(say(kNothing)); return; }
        const step = 0.05 * extent(this.document);
        this.attempt(say(t("Einfügen", "paste")), () => objects.reduce((now: Document, o) => {
            const at = now.objects.length;
            const next = added(now, [named(now, o)]);
            return moved(next, pointsOf(o).map((_, point) => ({ object: at, point })), shifted([step, step]));
        }, this.document), true);
    }

    private finish(): void {
        const points = this.draft?.state;
        if (!points) return;
        this.draft = undefined;
        if (points.length >= 2) this.attempt(say(t("Zeichnen", "draw")), () => added(this.document, [named(this.document, { ...drawn(flat(this.document) ? points : points.map((p) => [...p, 0].slice(0, 3))), name: say(kCurve) })]), true);
        this.refresh();
    }

    private prompt(label: Text, first: string, act: (numbers: number[]) => (p: readonly number[]) => number[]): void {
        if (this.selection.meant(this.document).length === 0) { notify(say(kNothing)); return; }
        askNumbers(label, first, (numbers) => { this.attempt(say(label), () => moved(this.document, this.selection.meant(this.document), act(numbers))); });
    }

    private bar(): HTMLElement {
        return h("div", { class: "bar", role: "toolbar", "aria-label": say(t("Werkzeuge", "Tools")) },
            h("button", { onclick: () => { this.attempt(say(t("Neu", "new")), () => ({ objects: [] })); } }, say(t("Neu", "New"))), opener((opened) => { this.take(opened); }),
            ...exportButtons(() => this.json(), () => this.view, () => 0.001 * extent(this.document)), h("span", { class: "sep" }), this.back, this.again, h("span", { class: "sep" }), this.pen,
            h("button", { title: keyed("Enter"), onclick: () => { this.finish(); } }, say(t("Fertig", "Finish"))), h("label", { class: "check" }, this.snap, say(t("Einrasten", "Snap"))), this.several, this.grips,
            h("button", { title: "F", onclick: () => { this.fit(); } }, say(t("Alles", "Fit"))), h("button", { title: keyed("Del"), onclick: () => { this.remove(); } }, say(t("Löschen", "Delete"))),
            h("button", { onclick: () => { this.inspect(JSON.stringify(this.json())); } }, say(t("Untersuchen", "Inspect"))), h("button", { title: "?", "aria-label": say(t("Tasten", "Keys")), onclick: showKeys }, "?"));
    }
}
