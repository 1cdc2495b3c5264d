// R32 to R35: illustration, fonts, modelling, colour.

import type { CurveJson, DocumentJson, ObjectJson } from "../../kernel/module";
import { ff } from "../../kernel/module";
import { download, h } from "../../ui/dom";
import { say, t } from "../../ui/language";
import type { Plane } from "../../views/plane";
import { box, run, type Style } from "../../views/view";
import { curve, dots, net, polygon, surface } from "../draw";
import glyph from "../glyph.json";
import type { Page } from "../stage";

const document = (...objects: ObjectJson[]): DocumentJson => ({ freiform: 1, objects });

/** The closed curves of a document as one filled area. */
function area(plane: Plane, of: DocumentJson, style: Style): void {
    const shapes = ff().document(of).shapes;
    try {
        const at: number[] = [];
        for (const shape of shapes) {
            const { lower, upper } = box(net(shape));
            const size = Math.max(1e-12, ...upper.map((x, i) => x - (lower[i] ?? 0)));
            for (const line of shape.polylines(size / 4000)) at.push(...line.points, NaN, NaN);
        }
        plane.line({ at, dimension: 2 }, style);
    } finally { shapes.forEach((shape) => { shape.free(); }); }
}

const kOperations = { union: t("Vereinigung", "Union"), intersection: t("Durchschnitt", "Intersection"), difference: t("Differenz", "Difference"), exclusion: t("Ausschluss", "Exclusion") };

const r32: Page = {
    row: "R32", title: t("Illustration", "Illustration"), gist: t("SVG-Pfade, gefüllt und gezogen", "SVG paths, filled and stroked"),
    text: t("Zwei Formen als SVG, so wie Inkscape sie schreibt. Das Modul liest die Pfade, vereinigt oder schneidet sie, und zieht auf Wunsch einen Strich als Fläche, innerhalb eines bewiesenen Abstands. Das Ergebnis ist wieder SVG.",
        "Two shapes as SVG, as Inkscape writes it. The module reads the paths, unites or cuts them, and if you like strokes the result as an area, within a proven distance. The result is SVG again."),
    build(stage) {
        const places = [[3, 3.4], [5.2, 2.8]], sizes = [[4.8, 3.4], [7, 1.6]];
        const plane = stage.plane({ label: "paths" });
        plane.fit([[0, 0], [8, 6]]);
        plane.handles.show([
            ...stage.handlesOf(places, (i) => say(i ? t("Stern", "star") : t("Kreis", "circle")), {}).map((handle, i) => ({ ...handle, move: (to: number[]) => {
                const from = [...(places[i] ?? [])];
                sizes[i]?.forEach((x, k) => { if (sizes[i]) sizes[i][k] = x + (to[k] ?? 0) - (from[k] ?? 0); });
                handle.move(to);
            } })), ...stage.handlesOf(sizes, () => say(t("Größe", "size")), { shape: "diamond", colour: "aux" })]);
        const operation = stage.choice(t("Verknüpfung", "Operation"), kOperations, "union");
        const width = stage.slider(t("Strichbreite (0: keine)", "Width of the stroke (0: none)"), { min: 0, max: 1, step: 0.02, value: 0 });
        const svg = (): string => {
            const [cx = 0, cy = 0] = places[0] ?? [], [sx = 0, sy = 0] = places[1] ?? [];
            const r = Math.hypot((sizes[0]?.[0] ?? 0) - cx, (sizes[0]?.[1] ?? 0) - cy), s = Math.hypot((sizes[1]?.[0] ?? 0) - sx, (sizes[1]?.[1] ?? 0) - sy);
            const star = "M 0,-1 0.22,-0.31 0.95,-0.31 0.36,0.12 0.59,0.81 0,0.38 -0.59,0.81 -0.36,0.12 -0.95,-0.31 -0.22,-0.31 Z";
            return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 8 6">\n<circle id="a" cx="${cx}" cy="${-cy}" r="${r}"/>\n` +
                `<path id="b" transform="translate(${sx} ${-sy}) scale(${s})" d="${star}"/>\n</svg>\n`;
        };
        const result = (): DocumentJson => {
            const one = ff().run("path", [operation.value, svg()], { to: "json" }).json as DocumentJson;
            return width.value > 0 ? ff().run("path", ["stroke", one], { width: width.value, to: "json", tolerance: 1e-3 }).json as DocumentJson : one;
        };
        stage.opens(result);
        stage.button(t("SVG speichern", "Save SVG"), () => { download("freiform.svg", ff().run("path", [operation.value, svg()], { to: "svg" }).text, "image/svg+xml"); });
        stage.update(() => {
            plane.clear();
            area(plane, ff().run("convert", svg(), { to: "json" }).json as DocumentJson, { colour: "axis", width: 1.2, dashed: true });
            const made = result();
            area(plane, made, { colour: "curve", width: 2, fill: "fill", rule: "evenodd" });
            stage.say([[say(t("Kurven", "curves")), String(made.objects.length)], [say(t("Stücke", "pieces")),
                String(made.objects.reduce((n, o) => n + new Set((o as CurveJson).knots ?? []).size - 1, 0))]]);
        });
    },
};

