// R11, R12, R14 to R16: splines, weights, de Casteljau, subdivision.

import type { CurveJson, DocumentJson } from "../../kernel/module";
import { construct, ff } from "../../kernel/module";
import { shown } from "../../ui/dom";
import { say, t } from "../../ui/language";
import type { Handle } from "../../views/handles";
import type { Plane } from "../../views/plane";
import { run } from "../../views/view";
import { construction, curve, dots, graphs, labels, net, polygon, shade, superscript } from "../draw";
import type { Page, Stage } from "../stage";

const d = (i: number): string => `d${i}`;
const b = (i: number): string => `b${i}`;
const document = (...objects: CurveJson[]): DocumentJson => ({ freiform: 1, objects });

/** Handles on a line for knots from..to-1 of a knot vector; neighbours keep their order and may meet. */
function knotHandles(stage: Stage, knots: number[], from: number, to: number): Handle[] {
    return Array.from({ length: to - from }, (_, i) => ({
        label: `${say(t("Knoten", "knot"))} ${from + i}`, shape: "diamond" as const, colour: "aux",
        // Equal knots stand above each other, so that each can be taken.
        at: () => [knots[from + i] ?? 0, knots.slice(from, from + i).filter((k) => k === knots[from + i]).length],
        move: (at: number[]) => {
            const k = from + i, near = Math.round((at[0] ?? 0) * 20) / 20;
            knots[k] = Math.min(knots[k + 1] ?? near, Math.max(knots[k - 1] ?? near, near));
            stage.changed();
        },
    }));
}

function strip(stage: Stage): Plane { return stage.plane({ label: say(t("Knoten", "knots")), graph: true, movable: false, grid: false, height: 92 }); }

function drawStrip(plane: Plane, knots: readonly number[]): void {
    plane.clear();
    const distinct = [...new Set(knots)];
    plane.line(run([[distinct[0] ?? 0, 0], [distinct[distinct.length - 1] ?? 1, 0]]), { colour: "axis", width: 2 });
    for (const k of distinct) plane.label([k, -0.9], shown(k, 3));
    for (const k of distinct) dots(plane, knots.filter((x) => x === k).map((_, i) => [k, i]), "ink-soft", 4);
}

const r11: Page = {
    row: "R11", title: t("Gleichmäßige B\u2011Splines", "Uniform B\u2011splines"), gist: t("C² von selbst; doppelte Punkte", "C² for free; doubled points"),
    text: t("Mit m + 1 Punkten hat der kubische Spline m − 2 Stücke und überall zwei stetige Ableitungen. Ein Punkt, der dreimal vorkommt, wird interpoliert, um den Preis eines geraden Stücks auf jeder Seite.",
        "With m + 1 points the cubic spline has m − 2 pieces and two continuous derivatives everywhere. A point used three times is interpolated, at the price of a straight piece on each side."),
    formula: `M_{BS} = frac{1}{6} [-1 3 -3 1; 3 -6 0 4; -3 3 3 1; 1 0 0 0]`,
    build(stage) {
        const points = [[0, 0], [0.6, 2.2], [2.4, 2.8], [3.6, 0.4], [5, 0.2], [6, 2], [7.4, 2.2]];
        const plane = stage.plane({ label: "B-spline" });
        const graph = stage.graph(t("Basisfunktionen", "basis functions"), 150);
        plane.fit(points);
        stage.hold(plane, points, d);
        const times = stage.slider(t("Wie oft der mittlere Punkt vorkommt", "How often the middle point occurs"), { min: 1, max: 3, step: 1, value: 1 });
        const pieces = stage.toggle(t("Stücke in Farben", "Pieces in colours"), true);
        const made = (): CurveJson => {
            const all = points.flatMap((p, i) => new Array<number[]>(i === 3 ? times.value : 1).fill(p));
            return { type: "curve", degree: 3, knots: Array.from({ length: all.length + 4 }, (_, i) => i), points: all };
        };
        stage.opens(() => document(made()));
        stage.update((make) => {
            plane.clear();
            graph.clear();
            const q = make(made());
            polygon(plane, points);
            labels(plane, points, "d");
            if (!pieces.value) curve(plane, q, { colour: "curve", width: 3 });
            else (ff().run("convert", made(), { toBezier: true }).json as DocumentJson).objects.forEach((piece, i) => {
                const shape = make(piece);
                const size = Math.max(...net(shape).map((p) => Math.hypot(...p.map((x, k) => x - (net(shape)[0]?.[k] ?? 0)))));
                if (size > 0) curve(plane, shape, { colour: shade(i), width: 3.4 });
            });
            const [lo = 0, hi = 1] = q.domain[0] ?? [];
            graph.fit([[lo, 0], [hi, 1]]);
            graphs(graph, q);
            const joints = (ff().run("continuity", made()).json as { objects: { knots: { c_order: number; g_order: number }[] }[] }).objects[0]?.knots ?? [];
            stage.say([[say(t("Stücke", "pieces")), String(hi - lo)], [say(t("C an Knoten", "C at knots")), joints.map((j) => j.c_order).join(", ")],
                [say(t("G an Knoten", "G at knots")), joints.map((j) => j.g_order).join(", ")]]);
        });
    },
};

