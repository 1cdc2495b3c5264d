// Where a hand that holds an arrow, an arc or a box takes control points: places are moved, turned and scaled about a point.
// What the hand means is read from its line of sight, so that what is held stays under the cursor in any view.

export type Three = readonly [number, number, number];
export interface Sight { readonly from: Three; readonly along: Three }
export type Way = (point: readonly number[]) => number[];

export const kAxes: readonly [Three, Three, Three] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];

export const dot = (a: Three, b: Three): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const plus = (a: Three, b: Three, k = 1): Three => [a[0] + k * b[0], a[1] + k * b[1], a[2] + k * b[2]];
export const cross = (a: Three, b: Three): Three => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const three = (p: readonly number[]): Three => [p[0] ?? 0, p[1] ?? 0, p[2] ?? 0];

/** Turned by an angle about the axis (of length 1) through `centre`, counterclockwise seen from where the axis points. */
export function turnedAbout(centre: readonly number[], axis: Three, angle: number): Way {
    const c = three(centre), cos = Math.cos(angle), sin = Math.sin(angle);
    return (point) => {
        const r = plus(three(point), c, -1), side = cross(axis, r), k = dot(axis, r) * (1 - cos);
        const to = [0, 1, 2].map((i) => (c[i] ?? 0) + cos * (r[i] ?? 0) + sin * (side[i] ?? 0) + k * (axis[i] ?? 0));
        return point.map((x, i) => to[i] ?? x);
    };
}

/** `centre` stays; along each axis by its own factor. */
export function scaledAbout(centre: readonly number[], factors: readonly number[]): Way {
    return (point) => point.map((x, i) => (centre[i] ?? 0) + (factors[i] ?? 1) * (x - (centre[i] ?? 0)));
}

/** How far along the axis through `centre` the line of sight comes nearest to it; nothing if it looks along the axis. */
export function along(sight: Sight, centre: Three, axis: Three): number | undefined {
    const dd = dot(sight.along, sight.along), da = dot(sight.along, axis), w = plus(sight.from, centre, -1);
    const sine = dd - da * da;
    if (!(sine > 1e-3 * dd)) return undefined;
    return (dd * dot(axis, w) - da * dot(sight.along, w)) / sine;
}

/** Where the line of sight meets the plane through `centre` across the axis; nothing if it nearly lies in it. */
export function across(sight: Sight, centre: Three, axis: Three): Three | undefined {
    const da = dot(sight.along, axis);
    if (!(Math.abs(da) > 0.08 * Math.sqrt(dot(sight.along, sight.along)))) return undefined;
    return plus(sight.from, sight.along, dot(plus(centre, sight.from, -1), axis) / da);
}

/** The angle from `a` to `b` about the axis through `centre`, in (-pi, pi]. */
export function angleBetween(centre: Three, axis: Three, a: Three, b: Three): number {
    const r = plus(a, centre, -1), s = plus(b, centre, -1);
    return Math.atan2(dot(axis, cross(r, s)), dot(r, s) - dot(axis, r) * dot(axis, s));
}

/** The multiple of `step` that is nearest, without the dust of the product. */
export const stepped = (x: number, step: number): number => Number((Math.round(x / step) * step).toPrecision(12));
