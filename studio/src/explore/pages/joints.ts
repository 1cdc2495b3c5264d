// R8 to R10 and R13: pieces that meet.

import type { CurveJson, DocumentJson } from "../../kernel/module";
import { ff } from "../../kernel/module";
import { h, shown } from "../../ui/dom";
import { say, t } from "../../ui/language";
import { run } from "../../views/view";
import { comb, curve, dots, labels, polygon, shade, subscript } from "../draw";
import type { Page, Stage } from "../stage";

const P = (i: number): string => `P${i + 1}`;
const document = (objects: CurveJson[]): DocumentJson => ({ freiform: 1, objects });

interface Jump { readonly order: number; readonly size: number; readonly unit: string }
interface Joint {
    readonly c_order: number; readonly g_order: number; readonly c_jumps: Jump[]; readonly g_jumps: Jump[];
    readonly before: Side; readonly after: Side; readonly distance: number; readonly knot?: number;
}
interface Side { readonly tangent: number[]; readonly curvature?: { value: number } }

/** unit/t^2 with the figure set high. */
export const raised = (unit: string): string => unit.replace(/\^(\d)/g, (_, n: string) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[Number(n)] ?? "");

/** Which of C0..C3 and G0..G3 hold, and by how much the first fails. */
function report(stage: Stage, joint: Joint | undefined): void {
    if (!joint) { stage.say(say(t("Die Stücke berühren sich nicht.", "The pieces do not meet."))); return; }
    const mark = (name: string, order: number, reached: number): HTMLElement =>
        h("span", { class: order <= reached ? "yes" : "no" }, `${order <= reached ? "✓" : "✗"}\u00a0${name}${order} `);
    const line = (name: string, reached: number): HTMLElement => h("span", {}, ...[0, 1, 2, 3].map((k) => mark(name, k, reached)));
    const first = (jumps: Jump[], reached: number): string => {
        const jump = jumps.find((j) => j.order > reached);
        return jump ? `${shown(jump.size)} ${raised(jump.unit)}` : "–";
    };
    stage.say([["C", line("C", joint.c_order)], ["G", line("G", joint.g_order)],
        [say(t("erster Sprung C", "first jump of C")), first(joint.c_jumps, joint.c_order)],
        [say(t("erster Sprung G", "first jump of G")), first(joint.g_jumps, joint.g_order)],
        ["κ", `${shown(joint.before.curvature?.value ?? NaN)} | ${shown(joint.after.curvature?.value ?? NaN)}`]]);
}

function joints(document: DocumentJson, tolerance: number): Joint[] {
    const reply = ff().run("continuity", document, { tolerance, gap: 0.02 }).json as { joints: Joint[]; objects: { knots: Joint[] }[] };
    return [...reply.joints, ...reply.objects.flatMap((o) => o.knots)];
}

