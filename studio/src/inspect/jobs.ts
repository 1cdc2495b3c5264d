// What is computed beside the page: one bar that says how far it is, one button that ends it.

import type { Beside } from "../kernel/module";
import { h } from "../ui/dom";
import { say, t } from "../ui/language";
import { notify, refuse } from "../ui/toast";

export class Jobs {
    readonly progress = h("progress", { max: 1, value: 0, hidden: true, "aria-label": say(t("Fortschritt", "Progress")) });
    readonly stop = h("button", { hidden: true, onclick: () => { this.cancel(); } }, say(t("Abbrechen", "Cancel")));
    private readonly running = new Map<string, Beside<unknown>>();

    /** Begins a job instead of the one of this name. `ended` is told what it found: nothing if it was cancelled or refused. */
    begin<T>(name: string, make: (progress: (part: number) => void) => Beside<T>, ended: (found: T | undefined) => void): void {
        this.end(name);
        this.progress.removeAttribute("value");
        const job = make((part) => { if (this.running.get(name) === job) this.progress.value = part; });
        const over = (found: T | undefined): void => {
            if (this.running.get(name) !== job) return;
            this.running.delete(name);
            this.tell();
            ended(found);
        };
        this.running.set(name, job);
        this.tell();
        job.done.then(over).catch((error: unknown) => {
            // Of a job that another one took the place of nobody waits for an answer.
            if (!(error instanceof DOMException)) refuse(error);
            over(undefined);
        });
    }

    is(name: string): boolean { return this.running.has(name); }

    /** Ends a job whose answer nobody waits for any more. */
    end(name: string): void {
        const job = this.running.get(name);
        this.running.delete(name);
        job?.cancel();
        this.tell();
    }

    endAll(): void { for (const name of [...this.running.keys()]) this.end(name); }

    /** The reader does not want to wait. */
    private cancel(): void {
        notify(say(t("Abgebrochen", "Cancelled")));
        for (const job of [...this.running.values()]) job.cancel();
    }

    private tell(): void { this.progress.hidden = this.stop.hidden = this.running.size === 0; }
}
