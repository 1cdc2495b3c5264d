// The part of the studio that looks at surfaces and models.

import type { MeshOptions } from "freiform";
import teapot from "../../../examples/teapot.bpt?url";
import { answer, curvatures, ff, file, mesh, read, section, type Mesh, type Beside, type Meshed, type Source } from "../kernel/module";
import type { Shown } from "../explore/explore";
import { coalesced, download, h, shown } from "../ui/dom";
import { droppable, opener, type Opened } from "../ui/files";
import { say, t, type Text } from "../ui/language";
import { refuse } from "../ui/toast";
import { Space, type Look } from "../views/space";
import { legend } from "./colours";
import { Faces, type Refused } from "./faces";
import { Jobs } from "./jobs";
import { draw, extent, section as cutLines, type Colouring, type Continuity, type Drawn, type Model, type Showing } from "./scene";

const kLooks: Record<Look, Text> = { shaded: t("Schattiert", "Shaded"), zebra: t("Zebra", "Zebra"), isophotes: t("Isophoten", "Isophotes"), normals: t("Normalen", "Normals"), flat: t("Facetten", "Facets") };
const kColourings: Record<Colouring, Text> = { plain: t("ohne", "none"), faces: t("nach Flächen", "by faces"), gauss: t("Gauß-Krümmung", "Gauss curvature"), mean: t("mittlere Krümmung", "mean curvature"),
    bound: t("Fehlerschranke", "error bound"), deviation: t("gemessene Abweichung", "measured deviation") };

/** So many triangles move less than fluidly where pictures are made without a graphics card. */
const kMany = 150_000;
/** How much wider the tolerance is of what is shown while the eye moves. */
const kCoarser = 30;

/** Milliseconds after which a section is not waited for if the plane is elsewhere. */
const kLong = 600;

/** What the reader looks at stays when the language changes. */
let last: { name: string; source: Source; refused: Refused[] } | undefined;

async function served(): Promise<typeof last> {
    const reply = await fetch("./view.json").catch(() => undefined);
    if (!reply?.ok || !reply.headers.get("content-type")?.includes("json")) return undefined;
    const about = (await reply.json()) as { file: string };
    const document = await fetch("./document.json");
    if (!document.ok) {
        const { error } = (await document.json()) as { error: Refused };
        throw Object.assign(new Error(error.message), error);
    }
    const faces = (await fetch("./faces.json").then((r) => (r.ok ? r.json() : undefined)).catch(() => undefined)) as { refused?: Refused[] } | undefined;
    return { name: about.file, source: await document.text(), refused: faces?.refused ?? [] };
}

async function example(): Promise<NonNullable<typeof last>> {
    return { name: "teapot.bpt", source: file("teapot.bpt", await (await fetch(teapot)).text()), refused: [] };
}

export function inspect(taken: string | Opened | undefined, edit: (text: string) => void): Shown {
    const view = new Inspector(edit);
    view.begin(taken).catch(refuse);
    return view;
}

