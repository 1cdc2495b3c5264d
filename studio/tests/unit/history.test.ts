import { expect, test } from "vitest";
import { History } from "../../src/edit/history";

test("undo and redo return to the same states, however many", () => {
    const history = new History(0);
    for (let i = 1; i <= 5000; ++i) history.put(`to ${i}`, i);
    for (let i = 4999; i >= 0; --i) { expect(history.undo()).toBe(true); expect(history.state).toBe(i); }
    expect(history.undo()).toBe(false);
    for (let i = 1; i <= 5000; ++i) { expect(history.redo()).toBe(true); expect(history.state).toBe(i); }
    expect(history.redo()).toBe(false);
});

test("a drag is one step", () => {
    const seen: [number, boolean][] = [];
    const history = new History(0, (state, settled) => seen.push([state, settled]));
    history.begin();
    for (let i = 1; i <= 9; ++i) history.put("drag", i);
    history.end();
    expect(history.state).toBe(9);
    expect(seen.filter(([, settled]) => settled)).toEqual([[9, true]]);
    history.undo();
    expect(history.state).toBe(0);
    history.redo();
    expect(history.state).toBe(9);
});

test("a drag that moved nothing leaves no step", () => {
    const history = new History("a");
    history.begin();
    history.end();
    expect(history.names).toEqual({ undo: undefined, redo: undefined });
});

test("a new state forgets what was undone", () => {
    const history = new History(0);
    history.put("one", 1);
    history.undo();
    history.put("two", 2);
    expect(history.redo()).toBe(false);
    expect(history.names.undo).toBe("two");
});

test("undo during a drag ends it first", () => {
    const history = new History(0);
    history.begin();
    history.put("drag", 1);
    history.undo();
    expect(history.state).toBe(0);
    expect(history.busy).toBe(false);
});

test("what was kept and is read late lies below the steps that are there already", () => {
    const history = new History("first");
    history.put("open", "handed over");
    history.root("kept");
    expect(history.state).toBe("handed over");
    history.undo();
    expect(history.state).toBe("kept");
    expect(history.undo()).toBe(false);
});

test("what was taken back during a drag is not carried on", () => {
    const history = new History(0);
    history.begin();
    history.carry("drag", 1);
    history.undo();
    history.carry("drag", 2);
    history.end();
    expect(history.state).toBe(0);
    expect(history.names).toEqual({ undo: undefined, redo: "drag" });
    history.begin();
    history.carry("drag", 3);
    history.end();
    expect(history.state).toBe(3);
});
