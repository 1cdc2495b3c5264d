import { expect, test } from "vitest";
import type { Document } from "../../src/edit/document";
import { Selection, successors } from "../../src/edit/selection";

const line = (name: string, x = 0) => ({ type: "curve" as const, name, points: [[x, 0], [x + 1, 1]] });
const a = line("A"), b = line("B"), c = line("C");
const of = (...objects: Document["objects"]): Document => ({ objects });

test("what is chosen follows its object", () => {
    const selection = new Selection();
    selection.objects.add(0);
    selection.add({ object: 0, point: 1 });
    selection.follow(of(b, c), of(a, b, c));
    expect([...selection.objects]).toEqual([1]);
    expect(selection.places).toEqual([{ object: 1, point: 1 }]);
    selection.follow(of(a, b, c), of(a, c));
    expect(selection.objects.size + selection.size).toBe(0);
});

test("a changed object is where it was; one of another name is another", () => {
    expect(successors([a, b, c], [a, line("B", 5), c])).toEqual([[0], [1], [2]]);
    expect(successors([a, b], [line("A", 1), line("B", 1), c])).toEqual([[0], [1]]);
    expect(successors([a, b, c], [a, line("X"), c])).toEqual([[0], [], [2]]);
    expect(successors([a, a, b], [{ ...a }, { ...a }, b])).toEqual([[0], [1], [2]]);
});

test("pieces are what the whole was, and the whole what they were", () => {
    const pieces = [line("B.a"), line("B.b", 1)];
    expect(successors([a, b, c], [a, ...pieces, c])).toEqual([[0], [1, 2], [3]]);
    expect(successors([a, ...pieces, c], [a, b, c])).toEqual([[0], [1], [1], [2]]);
});

test("points that are gone are not chosen", () => {
    const selection = new Selection();
    selection.add({ object: 0, point: 2 });
    selection.follow(of({ ...a, points: [[0, 0], [1, 1], [2, 0]] }), of(a));
    expect(selection.size).toBe(0);
});
