// What a figure can draw on: the plane (SVG) and space (three.js) understand the same few words. A view keeps what was
// drawn and shows it again when it is moved; `clear` starts the next picture. Handles live on top of either.

import type { Handles } from "./handles";

export type Point = readonly number[];

export interface Style {
    /** Name of a colour in style.css without its dashes, or a CSS colour. */
    readonly colour: string;
    readonly width?: number;
    readonly dashed?: boolean;
    readonly opacity?: number;
    /** Areas: the colour inside. */
    readonly fill?: string;
    readonly rule?: "evenodd" | "nonzero";
}

/** Points one after another in one array, `dimension` numbers each. */
export interface Run { readonly at: ArrayLike<number>; readonly dimension: number }

export const run = (points: readonly Point[]): Run => ({ at: points.flat(), dimension: points[0]?.length ?? 2 });

export interface View {
    readonly element: HTMLElement;
    readonly handles: Handles;
    clear(): void;
    line(run: Run, style: Style): void;
    dots(run: Run, style: Style): void;
    label(at: Point, text: string, colour?: string): void;
    /** Shows all of these points. */
    fit(points: readonly Point[]): void;
    /** Pixels from the upper left corner. */
    project(point: Point): readonly [number, number];
    /** The point under a pixel, as deep in the picture as `like`. */
    unproject(x: number, y: number, like: Point): number[];
    dispose(): void;
}

/** Points of space, three numbers each, from the first finite one: what single precision would lose far from zero stays. */
export function local(at: ArrayLike<number>): { readonly origin: [number, number, number]; readonly places: Float32Array } {
    let first = 0;
    while (first + 3 < at.length && ![0, 1, 2].every((k) => Number.isFinite(at[first + k]))) first += 3;
    const from = (k: number): number => { const x = at[first + k] ?? 0; return Number.isFinite(x) ? x : 0; };
    const origin: [number, number, number] = [from(0), from(1), from(2)], places = new Float32Array(at.length);
    for (let i = 0; i < at.length; ++i) places[i] = (at[i] ?? 0) - (origin[i % 3] ?? 0);
    return { origin, places };
}

/** The smallest box around finite points: lower and upper corner. */
export function box(points: readonly Point[]): { lower: number[]; upper: number[] } {
    const n = Math.max(2, ...points.map((p) => p.length));
    const lower = new Array<number>(n).fill(Infinity), upper = new Array<number>(n).fill(-Infinity);
    for (const p of points) {
        for (let i = 0; i < n; ++i) {
            const x = p[i] ?? 0;
            if (!Number.isFinite(x)) continue;
            lower[i] = Math.min(lower[i] ?? x, x);
            upper[i] = Math.max(upper[i] ?? x, x);
        }
    }
    return { lower: lower.map((x) => (Number.isFinite(x) ? x : -1)), upper: upper.map((x) => (Number.isFinite(x) ? x : 1)) };
}

/** How far from the middle of a box the eye has to be, looking along -`back`, to see all corners: `slopes` are half the
    width and half the height of what it sees at the distance 1. Enough for parallel rays that show as much there. */
export function distanceFor(size: Point, back: Point, up: Point, slopes: readonly [number, number]): number {
    const at = (v: Point, k: number): number => v[k] ?? 0;
    const right = [0, 1, 2].map((k) => at(up, (k + 1) % 3) * at(back, (k + 2) % 3) - at(up, (k + 2) % 3) * at(back, (k + 1) % 3));
    let most = 0;
    for (let corner = 0; corner < 8; ++corner) {
        const along = (v: Point): number => [0, 1, 2].reduce((sum, k) => sum + ((corner >> k) & 1 ? 0.5 : -0.5) * at(size, k) * at(v, k), 0);
        most = Math.max(most, Math.max(0, along(back)) + Math.max(Math.abs(along(right)) / slopes[0], Math.abs(along(up)) / slopes[1]));
    }
    return most;
}

/** A round number near `x` from below: 1, 2 or 5 times a power of ten. */
export function round125(x: number): number {
    const power = 10 ** Math.floor(Math.log10(x));
    const lead = x / power;
    return (lead >= 5 ? 5 : lead >= 2 ? 2 : 1) * power;
}