const r33: Page = {
    row: "R33", title: t("Schriften", "Fonts"), gist: t("Buchstaben aus Bézier-Kurven", "letters made of Bézier curves"),
    text: t("TrueType-Buchstaben sind Ketten quadratischer Bézier-Stücke. Punkte auf der Kurve sind Quadrate, Kontrollpunkte daneben Kreise. Ziehen Sie, und sehen Sie, wie die Füllung folgt: Punze und Umriss sind zwei Konturen.",
        "TrueType letters are chains of quadratic Bézier pieces. Points on the curve are squares, control points beside it circles. Drag, and the filling follows: counter and outline are two contours."),
    build(stage) {
        const contours = glyph.contours.map((c) => ({ ...c, points: c.points.map((p) => [...p]) }));
        const plane = stage.plane({ label: "glyph" });
        plane.fit(contours.flatMap((c) => c.points));
        const show = stage.toggle(t("Kontrollpolygone", "Control polygons"), true);
        plane.handles.show(contours.flatMap((c, k) => c.points.slice(0, -1).map((p, i) => ({
            label: `${k + 1}.${i}`, at: () => p, shape: i % 2 ? "circle" as const : "square" as const, colour: i % 2 ? "control" : "curve",
            move: (to: number[]) => {
                p.splice(0, 2, ...to);
                if (i === 0) c.points[c.points.length - 1]?.splice(0, 2, ...to);
                stage.changed();
            } }))));
        const made = (): DocumentJson => document(...contours.map((c): CurveJson => ({ type: "curve", ...c })));
        stage.opens(made);
        stage.hint(t("Buchstabe a der DejaVu Serif, in Einheiten der Schrift.", "Letter a of DejaVu Serif, in units of the font."));
        stage.update(() => {
            plane.clear();
            area(plane, made(), { colour: "curve", width: 2.2, fill: "fill", rule: "nonzero" });
            if (show.value) for (const c of contours) polygon(plane, c.points, { colour: "control", width: 0.9, opacity: 0.7 });
            stage.say([[say(t("Konturen", "contours")), String(contours.length)], [say(t("Stücke", "pieces")), String(contours.reduce((n, c) => n + (c.points.length - 1) / 2, 0))]]);
        });
    },
};

