import { expect, test } from "vitest";
import { sheet } from "../../src/explore/draw";
import { distanceFor, local } from "../../src/views/view";

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

test("from where everything is seen, all corners are in the picture and one of them is at its edge", () => {
    const slopes = [0.4, 0.3] as const, unit = (v: number[]): number[] => v.map((x) => x / Math.hypot(...v));
    const cross = (a: number[], b: number[]): number[] => [0, 1, 2].map((k) => (a[(k + 1) % 3] ?? 0) * (b[(k + 2) % 3] ?? 0) - (a[(k + 2) % 3] ?? 0) * (b[(k + 1) % 3] ?? 0));
    const dot = (a: number[], b: number[]): number => a.reduce((sum, x, k) => sum + x * (b[k] ?? 0), 0);
    for (const size of [[1, 2, 30], [30, 2, 1], [5, 5, 5], [7, 0, 0]])
        for (const towards of [[4, -6, 4], [0, 0, 1], [1, 2, -3]]) {
            const back = unit(towards), right = unit(cross([0.1, 0.9, 0.2], back)), up = cross(back, right);
            const distance = distanceFor(size, back, up, slopes);
            let nearest = 0;
            for (let c = 0; c < 8; ++c) {
                const corner = size.map((x, k) => ((c >> k) & 1 ? x : -x) / 2), depth = distance - dot(corner, back);
                const out = Math.max(Math.abs(dot(corner, right)) / slopes[0], Math.abs(dot(corner, up)) / slopes[1]);
                expect(out).toBeLessThanOrEqual(depth * (1 + 1e-12));
                expect(out).toBeLessThanOrEqual(distance * (1 + 1e-12));
                nearest = Math.max(nearest, out / depth, dot(corner, back) > 0 ? 0 : out / distance);
            }
            expect(nearest).toBeCloseTo(1, 9);
        }
});
