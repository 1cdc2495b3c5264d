// Files come in by a button or by dropping them anywhere on a part of the page: one, or an assembly with the files that
// its parts are in, also as a folder.

import { filesNamedIn } from "freiform";
import { h } from "./dom";
import { keyed, say, t } from "./language";
import { refuse } from "./toast";

export interface Opened {
    readonly name: string;
    readonly source: string | Uint8Array;
    /** Files that this one may name, by their paths from its folder. */
    readonly beside: Record<string, Uint8Array>;
}

/** A file, and its path from what was dropped. */
interface Given { readonly path: string; readonly file: File }

const kText = /\.(json|svg|obj|map|bpt|txt|csv)$/i;
const kProgram = /\.(iges|igs|brep|brp|3dm|bv)$/i;
const kModel = /\.(step|stp)$/i;
const kMostBytes = 256 * 2 ** 20;
const kMostFiles = 10_000;

const refusal = (kind: string, where: string, message: string): Error => Object.assign(new Error(message), { kind, where });

async function contentOf({ path, file }: Given): Promise<string | Uint8Array> {
    if (kProgram.test(path)) throw refusal("unsupported", path, say(t(`Diese Art von Datei liest das Programm: freiform view ${path}`, `This kind of file is read by the program: freiform view ${path}`)));
    return kText.test(path) ? file.text() : new Uint8Array(await file.arrayBuffer());
}

const lastOf = (path: string): string => path.slice(path.lastIndexOf("/") + 1);
const alike = (path: string): string => lastOf(path).toLowerCase();

/** The one of the files that the others belong to, with those. */
async function read(given: readonly Given[]): Promise<Opened> {
    if (given.reduce((sum, { file }) => sum + file.size, 0) > kMostBytes)
        throw refusal("limit", given[0]?.path ?? "", given.length === 1 ? say(t("Die Datei ist größer als 256 MiB.", "The file is larger than 256 MiB.")) : say(t("Die Dateien sind größer als 256 MiB.", "The files are larger than 256 MiB.")));
    const files = await Promise.all(given.map(async (g) => ({ path: g.path, content: await contentOf(g) })));
    const named = files.map(({ path, content }) => new Set(kModel.test(path) ? filesNamedIn(content).map(alike) : []));
    const first = files.filter((one) => !files.some((other, i) => other !== one && named[i]?.has(alike(one.path))));
    if (first.length > 1) throw refusal("invalid", first.map(({ path }) => path).join(", "), say(t("Diese Dateien gehören nicht zusammen; eine wird geöffnet.", "These files do not belong together; one is opened at a time.")));
    const whole = first[0] ?? files[0];
    if (!whole) throw refusal("invalid", "", say(t("Hier ist keine STEP-Datei.", "There is no STEP file here.")));
    const folder = whole.path.slice(0, whole.path.length - lastOf(whole.path).length);
    const beside: Record<string, Uint8Array> = {};
    for (const { path, content } of files)
        if (path !== whole.path && typeof content !== "string") beside[path.startsWith(folder) ? path.slice(folder.length) : lastOf(path)] = content;
    return { name: lastOf(whole.path), source: whole.content, beside };
}

/** What is in a folder, and below it, of the files that may belong together. */
async function filesIn(entry: FileSystemEntry, path: string, out: Given[]): Promise<void> {
    if (entry.isFile) {
        if (kModel.test(entry.name)) out.push({ path, file: await new Promise<File>((take, fail) => { (entry as FileSystemFileEntry).file(take, fail); }) });
        if (out.length > kMostFiles) throw refusal("limit", path, say(t("Das sind zu viele Dateien.", "These are too many files.")));
        return;
    }
    const reader = (entry as FileSystemDirectoryEntry).createReader();
    for (;;) {  // it tells a hundred at a time
        const some = await new Promise<FileSystemEntry[]>((take, fail) => { reader.readEntries(take, fail); });
        if (some.length === 0) return;
        for (const one of some) await filesIn(one, `${path}/${one.name}`, out);
    }
}

/** REQUIRES the drop to be under way: later nothing is known of folders. */
function dropped(transfer: DataTransfer): Promise<Given[]> {
    const folders = Array.from(transfer.items, (item) => item.webkitGetAsEntry()).filter((entry) => entry?.isDirectory === true);
    const names = new Set(folders.map((entry) => entry?.name));
    const out = Array.from(transfer.files).filter((file) => !names.has(file.name)).map((file) => ({ path: file.name, file }));
    return folders.reduce(async (before, entry) => { await before; if (entry) await filesIn(entry, entry.name, out); return out; }, Promise.resolve(out));
}

/** Whether what comes from this file is looked at, not edited. */
export const isModel = (opened: Opened): boolean => kModel.test(opened.name);

/** A button that opens a file, or several that belong together. */
export function opener(open: (file: Opened) => void): HTMLElement {
    const input = h("input", { type: "file", hidden: true, multiple: true, accept: ".json,.step,.stp,.bpt,.svg,.obj,.bsp,.map", onchange: () => {
        const given = Array.from(input.files ?? [], (file) => ({ path: file.name, file }));
        input.value = "";
        if (given.length > 0) read(given).then(open).catch(refuse);
    } });
    return h("span", {}, input, h("button", { title: keyed("Ctrl+O"), "data-open": true, onclick: () => { input.click(); } }, say(t("Öffnen …", "Open …"))));
}

/** Files dropped on an element are opened. */
export function droppable(element: HTMLElement, open: (file: Opened) => void): void {
    element.addEventListener("dragover", (event) => { event.preventDefault(); element.classList.add("drop"); });
    element.addEventListener("dragleave", () => { element.classList.remove("drop"); });
    element.addEventListener("drop", (event) => {
        event.preventDefault();
        element.classList.remove("drop");
        const { dataTransfer } = event;
        if (dataTransfer && Array.from(dataTransfer.items).some(({ kind }) => kind === "file")) dropped(dataTransfer).then(read).then(open).catch(refuse);
    });
}
