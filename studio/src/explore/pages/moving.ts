// R36: key frames, easing, motion along a curve.

import type { CurveJson, DocumentJson } from "../../kernel/module";
import { ff } from "../../kernel/module";
import { shown } from "../../ui/dom";
import { say, t } from "../../ui/language";
import { run } from "../../views/view";
import { curve, dots, polygon, steps } from "../draw";
import type { Page } from "../stage";

const document = (...objects: CurveJson[]): DocumentJson => ({ freiform: 1, objects });

const r36: Page = {
    row: "R36", title: t("Bewegung", "Animation"), gist: t("Bahnen, Geschwindigkeit, Easing", "ways, speed, easing"),
    text: t("Ein Körper läuft auf einer Kurve: mit gleichem Parameter, mit gleicher Geschwindigkeit, oder so, wie die Easing-Kurve unten es will. Ziehen Sie deren Griffe: waagrecht läuft die Zeit, senkrecht der Weg.",
        "A body runs along a curve: at equal parameters, at constant speed, or as the easing below has it. Drag its handles: time runs to the right, distance upwards."),
    formula: `"distance" = s · E("time" / T)`,
    build(stage) {
        const points = [[0, 0], [0.4, 3.4], [2.6, 3.6], [3, 0], [5.4, -0.6], [6.4, 2.8]], grips = [[0.42, 0], [0.58, 1]];
        const plane = stage.plane({ label: "way" }), graph = stage.graph(t("Easing", "easing"), 210);
        plane.fit(points);
        graph.fit([[0, -0.1], [1, 1.1]]);
        stage.hold(plane, points, (i) => `d${i}`);
        graph.handles.show(stage.handlesOf(grips, (i) => `E${i + 1}`, { shape: "diamond", colour: "aux" }).map((handle) => ({
            ...handle, move: (to: number[]) => { handle.move([Math.min(1, Math.max(0, to[0] ?? 0)), Math.min(1, Math.max(0, to[1] ?? 0))]); } })));
        const time = stage.player(t("Zeit", "Time"), { min: 0, max: 1, value: 0.3 }, 3);
        const way = (): CurveJson => ({ type: "curve", degree: 3, knots: [0, 0, 0, 0, 1, 2, 3, 3, 3, 3], points });
        stage.opens(() => document(way()));
        interface Eased { readonly values: { at: number; value: number; bound: number }[] }
        stage.update((make) => {
            plane.clear();
            graph.clear();
            const q = make(way());
            polygon(plane, points, { colour: "axis", width: 1 });
            curve(plane, q, { colour: "curve", width: 2.6 });
            const at = steps(0, 1, 60);
            const eased = (ff().run("ease", [], { bezier: grips.flat(), at: [...at, time.value] }).json as Eased).values;
            const now = eased[eased.length - 1]?.value ?? 0;
            graph.line(run([[0, 0], grips[0] ?? []]), { colour: "aux", width: 1.2 });
            graph.line(run([[1, 1], grips[1] ?? []]), { colour: "aux", width: 1.2 });
            graph.line(run(eased.slice(0, -1).map((e) => [e.at, e.value])), { colour: "hot", width: 2.4 });
            dots(graph, [[time.value, now]], "hot", 11);
            interface Length { readonly objects: { value: number; at: { point: number[]; parameter: number }[] }[] }
            const total = (ff().run("length", way(), {}).json as Length).objects[0]?.value ?? 0;
            const places = (ff().run("length", way(), { at: [total * time.value, total * Math.min(1, Math.max(0, now))] }).json as Length).objects[0]?.at ?? [];
            const [lo, hi] = q.domain[0] ?? [0, 1];
            dots(plane, [Array.from(q.evaluate([lo + (hi - lo) * time.value]))], "control", 13);
            dots(plane, [places[0]?.point ?? []], "aux", 13);
            const jet = q.evaluate([places[1]?.parameter ?? lo], { derivatives: 1 });
            const [x = 0, y = 0, dx = 1, dy = 0] = jet, size = 0.22 / (Math.hypot(dx, dy) || 1), [a, b] = [dx * size, dy * size];
            plane.line(run([[x + a, y + b], [x - a - b, y - b + a], [x - a / 2, y - b / 2], [x - a + b, y - b - a], [x + a, y + b]]), { colour: "hot", fill: "hot", width: 1.5 });
            stage.say([[say(t("Länge", "length")), shown(total, 8)], ["E(t)", shown(now, 8)], [say(t("Schranke", "bound")), shown(eased[eased.length - 1]?.bound ?? 0)]]);
        });
        stage.hint(t("Orange: gleicher Parameter. Grün: gleiche Geschwindigkeit. Pfeil: Easing.", "Orange: equal parameters. Green: constant speed. Arrow: easing."));
    },
};

export const kMoving: readonly Page[] = [r36];
