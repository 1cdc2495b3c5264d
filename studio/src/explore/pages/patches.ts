// R25 to R27, R29, R30: revolution, Quake patches, trimming, triangles, what the graphics processor draws.

import type { CurveJson, DocumentJson, ObjectJson, SurfaceJson } from "../../kernel/module";
import { ff, file } from "../../kernel/module";
import { h, shown } from "../../ui/dom";
import { say, t } from "../../ui/language";
import type { Space } from "../../views/space";
import { run } from "../../views/view";
import { curve, dots, isoline, lattice, net, polygon, shade, surface } from "../draw";
import type { Page } from "../stage";
import type { Mesh, Shape } from "freiform";

const document = (...objects: ObjectJson[]): DocumentJson => ({ freiform: 1, objects });

/** A mesh of the module in a space view. */
export function triangles(space: Space, mesh: Mesh, style: Parameters<Space["surface"]>[1] = {}): void {
    space.surface({ points: mesh.positions, normals: mesh.normals, indices: mesh.indices, origin: mesh.origin }, style);
}

const r25: Page = {
    row: "R25", title: t("Drehflächen", "Surfaces of revolution"), gist: t("ein Profil, eine Achse", "a profile, an axis"),
    text: t("Eine Kurve dreht sich um eine Achse: exakt als rationale Fläche, oder als Polynom mit einer Schranke, die dabei steht. Ziehen Sie am Profil links.",
        "A curve turns about an axis: exactly as a rational surface, or as a polynomial with a bound that is stated. Drag the profile on the left."),
    build(stage) {
        const points = [[0.3, 0], [1.5, 0.2], [1.6, 1.4], [0.3, 1.8], [0.5, 2.6], [1, 3]];
        stage.beside();
        const plane = stage.plane({ label: "profile" }), space = stage.space(t("Drehfläche", "surface of revolution"));
        stage.beside();
        plane.fit([[0, 0], [2, 3]]);
        space.fit([[-1.6, -1.6, 0], [1.6, 1.6, 3]]);
        stage.hold(plane, points, (i) => `d${i}`);
        const angle = stage.slider(t("Winkel", "Angle"), { min: 10, max: 360, step: 1, value: 290 });
        const exact = stage.choice(t("Art", "Way"), { exact: t("Exakt (rational)", "Exact (rational)"), polynomial: t("Polynom", "Polynomial") }, "exact");
        const tolerance = stage.slider(t("Toleranz 10^−k", "Tolerance 10^−k"), { min: 1, max: 6, step: 1, value: 2 });
        const profile = (): CurveJson => ({ type: "curve", degree: 3, knots: [0, 0, 0, 0, 1, 2, 3, 3, 3, 3], points: points.map(([x = 0, y = 0]) => [x, 0, y]) });
        let bound = "0";
        const made = (): DocumentJson => {
            const reply = ff().run("revolve", profile(), { axis: [0, 0, 0, 0, 0, 1], angle: angle.value,
                ...(exact.value === "polynomial" ? { polynomial: 10 ** -tolerance.value } : {}) });
            bound = reply.remarks.join(" ");
            return reply.json as DocumentJson;
        };
        stage.opens(made);
        stage.update((make) => {
            plane.clear();
            space.clear();
            polygon(plane, points);
            plane.line(run([[0, -0.4], [0, 3.4]]), { colour: "aux", width: 2, dashed: true });
            curve(plane, make({ ...profile(), points }), { colour: "curve", width: 3 });
            for (const object of made().objects) {
                const s = make(object), all = net(s), columns = s.size[1] ?? 1;
                surface(space, s, {}, 60);
                lattice(space, Array.from({ length: s.size[0] ?? 0 }, (_, i) => all.slice(i * columns, (i + 1) * columns)), { colour: "control", width: 0.9, opacity: 0.6 });
                stage.say([[say(t("Grade", "degrees")), s.degrees.join(" × ")], [say(t("Kontrollpunkte", "control points")), s.size.join(" × ")],
                    [say(t("rational", "rational")), say(s.rational ? t("ja", "yes") : t("nein", "no"))], [say(t("Meldung", "remark")), bound || "–"]]);
            }
        });
    },
};

