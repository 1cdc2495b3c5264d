// R21 to R24, R28, R31: tensor products and how they join.

import type { DocumentJson, SurfaceJson } from "../../kernel/module";
import { construct, ff } from "../../kernel/module";
import { h, shown } from "../../ui/dom";
import { say, t } from "../../ui/language";
import type { Space } from "../../views/space";
import { run } from "../../views/view";
import { curve, dots, isoline, lattice, net, shade, surface } from "../draw";
import type { Page, Stage } from "../stage";
import { raised } from "./joints";

type Net = number[][][];
const document = (...objects: SurfaceJson[]): DocumentJson => ({ freiform: 1, objects });

/** A net over the integers with these heights. */
const hills = (heights: readonly (readonly number[])[]): Net => heights.map((row, i) => row.map((z, j) => [i, j, z]));
const kSixteen = [[0, 0.6, 0.2, 0.8], [0.6, 2.4, -0.6, 0.2], [-0.2, 1, 2.6, 0.6], [0.4, -0.4, 0.8, 1.4]];

/** Handles for every point of a net. */
function holdNet(stage: Stage, space: Space, points: Net, name = "b"): void {
    space.handles.show(points.flatMap((row, i) => stage.handlesOf(row, (j) => `${name}${i}${j}`)));
}

const kUniform = [-3, -2, -1, 0, 1, 2, 3, 4];

const r21: Page = {
    row: "R21", title: t("Bikubische Flächenstücke", "Bicubic patches"), gist: t("16 Punkte, zwei Matrizen", "16 points, two matrices"),
    text: t("Sechzehn Punkte sind die Geometrie einer Kurve, deren Kontrollpunkte auf Kurven laufen. Wie bei Kurven geben dieselben Punkte mit einer anderen Matrix ein anderes Stück, und jede Richtung darf ihre eigene haben.",
        "Sixteen points are the geometry of a curve whose control points run along curves. As with curves the same points give another patch with another matrix, and each direction may have its own."),
    formula: `Q(s, t) = S^T M_s^T G M_t T`,
    build(stage) {
        const points = hills(kSixteen);
        const space = stage.space(t("Fläche", "surface"));
        space.fit(points.flat());
        holdNet(stage, space, points);
        const kinds = { bezier: t("Bézier", "Bézier"), spline: t("B-Spline", "B-spline"), catmull: t("interpolierend", "interpolating") };
        const kind = stage.choice(t("Matrix in beiden Richtungen", "Matrix in both directions"), kinds, "bezier");
        const made = (): SurfaceJson => {
            if (kind.value === "bezier") return { type: "surface", points };
            if (kind.value === "spline") return { type: "surface", degrees: [3, 3], knots: [kUniform, kUniform], points };
            const json = ff().run("interpolate", JSON.stringify(points) + "\n", { ends: "catmull-rom" }).json as DocumentJson;
            return json.objects[0] as SurfaceJson;
        };
        stage.opens(() => document(made()));
        stage.update((make) => {
            space.clear();
            surface(space, make(made()));
            lattice(space, points);
        });
    },
};

const r22: Page = {
    row: "R22", title: t("Tensorprodukte", "Tensor products"), gist: t("eine Kurve, die sich bewegt", "a curve that moves"),
    text: t("Hält man u fest, laufen die Punkte der Spalten auf ihren eigenen Kurven, und was sie gerade bilden, sind die Kontrollpunkte einer Kurve in v. Bewegt sich u, fegt diese Kurve die Fläche aus.",
        "With u fixed, the points of the columns stand on curves of their own, and what they form are the control points of a curve in v. As u moves, this curve sweeps out the surface."),
    formula: `S(u, v) = sum_i sum_j B_i^n(u) B_j^m(v) b_{ij}`,
    build(stage) {
        const points = hills(kSixteen);
        const space = stage.space(t("Tensorprodukt", "tensor product"));
        space.fit(points.flat());
        holdNet(stage, space, points);
        const u = stage.player(t("Parameter u", "Parameter u"), { min: 0, max: 1, value: 0.35 });
        const columns = stage.toggle(t("Kurven der Spalten", "Curves of the columns"), true);
        stage.opens(() => document({ type: "surface", points }));
        stage.update((make) => {
            space.clear();
            const s = make({ type: "surface", points });
            surface(space, s, { opacity: 0.75 });
            lattice(space, points, { colour: "axis", width: 1 });
            const moving = points[0]?.map((_, j) => {
                const column = make({ type: "curve", points: points.map((row) => row[j] ?? []) });
                if (columns.value) curve(space, column, { colour: shade(j), width: 2.4 });
                return Array.from(column.evaluate([u.value]));
            }) ?? [];
            space.line(run(moving), { colour: "control", width: 2 });
            dots(space, moving, "control", 11);
            curve(space, make({ type: "curve", points: moving }), { colour: "hot", width: 5 });
        });
    },
};