class Inspector implements Shown {
    readonly element: HTMLElement;
    private readonly space = new Space(say(t("Modell: Pfeiltasten drehen, + und − zoomen, 1, 3, 7, 0 Ansichten, F alles", "Model: arrow keys turn, + and − zoom, 1, 3, 7, 0 views, F all")));
    private readonly status = h("div", { class: "status long", role: "status", "aria-live": "polite" });
    private readonly facts = h("div", { class: "readout" });
    private readonly jobs = new Jobs();
    private readonly faces = new Faces((chosen) => { this.showing.chosen = chosen; this.draw(); }, refuse);
    private readonly tolerance = h("input", { type: "range", min: 1, max: 5.5, step: 0.1, value: 3, "aria-label": say(t("Toleranz", "Tolerance")), onchange: () => { this.tessellate(); },
        oninput: () => { this.said.textContent = shown(this.accuracy(), 3); } });
    /** Where the slider was for the triangles that are shown. */
    private reached = this.tolerance.value;
    private readonly colours = h("select", { "aria-label": say(t("Farben", "Colours")), onchange: () => {
        this.colour(this.colours.value as Colouring);
        this.curve();
        if (this.showing.colouring === "deviation" && !this.model?.deviations) this.tessellate();
    } }, ...(Object.keys(kColourings) as Colouring[]).map((key) => h("option", { value: key }, say(kColourings[key]))));
    private readonly said = h("output", {});
    private readonly name = h("strong", {});
    private readonly showing: Showing = { look: "shaded", colouring: "plain", edges: false, net: false, knots: false, isolines: 0, comb: false, normals: false, section: false, chosen: undefined, joints: false };
    private model: Model | undefined;
    private drawn: Drawn | undefined;
    private coarsening: Beside<Meshed> | undefined;
    private key: HTMLElement | undefined;
    private size = 1;
    private unit = "";
    private readonly cut = { axis: 2, at: 0.5, on: false, again: false, since: 0 };
    private readonly cutting = h("input", { type: "checkbox", onchange: () => { this.cut.on = this.cutting.checked; this.section(); } });
    /** The meshes whose curvatures are on their way. */
    private curved: readonly Mesh[] | undefined;
    private box = { lower: [-1, -1, -1], upper: [1, 1, 1] };
    private source: Source = "";
    private refused: Refused[] = [];
    private gone = false;

    constructor(private readonly toEdit: (text: string) => void) {
        this.space.onColours = () => { this.drawn = undefined; this.draw(); };
        const stage = h("div", { class: "stage" }, h("h1", { class: "unseen" }, say(t("Untersuchen", "Inspect"))), this.bar(), this.space.element, this.status);
        this.element = h("div", { style: "display:contents" }, stage, this.tools());
        droppable(stage, (opened) => { this.open(opened); });
        window.addEventListener("keydown", this.shortcut);
        this.space.canvas.addEventListener("pointermove", (event) => { if (event.buttons === 0) this.point(event.offsetX, event.offsetY); });
    }

    /** What the titles of the buttons promise, wherever the focus is, but where letters and digits are entered. */
    private readonly shortcut = (event: KeyboardEvent): void => {
        const { target } = event;
        if (event.defaultPrevented || document.querySelector("dialog[open]")) return;
        if ((event.ctrlKey || event.metaKey) && !event.shiftKey && event.key.toLowerCase() === "o") {
            event.preventDefault();
            this.element.querySelector<HTMLElement>("[data-open]")?.click();
        } else if ("01357fF".includes(event.key) && !(target instanceof Element && target.matches("select, textarea, input:not([type=checkbox], [type=range])"))) this.space.key(event);
    };

    async begin(taken: string | Opened | undefined): Promise<void> {
        if (typeof taken === "object") { this.open(taken); return; }
        if (taken !== undefined) { this.show("studio.json", taken, []); return; }
        const found = last ?? (await served()) ?? (await example());
        if (!this.gone) this.show(found.name, found.source, found.refused);
    }

    dispose(): void {
        this.gone = true;
        window.removeEventListener("keydown", this.shortcut);
        this.coarsening?.cancel();
        this.jobs.endAll();
        this.model?.shapes.forEach((shape) => { shape.free(); });
        this.space.dispose();
    }

    /** Reads a file beside the page, which goes on showing what it had until all is understood. */
    private open({ name, source, beside }: Opened): void {
        this.jobs.begin("read", () => read(file(name, source, beside)), (found) => {
            if (found) this.show(name, found.document, found.leftOut.map((x) => ({ kind: "left out", ...x })));
        });
    }

