// R1 to R7: descriptions of curves, and one cubic in many bases.

import type { CurveJson } from "../../kernel/module";
import { ff } from "../../kernel/module";
import { shown } from "../../ui/dom";
import { say, t } from "../../ui/language";
import { run } from "../../views/view";
import { arrow, bezier, curve, dots, graphs, jet, labels, polygon, shade, steps, subscript } from "../draw";
import type { Page } from "../stage";

const P = (i: number): string => `P${i + 1}`;
const b = (i: number): string => `b${i}`;
const one = (object: object) => ({ freiform: 1 as const, objects: [object as CurveJson] });
const pair = (p: readonly number[] | undefined): string => `(${(p ?? []).map((x) => shown(x)).join(", ")})`;

interface Term { readonly x: number; readonly y: number; readonly coefficient: number }

const r1: Page = {
    row: "R1", title: t("Drei Beschreibungen", "Three descriptions"),
    gist: t("explizit, implizit, parametrisch", "explicit, implicit, parametric"),
    text: t("Die parametrische Kurve sagt, wo der Punkt zu jeder Zeit ist; die implizite Gleichung F(x, y) = 0 sagt von jedem Punkt der Ebene, " +
            "auf welcher Seite er liegt. Die Gleichung dieser Kurve wird exakt berechnet, und das Vorzeichen am grünen Punkt auch.",
        "The parametric curve says where the point is at each time; the implicit equation F(x, y) = 0 says of each point of the plane on which " +
            "side it lies. The equation of this curve is computed exactly, and so is the sign at the green point."),
    formula: `F(x, y) = sum_{i+j≤n} a_{ij} x^i y^j = 0`,
    build(stage) {
        const points = [[0, 0], [1, 2], [3, 2.5], [4, 0]], probe = [[2, 0.8]];
        const plane = stage.plane({ label: "curve and point" });
        plane.fit([...points, [0, -0.5]]);
        plane.handles.show([...stage.handlesOf(points, P), ...stage.handlesOf(probe, () => "probe", { colour: "aux", shape: "diamond" })]);
        stage.opens(() => one({ type: "curve", points }));
        stage.update((make) => {
            plane.clear();
            polygon(plane, points);
            curve(plane, make({ type: "curve", points }));
            labels(plane, points, "P", 1);
            const reply = ff().run("implicit", { type: "curve", points }, { at: (probe[0] ?? []).join(",") }).json as
                { results: { terms: Term[]; signs: number[]; degree: number }[] };
            const it = reply.results[0];
            const sign = it?.signs[0] ?? 0;
            const terms = (it?.terms ?? []).filter((m) => m.coefficient !== 0).map((m) =>
                `${m.coefficient < 0 ? "− " : "+ "}${shown(Math.abs(m.coefficient), 4)}${m.x ? ` x${m.x > 1 ? "⁰¹²³"[m.x] ?? "" : ""}` : ""}${m.y ? ` y${m.y > 1 ? "⁰¹²³"[m.y] ?? "" : ""}` : ""}`);
            stage.say([["F", sign > 0 ? "> 0" : sign < 0 ? "< 0" : "= 0"], [say(t("Grad", "degree")), String(it?.degree ?? 0)], ["F(x, y)", terms.join(" ")]]);
        });
    },
};