const r23: Page = {
    row: "R23", title: t("De Casteljau auf Flächen", "De Casteljau on surfaces"), gist: t("bilineare Interpolation, immer wieder", "bilinear interpolation, again and again"),
    text: t("In jeder Masche des Netzes wird bilinear interpoliert; das Netz schrumpft um eine Reihe in jeder Richtung, bis ein Punkt bleibt: S(u, v). Schneiden lässt sich die Fläche in u, in v oder in beiden.",
        "Each cell of the net is interpolated bilinearly; the net shrinks by a row in each direction until one point is left: S(u, v). The surface can be cut in u, in v or in both."),
    formula: `b_{ij}^r = (1-u)(1-v) b_{ij}^{r-1}
              + u(1-v) b_{i+1,j}^{r-1}
              + (1-u)v b_{i,j+1}^{r-1}
              + u v b_{i+1,j+1}^{r-1}`,
    build(stage) {
        const points = hills(kSixteen);
        const space = stage.space(t("Fläche", "surface"));
        space.fit(points.flat());
        holdNet(stage, space, points);
        const u = stage.slider(t("u", "u"), { min: 0, max: 1, value: 0.4 }), v = stage.slider(t("v", "v"), { min: 0, max: 1, value: 0.6 });
        const cut = stage.choice(t("Teilen", "Cut"), { no: t("nein", "no"), u: t("in u", "in u"), v: t("in v", "in v"), both: t("beide", "both") }, "no");
        const parts = (): SurfaceJson[] => {
            let now: SurfaceJson[] = [{ type: "surface", points }];
            for (const axis of ["u", "v"] as const) {
                if (cut.value !== axis && cut.value !== "both") continue;
                const at = axis === "u" ? u.value : v.value;
                if (!(at > 0 && at < 1)) continue;
                now = now.flatMap((s) => (ff().run("convert", s, { split: at, axis }).json as DocumentJson).objects as SurfaceJson[]);
            }
            return now;
        };
        stage.opens(() => document(...parts()));
        stage.update((make) => {
            space.clear();
            const all = parts();
            all.forEach((part, i) => {
                surface(space, make(part), { opacity: 0.8, colour: all.length > 1 ? shade(i) : "surface" }, 24);
                if (all.length > 1) lattice(space, part.points, { colour: shade(i), width: 1.6 });
            });
            const s = make({ type: "surface", points }), scheme = construct(s, [u.value, v.value]);
            if (all.length === 1) scheme.forEach(({ level, extent, points: at }) => {
                if (level[0] !== level[1]) return;
                const [rows = 1, columns = 1] = extent, r = level[0] ?? 0;
                if (rows > 1) lattice(space, Array.from({ length: rows }, (_, i) => at.slice(i * columns, (i + 1) * columns)), { colour: shade(r + 1), width: 1.8 });
                dots(space, at, rows > 1 ? shade(r + 1) : "hot", rows > 1 ? 8 : 14);
            });
            stage.say([["S(u, v)", `(${Array.from(s.evaluate([u.value, v.value]), (x) => shown(x, 6)).join(", ")})`]]);
        });
    },
};

const r24: Page = {
    row: "R24", title: t("Interpolierende Flächen", "Interpolating surfaces"), gist: t("C¹ durch ein Gitter von Punkten", "C¹ through a grid of points"),
    text: t("Die Interpolation der Kurven, in beiden Richtungen: durch 5 × 5 Punkte gehen 16 bikubische Stücke mit stetiger Tangentialebene. Ziehen Sie einen Punkt und sehen Sie, wie weit seine Wirkung reicht.",
        "The interpolation of curves, in both directions: 16 bicubic pieces with a continuous tangent plane go through 5 × 5 points. Drag a point and see how far its influence reaches."),
    build(stage) {
        const points = hills([[0, 0, 0.3, 0, 0], [0, 0.8, 1.4, 0.6, 0], [0.2, 1.2, 2.4, 0.4, -0.2], [0, 0.6, 0.8, -0.4, -0.4], [0, 0, 0, -0.4, 0]]);
        const space = stage.space(t("Fläche", "surface"));
        space.fit(points.flat());
        holdNet(stage, space, points, "Q");
        const ends = stage.choice(t("Art", "Way"), { "catmull-rom": t("C¹, lokal", "C¹, local"), natural: t("C², natürlich", "C², natural"), "not-a-knot": t("C² not-a-knot", "C² not-a-knot") }, "catmull-rom");
        const look = stage.choice(t("Ansicht", "Look"), { shaded: t("Schattiert", "Shaded"), zebra: t("Zebra", "Zebra") }, "shaded");
        const made = (): DocumentJson => ff().run("interpolate", JSON.stringify(points) + "\n", { ends: ends.value }).json as DocumentJson;
        stage.opens(made);
        stage.update((make) => {
            space.clear();
            for (const object of made().objects) {
                const s = make(object);
                surface(space, s, { look: look.value });
                for (const axis of [0, 1] as const)
                    for (const k of new Set(s.knots[axis])) {
                        const [lo, hi] = s.domain[axis] ?? [0, 1];
                        if (k >= lo && k <= hi) isoline(space, s, axis, k, { colour: "curve", width: 1.5 });
                    }
            }
        });
    },
};