const r12: Page = {
    row: "R12", title: t("Ungleichmäßige B\u2011Splines", "Non-uniform B\u2011splines"), gist: t("ziehbare Knoten", "knots to drag"),
    text: t("Ziehen Sie die Knoten unten: fallen m zusammen, bleiben p − m stetige Ableitungen, und ein dreifacher Knoten einer Kubik interpoliert einen Kontrollpunkt ohne gerade Stücke. Die Basisfunktionen zeigen es: eine erreicht dort 1.",
        "Drag the knots below: where m of them meet, p − m continuous derivatives are left, and a triple knot of a cubic interpolates a control point without straight pieces. The basis functions show it: one of them reaches 1 there."),
    formula: `N_{i,p}(u) = frac{u - t_i}{t_{i+p} - t_i} N_{i,p-1}(u)
              + frac{t_{i+p+1} - u}{t_{i+p+1} - t_{i+1}} N_{i+1,p-1}(u)`,
    build(stage) {
        const points = [[0, 0], [0.4, 2.2], [2.2, 3], [3.4, 0.6], [4.8, 0], [6.2, 1.2], [6.6, 2.8]], knots = [0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4];
        const plane = stage.plane({ label: "B-spline" }), graph = stage.graph(t("Basisfunktionen", "basis functions"), 150), line = strip(stage);
        plane.fit(points);
        graph.fit([[0, 0], [4, 1]]);
        line.fit([[0, 0], [4, 3]]);
        stage.hold(plane, points, d);
        line.handles.show(knotHandles(stage, knots, 4, 7));
        const u = stage.player(t("Parameter u", "Parameter u"), { min: 0, max: 4, value: 1.5 });
        const put = (three: number[]): void => { three.forEach((k, i) => { knots[4 + i] = k; }); };
        stage.button(t("Gleichmäßig", "Uniform"), () => { put([1, 2, 3]); });
        stage.button(t("Dreifacher Knoten", "Triple knot"), () => { put([2, 2, 2]); });
        const made = (): CurveJson => ({ type: "curve", degree: 3, knots, points });
        stage.opens(() => document(made()));
        stage.update((make) => {
            plane.clear();
            graph.clear();
            const q = make(made());
            polygon(plane, points);
            labels(plane, points, "d");
            curve(plane, q, { colour: "curve", width: 3 });
            graphs(graph, q);
            drawStrip(line, knots);
            line.handles.place();
            dots(plane, [...new Set(knots.slice(3, 8))].map((k) => Array.from(q.evaluate([k]))), "aux", 8);
            const weights = q.basis([u.value]);
            graph.line(run([[u.value, 0], [u.value, 1]]), { colour: "hot", width: 1.2, dashed: true });
            weights.forEach((w, i) => { if (w > 0) dots(graph, [[u.value, w]], shade(i), 8); });
            dots(plane, [Array.from(q.evaluate([u.value]))], "hot", 11);
            const joints = (ff().run("continuity", made()).json as { objects: { knots: { knot?: number; at?: number; parameter?: number; c_order: number; g_order: number }[] }[] }).objects[0]?.knots ?? [];
            stage.say([["t", knots.map((k) => shown(k, 3)).join(" ")], [say(t("C an inneren Knoten", "C at inner knots")), joints.map((j) => j.c_order).join(", ")],
                [say(t("Gewichte bei u", "weights at u")), Array.from(weights, (w) => shown(w, 2)).join(" ")]]);
        });
    },
};

