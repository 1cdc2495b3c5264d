// What the editor asks and tells in a box of its own.

import { h } from "../ui/dom";
import { say, t, type Text } from "../ui/language";
import { kHelp } from "./keys";

function open(label: Text, ...children: HTMLElement[]): void {
    const dialog = h("dialog", { "aria-label": say(label) }, ...children);
    dialog.addEventListener("close", () => { dialog.remove(); });
    document.body.append(dialog);
    dialog.showModal();
}

/** Numbers with spaces or commas between them. */
export function askNumbers(label: Text, first: string, act: (numbers: number[]) => void): void {
    const input = h("input", { type: "text", value: first, "aria-label": say(label), style: "width:100%" });
    open(label, h("form", { method: "dialog", onsubmit: () => {
        const numbers = input.value.split(/[\s,;]+/).filter((x) => x !== "").map(Number);
        if (numbers.every(Number.isFinite)) act(numbers);
    } }, h("p", {}, say(label)), input));
    input.select();
}

export function showKeys(): void {
    const label = t("Tasten", "Keys");
    open(label, h("h2", {}, say(label)), h("table", {}, ...kHelp.map(([keys, text]) => h("tr", {}, h("td", {}, h("kbd", {}, keys)), h("td", {}, say(text))))),
        h("form", { method: "dialog" }, h("button", { class: "primary" }, say(t("Schließen", "Close")))));
}
