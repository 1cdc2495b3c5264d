// The frame of the studio: what stands on top, and what the address asks for below it.

import "./style.css";
import { edit } from "./edit/editor";
import { explore, type Shown } from "./explore/explore";
import { inspect } from "./inspect/inspect";
import { start } from "./kernel/module";
import { h } from "./ui/dom";
import { droppable, type Opened } from "./ui/files";
import { language, say, speak, t } from "./ui/language";
import { address, parse, type Place } from "./ui/router";
import { show, theme, wear } from "./ui/theme";
import { refuse } from "./ui/toast";

const app = document.querySelector("#app") ?? document.body;
const main = h("main", { id: "main", tabindex: -1 });
let shown: Shown | undefined;
/** A document or file on its way from one part to another. */
let carried: string | Opened | undefined;

const kParts = [
    { view: "explore", name: t("Entdecken", "Explore") }, { view: "edit", name: t("Bearbeiten", "Edit") },
    { view: "inspect", name: t("Untersuchen", "Inspect") }] as const;

function top(place: Place): HTMLElement {
    const other = language() === "de" ? "en" : "de";
    return h("header", { class: "top" },
        h("a", { class: "skip", href: "#main", onclick: (event: Event) => { event.preventDefault(); main.focus(); } }, say(t("Zum Inhalt", "Skip to content"))),
        h("a", { class: "brand", href: address({ view: "explore", page: "" }) }, h("img", { src: "./icon.svg", alt: "", width: 24, height: 24 }), "freiform studio"),
        h("nav", { "aria-label": say(t("Teile", "Parts")) }, ...kParts.map(({ view, name }) =>
            h("a", { href: address({ view, page: "" }), "aria-current": place.view === view ? "page" : null }, say(name)))),
        h("button", { lang: other, onclick: () => { speak(other); build(); } }, other === "de" ? "Deutsch" : "English"),
        h("button", { "aria-label": say(t("Hell oder dunkel", "Light or dark")), title: say(t("Hell oder dunkel", "Light or dark")),
            onclick: () => { wear(theme() === "dark" ? "light" : "dark"); } }, "◐"));
}

function carry(what: string | Opened): void { carried = what; }
function look(what: string | Opened): void { carry(what); location.hash = "#/inspect"; }

function body(place: Place): Shown {
    const taken = carried;
    carried = undefined;
    if (place.view === "edit") return edit(typeof taken === "string" ? taken : undefined, look);
    if (place.view === "inspect") return inspect(taken, (text) => { carry(text); location.hash = "#/edit"; });
    const shown = explore(place.page, carry);
    droppable(shown.element, look);
    return shown;
}

function build(): void {
    const place = parse(location.hash);
    shown?.dispose();
    shown = undefined;
    main.className = place.view === "explore" ? "" : "fixed";
    try {
        shown = body(place);
        main.replaceChildren(shown.element);
    } catch (error) {
        main.replaceChildren();
        refuse(error);
    }
    app.replaceChildren(top(place), main);
    const part = kParts.find(({ view }) => view === place.view);
    document.title = `${place.page === "" ? say(part?.name ?? t("", "")) : place.page} · freiform studio`;
}

async function begin(): Promise<void> {
    speak(language());
    show();
    app.replaceChildren(h("p", { class: "loading", role: "status" }, say(t("Die Bibliothek wird geladen …", "Loading the library …"))));
    await start();
    // A file that the program was opened with is what the reader wants to see first.
    if (location.hash === "" && (await fetch("./view.json").catch(() => undefined))?.headers.get("content-type")?.includes("json")) location.hash = "#/inspect";
    build();
    window.addEventListener("hashchange", build);
    if ("serviceWorker" in navigator && import.meta.env.PROD) navigator.serviceWorker.register("./sw.js").catch(() => undefined);
}

begin().catch((error: unknown) => {
    app.replaceChildren(h("p", { class: "loading" }, say(t("Die Bibliothek ließ sich nicht laden.", "The library could not be loaded."))));
    refuse(error);
});
