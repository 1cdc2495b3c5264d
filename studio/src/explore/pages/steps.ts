// R17 to R20: what control points tell, drawing by equal steps and by halving, arc length.

import type { CurveJson, DocumentJson } from "../../kernel/module";
import { ff } from "../../kernel/module";
import { shown } from "../../ui/dom";
import { say, t } from "../../ui/language";
import { run } from "../../views/view";
import { curve, dots, labels, polygon, steps } from "../draw";
import type { Page } from "../stage";

const b = (i: number): string => `b${i}`;
const document = (...objects: CurveJson[]): DocumentJson => ({ freiform: 1, objects });
const kWave = (): number[][] => [[0, 0], [0.4, 3], [2.6, -1.6], [4.6, 3.4], [6.4, 2.6], [7, 0]];

interface Crossing { readonly point: number[]; readonly kind: string }

const r17: Page = {
    row: "R17", title: t("Was Kontrollpunkte verraten", "What control points tell"), gist: t("Schnitte mit einer Geraden, Kästen", "crossings with a line, boxes"),
    text: t("Keine Gerade schneidet die Kurve öfter als ihr Polygon: die Variation wird vermindert. Bewegen Sie die Gerade und zählen Sie. Der Kasten umschließt die Kurve, und jede Seite liegt so nah an ihr, wie die Schranke sagt.",
        "No line crosses the curve more often than its polygon: variation is diminished. Move the line and count. The box encloses the curve, and every side is as near to it as the bound says."),
    build(stage) {
        const points = kWave(), line = [[-0.4, 0.6], [7.4, 1.4]];
        const plane = stage.plane({ label: "properties" });
        plane.fit(points);
        plane.handles.show([...stage.handlesOf(points, b), ...stage.handlesOf(line, (i) => `${say(t("Gerade", "line"))} ${i + 1}`, { shape: "diamond", colour: "aux" })]);
        const box = stage.toggle(t("Engster Kasten", "Tightest box"), true);
        stage.opens(() => document({ type: "curve", points }));
        stage.update((make) => {
            plane.clear();
            const q: CurveJson = { type: "curve", points };
            polygon(plane, points);
            curve(plane, make(q), { colour: "curve", width: 3 });
            labels(plane, points, "b");
            const [[x0 = 0, y0 = 0] = [], [x1 = 1, y1 = 0] = []] = line;
            plane.line(run(line), { colour: "aux", width: 2 });
            const equation = [y0 - y1, x1 - x0, x0 * y1 - x1 * y0];
            const crossings = (of: CurveJson): Crossing[] =>
                (ff().run("features", of, { line: equation }).json as { objects: { crossings: Crossing[] }[] }).objects[0]?.crossings ?? [];
            const ofCurve = crossings(q);
            const ofPolygon = crossings({ type: "curve", degree: 1, knots: [0, ...steps(0, 1, points.length - 1), 1], points });
            dots(plane, ofPolygon.map((c) => c.point), "control", 8);
            dots(plane, ofCurve.map((c) => c.point), "hot", 10);
            const bounds = ff().run("bounds", q).json as { box: { min: number[]; max: number[] }; bound: number };
            const [u0 = 0, v0 = 0] = bounds.box.min, [u1 = 1, v1 = 1] = bounds.box.max;
            if (box.value) plane.line(run([[u0, v0], [u1, v0], [u1, v1], [u0, v1], [u0, v0]]), { colour: "violet", width: 1.3, dashed: true });
            stage.say([[say(t("Schnitte mit dem Polygon", "crossings of the polygon")), String(ofPolygon.length)],
                [say(t("Schnitte mit der Kurve", "crossings of the curve")), String(ofCurve.length)],
                [say(t("Kasten", "box")), `[${shown(u0)}, ${shown(u1)}] × [${shown(v0)}, ${shown(v1)}]`], [say(t("Schranke", "bound")), shown(bounds.bound)]]);
        });
    },
};

interface Flattened { readonly objects: { points: number[][]; segments: number; error_bound: number }[] }

const r18: Page = {
    row: "R18", title: t("Zeichnen mit gleichen Schritten", "Drawing with equal steps"), gist: t("Horner und Vorwärtsdifferenzen", "Horner and forward differences"),
    text: t("Mit gleichen Schritten im Parameter kostet eine Kubik drei Additionen je Koordinate, weil dritte Differenzen konstant sind. Die Rundungen summieren sich, bleiben aber unter einer Schranke, die man vorher kennt.",
        "At equal steps of the parameter a cubic costs three additions per coordinate, because third differences are constant. Roundings add up, but stay below a bound that is known beforehand."),
    formula: `Δ^3 Q = 6 a δ^3 "  constant"`,
    build(stage) {
        const points = [[0, 0], [0.6, 3.4], [5.4, 3.6], [4, -0.4]];
        const plane = stage.plane({ label: "steps" });
        plane.fit([...points, [2, 3]]);
        stage.hold(plane, points, b);
        const n = stage.slider(t("Strecken", "Segments"), { min: 1, max: 64, step: 1, value: 8 });
        const method = stage.choice(t("Verfahren", "Method"), { uniform: t("Horner", "Horner"), forward: t("Vorwärtsdifferenzen", "Forward differences") }, "forward");
        stage.opens(() => document({ type: "curve", points }));
        stage.update((make) => {
            plane.clear();
            const q: CurveJson = { type: "curve", points };
            polygon(plane, points, { colour: "axis", width: 1.2 });
            curve(plane, make(q), { colour: "curve", width: 4, opacity: 0.35 });
            const flat = (ff().run("flatten", q, { segments: n.value, method: method.value }).json as Flattened).objects[0];
            polygon(plane, flat?.points ?? [], { colour: "hot", width: 2 });
            dots(plane, flat?.points ?? [], "hot", 6);
            stage.say([[say(t("Strecken", "segments")), String(flat?.segments ?? 0)], [say(t("Schranke des Abstands", "bound of the distance")), shown(flat?.error_bound ?? 0)]]);
        });
    },
};