const kQuadrics = { sphere: t("Kugel", "Sphere"), cylinder: t("Zylinder", "Cylinder"), cone: t("Kegel", "Cone"), torus: t("Torus", "Torus"), ellipsoid: t("Ellipsoid", "Ellipsoid") };

const r28: Page = {
    row: "R28", title: t("Rationale Flächen", "Rational surfaces"), gist: t("Kugel, Zylinder, Kegel, Torus: exakt", "sphere, cylinder, cone, torus: exact"),
    text: t("NURBS stellen Kugel, Zylinder, Kegel und Torus exakt dar. Das Netz zeigt die Kontrollpunkte; die Anzeige misst, wie weit ausgewertete Punkte von der Radiusgleichung abweichen: nur Rundung.",
        "NURBS represent sphere, cylinder, cone and torus exactly. The net shows the control points; the readout measures how far evaluated points are off the equation of the radius: rounding alone."),
    build(stage) {
        const space = stage.space(t("Quadrik", "quadric"));
        space.fit([[-2, -2, -1.5], [2, 2, 1.5]]);
        const kind = stage.choice(t("Fläche", "Surface"), kQuadrics, "torus");
        const radius = stage.slider(t("Radius", "Radius"), { min: 0.5, max: 2, value: 1.4 });
        const other = stage.slider(t("Rohr, Höhe oder Halbachse", "Tube, height or half-axis"), { min: 0.1, max: 2, value: 0.5 });
        const angle = stage.slider(t("Winkel", "Angle"), { min: 30, max: 360, step: 1, value: 270 });
        const made = (): DocumentJson => {
            const r = radius.value, o = other.value;
            const own = { sphere: { radius: r }, cylinder: { radius: r, height: o }, cone: { radius: r, height: o }, torus: { radius: r, tube: Math.min(o, 0.95 * r) }, ellipsoid: { radii: [r, o, 1] } }[kind.value];
            return ff().run("quadric", [kind.value], { ...own, ...(kind.value === "ellipsoid" ? {} : { angle: angle.value }) }).json as DocumentJson;
        };
        stage.opens(made);
        stage.update((make) => {
            space.clear();
            for (const object of made().objects) {
                const s = make(object), points = net(s), [, columns = 1] = s.size;
                surface(space, s, {}, 64);
                lattice(space, Array.from({ length: s.size[0] ?? 0 }, (_, i) => points.slice(i * columns, (i + 1) * columns)), { colour: "control", width: 1.2 });
                dots(space, points, "control", 6);
                const grid = s.grid([[0.13, 0.37, 0.71].map((x) => mix(s.domain[0], x)), [0.2, 0.6].map((x) => mix(s.domain[1], x))]).points;
                let off = 0;
                for (let i = 0; i < grid.length; i += 3) {
                    const [x = 0, y = 0, z = 0] = grid.slice(i, i + 3), rho = Math.hypot(x, y), r = radius.value;
                    const miss = kind.value === "sphere" ? Math.hypot(rho, z) - r : kind.value === "cylinder" ? rho - r
                        : kind.value === "torus" ? Math.hypot(rho - r, z) - Math.min(other.value, 0.95 * r) : 0;
                    off = Math.max(off, Math.abs(miss));
                }
                const rows: [string, string][] = [[say(t("Grad", "degree")), s.degrees.join(" × ")], [say(t("Kontrollpunkte", "control points")), s.size.join(" × ")],
                    [say(t("Schranke der Rundung", "bound of rounding")), shown(s.valueErrorBound)]];
                if (["sphere", "cylinder", "torus"].includes(kind.value)) rows.push([say(t("gemessene Abweichung", "measured deviation")), shown(off)]);
                stage.say(rows);
            }
        });
    },
};