const r2: Page = {
    row: "R2", title: t("Polynomkurven", "Polynomial curves"), gist: t("Koeffizienten und Tangente", "coefficients and tangent"),
    text: t("Jede Koordinate ist ein Polynom in t. Die Tangente Q′ kommt aus denselben Koeffizienten und ist selbst eine Kurve, einen Grad niedriger " +
            "(rechts). Die Matrix C berechnet das Modul aus den Kontrollpunkten.",
        "Each coordinate is a polynomial of t. The tangent Q′ comes from the same coefficients and is a curve itself, one degree lower (right). " +
            "The module computes the matrix C from the control points."),
    formula: `Q(t) = C · (t^3, t^2, t, 1)^T
              Q′(t) = C · (3t^2, 2t, 1, 0)^T`,
    build(stage) {
        const points = [[0, 0], [0.5, 2.2], [3.5, 2.6], [4, 0.4]];
        stage.beside();
        const plane = stage.plane({ label: "Q" }), hodograph = stage.plane({ label: "Q′" });
        stage.beside();
        plane.fit(points);
        hodograph.fit([[-2, -8], [10, 8]]);
        stage.hold(plane, points, P);
        const u = stage.player(t("Parameter t", "Parameter t"), { min: 0, max: 1, value: 0.3 });
        stage.opens(() => one({ type: "curve", points }));
        stage.update((make) => {
            const q = make({ type: "curve", points });
            plane.clear();
            hodograph.clear();
            polygon(plane, points, { colour: "axis", width: 1.2 });
            curve(plane, q);
            const [at = [], d = []] = jet(q, u.value, 1);
            const all = q.evaluate(steps(0, 1, 120), { derivatives: 1 });
            hodograph.line({ at: Float64Array.from({ length: 242 }, (_, i) => all[2 * (i - (i % 2)) + 2 + (i % 2)] ?? 0), dimension: 2 }, { colour: "control", width: 2.4 });
            arrow(hodograph, [0, 0], d, "control");
            arrow(plane, at, at.map((x, i) => x + (d[i] ?? 0) / 3), "control");
            dots(plane, [at], "hot", 11);
            plane.label(at, "Q(t)");
            const reply = ff().run("basis", { type: "curve", points }, { toBasis: "monomial", origin: 0 }).json as { results: { coefficients: number[][] }[] };
            const c = reply.results[0]?.coefficients ?? [];
            stage.say([["t³", pair(c[0])], ["t²", pair(c[1])], ["t", pair(c[2])], ["1", pair(c[3])], ["Q(t)", pair(at)], ["Q′(t)", pair(d)]]);
        });
    },
};

const kUniform = [-3, -2, -1, 0, 1, 2, 3, 4];

const r3: Page = {
    row: "R3", title: t("Q = G · M · T", "Q = G · M · T"), gist: t("Geometrie, Basis, Parameter", "geometry, basis, parameter"),
    text: t("Drei Faktoren: dieselben vier Punkte G geben mit einer anderen Matrix M eine andere Kurve. Unten die vier Funktionen, mit denen die Punkte gewichtet werden.",
        "Three factors: with another matrix M the same four points G give another curve. Below are the four functions that the points are weighted by."),
    formula: `Q(t) = G · M · T
              T = (t^3, t^2, t, 1)^T
              M_B = [-1 3 -3 1; 3 -6 3 0; -3 3 0 0; 1 0 0 0]`,
    build(stage) {
        const points = [[0, 0], [1, 2.4], [3.2, 2], [4, -0.2]];
        const plane = stage.plane({ label: "Q = G M T" });
        const graph = stage.graph(t("Basisfunktionen", "basis functions"));
        plane.fit(points);
        graph.fit([[0, -0.2], [1, 1.05]]);
        stage.hold(plane, points, P);
        const which = stage.choice(t("Matrix M", "Matrix M"), { bezier: t("Bézier", "Bézier"), spline: t("B-Spline", "B-spline"),
            lagrange: t("Lagrange", "Lagrange"), catmull: t("Catmull-Rom", "Catmull-Rom") }, "bezier");
        const made = (p: number[][]): CurveJson => {
            if (which.value === "bezier") return { type: "curve", points: p };
            if (which.value === "spline") return { type: "curve", degree: 3, knots: kUniform, points: p };
            const ends = which.value === "lagrange" ? { parameters: "uniform", ends: "not-a-knot" } : { ends: "catmull-rom" };
            const reply = ff().run("interpolate", JSON.stringify(p) + "\n", ends).json as { objects: CurveJson[] } | CurveJson;
            return "objects" in reply ? reply.objects[0] ?? { points: p } : reply;
        };
        stage.opens(() => one(made(points)));
        stage.update((make) => {
            plane.clear();
            graph.clear();
            polygon(plane, points);
            labels(plane, points, "P", 1);
            curve(plane, make(made(points)), { colour: "curve", width: 2.8 });
            // Function i is what becomes of the numbers 0, .., 1, .., 0: the module says so itself.
            for (let i = 0; i < 4; ++i) {
                const f = make(made(points.map((_, k) => [k === i ? 1 : 0, 0])));
                const [lo, hi] = f.domain[0] ?? [0, 1];
                const from = which.value === "catmull" ? lo + (hi - lo) / 3 : lo, to = which.value === "catmull" ? lo + (2 * (hi - lo)) / 3 : hi;
                const at = f.evaluate(steps(from, to, 100));
                graph.line({ at: Float64Array.from({ length: 202 }, (_, k) => (k % 2 ? at[k - 1] ?? 0 : k / 200)), dimension: 2 }, { colour: shade(i) });
                graph.label([0.08 + 0.24 * i, 0.9], P(i), shade(i));
            }
        });
    },
};

