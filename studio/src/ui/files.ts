// Files come in by a button or by dropping them anywhere on a part of the page.

import { h } from "./dom";
import { say, t } from "./language";
import { refuse } from "./toast";

export interface Opened { readonly name: string; readonly source: string | Uint8Array }

const kText = /\.(json|svg|obj|map|bpt|txt|csv)$/i;
const kProgram = /\.(iges|igs|brep|brp|3dm|bv)$/i;
const kModel = /\.(step|stp)$/i;
const kMostBytes = 256 * 2 ** 20;

async function read(file: File): Promise<Opened> {
    if (kProgram.test(file.name)) {
        throw Object.assign(new Error(say(t(`Diese Art von Datei liest das Programm: freiform view ${file.name}`, `This kind of file is read by the program: freiform view ${file.name}`))),
            { kind: "unsupported", where: file.name });
    }
    if (file.size > kMostBytes) throw Object.assign(new Error(say(t("Die Datei ist größer als 256 MiB.", "The file is larger than 256 MiB."))), { kind: "limit", where: file.name });
    return { name: file.name, source: kText.test(file.name) ? await file.text() : new Uint8Array(await file.arrayBuffer()) };
}

/** Whether what comes from this file is looked at, not edited. */
export const isModel = (opened: Opened): boolean => kModel.test(opened.name);

/** A button that opens a file. */
export function opener(open: (file: Opened) => void): HTMLElement {
    const input = h("input", { type: "file", hidden: true, accept: ".json,.step,.stp,.bpt,.svg,.obj,.bsp,.map", onchange: () => {
        const file = input.files?.[0];
        input.value = "";
        if (file) read(file).then(open).catch(refuse);
    } });
    return h("span", {}, input, h("button", { title: "Ctrl+O", "data-open": true, onclick: () => { input.click(); } }, say(t("Öffnen …", "Open …"))));
}

/** Files dropped on an element are opened. */
export function droppable(element: HTMLElement, open: (file: Opened) => void): void {
    element.addEventListener("dragover", (event) => { event.preventDefault(); element.classList.add("drop"); });
    element.addEventListener("dragleave", () => { element.classList.remove("drop"); });
    element.addEventListener("drop", (event) => {
        event.preventDefault();
        element.classList.remove("drop");
        const file = event.dataTransfer?.files[0];
        if (file) read(file).then(open).catch(refuse);
    });
}
