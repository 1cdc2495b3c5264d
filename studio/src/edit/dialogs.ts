// What the editor asks and tells in a box of its own.

import { h } from "../ui/dom";
import { keyed, say, t, type Text } from "../ui/language";
import { refusal } from "../ui/toast";
import { kHelp } from "./keys";
import { numbersOf } from "./numbers";

function open(label: Text, ...children: HTMLElement[]): void {
    const dialog = h("dialog", { "aria-label": say(label) }, ...children);
    dialog.addEventListener("close", () => { dialog.remove(); });
    document.body.append(dialog);
    dialog.showModal();
}

/** Numbers; what is refused is told beside them and may be mended. */
export function askNumbers(label: Text, first: string, act: (numbers: number[]) => void): void {
    const input = h("input", { type: "text", value: first, "aria-label": say(label), style: "width:100%" });
    const told = h("p", { role: "alert", style: "color: var(--hot)" });
    open(label, h("form", { method: "dialog", onsubmit: (event: Event) => {
        try { act(numbersOf(input.value)); } catch (error) {
            event.preventDefault();
            const { where, message } = refusal(error);
            told.textContent = `${where}: ${message}`;
        }
    } }, h("p", {}, say(label)), input, told));
    input.select();
}

export function showKeys(): void {
    const label = t("Tasten", "Keys");
    open(label, h("h2", {}, say(label)), h("table", {}, ...kHelp.map(([keys, text]) => h("tr", {}, h("td", {}, h("kbd", {}, keyed(keys))), h("td", {}, say(text))))),
        h("form", { method: "dialog" }, h("button", { class: "primary" }, say(t("Schließen", "Close")))));
}