const r4: Page = {
    row: "R4", title: t("Hermite-Kurven", "Hermite curves"), gist: t("zwei Punkte, zwei Tangenten", "two points, two tangents"),
    text: t("Zwei Endpunkte und die Ableitungen dort bestimmen eine Kubik. Ziehen Sie an den Pfeilspitzen: längere Tangenten behalten die Richtung und treiben die Kurve weiter hinaus.",
        "Two ends and the derivatives there determine a cubic. Drag the tips of the arrows: longer tangents keep the direction and push the curve further out."),
    formula: `G_H = (P_1, P_4, R_1, R_4)
              M_H = [2 -3 0 1; -2 3 0 0; 1 -2 1 0; 1 -1 0 0]`,
    build(stage) {
        const ends = [[0, 0], [4, 0]], tips = [[1, 2], [5, -1.5]];
        const plane = stage.plane({ label: "Hermite" });
        const graph = stage.graph(t("die vier Hermite-Polynome", "the four Hermite polynomials"), 170);
        plane.fit([[-0.5, -2], [5, 2.4]]);
        graph.fit([[0, -0.2], [1, 1]]);
        plane.handles.show([...stage.handlesOf(ends, (i) => (i ? "P4" : "P1"), { colour: "curve" }),
            ...stage.handlesOf(tips, (i) => (i ? "R4" : "R1"), { shape: "diamond" })]);
        const spread = stage.slider(t("Länge der Tangenten k", "Length of the tangents k"), { min: 0.2, max: 4, value: 1 });
        const tangents = (): number[][] => tips.map((tip, i) => tip.map((x, k) => (x - (ends[i]?.[k] ?? 0)) * 3 * spread.value));
        stage.opens(() => one({ type: "hermite", points: ends, tangents: tangents() }));
        stage.update((make) => {
            plane.clear();
            graph.clear();
            const q = make({ type: "hermite", points: ends as [number[], number[]], tangents: tangents() as [number[], number[]] });
            curve(plane, q, { colour: "curve", width: 2.8 });
            tips.forEach((tip, i) => { arrow(plane, ends[i] ?? [], tip, "control"); plane.label(tip, i ? "R₄" : "R₁"); });
            ends.forEach((p, i) => { plane.label(p, i ? "P₄" : "P₁"); });
            const zero = [[0], [0]] as [number[], number[]];
            ["P₁", "P₄", "R₁", "R₄"].forEach((name, i) => {
                const unit = [[i % 2 === 0 ? 1 : 0], [i % 2 === 1 ? 1 : 0]] as [number[], number[]];
                const f = make({ type: "hermite", points: i < 2 ? unit : zero, tangents: i < 2 ? zero : unit });
                const at = f.evaluate(steps(0, 1, 100));
                graph.line(run(Array.from(at, (y, k) => [k / 100, y])), { colour: shade(i) });
                graph.label([[0.12, 0.88, 0.3, 0.62][i] ?? 0, [0.86, 0.86, 0.16, -0.18][i] ?? 0], name, shade(i));
            });
            const [from = [], to = []] = tangents();
            stage.say([["R₁", pair(from)], ["R₄", pair(to)]]);
        });
    },
};