const mix = (domain: readonly [number, number] | undefined, x: number): number => (domain ? domain[0] + x * (domain[1] - domain[0]) : x);

interface SurfaceJoint { readonly c_order: number; readonly g_order: number; readonly first_g_jump?: { order: number; size: number; unit: string } }

const r31: Page = {
    row: "R31", title: t("Glatte Anschlüsse von Flächen", "Smooth joints of surfaces"), gist: t("C⁰, C¹, G¹, G² an einer Kante", "C⁰, C¹, G¹, G² along an edge"),
    text: t("Zwei Flächenstücke teilen eine Kante. Ziehen Sie an den mittleren Reihen: G¹ verlangt überall dieselbe Tangentialebene. Zebrastreifen brechen bei G⁰ ab, knicken bei G¹ und sind glatt bei G².",
        "Two patches share an edge. Drag the middle rows: G¹ asks for the same tangent plane everywhere. Zebra stripes break with G⁰, kink with G¹ and are smooth with G²."),
    build(stage) {
        const rows = [0, 1, 2, 3, 4, 5, 6];
        const points: Net = rows.map((i) => [0, 1, 2, 3].map((j) => [i * 0.8, j, [0, 0.9, 1.4, 1.5, 1.2, 0.2, -0.6][i] ?? 0]));
        const space = stage.space(t("zwei Flächen", "two surfaces"));
        space.fit(points.flat());
        space.handles.show(points.slice(2, 5).flatMap((row, i) => stage.handlesOf(row, (j) => `b${i + 2}${j}`, { colour: i === 1 ? "curve" : "control" })));
        const look = stage.choice(t("Ansicht", "Look"), { zebra: t("Zebra", "Zebra"), shaded: t("Schattiert", "Shaded"), isophotes: t("Isophoten", "Isophotes") }, "zebra");
        const spline = (multiplicity: number): void => {
            // Both patches as pieces of one spline: a knot of this multiplicity joins them with 3 - m derivatives.
            const inner = points.slice(1, 6).filter((_, i) => !(multiplicity < 3 && i === 2) && !(multiplicity < 2 && i === 1));
            const all = [points[0] ?? [], ...inner, points[6] ?? []];
            const one: SurfaceJson = { type: "surface", degrees: [3, 3], knots: [[0, 0, 0, 0, ...new Array<number>(multiplicity).fill(1), 2, 2, 2, 2], [0, 0, 0, 0, 1, 1, 1, 1]], points: all };
            const pieces = (ff().run("convert", one, { toBezier: true }).json as DocumentJson).objects as SurfaceJson[];
            pieces.forEach((piece, k) => { piece.points.forEach((row, i) => { row.forEach((p, j) => { points[3 * k + i]?.[j]?.splice(0, 3, ...p); }); }); });
            space.handles.place();
        };
        stage.button(t("C¹ herstellen", "Make it C¹"), () => { spline(2); });
        stage.button(t("C² herstellen", "Make it C²"), () => { spline(1); });
        const parts = (): SurfaceJson[] => [{ type: "surface", points: points.slice(0, 4) }, { type: "surface", points: points.slice(3) }];
        stage.opens(() => document(...parts()));
        stage.update((make) => {
            space.clear();
            parts().forEach((part, i) => {
                surface(space, make(part), { look: look.value, colour: i ? "surface" : "curve" }, 40);
                lattice(space, part.points, { colour: "control", width: 1 });
            });
            space.line(run(points[3] ?? []), { colour: "hot", width: 1.5 });
            const joint = (ff().run("continuity", document(...parts()), { tolerance: 1e-6 }).json as { joints: SurfaceJoint[] }).joints[0];
            const order = (name: string, reached: number): Node => h("span", {}, ...[0, 1, 2].map((k) => h("span", { class: k <= reached ? "yes" : "no" }, `${k <= reached ? "✓" : "✗"}\u00a0${name}${k} `)));
            if (joint) stage.say([["C", order("C", joint.c_order)], ["G", order("G", joint.g_order)],
                [say(t("größter Sprung", "largest jump")), joint.first_g_jump ? `${shown(joint.first_g_jump.size)} ${raised(joint.first_g_jump.unit)}` : "–"]]);
        });
    },
};

export const kTensors: readonly Page[] = [r21, r22, r23, r24, r28, r31];