    private show(name: string, source: Source, refused: Refused[]): void {
        const { shapes, leftOut, unit } = ff().document(source);
        this.unit = unit;
        this.model?.shapes.forEach((shape) => { shape.free(); });
        last = { name, source, refused };
        this.source = source;
        this.refused = [...refused, ...leftOut.map((x) => ({ kind: "left out", ...x }))];
        this.model = { shapes, solid: shapes.filter((s) => s.type !== "curve" && s.type !== "volume"), document: ff().json([...shapes]), size: 1, meshes: [], edges: [], deviations: undefined, curvatures: undefined, section: undefined, continuity: undefined };
        this.name.textContent = name;
        const bounds = ff().run("bounds", source, { }).json as { box?: { min: number[]; max: number[] } | null };
        this.box = { lower: [...(bounds.box?.min ?? [-1, -1, -1]), 0].slice(0, 3), upper: [...(bounds.box?.max ?? [1, 1, 1]), 0].slice(0, 3) };
        this.size = this.model.size = extent([this.box.lower, this.box.upper]);
        this.space.fit([this.box.lower, this.box.upper]);
        this.showing.chosen = undefined;
        // Until there are answers for this one, those of the one before must not stand under its name.
        this.facts.replaceChildren();
        this.faces.show([], [], undefined);
        this.status.textContent = "";
        this.draw();
        for (const name of ["continuity", "curvatures", "section"]) this.jobs.end(name);
        this.section();
        if (this.showing.joints) this.ask();
        this.tessellate();
    }

    /** The continuity of joints and edges, which takes longer than a picture may. */
    private ask(): void {
        const { model } = this;
        if (!model || model.continuity) return;
        this.jobs.begin("continuity", () => answer("continuity", this.source, {}), (found) => {
            if (!found) return;
            model.continuity = found as Continuity;
            this.draw();
        });
    }

    private accuracy(): number { return this.size * 10 ** -this.tolerance.valueAsNumber; }

    private tessellate(): void {
        this.coarsening?.cancel();
        const { model } = this;
        if (!model) return;
        this.said.textContent = shown(this.accuracy(), 3);
        if (model.solid.length === 0) { this.jobs.end("mesh"); this.draw(); this.tell(0); return; }
        const options: MeshOptions = { tolerance: this.accuracy(), maxTriangles: 4_000_000 };
        const began = performance.now();
        const tolerance = this.tolerance.value, also = { deviations: this.showing.colouring === "deviation", edges: this.size };
        this.jobs.begin("mesh", (progress) => mesh(this.source, options, also, progress), (found) => {
            if (!found) { this.stay(model); return; }
            const { meshes, edges, deviations } = found;
            model.meshes = meshes;
            model.edges = edges ?? [];
            model.coarse = undefined;
            model.deviations = deviations;
            model.curvatures = undefined;
            this.reached = tolerance;
            this.draw();
            if (meshes.reduce((n, m) => n + m.indices.length / 3, 0) > kMany) this.coarsen(model, options);
            this.tell(performance.now() - began);
            this.curve();
        });
    }

    /** The curvatures, if they are asked for and not known. */
    private curve(): void {
        const { model } = this;
        if (!model || model.meshes.length === 0 || model.curvatures || !["gauss", "mean"].includes(this.showing.colouring)) { this.jobs.end("curvatures"); return; }
        if (this.jobs.is("curvatures") && this.curved === model.meshes) return;
        this.curved = model.meshes;
        this.jobs.begin("curvatures", (progress) => curvatures(this.source, model.meshes, progress), (found) => {
            model.curvatures = found;
            if (found) this.draw();
            else this.colour("plain");
        });
    }