const r5: Page = {
    row: "R5", title: t("Kubische Bézier-Kurven", "Cubic Bézier curves"), gist: t("vier Punkte, ein Polygon", "four points, one polygon"),
    text: t("Die Kurve beginnt und endet in den äußeren Punkten, in Richtung der inneren, und bleibt in der konvexen Hülle. Das Polygon verrät schon Wendepunkte, Spitzen und Schleifen; das Modul findet sie mit Beweis.",
        "The curve begins and ends at the outer points, towards the inner ones, and stays in the convex hull. The polygon already tells inflections, cusps and loops; the module finds them with a proof."),
    formula: `R_1 = 3(P_2 - P_1)
              R_4 = 3(P_4 - P_3)
              M_B = [-1 3 -3 1; 3 -6 3 0; -3 3 0 0; 1 0 0 0]`,
    build(stage) {
        const points = [[0, 0], [4, 3], [0, 3], [4, 0]];
        const plane = stage.plane({ label: "Bézier" });
        plane.fit(points);
        stage.hold(plane, points, P);
        const tangents = stage.toggle(t("Tangenten (ein Drittel)", "Tangents (a third)"), true);
        const put = (x: number[][]): void => { x.forEach((p, i) => { points[i]?.splice(0, 2, ...p); }); plane.handles.place(); };
        const shapes: [string, number[][]][] = [[say(t("Bogen", "Arch")), [[0, 0], [0.6, 2.5], [3.4, 2.5], [4, 0]]], ["S", [[0, 0], [1.5, 3], [2.5, -2], [4, 1]]],
            [say(t("Spitze", "Cusp")), [[0, 0], [4, 3], [0, 3], [4, 0]]], [say(t("Schleife", "Loop")), [[0, 0], [5, 3], [-1, 3], [4, 0]]]];
        for (const [name, p] of shapes) stage.button(t(name, name), () => { put(p); });
        stage.opens(() => one({ type: "curve", points }));
        stage.update((make) => {
            plane.clear();
            const q = make({ type: "curve", points });
            polygon(plane, points);
            curve(plane, q, { colour: "curve", width: 3 });
            labels(plane, points, "P", 1);
            const [p0 = [], d0 = []] = jet(q, 0, 1), [p1 = [], d1 = []] = jet(q, 1, 1);
            if (tangents.value) {
                arrow(plane, p0, p0.map((x, i) => x + (d0[i] ?? 0) / 3), "aux");
                arrow(plane, p1, p1.map((x, i) => x + (d1[i] ?? 0) / 3), "aux");
            }
            const found = (ff().run("features", { type: "curve", points }).json as { objects: Record<string, { point: number[] }[]>[] }).objects[0] ?? {};
            const places = (name: string): number[][] => (found[name] ?? []).map((x) => x.point);
            dots(plane, places("inflections"), "hot", 10);
            dots(plane, places("cusps"), "violet", 12);
            dots(plane, places("self_intersections"), "gold", 12);
            stage.say([["R₁", pair(d0)], ["R₄", pair(d1)], [say(t("Wendepunkte", "inflections")), String(places("inflections").length)],
                [say(t("Spitzen", "cusps")), String(places("cusps").length)], [say(t("Doppelpunkte", "self-intersections")), String(places("self_intersections").length)]]);
        });
    },
};

const r6: Page = {
    row: "R6", title: t("Bernstein-Polynome", "Bernstein polynomials"), gist: t("jeder Grad, Summe 1", "any degree, sum 1"),
    text: t("Die Gewichte der Kontrollpunkte sind positiv, ihre Summe ist 1, und jedes hat ein Maximum bei i/n, wo sein Punkt am stärksten zieht. Gehen Sie mit u über die Kurve und sehen Sie die Gewichte als Säulen.",
        "The weights of the control points are positive, their sum is 1, and each has one maximum at i/n, where its point pulls most. Move u along the curve and see the weights as bars."),
    formula: `B_i^n(u) = binom{n}{i} u^i (1-u)^{n-i}
              B_i^n = u B_{i-1}^{n-1} + (1-u) B_i^{n-1}`,
    build(stage) {
        const all = [[0, 0], [0.6, 2.2], [1.8, 3], [3, 2.6], [3.6, 0.8], [4.6, 0], [5.6, 1.4], [6.2, 2.8], [7, 1]];
        const degree = stage.slider(t("Grad n", "Degree n"), { min: 1, max: 8, step: 1, value: 4 });
        const plane = stage.plane({ label: "Bézier" });
        const graph = stage.graph(t("Bernstein-Polynome", "Bernstein polynomials"));
        plane.fit(all);
        graph.fit([[0, 0], [1, 1]]);
        const u = stage.player(t("Parameter u", "Parameter u"), { min: 0, max: 1, value: 0.4 });
        const points = (): number[][] => all.slice(0, degree.value + 1);
        stage.opens(() => one({ type: "curve", points: points() }));
        stage.update((make) => {
            plane.clear();
            graph.clear();
            const p = points();
            if (plane.handles.count !== p.length) stage.hold(plane, p, b);
            const q = bezier(make, p);
            polygon(plane, p);
            curve(plane, q);
            labels(plane, p, "b");
            graphs(graph, q);
            const weights = q.basis([u.value]);
            weights.forEach((w, i) => {
                graph.line(run([[u.value, 0], [u.value, w]]), { colour: shade(i), width: 1.2, opacity: 0.6 });
                dots(graph, [[u.value, w]], shade(i), 8);
                dots(plane, [p[i] ?? []], shade(i), 4 + 40 * w);
            });
            dots(plane, [Array.from(q.evaluate([u.value]))], "hot", 11);
            stage.say([...Array.from(weights, (w, i): [string, string] => [`B${subscript(i)}`, shown(w, 4)]),
                ["Σ", shown(weights.reduce((a, x) => a + x, 0), 12)]]);
        });
    },
};

