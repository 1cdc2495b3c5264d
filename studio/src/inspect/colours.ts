// Colours for numbers: one map that grows (viridis), one that has a middle (blue, white, orange); both can be told apart
// by eyes that do not see red and green.

import { s, h, shown } from "../ui/dom";

type Rgb = readonly [number, number, number];
const kGrow: readonly Rgb[] = [[0.267, 0.005, 0.329], [0.283, 0.141, 0.458], [0.254, 0.265, 0.53], [0.207, 0.372, 0.553], [0.164, 0.471, 0.558],
    [0.128, 0.567, 0.551], [0.135, 0.659, 0.518], [0.267, 0.749, 0.441], [0.478, 0.821, 0.318], [0.741, 0.873, 0.15], [0.993, 0.906, 0.144]];
const kBoth: readonly Rgb[] = [[0.05, 0.2, 0.55], [0.25, 0.5, 0.85], [0.65, 0.8, 0.95], [0.96, 0.96, 0.94], [0.98, 0.8, 0.55], [0.9, 0.5, 0.15], [0.6, 0.2, 0.02]];

export type Scale = { readonly low: number; readonly high: number; readonly both: boolean };

/** Red, green, blue of a number; grey where it is none. */
export function tint(x: number, scale: Scale): Rgb {
    if (!Number.isFinite(x)) return [0.55, 0.55, 0.55];
    const map = scale.both ? kBoth : kGrow, share = scale.high > scale.low ? (x - scale.low) / (scale.high - scale.low) : 0.5;
    const at = Math.min(1, Math.max(0, share)) * (map.length - 1), i = Math.min(map.length - 2, Math.floor(at)), f = at - i;
    const a = map[i] ?? kGrow[0] ?? [0, 0, 0], b = map[i + 1] ?? a;
    return [0, 1, 2].map((k) => (a[k] ?? 0) + f * ((b[k] ?? 0) - (a[k] ?? 0))) as unknown as Rgb;
}

/** From the 5th to the 95th of a hundred, so that few extremes do not take all colours. */
export function range(values: ArrayLike<number>, both: boolean): Scale {
    const sorted = Float64Array.from(values).filter(Number.isFinite).sort();
    const at = (share: number): number => sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] ?? 0;
    if (!both) return { low: sorted[0] ?? 0, high: sorted[sorted.length - 1] ?? 1, both };
    const most = Math.max(Math.abs(at(0.05)), Math.abs(at(0.95))) || 1;
    return { low: -most, high: most, both };
}

/** Numbers as vertex colours; three.js wants them linear. */
export function painted(values: Float64Array, scale: Scale): Float32Array {
    const out = new Float32Array(3 * values.length);
    values.forEach((x, i) => { tint(x, scale).forEach((c, k) => { out[3 * i + k] = c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; }); });
    return out;
}

export function legend(title: string, scale: Scale): HTMLElement {
    const stops = Array.from({ length: 11 }, (_, i) => tint(scale.low + (i / 10) * (scale.high - scale.low), scale));
    const bar = s("svg", { class: "bar-of", viewBox: "0 0 11 1", preserveAspectRatio: "none", "aria-hidden": "true" },
        ...stops.map((c, i) => s("rect", { x: i, y: 0, width: 1.05, height: 1, fill: `rgb(${c.map((x) => Math.round(255 * x)).join(",")})` })));
    return h("div", { class: "legend" }, h("div", {}, title), bar, h("div", { class: "ends" }, h("span", {}, shown(scale.low, 3)), h("span", {}, shown(scale.high, 3))));
}