    /** The section at the plane, found beside the page; the one before is shown until then. */
    private section(): void {
        const { model } = this, { axis, at, on } = this.cut;
        this.showing.section = on;
        if (!model || !on) { this.jobs.end("section"); this.cutLines(); return; }
        // A slider moves faster than sections are found: the newest place comes next, or now if the last one takes long.
        if (this.jobs.is("section") && performance.now() - this.cut.since < kLong) { this.cut.again = true; return; }
        const [lo = 0, hi = 1] = [this.box.lower[axis], this.box.upper[axis]];
        const plane = [...[0, 1, 2].map((k) => (k === axis ? 1 : 0)), -(lo + at * (hi - lo))];
        Object.assign(this.cut, { again: false, since: performance.now() });
        this.jobs.begin("section", () => section(this.source, plane), (found) => {
            if (found) model.section = found;
            else { this.cut.on = this.showing.section = this.cutting.checked = false; }
            this.cutLines();
            if (found && this.cut.again) this.section();
        });
    }

    /** Of the picture the section alone. */
    private cutLines(): void {
        if (!this.drawn || !this.model) return;
        if (this.drawn.section) this.space.remove(this.drawn.section);
        this.drawn = { ...this.drawn, section: this.showing.section ? cutLines(this.space, this.model) : undefined };
    }

    /** There are no triangles of what was asked for: what is said is about those that are shown. */
    private stay(model: Model): void {
        if (this.showing.colouring === "deviation" && !model.deviations) this.colour("plain");
        if (model.meshes.length === 0) { this.facts.textContent = say(t("Nicht vernetzt. Eine andere Toleranz beginnt von Neuem.", "Not meshed. Another tolerance begins anew.")); return; }
        this.tolerance.value = this.reached;
        this.said.textContent = shown(this.accuracy(), 3);
    }

    private colour(by: Colouring): void {
        this.showing.colouring = this.colours.value = by;
        this.draw();
    }

    /** Another level of detail: what cannot be meshed so coarsely is always shown as it is. */
    private coarsen(model: Model, options: MeshOptions): void {
        const meshing = mesh(this.source, { ...options, tolerance: kCoarser * options.tolerance }, {}, () => undefined);
        this.coarsening?.cancel();
        this.coarsening = meshing;
        meshing.done.then(({ meshes }) => {
            if (this.gone || this.model !== model || this.coarsening !== meshing || meshes.length !== model.meshes.length) return;
            model.coarse = meshes;
            this.draw();
        }).catch(() => undefined);
    }

    private draw(): void {
        if (!this.model || this.gone) return;
        this.key?.remove();
        this.key = undefined;
        try {
            this.drawn = draw(this.space, this.model, this.showing, this.drawn);
        } catch (error) {
            refuse(error);
            this.drawn = draw(this.space, this.model, { ...this.showing, colouring: "plain" });
        }
        if (this.drawn.scale) {
            const { unit } = this, { colouring } = this.showing;
            const of = unit === "" ? "" : colouring === "gauss" ? ` (1/${unit}²)` : colouring === "mean" ? ` (1/${unit})` : ` (${unit})`;
            this.key = legend(say(kColourings[colouring]) + of, this.drawn.scale);
            this.space.element.append(this.key);
        }
        this.space.element.dataset["triangles"] = String(this.model.meshes.reduce((n, m) => n + m.indices.length / 3, 0));
    }

