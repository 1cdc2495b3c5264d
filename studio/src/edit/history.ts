// Undo and redo without limit: states are values that share what did not change. Steps that belong together (a drag) are
// one: `begin`, any number of `put`, `end`.

export interface Entry<T> { readonly name: string; readonly state: T }

export class History<T> {
    private past: Entry<T>[];
    private future: Entry<T>[] = [];
    private before: Entry<T> | undefined;

    constructor(first: T, /** Who is told. */ public changed: (state: T, settled: boolean) => void = () => undefined) {
        this.past = [{ name: "", state: first }];
    }

    /** Between `begin` and `end`. */
    get busy(): boolean { return this.before !== undefined; }

    get state(): T { return this.last().state; }

    /** A new state; inside of begin .. end it replaces the one before. */
    put(name: string, state: T): void {
        if (Object.is(state, this.state)) return;
        if (this.before) this.past[this.past.length - 1] = { name, state };
        else this.past.push({ name, state });
        this.future = [];
        this.changed(state, this.before === undefined);
    }

    /** What was there before the first step was something else: it was read late. */
    root(first: T): void {
        this.past[0] = { name: "", state: first };
        this.changed(this.state, false);
    }

    begin(): void {
        if (this.before) return;
        this.before = this.last();
        this.past.push({ ...this.before });
    }

    /** A state that a hand carries on from `begin`. Whatever else happened since then (undo, a deletion) took it from the hand. */
    carry(name: string, state: T): void { if (this.before) this.put(name, state); }

    end(): void {
        const { before } = this;
        if (!before) return;
        this.before = undefined;
        if (Object.is(this.state, before.state)) this.past.pop();
        else this.changed(this.state, true);
    }

    undo(): boolean { return this.step(this.past, this.future, 1); }

    redo(): boolean { return this.step(this.future, this.past, 0); }

    /** What `undo` and `redo` would take back and do again; nothing if they can't. */
    get names(): { readonly undo: string | undefined; readonly redo: string | undefined } {
        return { undo: this.past.length > 1 ? this.last().name : undefined, redo: this.future[this.future.length - 1]?.name };
    }

    private step(from: Entry<T>[], to: Entry<T>[], kept: number): boolean {
        this.end();
        const entry = from.length > kept ? from.pop() : undefined;
        if (!entry) return false;
        to.push(entry);
        this.changed(this.state, true);
        return true;
    }

    private last(): Entry<T> {
        const entry = this.past[this.past.length - 1];
        if (!entry) throw new Error("a history has a first state");
        return entry;
    }
}