const r8: Page = {
    row: "R8", title: t("Anschlüsse", "Joints"), gist: t("C⁰, G¹, C¹, C² von zwei Stücken", "C⁰, G¹, C¹, C² of two pieces"),
    text: t("Wo zwei Bézier-Stücke sich treffen, legen die letzten Punkte des einen die ersten des anderen fest. Wählen Sie eine Bedingung, und ziehen Sie am gemeinsamen Spline: bei „frei“ sind alle sieben Punkte unabhängig, und die Anzeige sagt, was gilt.",
        "Where two Bézier pieces meet, the last points of one determine the first ones of the other. Choose a condition and drag the common spline: with “free” all seven points are independent, and the readout says what holds."),
    formula: `G^1: P_3 - P_4 = k (P_4 - P_5)
              C^1: P_5 = 2P_4 - P_3
              C^2: P_6 = P_2 + 4 (P_4 - P_3)`,
    build(stage) {
        const free = [[0, 0], [0.6, 1.8], [2, 2.4], [3, 1.6], [4, 0.8], [5.2, 0.6], [6, 2]];
        const spline: Record<string, number[][]> = {
            c1: [[0, 0], [0.6, 1.8], [2, 2.4], [4, 0.8], [5.2, 0.6], [6, 2]], c2: [[0, 0], [0.6, 1.8], [3, 3], [5.2, 0.2], [6, 2]] };
        const plane = stage.plane({ label: "joint" });
        plane.fit([...free, [3, 3]]);
        const hold = (): void => {
            const points = rule.value === "free" ? free : spline[rule.value] ?? [];
            stage.hold(plane, points, rule.value === "free" ? P : (i) => `d${i}`);
        };
        const rule = stage.choice(t("Bedingung", "Condition"), { free: t("frei", "free"), c1: t("C¹", "C¹"), c2: t("C²", "C²") }, "free", () => { hold(); });
        stage.button(t("G¹ herstellen (frei)", "Make it G¹ (free)"), () => {
            // The leg keeps its length and takes the direction of the tangent that the first piece ends with.
            const q = ff().shape({ type: "curve", points: free.slice(0, 4) });
            const end = q.evaluate([1], { derivatives: 1 });
            q.free();
            const [x3 = 0, y3 = 0] = free[3] ?? [], [x4 = 0, y4 = 0] = free[4] ?? [];
            const size = Math.hypot(x4 - x3, y4 - y3) / Math.hypot(end[2] ?? 0, end[3] ?? 1);
            free[4]?.splice(0, 2, x3 + (end[2] ?? 0) * size, y3 + (end[3] ?? 0) * size);
            plane.handles.place();
        });
        hold();
        const pieces = (): CurveJson[] => {
            if (rule.value === "free") return [{ type: "curve", points: free.slice(0, 4) }, { type: "curve", points: free.slice(3) }];
            const knots = rule.value === "c1" ? [0, 0, 0, 0, 1, 1, 2, 2, 2, 2] : [0, 0, 0, 0, 1, 2, 2, 2, 2];
            const made = ff().run("convert", { type: "curve", degree: 3, knots, points: spline[rule.value] ?? [] }, { toBezier: true }).json as DocumentJson;
            return made.objects as CurveJson[];
        };
        stage.opens(() => document(pieces()));
        stage.update((make) => {
            plane.clear();
            const all = pieces();
            all.forEach((piece, i) => {
                polygon(plane, piece.points, { colour: i ? "aux" : "control", width: 1.3 });
                curve(plane, make(piece), { colour: i ? "violet" : "curve", width: 3 });
            });
            const points = [...(all[0]?.points ?? []), ...(all[1]?.points.slice(1) ?? [])];
            if (rule.value !== "free") dots(plane, points, "ink-soft", 6);
            labels(plane, points, "P", 1);
            report(stage, joints(document(all), 1e-6)[0]);
        });
    },
};

const r9: Page = {
    row: "R9", title: t("Geometrische Stetigkeit", "Geometric continuity"), gist: t("Krümmungskamm und Knoten", "curvature comb and knots"),
    text: t("Nadeln so lang wie die Krümmung zeigen, was das Auge nicht sieht: eine Krümmung, die springt, obwohl die Tangente stetig ist. Ein Knoten der Vielfachheit m lässt im Grad d genau d − m stetige Ableitungen. Stellen Sie die Vielfachheit ein und lesen Sie, was gilt.",
        "Needles as long as the curvature show what the eye does not: curvature that jumps although the tangent is continuous. A knot of multiplicity m leaves d − m continuous derivatives at degree d. Set the multiplicity and read what holds."),
    formula: `κ = frac{‖Q′ × Q″‖}{‖Q′‖^3}`,
    build(stage) {
        const all = [[0, 0], [0.4, 1.9], [1.8, 2.7], [3.4, 1.2], [4.6, 0.2], [5.6, 0.8], [6.2, 2.2]];
        const plane = stage.plane({ label: "comb" });
        plane.fit([...all, [3, 4], [3, -1]]);
        const m = stage.slider(t("Vielfachheit m des Knotens", "Multiplicity m of the knot"), { min: 1, max: 3, step: 1, value: 2 });
        const made = (): CurveJson => {
            const knots = [0, 0, 0, 0, ...new Array<number>(m.value).fill(0.5), 1, 1, 1, 1];
            return { type: "curve", degree: 3, knots, points: all.slice(0, 4 + m.value) };
        };
        let held = 0;
        stage.opens(() => document([made()]));
        stage.update((make) => {
            const json = made();
            if (held !== json.points.length) { held = json.points.length; stage.hold(plane, json.points, (i) => `d${i}`); }
            plane.clear();
            polygon(plane, json.points);
            curve(plane, make(json), { colour: "curve", width: 3 });
            comb(plane, make(json), 0.8);
            report(stage, joints(document([json]), 1e-9)[0]);
        });
    },
};

const interpolations = {
    "catmull-rom": t("C¹ (Catmull-Rom)", "C¹ (Catmull-Rom)"), natural: t("C² natürlich", "C² natural"), "not-a-knot": t("C² not-a-knot", "C² not-a-knot"),
    periodic: t("C² periodisch", "C² periodic"), akima: t("Akima", "Akima"),
} as const;