const r14: Page = {
    row: "R14", title: t("Rationale Kurven", "Rational curves"), gist: t("Gewichte und Kegelschnitte", "weights and conics"),
    text: t("Mit Gewichten werden Polynomkurven im Raum vom Ursprung aus projiziert, und Kegelschnitte werden exakt. Ein einziges Gewicht entscheidet zwischen Ellipse (w\u00a0<\u00a01), Parabel (w\u00a0=\u00a01) und Hyperbel (w\u00a0>\u00a01). Rechts ist dieselbe Kurve vor der Projektion zu sehen.",
        "With weights, polynomial curves in space are projected from the origin, and conics become exact. A single weight decides between ellipse (w\u00a0<\u00a01), parabola (w\u00a0=\u00a01) and hyperbola (w\u00a0>\u00a01). On the right is the same curve before the projection."),
    formula: `Q(t) = frac{sum_i w_i P_i B_i^n(t)}{sum_i w_i B_i^n(t)}`,
    build(stage) {
        const points = [[1, 0], [1, 1], [0, 1]];
        stage.beside();
        const plane = stage.plane({ label: "conic" }), space = stage.space(t("homogene Koordinaten", "homogeneous coordinates"));
        stage.beside();
        plane.fit([[0, 0], [1, 1.05]]);
        space.fit([[0, 0, 0], [1.4, 1.4, 1.4]]);
        stage.hold(plane, points, (i) => `P${i + 1}`);
        const w = stage.slider(t("Gewicht w₂", "Weight w₂"), { min: 0.05, max: 4, value: Math.SQRT1_2 });
        stage.button(t("Kreis: w = √½", "Circle: w = √½"), () => { w.value = Math.SQRT1_2; points.forEach((p, i) => { p.splice(0, 2, ...([[1, 0], [1, 1], [0, 1]][i] ?? [])); }); plane.handles.place(); });
        stage.button(t("Parabel: w = 1", "Parabola: w = 1"), () => { w.value = 1; });
        const made = (): CurveJson => ({ type: "curve", points, weights: [1, w.value, 1] });
        stage.opens(() => document(made()));
        stage.update((make) => {
            plane.clear();
            space.clear();
            const q = make(made());
            polygon(plane, points);
            labels(plane, points, "P", 1);
            curve(plane, q, { colour: "curve", width: 3 });
            // The same coefficients (w x, w y, w) as a polynomial curve in space, and its rays to the origin.
            const lifted = make({ type: "curve", points: points.map((p, i) => { const wi = i === 1 ? w.value : 1; return [...p.map((x) => x * wi), wi]; }) });
            polygon(space, net(lifted));
            curve(space, lifted, { colour: "violet", width: 3 });
            for (let i = 0; i <= 12; ++i) space.line(run([[0, 0, 0], Array.from(lifted.evaluate([i / 12]))]), { colour: "axis", width: 1 });
            const flat = make({ type: "curve", points: points.map((p) => [...p, 1]), weights: [1, w.value, 1] });
            curve(space, flat, { colour: "curve", width: 3 });
            space.label([0, 0, 0], "0");
            space.label([1.2, 0, 1], "W = 1");
            const kind = w.value < 1 ? t("Ellipse", "ellipse") : w.value > 1 ? t("Hyperbel", "hyperbola") : t("Parabel", "parabola");
            const radii = [0.2, 0.5, 0.8].map((u) => Math.hypot(...q.evaluate([u])));
            stage.say([[say(t("Art", "kind")), say(kind)], ["|Q(t)|", radii.map((r) => shown(r, 8)).join(", ")]]);
        });
    },
};

const r15: Page = {
    row: "R15", title: t("De Casteljau", "De Casteljau"), gist: t("alle Zwischenpunkte, ein Schieber", "all points between, one slider"),
    text: t("Teilt man jeden Schenkel im selben Verhältnis, immer wieder, bleibt ein Punkt übrig: der Punkt der Kurve. Bei rationalen Kurven geschieht dasselbe mit gewichteten Punkten.",
        "Dividing each leg in the same ratio, again and again, leaves one point: the point of the curve. For rational curves the same is done with weighted points."),
    formula: `b_i^r = (1-u) b_i^{r-1} + u b_{i+1}^{r-1}`,
    build(stage) {
        const all = [[0, 0], [0.6, 2.6], [2.8, 3.2], [4.6, 2.4], [5, 0], [6.6, -0.4], [7.4, 1.8]], weight = new Array<number>(7).fill(1);
        const plane = stage.plane({ label: "de Casteljau" });
        plane.fit(all.slice(0, 5));
        const u = stage.player(t("Parameter u", "Parameter u"), { min: 0, max: 1, value: 0.4 });
        const degree = stage.slider(t("Grad", "Degree"), { min: 1, max: 6, step: 1, value: 4 });
        const w = stage.slider(t("Gewicht des mittleren Punkts", "Weight of the middle point"), { min: 0.1, max: 6, value: 1 });
        const made = (): CurveJson => {
            const n = degree.value + 1, weights = weight.slice(0, n).map((x, i) => (i === Math.floor(n / 2) ? w.value : x));
            return { type: "curve", points: all.slice(0, n), ...(w.value !== 1 ? { weights } : {}) };
        };
        let held = 0;
        stage.opens(() => document(made()));
        stage.update((make) => {
            const json = made();
            if (held !== json.points.length) { held = json.points.length; stage.hold(plane, json.points, b); }
            plane.clear();
            const q = make(json), scheme = construct(q, [u.value]);
            polygon(plane, json.points);
            curve(plane, q, { colour: "curve", width: 3 });
            labels(plane, json.points, "b");
            construction(plane, scheme);
            const point = scheme[scheme.length - 1]?.points[0] ?? [];
            plane.label(point, `b₀${superscript(degree.value)}`, "hot");
            stage.say([["Q(u)", `(${point.map((x) => shown(x, 8)).join(", ")})`], [say(t("Schranke", "bound")), shown(q.valueErrorBound)]]);
        });
    },
};