const r34: Page = {
    row: "R34", title: t("Modellieren", "Modelling"), gist: t("Körper für andere Programme", "bodies for other programs"),
    text: t("Aus einem Querschnitt und einem Weg wird ein Körper: durch Ziehen längs einer Geraden, durch Drehen, oder indem er einer Leitkurve folgt. Speichern Sie ihn als STEP (exakt), glb oder STL (Dreiecke innerhalb der Toleranz).",
        "A section and a way become a body: by extrusion, by revolution, or by following a rail. Save it as STEP (exact), glb or STL (triangles within the tolerance)."),
    build(stage) {
        const section = [[0.5, 0], [0.9, 0.7], [-0.1, 1], [-0.9, 0.4], [-0.6, -0.5], [0.2, -0.8]], rail = [[0, 0, 0], [0, 2, 0.4], [0.4, 3, 2.4], [2.6, 3.4, 3]];
        stage.beside();
        const plane = stage.plane({ label: "section" }), space = stage.space(t("Körper", "body"));
        stage.beside();
        plane.fit(section);
        space.fit([[-1, -1, 0], [3, 4, 3]]);
        stage.hold(plane, section, (i) => `d${i}`);
        const way = stage.choice(t("Weg", "Way"), { sweep: t("Leitkurve", "Rail"), extrude: t("Gerade", "Straight"), revolve: t("Drehung", "Turn") }, "sweep",
            (key) => { space.handles.show(key === "sweep" ? stage.handlesOf(rail, (i) => `r${i}`) : []); });
        space.handles.show(stage.handlesOf(rail, (i) => `r${i}`));
        const closed = (): CurveJson => ({ type: "curve", degree: 3, closed: true, knots: section.map((_, i) => i).concat(section.length), points: section });
        const made = (): DocumentJson => {
            if (way.value === "sweep") return ff().run("sweep", closed(), { rail: { type: "curve", points: rail }, tolerance: 0.01 }).json as DocumentJson;
            if (way.value === "extrude") return ff().run("extrude", closed(), { by: [0.4, 0.2, 3] }).json as DocumentJson;
            return ff().run("revolve", closed(), { axis: [2, 0, 0, 0, 1, 0], angle: 300 }).json as DocumentJson;
        };
        stage.opens(made);
        stage.button(t("STEP speichern", "Save STEP"), () => { download("freiform.step", ff().run("convert", made(), { to: "step" }).text, "model/step"); });
        stage.button(t("glb speichern", "Save glb"), () => { download("freiform.glb", ff().run("tessellate", made(), { to: "glb", tolerance: 0.005 }).bytes, "model/gltf-binary"); });
        stage.button(t("STL speichern", "Save STL"), () => { download("freiform.stl", ff().run("tessellate", made(), { to: "stl", tolerance: 0.005 }).bytes, "model/stl"); });
        stage.update((make) => {
            plane.clear();
            space.clear();
            polygon(plane, [...section, section[0] ?? []]);
            area(plane, document(closed()), { colour: "curve", width: 2.6, fill: "fill" });
            if (way.value === "sweep") {
                space.line(run(rail), { colour: "control", width: 1.3 });
                curve(space, make({ type: "curve", points: rail }), { colour: "hot", width: 3 });
            }
            for (const object of made().objects) {
                const s = make(object);
                surface(space, s, {}, 64);
                stage.say([[say(t("Grade", "degrees")), s.degrees.join(" × ")], [say(t("Kontrollpunkte", "control points")), s.size.join(" × ")]]);
            }
        });
    },
};

const kColours = ["#c84018", "#ffe080", "#2f8f6b", "#1060a0"];

interface Stop { readonly at: number; readonly colour: string; readonly rgba: number[] }

