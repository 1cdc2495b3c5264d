// What outlives a visit to another part of the page and a change of language: the steps, what was copied, what is chosen.

import type { ObjectJson } from "freiform";
import { arena } from "../kernel/module";
import { refuse } from "../ui/toast";
import type { Document } from "./document";
import { History } from "./history";
import { Selection } from "./selection";
import { kept } from "./store";

export class Session {
    readonly history: History<Document>;
    readonly selection = new Selection();
    clipboard: readonly ObjectJson[] = [];
    private reading: Promise<void> | undefined;

    constructor(first: Document) { this.history = new History(first); }

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
