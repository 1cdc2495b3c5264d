import { expect, test } from "vitest";
import { chained, clamped, drawn, flat, inside, loose, moved, named, pointsOf, raised, removed, shifted, weighted, weightsOf, withPoints, type Document } from "../../src/edit/document";

const curve = { type: "curve" as const, name: "c", points: [[0, 0], [1, 2], [3, 2]] };
const surface = { type: "surface" as const, points: [[[0, 0, 0], [0, 1, 0], [0, 2, 0]], [[1, 0, 0], [1, 1, 5], [1, 2, 0]]] };
const document: Document = { objects: [curve, surface] };

test("points of surfaces run with v", () => {
    expect(pointsOf(surface)[4]).toEqual([1, 1, 5]);
    expect(withPoints(surface, pointsOf(surface))).toEqual(surface);
});

test("moving makes a new document and shares the rest", () => {
    const next = moved(document, [{ object: 1, point: 4 }], shifted([1, 0, -5]));
    expect(pointsOf(next.objects[1])[4]).toEqual([2, 1, 0]);
    expect(pointsOf(document.objects[1])[4]).toEqual([1, 1, 5]);
    expect(next.objects[0]).toBe(document.objects[0]);
});

test("a place that is chosen twice moves once", () => {
    const next = moved(document, [{ object: 0, point: 1 }, { object: 0, point: 1 }], shifted([1, 1]));
    expect(pointsOf(next.objects[0])[1]).toEqual([2, 3]);
});

test("weights appear only when one is not 1, and old products go", () => {
    const next = weighted({ objects: [{ ...curve, weighted_points: [] } as typeof curve] }, [{ object: 0, point: 1 }], 2);
    expect(weightsOf(next.objects[0])).toEqual([1, 2, 1]);
    expect(next.objects[0]).not.toHaveProperty("weighted_points");
    expect(moved(document, [{ object: 0, point: 0 }], shifted([1, 1])).objects[0]).not.toHaveProperty("weights");
});

test("clamped knots have degree + 1 equal ends", () => {
    expect(clamped(5, 3)).toEqual([0, 0, 0, 0, 1, 2, 2, 2, 2]);
    expect(drawn([[0, 0], [1, 1]])).toMatchObject({ degree: 1, knots: [0, 0, 1, 1] });
});

test("names are not taken twice", () => {
    expect(named({ objects: [curve, { ...curve, name: "c 2" }] }, curve).name).toBe("c 3");
});

test("plane documents are flat until they are raised", () => {
    expect(flat({ objects: [curve] })).toBe(true);
    const up = raised({ objects: [curve] });
    expect(flat(up)).toBe(false);
    expect(pointsOf(up.objects[0])[2]).toEqual([3, 2, 0]);
});

test("removing keeps the others", () => expect(removed(document, [0]).objects).toEqual([surface]));

test("chains keep counts: knots are points + degree + 1, weights agree where they meet", () => {
    const a = { points: [[0, 0], [1, 1], [2, 0]], weights: [1, 1, 4] }, b = { points: [[2, 0], [3, -1], [4, 0]], weights: [2, 1, 1] };
    const c = chained(a, b);
    expect(c.points).toHaveLength(5);
    expect(c.knots).toEqual([0, 0, 0, 1, 1, 2, 2, 2]);
    expect(c.weights).toEqual([1, 1, 4, 2, 2]);
});

test("a curve that floats beyond its domain lacks knots there; what is outside goes", () => {
    const u = { points: [[3, 1], [4, -1], [6, 0], [7, 3]], degree: 2, knots: [0, 1, 2, 3, 4, 5, 6] };
    expect(loose(u)).toEqual([2, 4]);
    expect(loose(drawn([[0, 0], [1, 1], [2, 0], [3, 1], [4, 0]]))).toEqual([]);
    // What the module makes of it.
    const whole = { degree: 2, knots: [0, 1, 2, 2, 3, 4, 4, 5, 6], points: [[3, 1], [3.5, 0], [4, -1], [6, 0], [6.5, 1.5], [7, 3]], weights: [1, 2, 3, 4, 5, 6] };
    expect(loose(whole)).toEqual([]);
    expect(inside(whole)).toEqual({ degree: 2, knots: [2, 2, 2, 3, 4, 4, 4], points: [[3.5, 0], [4, -1], [6, 0], [6.5, 1.5]], weights: [2, 3, 4, 5] });
    const clean = drawn([[0, 0], [1, 1], [2, 0], [3, 1], [4, 0]]);
    expect(inside(clean)).toBe(clean);
    expect(inside(curve)).toBe(curve);
});