const r26: Page = {
    row: "R26", title: t("Quake-Flächen", "Quake patches"), gist: t("biquadratische 3 × 3-Stücke", "biquadratic 3 × 3 pieces"),
    text: t("Quake III baut runde Wände aus biquadratischen Bézier-Stücken: ein ungerades Gitter von Punkten, je 3 × 3 ein Stück. Der Text rechts ist der Eintrag einer .map-Datei; das Modul liest ihn und macht die Fläche daraus.",
        "Quake III builds round walls from biquadratic Bézier patches: an odd grid of points, each 3 × 3 a piece. The text is the entry of a .map file; the module reads it and makes the surface from it."),
    build(stage) {
        const points = [0, 1, 2, 3, 4].map((i) => [0, 1, 2].map((j) => [i * 64, j * 64, [0, 96, 0, -64, 32][i] ?? 0]));
        const space = stage.space(t("Flächenstücke", "patches"));
        space.fit(points.flat());
        space.handles.show(points.flatMap((row, i) => stage.handlesOf(row, (j) => `b${i}${j}`)));
        const text = h("pre", { class: "hint", style: "overflow:auto;max-height:150px;margin:0", tabindex: 0, "aria-label": ".map" });
        stage.add(text);
        const map = (): string => `{\n"classname" "worldspawn"\n{\npatchDef2\n{\nbase_wall/concrete\n( ${points.length} 3 0 0 0 )\n(\n${points.map((row, i) =>
            `( ${row.map((p, j) => `( ${p.map((x) => Number(x.toPrecision(6))).join(" ")} ${i / 4} ${j / 2} )`).join(" ")} )`).join("\n")}\n)\n}\n}\n}\n`;
        stage.opens(() => ff().run("convert", file("patch.map", map()), { to: "json" }).json as DocumentJson);
        stage.update(() => {
            space.clear();
            text.textContent = map();
            const shapes = ff().document(file("patch.map", map())).shapes;
            // Every second row of points is on the surface, where pieces meet.
            const pieces = shapes.reduce((n, s) => n + ((s.size[0] ?? 1) - 1) * ((s.size[1] ?? 1) - 1) / 4, 0);
            try {
                shapes.forEach((s) => { surface(space, s, {}, 30); });
                for (const s of shapes) for (const axis of [0, 1] as const) for (const k of new Set(s.knots[axis])) isoline(space, s, axis, k, { colour: "curve", width: 1.5 });
            } finally { shapes.forEach((s) => { s.free(); }); }
            lattice(space, points);
            stage.say([[say(t("Stücke", "pieces")), String(pieces)]]);
        });
    },
};

const kCircle = (x: number, y: number, r: number): CurveJson[] => {
    const c = Math.SQRT1_2, at = (i: number, j: number): number[] => [x + i * r, y + j * r];
    return [{ degree: 2, knots: [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4],
        points: [at(1, 0), at(1, 1), at(0, 1), at(-1, 1), at(-1, 0), at(-1, -1), at(0, -1), at(1, -1), at(1, 0)], weights: [1, c, 1, c, 1, c, 1, c, 1] }];
};