const r10: Page = {
    row: "R10", title: t("Interpolation", "Interpolation"), gist: t("C¹ durch Punkte, lokal", "C¹ through points, local"),
    text: t("Jeder Punkt wird zum Anschluss zweier kubischer Bézier-Stücke, mit einer Tangente parallel zur Sehne seiner Nachbarn. Alles ist lokal: ein Punkt, der sich bewegt, ändert vier Stücke. C²-Splines ändern sich überall, aber schwach.",
        "Each point becomes the joint of two cubic Bézier pieces, with a tangent parallel to the chord of its neighbours. All is local: a point that moves changes four pieces. C² splines change everywhere, but faintly."),
    formula: `P_{3i-1} = Q_i + frac{Q_{i+1} - Q_{i-1}}{6}`,
    build(stage) {
        const points = [[0, 0], [1, 1.6], [2.4, 1.8], [3.2, 0.2], [4.6, 0], [5.6, 1.6], [7, 1]];
        const plane = stage.plane({ label: "interpolation" });
        plane.fit(points);
        stage.hold(plane, points, (i) => `Q${i + 1}`);
        const ends = stage.choice(t("Art", "Way"), interpolations, "catmull-rom");
        const bezier = stage.toggle(t("Bézier-Punkte", "Bézier points"), true);
        const made = (): DocumentJson => {
            const sent = ends.value === "periodic" ? [...points, points[0] ?? []] : points;
            const json = ff().run("interpolate", JSON.stringify(sent) + "\n", { ends: ends.value }).json as DocumentJson | CurveJson;
            return "objects" in json ? json : document([json]);
        };
        stage.opens(made);
        stage.update((make) => {
            plane.clear();
            for (const object of made().objects) {
                curve(plane, make(object), { colour: "curve", width: 3 });
                if (!bezier.value) continue;
                const pieces = ff().run("convert", object, { toBezier: true }).json as DocumentJson;
                for (const piece of pieces.objects as CurveJson[]) {
                    polygon(plane, piece.points, { colour: "ink-soft", width: 1 });
                    dots(plane, piece.points.slice(1, 3), "ink-soft", 5);
                }
            }
            labels(plane, points, "Q", 1);
        });
    },
};

const r13: Page = {
    row: "R13", title: t("A-Rahmen", "A-frames"), gist: t("de-Boor-Punkte und Bézier-Punkte", "de Boor points and Bézier points"),
    text: t("An einem C²-Anschluss treffen sich die verlängerten Schenkel beider Polygone in einem Punkt: so entsteht ein A. Diese Punkte sind die de-Boor-Punkte des Splines und führen zu allen Bézier-Punkten zurück. Ziehen Sie einen Knoten.",
        "At a joint with two continuous derivatives the prolonged legs of both polygons meet in one point, forming an A. These points are the de Boor points of the spline and lead back to all Bézier points. Drag a knot."),
    formula: `b_{n-1} + (b_{n-1} - b_{n-2})
              = c_1 + (c_1 - c_2)`,
    build(stage) {
        const points = [[0, 0], [0.5, 2.4], [2.4, 3], [4, 0.2], [5.8, 0], [6.6, 2.4]], knots = [[1, 0], [2, 0]];
        const plane = stage.plane({ label: "A-frames" });
        const strip = stage.plane({ label: "knots", graph: true, movable: false, grid: false, height: 74 });
        plane.fit(points);
        strip.fit([[0, 0], [3, 0.01]]);
        stage.hold(plane, points, (i) => `d${i}`);
        strip.handles.show(knots.map((knot, i) => ({ label: `${say(t("Knoten", "knot"))} ${i + 1}`, at: () => knot, shape: "diamond" as const, colour: "aux",
            move: (to: number[]) => {
                knot[0] = Math.min((knots[i + 1]?.[0] ?? 3) - 0.05, Math.max((knots[i - 1]?.[0] ?? 0) + 0.05, to[0] ?? 0));
                stage.changed();
            } })));
        const made = (): CurveJson => ({ type: "curve", degree: 3, knots: [0, 0, 0, 0, ...knots.map((k) => k[0] ?? 0), 3, 3, 3, 3], points });
        stage.opens(() => document([made()]));
        stage.update((make) => {
            plane.clear();
            strip.clear();
            strip.line(run([[0, 0], [3, 0]]), { colour: "axis" });
            polygon(plane, points);
            curve(plane, make(made()), { colour: "curve", width: 3 });
            const pieces = (ff().run("convert", made(), { toBezier: true }).json as DocumentJson).objects as CurveJson[];
            pieces.forEach((piece, i) => {
                polygon(plane, piece.points, { colour: shade(i + 2), width: 1.5 });
                dots(plane, piece.points, shade(i + 2), 7);
                piece.points.forEach((p, k) => { if (k > 0 && k < 3) plane.label(p, `${"bce"[i] ?? "b"}${subscript(k)}`, shade(i + 2)); });
            });
            labels(plane, points, "d");
        });
    },
};

export const kJoints: readonly Page[] = [r8, r9, r10, r13];
