import { expect, test } from "vitest";
import { Selection } from "../../src/edit/selection";
import { across, along, angleBetween, cross, dot, kAxes, plus, scaledAbout, stepped, turnedAbout, type Three } from "../../src/edit/transform";

const [x, , z] = kAxes;
const tilted: Three = [0.36, 0.48, 0.8];

test("a quarter turn takes x to y about z, y to z about x, z to x about y", () => {
    for (const [i, axis] of kAxes.entries()) {
        const from = kAxes[(i + 1) % 3] ?? x, to = kAxes[(i + 2) % 3] ?? x;
        turnedAbout([0, 0, 0], axis, Math.PI / 2)(from).forEach((c, k) => { expect(c).toBeCloseTo(to[k] ?? NaN, 14); });
    }
    expect(turnedAbout([1, 1], z, Math.PI)([2, 1]).map((c) => Number(c.toFixed(12)))).toEqual([0, 1]);
});

test("turns keep distances and the axis, and add up", () => {
    const centre: Three = [1, -2, 0.5], p = [3, 1, -4], q = [0, 7, 2];
    const a = turnedAbout(centre, tilted, 0.7), b = turnedAbout(centre, tilted, 1.9), both = turnedAbout(centre, tilted, 2.6);
    expect(Math.hypot(...a(p).map((c, i) => c - (a(q)[i] ?? 0)))).toBeCloseTo(Math.hypot(...p.map((c, i) => c - (q[i] ?? 0))), 12);
    a(plus(centre, tilted, 5)).forEach((c, i) => { expect(c).toBeCloseTo(plus(centre, tilted, 5)[i] ?? NaN, 12); });
    b(a(p)).forEach((c, i) => { expect(c).toBeCloseTo(both(p)[i] ?? NaN, 12); });
});

test("scaling keeps the centre and takes each axis by its own factor; what else a point has stays", () => {
    expect(scaledAbout([1, 2, 3], [2, 1, 0.5])([2, 5, 7, 9])).toEqual([3, 5, 5, 9]);
    expect(scaledAbout([1, 2, 3], [2, 3, 4])([1, 2, 3])).toEqual([1, 2, 3]);
});

test("the point of an axis that is nearest to a line of sight: the connection is across both", () => {
    const centre: Three = [1, 2, 3], sight = { from: [4, -3, 9] as Three, along: [-0.3, 0.7, -1.1] as Three };
    const far = along(sight, centre, tilted) ?? NaN, at = plus(centre, tilted, far);
    // The nearest point of the line of sight to it.
    const k = dot(plus(at, sight.from, -1), sight.along) / dot(sight.along, sight.along), gap = plus(plus(sight.from, sight.along, k), at, -1);
    expect(dot(gap, tilted)).toBeCloseTo(0, 12);
    expect(along({ from: [0, 0, 5], along: [0, 0, -1] }, [0, 0, 0], z), "who looks along an axis sees no movement").toBeUndefined();
});

test("a line of sight meets the plane across an axis, unless it lies in it", () => {
    const hit = across({ from: [0, 0, 5], along: [1, 0, -1] }, [7, 7, 2], z);
    expect(hit).toEqual([3, 0, 2]);
    expect(across({ from: [0, 0, 5], along: [1, 0, 0.01] }, [0, 0, 2], z)).toBeUndefined();
});

test("the angle between two places is that of the turn that takes one to the other", () => {
    const centre: Three = [1, 2, 3], u = cross(tilted, [0.8, -0.6, 0]), start = plus(plus(centre, u), tilted, 0.4);
    for (const angle of [-3, -1, 0, 0.5, 2, 3.1]) {
        const [a = 0, b = 0, c = 0] = turnedAbout(centre, tilted, angle)(start);
        expect(angleBetween(centre, tilted, start, [a, b, c])).toBeCloseTo(angle, 12);
    }
});

test("steps are round", () => {
    expect(stepped(0.29, 0.1)).toBe(0.3);
    expect(stepped(1.13, 0.05)).toBe(1.15);
});

test("what is chosen: points before objects, their middle, and nothing that is gone", () => {
    const curve = { type: "curve" as const, points: [[0, 0, 0], [2, 0, 0], [4, 6, 3]] }, document = { objects: [curve, { ...curve }] };
    const selection = new Selection();
    selection.objects.add(1);
    expect(selection.meant(document)).toHaveLength(3);
    expect(selection.centre(document)).toEqual([2, 2, 1]);
    selection.add({ object: 0, point: 1 });
    selection.toggle({ object: 1, point: 2 });
    expect(selection.meant(document)).toEqual([{ object: 0, point: 1 }, { object: 1, point: 2 }]);
    selection.follow(document, { objects: [curve] });
    expect(selection.places).toEqual([{ object: 0, point: 1 }]);
    expect(selection.objects.size).toBe(0);
    selection.toggle({ object: 0, point: 1 });
    expect(selection.owners).toEqual([]);
});
