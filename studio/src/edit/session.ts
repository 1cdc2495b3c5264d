// What outlives a visit to another part of the page and a change of language: the steps, what was copied, what is chosen.

import type { ObjectJson } from "freiform";
import { arena } from "../kernel/module";
import { say } from "../ui/language";
import { refuse } from "../ui/toast";
import type { Document } from "./document";
import { History } from "./history";
import { Selection } from "./selection";
import { kept } from "./store";
import { kCurve } from "./words";

/** What a reader finds who never drew. */
const first = (): Document => ({ objects: [{ type: "curve", name: say(kCurve), degree: 3, knots: [0, 0, 0, 0, 1, 2, 2, 2, 2], points: [[0, 0], [1, 2.4], [3, 3], [4.4, 0.6], [6, 1.2]] }] });

export class Session {
    readonly history: History<Document>;
    readonly selection = new Selection();
    clipboard: readonly ObjectJson[] = [];
    private reading: Promise<void> | undefined;

    constructor() { this.history = new History(first()); }

    /** Puts what was kept below the steps, once. */
    restore(): Promise<void> { return this.reading ??= this.read(); }

    private async read(): Promise<void> {
        const text = await kept().catch(() => undefined);
        if (text === undefined) return;
        try {
            const state = JSON.parse(text) as Document;
            if (state.objects.length > 0) arena((make) => { state.objects.forEach((o) => make(o)); });
            this.history.root({ ...(state.unit ? { unit: state.unit } : {}), objects: state.objects });
        } catch (error) { refuse(error); }
    }
}