const r35: Page = {
    row: "R35", title: t("Farbverläufe", "Colour gradients"), gist: t("Splines im Farbraum, Netze mit Farben", "splines in colour space, meshes of colours"),
    text: t("Ein Verlauf ist eine Kurve im Farbraum: gerade von Farbe zu Farbe, glatt durch sie hindurch, oder ein Spline in ihrer Nähe. Unten die drei Kanäle. Das Netz darüber ist ein bikubisches Flächenstück mit Farben in den Ecken, wie PDF es kennt.",
        "A gradient is a curve in colour space: straight from colour to colour, smooth through them, or a spline near them. Below are the three channels. The mesh above it is a bicubic patch with colours, the kind PDF knows."),
    build(stage) {
        const points = [[[0, 0], [0.2, 1], [-0.3, 2], [0, 3]], [[1, 0.5], [1, 1], [1, 2], [1, 3.5]], [[2, -0.5], [2, 1], [2, 2], [2, 2.5]], [[3, 0], [3.4, 1], [2.6, 2], [3, 3]]];
        const plane = stage.plane({ label: "mesh", grid: false });
        const strip = stage.plane({ label: "gradient", graph: true, movable: false, grid: false, height: 70, above: 12 });
        const graph = stage.graph(t("Kanäle", "channels"), 130);
        plane.fit(points.flat());
        strip.fit([[0, 0], [1, 1]]);
        graph.fit([[0, 0], [1, 1]]);
        plane.handles.show(points.flatMap((row, i) => stage.handlesOf(row, (j) => `b${i}${j}`)));
        const space = stage.choice(t("Farbraum", "Colour space"), { srgb: t("sRGB", "sRGB"), linear: t("linear", "linear"), oklab: t("Oklab", "Oklab"), oklch: t("OKLCh", "OKLCh") }, "oklab");
        const way = stage.choice(t("Weg", "Way"), { lines: t("gerade", "straight"), smooth: t("glatt", "smooth"), near: t("Spline", "spline") }, "smooth");
        const colours = [...kColours];
        stage.add(h("div", { class: "row-of", role: "group", "aria-label": say(t("Farben", "Colours")) }, ...colours.map((c, i) => {
            const input = h("input", { type: "color", value: c, "aria-label": `${say(t("Farbe", "colour"))} ${i + 1}`, oninput: () => { colours[i] = input.value; stage.changed(); } });
            return input;
        })));
        const rgb = (hex: string): number[] => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16) / 255);
        const mesh = (): ObjectJson => ({ type: "surface", degrees: [3, 3], points,
            colours: points.flatMap((_, i) => [0, 1, 2, 3].map((j) => rgb(colours[(i + j) % 4] ?? "#888888"))) }) as unknown as ObjectJson;
        stage.opens(() => document({ type: "surface", points: points.map((row) => row.map((p) => [...p, 0])) }));
        // Thousands of triangles: made anew only when they are others.
        let drawn = "", made = "";
        stage.update(() => {
            plane.clear();
            strip.clear();
            graph.clear();
            const stops = (ff().run("gradient", colours, { space: space.value, way: way.value, to: "json" }).json as { stops: Stop[] }).stops;
            for (let k = 0; k < 3; ++k) graph.line(run(stops.map((s) => [s.at, s.rgba[k] ?? 0])), { colour: ["hot", "aux", "curve"][k] ?? "ink" });
            dots(graph, stops.flatMap((s) => s.rgba.slice(0, 3).map((y) => [s.at, y])), "ink-soft", 4);
            const gradient = stops.map((s) => `<stop offset="${s.at}" stop-color="${s.colour}"/>`).join("");
            strip.image(`<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 10" preserveAspectRatio="none"><defs><linearGradient id="g">${gradient}</linearGradient></defs><rect width="100" height="10" fill="url(#g)"/></svg>`, [0, 0], [1, 1]);
            const key = `${space.value} ${JSON.stringify(mesh())}`;
            if (made !== key) {
                drawn = ff().run("gradient", [], { mesh: mesh(), to: "svg", space: space.value === "oklch" ? "oklab" : space.value }).text
                    // Edges that are smoothed let the ground shine through where triangles meet.
                    .replace("<svg ", '<svg shape-rendering="crispEdges" ');
                made = key;
            }
            const view = /viewBox="([^"]+)"/.exec(drawn)?.[1]?.split(/\s+/).map(Number) ?? [0, 0, 1, 1];
            const [x = 0, y = 0, w = 1, tall = 1] = view;
            plane.image(drawn, [x, -y - tall], [x + w, -y]);
            for (const row of points) plane.line(run(row), { colour: "ink", width: 0.8, opacity: 0.5 });
            stage.say([[say(t("Stützstellen", "stops")), String(stops.length)]]);
        });
    },
};

export const kUses: readonly Page[] = [r32, r33, r34, r35];