const r27: Page = {
    row: "R27", title: t("Beschneiden", "Trimming"), gist: t("Schleifen und der Strahl", "loops and the ray"),
    text: t("Schleifen in der Parameterebene schneiden die Fläche zu. Innen ist, von wo ein Strahl die Schleifen ungerade oft trifft; Ecken und Kanten auf dem Strahl zählen richtig, auch bei krummen Schleifen. Ziehen Sie den grünen Punkt und die Schleifen.",
        "Loops in the parameter plane trim the surface. Inside is where a ray meets the loops an odd number of times; corners and edges on the ray are counted right, for curved loops as well. Drag the green point and the loops."),
    build(stage) {
        const outer = [[0.08, 0.1], [0.9, 0.06], [0.94, 0.6], [0.5, 0.96], [0.06, 0.8]], hole = [[0.55, 0.45], [0.75, 0.45]], probe = [[0.3, 0.45]];
        const points = [[0, 0.6, 0.2, 0.8], [0.6, 1.8, -0.3, 0.2], [-0.2, 0.8, 1.6, 0.6], [0.4, -0.2, 0.6, 1]].map((row, i) => row.map((z, j) => [i, j, z]));
        stage.beside();
        const plane = stage.plane({ label: "parameters" }), space = stage.space(t("beschnittene Fläche", "trimmed surface"));
        stage.beside();
        plane.fit([[0, 0], [1, 1]]);
        space.fit(points.flat());
        const clamp = (p: number[]): number[] => p.map((x) => Math.min(0.999, Math.max(0.001, x)));
        plane.handles.show([...stage.handlesOf(outer, (i) => `P${i + 1}`), ...stage.handlesOf(hole, (i) => say(i ? t("Rand des Lochs", "rim of the hole") : t("Mitte des Lochs", "centre of the hole")), { colour: "violet" }),
            ...stage.handlesOf(probe, () => say(t("Prüfpunkt", "probe")), { shape: "diamond", colour: "aux" })].map((handle, i) => (i === outer.length ? {
                ...handle, move: (to: number[]) => {
                    const [cx = 0, cy = 0] = hole[0] ?? [], [rx = 0, ry = 0] = hole[1] ?? [];
                    hole[0]?.splice(0, 2, to[0] ?? 0, to[1] ?? 0);
                    hole[1]?.splice(0, 2, rx + (to[0] ?? 0) - cx, ry + (to[1] ?? 0) - cy);
                    stage.changed();
                } } : { ...handle, move: (to: number[]) => { handle.move(clamp(to)); } })));
        const round = stage.toggle(t("Runde äußere Schleife", "Round outer loop"), false);
        const loops = (): CurveJson[][] => {
            const n = outer.length, radius = Math.hypot((hole[1]?.[0] ?? 0) - (hole[0]?.[0] ?? 0), (hole[1]?.[1] ?? 0) - (hole[0]?.[1] ?? 0));
            const ring: CurveJson[] = round.value
                ? [{ degree: 2, closed: true, points: outer, knots: Array.from({ length: n + 1 }, (_, i) => i) }]
                : outer.map((p, i) => ({ points: [p, outer[(i + 1) % n] ?? p] }));
            return [ring, kCircle(hole[0]?.[0] ?? 0, hole[0]?.[1] ?? 0, Math.max(0.01, radius))];
        };
        const made = (): ObjectJson => ({ type: "trimmed", surface: { degrees: [3, 3], points } as unknown as SurfaceJson, loops: loops() });
        stage.opens(() => document(made()));
        stage.update((make) => {
            plane.clear();
            space.clear();
            const lines = loops().flat().map((c) => make({ type: "curve", ...c }));
            lines.forEach((line) => { curve(plane, line, { colour: "curve", width: 2.6 }); });
            plane.line(run([[0, 0], [1, 0], [1, 1], [0, 1], [0, 0]]), { colour: "axis", width: 1 });
            const at = probe[0] ?? [0, 0], ray: CurveJson = { type: "curve", points: [at, [1.2, at[1] ?? 0]] };
            plane.line(run(ray.points), { colour: "aux", width: 1.6, dashed: true });
            const meets = (ff().run("intersect", [ray, { freiform: 1, objects: loops().flat().map((c) => ({ type: "curve", ...c })) }]).json as { points: { point: number[]; kind: string }[] }).points
                .filter((m, i, all) => all.findIndex((o) => Math.hypot(...o.point.map((x, k) => x - (m.point[k] ?? 0))) < 1e-9) === i);
            dots(plane, meets.map((m) => m.point), "hot", 10);
            const trimmed = made();
            const place = (ff().run("inside", trimmed, { points: `${at.join(",")}\n` }).json as { results: { place: string; winding: number }[] }).results[0];
            stage.say([[say(t("Der Punkt liegt", "the point is")), place?.place ?? "?"], [say(t("Treffer des Strahls", "meetings with the ray")), `${meets.length} (${meets.map((m) => m.kind).join(", ")})`],
                [say(t("Umlaufzahl", "winding number")), String(place?.winding ?? "")]]);
            triangles(space, make(trimmed).mesh({ tolerance: 0.01 }));
            const whole = make({ type: "surface", points });
            dots(space, [Array.from(whole.evaluate(clamp(at)))], "aux", 12);
        });
    },
};

/** The net of a triangle: rows of b_ijk with one i. */
function rowsOf(points: readonly number[][], degree: number): number[][][] {
    const rows: number[][][] = [];
    for (let r = 0, k = 0; r <= degree; k += ++r) rows.push(points.slice(k, k + r + 1));
    return rows;
}

