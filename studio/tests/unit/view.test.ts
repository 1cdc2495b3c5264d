import { expect, test } from "vitest";
import { sheet } from "../../src/explore/draw";
import { local } from "../../src/views/view";

test("far from zero points keep their places to each other", () => {
    const far = 5_600_000, { origin, places } = local([far, -far, 0, far + 0.001, -far + 0.25, 1e-9]);
    expect(origin).toEqual([far, -far, 0]);
    expect(places[3]).toBeCloseTo(0.001, 9);
    expect(places[4]).toBeCloseTo(0.25, 9);
    expect(places[5]).toBeCloseTo(1e-9, 15);
});

test("a point that is none is not what the others are seen from", () => {
    const { origin, places } = local([NaN, 0, 0, 7, 8, 9, 8, 8, Infinity]);
    expect(origin).toEqual([7, 8, 9]);
    expect(places).toEqual(Float32Array.of(NaN, -8, -9, 0, 0, 0, 1, 0, Infinity));
    expect(local([]).origin).toEqual([0, 0, 0]);
});

test("a grid far from zero is as one near it", () => {
    const at = (x: number): number[] => [0, 1, 2, 3].flatMap((i) => [x + 0.01 * i, x + 0.02 * i * i]);
    const near = sheet(at(0), 2, 2, 2), far = sheet(at(4e6), 2, 2, 2);
    expect(far.origin).toEqual([4e6, 4e6, 0]);
    far.points.forEach((x, i) => { expect(x).toBeCloseTo(near.points[i] ?? NaN, 8); });
});
