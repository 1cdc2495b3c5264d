// Messages at the lower edge. Refusals stay until they are closed and show what kind, where and why.

import { h, set } from "./dom";
import { say, t, type Text } from "./language";

const kTexts = {
    close: t("Schließen", "Close"),
    where: t("wo", "where"),
    messages: t("Meldungen", "messages"),
    lacking: t("ausgelassen", "left out"),
};

/** The kinds of refusals, as the library and the pages name them. */
const kKinds: Readonly<Record<string, Text>> = {
    invalid: t("ungültig", "invalid"),
    nonfinite: t("keine endliche Zahl", "nonfinite"),
    out_of_domain: t("außerhalb des Definitionsbereichs", "out of domain"),
    unreadable: t("unlesbar", "unreadable"),
    unsupported: t("nicht unterstützt", "unsupported"),
    unavailable: t("nicht vorhanden", "unavailable"),
    limit: t("Grenze erreicht", "limit"),
    not_converged: t("nicht konvergiert", "not converged"),
    ill_conditioned: t("schlecht konditioniert", "ill-conditioned"),
    no_answer: t("keine Antwort", "no answer"),
    io: t("Lesen und Schreiben", "reading and writing"),
    "left out": kTexts.lacking,
    usage: t("Bedienung", "usage"),
    error: t("Fehler", "error"),
};

/** In the language of the page; what has no name here stays. */
export const kindNamed = (kind: string): string => (Object.hasOwn(kKinds, kind) ? say(kKinds[kind] ?? t(kind, kind)) : kind);

const kMostTold = 5;

let box: HTMLElement | undefined;

function host(): HTMLElement {
    box ??= h("div", { class: "toasts", role: "region", "aria-live": "polite" });
    set(box, "aria-label", say(kTexts.messages));
    if (!box.isConnected) document.body.append(box);
    return box;
}

function add(element: HTMLElement): void {
    const list = host();
    list.append(element);
    while (list.children.length > 4) list.firstElementChild?.remove();
}

export interface Refusal { readonly kind: string; readonly where: string; readonly message: string }

/** Any thrown thing as kind, where and message. */
export function refusal(error: unknown): Refusal {
    const it = (error ?? {}) as Partial<Record<"kind" | "where" | "reason" | "message" | "name", unknown>>;
    const word = (x: unknown): string => (typeof x === "string" ? x : "");
    return { kind: word(it.kind) || word(it.name) || "error", where: word(it.where), message: word(it.reason) || word(it.message) || String(error) };
}

export function refuse(error: unknown): void {
    const { kind, where, message } = refusal(error);
    const element = h("div", { class: "toast refused", role: "alert" },
        h("div", {}, h("strong", {}, kindNamed(kind)), where !== "" && h("span", { class: "where" }, `${say(kTexts.where)}: ${where}`)),
        h("p", {}, message));
    element.append(h("button", { class: "close", "aria-label": say(kTexts.close), onclick: () => { element.remove(); } }, "×"));
    add(element);
}

/** Tells once what a file was made or read without; nothing if it is whole. */
export function lacking(file: string, list: readonly { readonly where: string; readonly message: string }[]): void {
    if (list.length === 0) return;
    const some = list.slice(0, kMostTold).map(({ where, message }) => `${where}: ${message}`), more = list.length - some.length;
    refuse({ kind: say(kTexts.lacking), where: file, message: [...some, ...(more > 0 ? [say(t(`und ${more} weitere`, `and ${more} more`))] : [])].join("; ") });
}

export function notify(text: string): void {
    const element = h("div", { class: "toast", role: "status" }, h("p", {}, text));
    add(element);
    setTimeout(() => { element.remove(); }, 4000);
}