const r29: Page = {
    row: "R29", title: t("Dreieckige Bézier-Flächen", "Triangular Bézier patches"), gist: t("baryzentrische Koordinaten", "barycentric coordinates"),
    text: t("Ein Dreieck mit Punkten bᵢⱼₖ, i + j + k = n. Die Ränder sind Bézier-Kurven, die Ecken liegen auf der Fläche. Seine Koordinaten bewegen den Prüfpunkt.",
        "A triangle with points bᵢⱼₖ, i + j + k = n. The boundaries are Bézier curves, the corners lie on the surface. Move the point by its coordinates."),
    formula: `B_{ijk}^n(t_1, t_2, t_3) = frac{n!}{i! j! k!} t_1^i t_2^j t_3^k`,
    build(stage) {
        const points = [[0, 0, 0], [1, -0.2, 0.9], [0.2, 1, 0.7], [2, -0.2, 0.8], [1.1, 1, 2.2], [0.2, 2, 0.6], [3, 0, 0], [2, 1, 0.9], [1, 2, 1.2], [0, 3, 0.2]];
        const space = stage.space(t("Dreieck", "triangle"));
        space.fit(points);
        space.handles.show(stage.handlesOf(points, (i) => `b${i}`));
        const u = stage.slider(t("t₂", "t₂"), { min: 0, max: 1, value: 0.3 }), v = stage.slider(t("t₃", "t₃"), { min: 0, max: 1, value: 0.3 });
        const raised = stage.slider(t("Graderhöhung um", "Elevation by"), { min: 0, max: 4, step: 1, value: 0 });
        const cut = stage.toggle(t("In Dreiecke geteilt", "Subdivided"), false);
        const made = (): DocumentJson => {
            const one: ObjectJson = { type: "triangle", degree: 3, points };
            if (raised.value > 0) return ff().run("convert", one, { elevate: raised.value }).json as DocumentJson;
            return cut.value ? ff().run("convert", one, { split: 0.5, axis: "u" }).json as DocumentJson : document(one);
        };
        stage.opens(made);
        stage.update((make) => {
            space.clear();
            const whole = make({ type: "triangle", degree: 3, points });
            made().objects.forEach((object, i) => {
                const s: Shape = make(object);
                triangles(space, s.mesh({ tolerance: 0.004 }), { colour: made().objects.length > 1 ? shade(i) : "surface" });
                const rows = rowsOf(net(s), s.degrees[0] ?? 3);
                for (const row of rows) space.line(run(row), { colour: "control", width: 1.3 });
                rows.slice(0, -1).forEach((row, r) => { row.forEach((p, k) => {
                    space.line(run([p, rows[r + 1]?.[k] ?? p]), { colour: "control", width: 1.3 });
                    space.line(run([p, rows[r + 1]?.[k + 1] ?? p]), { colour: "control", width: 1.3 });
                }); });
                if (raised.value > 0) dots(space, net(s), "aux", 8);
            });
            const [a, b] = u.value + v.value > 1 ? [u.value / (u.value + v.value), v.value / (u.value + v.value)] : [u.value, v.value];
            const at = Array.from(whole.evaluate([a, b]));
            dots(space, [at], "hot", 14);
            stage.say([["t", `(${[1 - a - b, a, b].map((x) => shown(x, 3)).join(", ")})`], ["S(t)", `(${at.map((x) => shown(x, 6)).join(", ")})`]]);
        });
    },
};

const r30: Page = {
    row: "R30", title: t("Auf der Grafikkarte", "On the graphics processor"), gist: t("Dreiecke innerhalb einer Toleranz", "triangles within a tolerance"),
    text: t("Gezeichnet wird in Dreiecken. Die Toleranz ist ein Abstand: kein Punkt des Netzes liegt weiter von der Fläche weg als die Schranke sagt, und umgekehrt. Grobe Toleranzen machen die Ecken sichtbar, die Schranke bleibt wahr.",
        "Drawing is done in triangles. The tolerance is a distance: no point of the mesh is farther from the surface than the bound says, and the other way round. Coarse tolerances show the corners; the bound stays true."),
    build(stage) {
        const points = [[0, 0.6, 0.2, 0.8], [0.6, 2.4, -0.6, 0.2], [-0.2, 1, 2.6, 0.6], [0.4, -0.4, 0.8, 1.4]].map((row, i) => row.map((z, j) => [i, j, z]));
        const space = stage.space(t("Netz", "mesh"));
        space.fit(points.flat());
        space.handles.show(points.flatMap((row, i) => stage.handlesOf(row, (j) => `b${i}${j}`)));
        const k = stage.slider(t("Toleranz 10^−k", "Tolerance 10^−k"), { min: 0, max: 4, step: 0.1, value: 1.2 });
        const edges = stage.toggle(t("Dreiecke zeigen", "Show triangles"), true);
        const flat = stage.toggle(t("Ohne Glättung", "Without smoothing"), true);
        stage.opens(() => document({ type: "surface", points }));
        stage.update((make) => {
            space.clear();
            const mesh = make({ type: "surface", points }).mesh({ tolerance: 10 ** -k.value });
            triangles(space, mesh, { edges: edges.value, look: flat.value ? "flat" : "shaded" });
            stage.say([[say(t("Toleranz", "tolerance")), shown(10 ** -k.value)], [say(t("Schranke", "bound")), shown(mesh.errorBound)],
                [say(t("Dreiecke", "triangles")), String(mesh.indices.length / 3)], ["ms", shown(mesh.seconds * 1000, 3)]]);
        });
    },
};

export const kPatches: readonly Page[] = [r25, r26, r27, r29, r30];
