import { expect, test } from "vitest";
import { numbersOf, oneOf } from "../../src/edit/numbers";

test("numbers have spaces, semicolons, or commas and spaces between them", () => {
    expect(numbersOf(" 1 2.5\t-3e-2 ")).toEqual([1, 2.5, -0.03]);
    expect(numbersOf("1, 2; 3,")).toEqual([1, 2, 3]);
    expect(numbersOf("")).toEqual([]);
});

test("what could be one number or two is refused, and so is what is none", () => {
    for (const text of ["1,5 2", "0,0,1", "1 abc", "1 Infinity", "1 NaN"]) expect(() => numbersOf(text), text).toThrow();
    expect(() => numbersOf("1,5")).toThrow(/1\.5 or 1 5/);
});

test("where one number is meant, its point may be a comma", () => {
    expect(oneOf(" 0,25 ")).toBe(0.25);
    expect(oneOf("-,5")).toBe(-0.5);
    expect(oneOf("1e-3")).toBe(0.001);
    for (const text of ["", "1 2", "1,2,3", "half"]) expect(() => oneOf(text), text).toThrow();
});