    private tell(time: number): void {
        const meshes = this.model?.meshes ?? [];
        const sum = (f: (m: (typeof meshes)[0]) => number): number => meshes.reduce((n, m) => n + f(m), 0);
        const all = [...this.refused, ...meshes.flatMap((m) => m.refused.map((r) => ({ where: r.where || r.name || `face ${r.face}`, kind: r.kind, message: r.message })))];
        // The program lists what it refused, and its document has the list again.
        const bad = [...new Map(all.map((r) => [`${r.where} ${r.message}`, r])).values()];
        const rows: [string, string][] = [
            [say(t("Dreiecke", "triangles")), String(sum((m) => m.indices.length / 3))], [say(t("Flächen", "faces")), String(sum((m) => m.parts.length))],
            [say(t("Schranke", "error bound")), shown(meshes.reduce((x, m) => Math.max(x, m.errorBound), 0), 4)], [say(t("Lücke am Rand", "boundary gap")), shown(meshes.reduce((x, m) => Math.max(x, m.boundaryGap), 0), 4)],
            ...(this.model?.solid.some((s) => s.type === "model") ? [[say(t("offene Kanten", "open edges")), String(sum((m) => m.openEdges))] as [string, string]] : []),
            ...(bad.length > 0 ? [[say(t("nicht gelesen", "refused")), `⚠ ${bad.length}`] as [string, string]] : []), [say(t("Zeit", "time")), `${shown(time, 3)} ms`]];
        this.facts.replaceChildren(h("table", {}, ...rows.map(([a, b]) => h("tr", {}, h("th", { scope: "row" }, a), h("td", {}, b)))));
        this.faces.show(bad, meshes.flatMap((m, shape) => m.parts.map((part) => {
            const name = part.name || this.model?.solid[shape]?.name || `${say(t("Fläche", "face"))} ${shape}.${part.face}`;
            return { shape, face: part.face, text: `${name} · ${part.count} · ≤ ${shown(part.errorBound, 2)}` };
        })), this.showing.chosen);
    }

    /** The nearest point of the shape that is under the cursor. */
    private point(x: number, y: number): void {
        const hits = (this.drawn?.objects ?? []).map((object, i) => ({ i, hit: this.model && this.model.meshes.length > 0 ? this.space.pick(x, y, object) : undefined }));
        const eye = this.space.camera.position;
        const first = hits.filter((a) => a.hit).sort((a, b) => far(a.hit?.point, eye) - far(b.hit?.point, eye))[0];
        const shape = first && this.model?.solid[first.i];
        if (!first?.hit || !shape) { this.status.textContent = ""; return; }
        const near = shape.nearest(first.hit.point.slice(0, shape.dimension));
        const words = (a: ArrayLike<number>): string => Array.from(a, (c) => shown(c, 5)).join(", ");
        this.status.textContent = `${shape.name || shape.type}${near.faces ? ` · ${say(t("Fläche", "face"))} ${near.faces[0] ?? ""}` : ""} · u, v = ${words(near.parameters)} · ` +
            `${say(t("nächster Punkt", "nearest point"))} (${words(near.points)}) · ${say(t("Abstand des Netzes hier", "distance of the mesh here"))} ${shown(near.distances[0] ?? 0, 3)} ≥ ${shown(near.lowerBounds[0] ?? 0, 3)}`;
    }

    private bar(): HTMLElement {
        return h("div", { class: "bar", role: "toolbar", "aria-label": say(t("Ansicht", "View")) }, opener((opened) => { this.open(opened); }), this.name, h("span", { class: "sep" }),
            ...([["1", t("Vorn", "Front"), 0, -1, 0], ["3", t("Rechts", "Right"), 1, 0, 0], ["7", t("Oben", "Top"), 0, -1e-3, 1], ["0", t("Schräg", "Oblique"), 4, -6, 4]] as const).map(([key, name, x, y, z]) =>
                h("button", { title: key, onclick: () => { this.space.look(x, y, z); } }, say(name))),
            h("button", { title: "F", onclick: () => { this.space.frame(); } }, say(t("Alles", "Fit"))),
            h("button", { title: "5", onclick: () => { this.space.project5(); } }, say(t("Parallel", "Parallel"))), h("span", { class: "sep" }),
            h("button", { onclick: () => { this.toEdit(JSON.stringify(this.model?.document ?? {})); } }, say(t("Bearbeiten", "Edit"))),
            h("button", { onclick: () => { download("freiform.png", bytesOf(this.space.png()), "image/png"); } }, "PNG"),
            ...(["glb", "stl"] as const).map((format) => h("button", { onclick: () => { this.save(format); } }, format)));
    }

    private save(format: "glb" | "stl"): void {
        try {
            const bytes = ff().run("tessellate", this.source, { to: format, tolerance: this.accuracy() }).bytes;
            download(`freiform.${format}`, bytes, format === "glb" ? "model/gltf-binary" : "model/stl");
        } catch (error) { refuse(error); }
    }