type BasisName = "bernstein" | "hermite" | "monomial" | "lagrange" | "newton";

const r7: Page = {
    row: "R7", title: t("Wechsel der Basis", "Change of basis"), gist: t("eine Kurve, viele Koeffizienten", "one curve, many coefficients"),
    text: t("Dieselbe Kurve hat Kontrollpunkte, Endtangenten, Potenzkoeffizienten, interpolierte Punkte oder dividierte Differenzen. Matrizen führen von jedem zu jedem; die Kondition sagt, wie viel Genauigkeit das kosten kann.",
        "The same curve has control points, end tangents, power coefficients, interpolated points or divided differences. Matrices lead from each to each other; the condition says how much accuracy that can cost."),
    formula: `c = M d
              ⇒ "coefficients go with " M^T`,
    build(stage) {
        const points = [[0, 0], [0.8, 2.4], [3, 2.8], [4, 0.4]];
        const plane = stage.plane({ label: "cubic" });
        plane.fit(points);
        stage.hold(plane, points, b);
        const basis = stage.choice<BasisName>(t("Basis", "Basis"), { bernstein: t("Bernstein", "Bernstein"), hermite: t("Hermite", "Hermite"),
            monomial: t("Monome", "Monomials"), lagrange: t("Lagrange", "Lagrange"), newton: t("Newton", "Newton") }, "lagrange");
        stage.opens(() => one({ type: "curve", points }));
        stage.update((make) => {
            plane.clear();
            const q = make({ type: "curve", points });
            polygon(plane, points, { colour: "axis", width: 1.2 });
            curve(plane, q);
            const it = (ff().run("basis", { type: "curve", points }, { toBasis: basis.value }).json as
                { results: { coefficients: number[][]; condition: number; bound: number }[] }).results[0];
            const c = it?.coefficients ?? [];
            if (basis.value === "lagrange" || basis.value === "bernstein") dots(plane, c, "hot", 10);
            else if (basis.value === "hermite") {
                dots(plane, c.slice(0, 2), "hot", 10);
                c.slice(2).forEach((r, i) => { const p = c[i] ?? []; arrow(plane, p, p.map((x, k) => x + (r[k] ?? 0) / 3), "hot"); });
            } else {
                const chain = basis.value === "monomial" ? [...c].reverse() : c;
                let at = chain[0] ?? [];
                dots(plane, [at], "hot", 10);
                for (const step of chain.slice(1)) { const to = at.map((x, k) => x + (step[k] ?? 0) / 5); arrow(plane, at, to, "hot"); at = to; }
            }
            stage.say([...c.map((p, i): [string, string] => [`c${subscript(i)}`, pair(p)]),
                [say(t("Kondition", "condition")), shown(it?.condition ?? 0)], [say(t("Schranke", "bound")), shown(it?.bound ?? 0)]]);
        });
    },
};

export const kBases: readonly Page[] = [r1, r2, r3, r4, r5, r6, r7];