interface Compared { readonly objects: { methods: { method: string; segments: number; measured: number; error_bound: number }[] }[] }

const r19: Page = {
    row: "R19", title: t("Zeichnen durch Halbieren", "Drawing by halving"), gist: t("Verfahren bei gleichem Aufwand", "methods at equal effort"),
    text: t("Halbieren, bis ein Stück flach ist, setzt die Punkte dorthin, wo die Kurve sich biegt; gleiche Schritte setzen sie überallhin. Die Tabelle sagt für die gleiche Zahl von Strecken, was jedes Verfahren wert ist: gemessen und bewiesen.",
        "Halving until a piece is flat puts the points where the curve bends; equal steps put them everywhere. For the same number of segments the table says what each is worth: measured and proven."),
    build(stage) {
        const points = kWave();
        const plane = stage.plane({ label: "halving" });
        plane.fit(points);
        stage.hold(plane, points, b);
        const n = stage.slider(t("Strecken", "Segments"), { min: 2, max: 64, step: 1, value: 12 });
        const method = stage.choice(t("Gezeichnet wird", "Drawn"), { halving: t("Halbieren", "Halving"), uniform: t("Gleiche Schritte", "Equal steps"), adaptive: t("So wenige wie möglich", "As few as possible") }, "halving");
        const polygons = stage.toggle(t("Kontrollpolygone der letzten Stufe", "Control polygons of the last level"), false);
        stage.opens(() => document({ type: "curve", points }));
        stage.update((make) => {
            plane.clear();
            const q: CurveJson = { type: "curve", points };
            curve(plane, make(q), { colour: "curve", width: 4, opacity: 0.35 });
            const flat = (ff().run("flatten", q, { segments: n.value, method: method.value, polygons: polygons.value && method.value === "halving" }).json as Flattened).objects[0];
            polygon(plane, flat?.points ?? [], { colour: "hot", width: 2 });
            dots(plane, flat?.points ?? [], "hot", 6);
            const table = (ff().run("flatten", q, { compare: n.value }).json as Compared).objects[0]?.methods ?? [];
            stage.say(table.map((m): [string, string] => [`${m.method} (${m.segments})`, `${shown(m.measured, 3)}\u00a0≤\u00a0${shown(m.error_bound, 3)}`]));
        });
    },
};

const r20: Page = {
    row: "R20", title: t("Bogenlänge", "Arc length"), gist: t("gleiche Abstände auf der Kurve", "equal distances along the curve"),
    text: t("Gleiche Schritte im Parameter sind keine gleichen Wege: der Punkt läuft schneller und langsamer. Die Umkehrung der Bogenlänge setzt Punkte in gleichen Abständen. Beide Läufer brauchen gleich lang.",
        "Equal steps of the parameter are not equal distances: the point runs faster and slower. The inverse of the arc length puts points at equal distances. Both runners take the same time."),
    formula: `s(t) = int_0^t ‖c′(τ)‖ d τ`,
    build(stage) {
        const points = [[0, 0], [0.2, 3.6], [0.8, 4.4], [6.4, 3.2], [7, 0]];
        const plane = stage.plane({ label: "arc length" });
        plane.fit(points);
        stage.hold(plane, points, b);
        const n = stage.slider(t("Teile", "Parts"), { min: 2, max: 40, step: 1, value: 12 });
        const time = stage.player(t("Zeit", "Time"), { min: 0, max: 1, value: 0.35 });
        stage.opens(() => document({ type: "curve", points }));
        stage.update((make) => {
            plane.clear();
            const q = make({ type: "curve", points });
            polygon(plane, points, { colour: "axis", width: 1.2 });
            curve(plane, q, { colour: "curve", width: 3 });
            interface Length { readonly objects: { value: number; bound: number; at: { parameter: number; point: number[] }[] }[] }
            const at = (options: object): Length["objects"][0] | undefined =>
                (ff().run("length", { type: "curve", points }, { ...options }).json as Length).objects[0];
            const equal = at({ equal: n.value });
            const even = q.evaluate(steps(0, 1, n.value));
            dots(plane, Array.from({ length: n.value + 1 }, (_, i) => [even[2 * i] ?? 0, even[2 * i + 1] ?? 0]), "control", 7);
            dots(plane, (equal?.at ?? []).map((p) => p.point), "aux", 9);
            const total = equal?.value ?? 0;
            const run2 = at({ at: total * time.value });
            dots(plane, [Array.from(q.evaluate([time.value]))], "control", 15);
            dots(plane, [run2?.at[0]?.point ?? []], "aux", 15);
            stage.say([[say(t("Länge", "length")), shown(total, 12)], [say(t("Schranke", "bound")), shown(equal?.bound ?? 0)],
                [say(t("Parameter bei gleicher Zeit", "parameter at the same time")), `${shown(time.value)} | ${shown(run2?.at[0]?.parameter ?? 0)}`]]);
        });
        stage.hint(t("Orange: gleiche Parameter. Grün: gleiche Wege.", "Orange: equal parameters. Green: equal distances."));
    },
};

export const kSteps: readonly Page[] = [r17, r18, r19, r20];
