// Colours for numbers: one map that grows (viridis), one that has a middle (blue, white, orange); both can be told apart
// by eyes that do not see red and green.

import { s, h, shown } from "../ui/dom";
import { say, t } from "../ui/language";

type Rgb = readonly [number, number, number];
const kGrow: readonly Rgb[] = [[0.267, 0.005, 0.329], [0.283, 0.141, 0.458], [0.254, 0.265, 0.53], [0.207, 0.372, 0.553], [0.164, 0.471, 0.558],
    [0.128, 0.567, 0.551], [0.135, 0.659, 0.518], [0.267, 0.749, 0.441], [0.478, 0.821, 0.318], [0.741, 0.873, 0.15], [0.993, 0.906, 0.144]];
const kBoth: readonly Rgb[] = [[0.05, 0.2, 0.55], [0.25, 0.5, 0.85], [0.65, 0.8, 0.95], [0.96, 0.96, 0.94], [0.98, 0.8, 0.55], [0.9, 0.5, 0.15], [0.6, 0.2, 0.02]];

/** `beyond`: numbers lie below and above the ends. `none`: some are no numbers; `empty`: all are. */
export interface Scale { readonly low: number; readonly high: number; readonly both: boolean; readonly beyond: boolean; readonly none: boolean; readonly empty: boolean }

/** Red, green, blue of a number; grey where it is none. */
export function tint(x: number, scale: Scale): Rgb {
    if (!Number.isFinite(x)) return [0.55, 0.55, 0.55];
    const map = scale.both ? kBoth : kGrow, share = scale.high > scale.low ? (x - scale.low) / (scale.high - scale.low) : 0.5;
    const at = Math.min(1, Math.max(0, share)) * (map.length - 1), i = Math.min(map.length - 2, Math.floor(at)), f = at - i;
    const a = map[i] ?? kGrow[0] ?? [0, 0, 0], b = map[i + 1] ?? a;
    return [0, 1, 2].map((k) => (a[k] ?? 0) + f * ((b[k] ?? 0) - (a[k] ?? 0))) as unknown as Rgb;
}

/** From the 5th to the 95th of a hundred, so that few extremes do not take all colours. `dust`: what is smaller is noise. */
export function range(values: ArrayLike<number>, both: boolean, dust = 0): Scale {
    const sorted = Float64Array.from(values).filter(Number.isFinite).sort(), n = sorted.length;
    const about = { both, none: n < values.length, empty: n === 0 };
    const [least, largest] = [sorted[0] ?? 0, sorted[n - 1] ?? 0];
    if (!both) return { low: least, high: largest, beyond: false, ...about };
    const at = (share: number): number => sorted[Math.min(n - 1, Math.floor(share * n))] ?? 0;
    const end = Math.max(Math.abs(at(0.05)), Math.abs(at(0.95)));
    const most = end > dust ? end : Math.max(-least, largest) > dust ? Math.max(-least, largest) : 0;
    return { low: -most, high: most, beyond: most > 0 && (least < -most || largest > most), ...about };
}

/** So many colours are told apart. */
const kSteps = 1024;

/** Numbers as vertex colours; three.js wants them linear. */
export function painted(values: Float64Array, scale: Scale): Float32Array {
    const linear = (colour: Rgb): Float32Array => Float32Array.from(colour, (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
    const { low, high } = scale, wide = high > low ? kSteps / (high - low) : 0;
    const table = Array.from({ length: kSteps + 1 }, (_, i) => linear(tint(low + (i / kSteps) * (high - low), scale))), none = linear(tint(NaN, scale));
    const out = new Float32Array(3 * values.length);
    values.forEach((x, i) => { out.set((Number.isFinite(x) ? table[Math.min(kSteps, Math.max(0, Math.round((x - low) * wide)))] : none) ?? none, 3 * i); });
    return out;
}

/** What stands below the colours, from left to right. */
export function ends({ low, high, beyond, empty }: Scale): string[] {
    if (empty) return [say(t("kein Wert", "no value"))];
    if (!(high > low)) return [`${shown(low, 3)} ${say(t("überall", "everywhere"))}`];
    return beyond ? [`≤ ${shown(low, 3)}`, "0", `≥ ${shown(high, 3)}`] : low < 0 && high > 0 ? [shown(low, 3), "0", shown(high, 3)] : [shown(low, 3), shown(high, 3)];
}

export function legend(title: string, scale: Scale): HTMLElement {
    const many = scale.high > scale.low && !scale.empty ? 11 : 1;
    const stops = Array.from({ length: many }, (_, i) => tint(scale.empty ? NaN : scale.low + (i / 10) * (scale.high - scale.low), scale));
    const bar = s("svg", { class: "bar-of", viewBox: `0 0 ${many} 1`, preserveAspectRatio: "none", "aria-hidden": "true" },
        ...stops.map((c, i) => s("rect", { x: i, y: 0, width: 1.05, height: 1, fill: `rgb(${c.map((x) => Math.round(255 * x)).join(",")})` })));
    return h("div", { class: "legend" }, h("div", {}, title), bar, h("div", { class: "ends" }, ...ends(scale).map((text) => h("span", {}, text))),
        scale.none && !scale.empty && h("div", {}, say(t("grau: kein Wert", "grey: no value"))));
}
