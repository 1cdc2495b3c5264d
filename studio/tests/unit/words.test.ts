import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { expect, test } from "vitest";
import { formula } from "../../src/explore/formula";
import { keyOf } from "../../src/edit/keys";
import { counted, t } from "../../src/ui/language";
import { address, parse } from "../../src/ui/router";
import { ends, painted, range, tint } from "../../src/inspect/colours";

const folder = fileURLToPath(new URL("../../src", import.meta.url));
const sources = (at: string): string[] => readdirSync(at, { withFileTypes: true }).flatMap((entry) => {
    const path = join(at, entry.name);
    return entry.isDirectory() ? sources(path) : path.endsWith(".ts") ? [path] : [];
});
const all = sources(folder).map((path) => readFileSync(path, "utf8"));

test("one thing is not many", () => {
    const points = (n: number) => counted(n, t("Punkt", "point"), t("Punkte", "points"));
    expect([0, 1, 2].map(points)).toEqual(["0 points", "1 point", "2 points"]);
});

test("every row R1 to R36 has one page", () => {
    const rows = all.flatMap((text) => [...text.matchAll(/^ {4}row: "R(\d+)"/gm)].map((m) => Number(m[1]))).sort((a, b) => a - b);
    expect(rows).toEqual(Array.from({ length: 36 }, (_, i) => i + 1));
});

test("no text is empty in one of the languages", () => {
    const texts = all.flatMap((text) => [...text.matchAll(/\bt\(\s*"((?:[^"\\]|\\.)*)"(?:\s*\+\s*"(?:[^"\\]|\\.)*")*,\s*"((?:[^"\\]|\\.)*)"/g)]);
    expect(texts.length).toBeGreaterThan(200);
    for (const [, german, english] of texts) expect(german === "" && english === "" || german !== "" && english !== "").toBe(true);
});

test("no source names another machine", () => {
    for (const text of all) expect([...text.matchAll(/https?:\/\/[^"'\s)]+/g)].map((m) => m[0]).filter((url) => !url.startsWith("http://www.w3.org/"))).toEqual([]);
});

test("places and addresses are the same thing", () => {
    for (const place of [{ view: "explore", page: "R5" }, { view: "explore", page: "" }, { view: "edit", page: "" }, { view: "inspect", page: "" }] as const)
        expect(parse(address(place))).toEqual(place);
    expect(parse("#/explore/<script>")).toEqual({ view: "explore", page: "" });
    expect(parse("")).toEqual({ view: "explore", page: "" });
});

test("formulas are MathML with every bracket closed", () => {
    expect(formula("b_i^r")).toBe('<math display="block"><mrow><msubsup><mi>b</mi><mi>i</mi><mi>r</mi></msubsup></mrow></math>');
    for (const text of all) for (const [, source = ""] of text.matchAll(/formula: `([^`]*)`/g)) {
        const made = formula(source);
        for (const tag of ["mrow", "mfrac", "msub", "msup", "mtable"]) expect(made.split(`<${tag}`).length, tag + source).toBe(made.split(`</${tag}>`).length + made.split(`<${tag}sup`).length - 1);
        expect(made).not.toMatch(/[{}]/);
    }
    expect(formula("a < b")).toContain("&lt;");
    expect(formula("binom{n}{i}").match(/<mtr>/g)).toHaveLength(2);
});

test("keys mean what other programs taught", () => {
    const key = (name: string, more: object = {}) => keyOf({ key: name, ctrlKey: false, metaKey: false, shiftKey: false, altKey: false, ...more });
    expect(key("z", { ctrlKey: true })).toBe("undo");
    expect(key("Z", { metaKey: true, shiftKey: true })).toBe("redo");
    expect(key("g")).toBe("grab");
    expect(key("Delete")).toBe("remove");
    expect(key("q")).toBeUndefined();
    expect(key("b", { ctrlKey: true })).toBeUndefined();
});

test("colours: ends, middle, and grey where there is no number", () => {
    const scale = range([-2, -1, 0, 1, 5], true);
    expect(scale.low).toBe(-scale.high);
    expect(tint(NaN, scale)).toEqual([0.55, 0.55, 0.55]);
    expect(tint(0, scale)).toEqual([0.96, 0.96, 0.94]);
    expect(range([1, NaN, 3], false)).toEqual({ low: 1, high: 3, both: false, beyond: false, none: true, empty: false });
});

test("a legend says what the ends of the colours mean", () => {
    const many = [-50, ...Array.from({ length: 98 }, (_, i) => (i - 49) / 100), 70];
    expect(ends(range(many, true))).toEqual(["≤ -0.45", "0", "≥ 0.45"]);
    expect(ends(range([-2, -1, 0, 1, 2], true)), "nothing lies beyond").toEqual(["-2", "0", "2"]);
    expect(ends(range([1, 3, NaN], false))).toEqual(["1", "3"]);
    expect(range([1, 3, NaN], false).none).toBe(true);
    expect(ends(range([NaN, NaN], true)), "no scale is made up").toEqual(["no value"]);
    expect(ends(range([0, 0, 0], true))).toEqual(["0 everywhere"]);
    expect(ends(range([1e-17, -3e-16, 0], true, 1e-12)), "rounding is no curvature").toEqual(["0 everywhere"]);
    expect(ends(range([4, 4], false))).toEqual(["4 everywhere"]);
    const one = [...Array.from({ length: 99 }, () => 0), 8];
    expect(ends(range(one, true)), "a flat model with one bend").toEqual(["-8", "0", "8"]);
});

test("vertices have the colours of the legend", () => {
    const scale = range([0, 10], false), colours = painted(Float64Array.of(0, 10, -5, NaN), scale);
    const linear = (c: number): number => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
    [0, 10, 0, NaN].forEach((x, i) => { tint(x, scale).forEach((c, k) => { expect(colours[3 * i + k]).toBeCloseTo(linear(c), 6); }); });
});