const r16: Page = {
    row: "R16", title: t("Unterteilung", "Subdivision"), gist: t("halbieren, Knoten einfügen", "halving, inserting knots"),
    text: t("Die Zwischenpunkte von de Casteljau sind die Kontrollpunkte beider Hälften, und nach wenigen Schritten sind ihre Polygone von der Kurve nicht mehr zu unterscheiden. Beim B-Spline tut das Einfügen eines Knotens in jede Spanne dasselbe, und die Nachbarn arbeiten weiter.",
        "The intermediate points of de Casteljau are the control points of both halves, and after a few steps their polygons cannot be told from the curve. For B-splines inserting a knot into every span does the same, and the neighbours keep working."),
    formula: `L = frac{1}{8} [8 4 2 1; 0 4 4 3; 0 0 2 3; 0 0 0 1] "  "
              R = frac{1}{8} [1 0 0 0; 3 2 0 0; 3 4 4 0; 1 2 4 8]`,
    build(stage) {
        const points = [[0, 0], [0.4, 3], [4.4, 3.4], [5, 0], [7, -0.4], [7.6, 2.4]];
        const plane = stage.plane({ label: "subdivision" });
        plane.fit(points);
        const kind = stage.choice(t("Kurve", "Curve"), { bezier: t("Bézier, halbieren", "Bézier, halving"), spline: t("B-Spline, Knoten", "B-spline, knots") }, "bezier",
            () => { hold(); });
        const level = stage.slider(t("Schritte", "Steps"), { min: 0, max: 5, step: 1, value: 1 });
        const at = stage.slider(t("Teilung bei", "Cut at"), { min: 0.1, max: 0.9, value: 0.5 });
        const own = (): number[][] => (kind.value === "bezier" ? points.slice(0, 4) : points);
        const hold = (): void => { stage.hold(plane, own(), kind.value === "bezier" ? b : d); };
        hold();
        const made = (): CurveJson => (kind.value === "bezier" ? { type: "curve", points: own() }
            : { type: "curve", degree: 3, knots: Array.from({ length: 10 }, (_, i) => i - 3), points: own() });
        const refined = (): CurveJson[] => {
            let now = [made()];
            for (let k = 0; k < level.value; ++k) {
                if (kind.value === "bezier") {
                    now = now.flatMap((piece) => {
                        const lo = piece.knots?.[0] ?? 0, hi = piece.knots?.[piece.knots.length - 1] ?? 1;
                        return (ff().run("convert", piece, { split: lo + at.value * (hi - lo) }).json as DocumentJson).objects as CurveJson[];
                    });
                } else {
                    const breaks = [...new Set(now[0]?.knots ?? [])];
                    const middle = breaks.slice(0, -1).map((x, i) => x + at.value * ((breaks[i + 1] ?? x) - x)).filter((x) => x > 0 && x < 3);
                    now = (ff().run("convert", now[0] ?? made(), { insertKnots: middle }).json as DocumentJson).objects as CurveJson[];
                }
            }
            return now;
        };
        stage.opens(() => document(...refined()));
        stage.update((make) => {
            plane.clear();
            curve(plane, make(made()), { colour: "curve", width: 3 });
            const all = refined();
            all.forEach((piece, i) => {
                polygon(plane, piece.points, { colour: kind.value === "bezier" ? shade(i + 1) : "control", width: 1.6 });
                dots(plane, piece.points, kind.value === "bezier" ? shade(i + 1) : "control", 6);
            });
            stage.say([[say(t("Polygone", "polygons")), String(all.length)], [say(t("Kontrollpunkte", "control points")), String(all.reduce((n, x) => n + x.points.length, 0))]]);
        });
    },
};

export const kSplines: readonly Page[] = [r11, r12, r14, r15, r16];