    private tools(): HTMLElement {
        const pick = <K extends string>(label: Text, options: Record<K, Text>, set: (key: K) => void): HTMLElement => {
            const select = h("select", { "aria-label": say(label), onchange: () => { set(select.value as K); this.draw(); } },
                ...(Object.keys(options) as K[]).map((key) => h("option", { value: key }, say(options[key]))));
            return h("label", { class: "knob" }, h("span", {}, say(label)), select);
        };
        const check = (label: Text, set: (on: boolean) => void): HTMLElement => {
            const input = h("input", { type: "checkbox", onchange: () => { set(input.checked); this.draw(); } });
            return h("label", { class: "check" }, input, say(label));
        };
        const redraw = coalesced(() => { this.draw(); });
        const isolines = h("input", { type: "range", min: 0, max: 12, step: 1, value: 0, "aria-label": say(t("Isolinien", "Iso-curves")), oninput: () => { this.showing.isolines = isolines.valueAsNumber; redraw(); } });
        const at = h("input", { type: "range", min: 0.001, max: 0.999, step: 0.001, value: 0.5, "aria-label": say(t("Ort der Schnittebene", "Place of the plane")), oninput: () => { this.cut.at = at.valueAsNumber; this.section(); } });
        const axis = h("select", { "aria-label": say(t("Achse der Schnittebene", "Axis of the plane")), onchange: () => { this.cut.axis = Number(axis.value); this.section(); } },
            ...["x", "y", "z"].map((name, i) => h("option", { value: i, selected: i === 2 }, name)));
        const s = this.showing;
        return h("div", { class: "tools" },
            h("section", {}, h("div", { class: "jobs" }, h("h2", {}, say(t("Netz", "Mesh"))), this.jobs.progress, this.jobs.stop), h("label", { class: "knob" }, h("span", {}, say(t("Toleranz", "Tolerance"))), this.said, this.tolerance), this.facts),
            h("section", {}, h("h2", {}, say(t("Aussehen", "Look"))), pick(t("Ansicht", "Look"), kLooks, (key) => { s.look = key; }), h("label", { class: "knob" }, h("span", {}, say(t("Farben", "Colours"))), this.colours),
                check(t("Dreiecke", "Triangles"), (on) => { s.edges = on; }), check(t("Kontrollnetz", "Control net"), (on) => { s.net = on; }), check(t("Knotenlinien", "Knots"), (on) => { s.knots = on; }),
                check(t("Anschlüsse: G⁰ rot, G¹ gelb, G² grün", "Joints: G⁰ red, G¹ yellow, G² green"), (on) => { s.joints = on; if (on) this.ask(); }),
                check(t("Krümmungskamm (Kurven)", "Curvature comb (curves)"), (on) => { s.comb = on; }), check(t("Normalen", "Normals"), (on) => { s.normals = on; }),
                h("label", { class: "knob" }, h("span", {}, say(t("Isolinien", "Iso-curves"))), isolines)),
            h("section", {}, h("h2", {}, say(t("Schnitt", "Section"))), h("label", { class: "check" }, this.cutting, say(t("Ebene schneidet", "Cut by a plane"))), h("label", { class: "knob" }, h("span", {}, say(t("Achse", "Axis"))), axis, at)),
            h("section", {}, h("h2", {}, say(t("Flächen", "Faces"))), this.faces.element));
    }
}

const far = (p: readonly number[] | undefined, eye: { x: number; y: number; z: number }): number =>
    Math.hypot((p?.[0] ?? 0) - eye.x, (p?.[1] ?? 0) - eye.y, (p?.[2] ?? 0) - eye.z);

function bytesOf(url: string): Uint8Array {
    const text = atob(url.slice(url.indexOf(",") + 1));
    return Uint8Array.from(text, (c) => c.charCodeAt(0));
}

