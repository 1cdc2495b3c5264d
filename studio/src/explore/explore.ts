// The part of the studio that explains: a table of contents, and a page for each row.

import { h } from "../ui/dom";
import { say, t, type Text } from "../ui/language";
import { address, go } from "../ui/router";
import { formula } from "./formula";
import { kBases } from "./pages/bases";
import { kJoints } from "./pages/joints";
import { kMoving } from "./pages/moving";
import { kSplines } from "./pages/splines";
import { kSteps } from "./pages/steps";
import { kPatches } from "./pages/patches";
import { kTensors } from "./pages/tensors";
import { kUses } from "./pages/uses";
import { Stage, type Page } from "./stage";

export const kPages: readonly Page[] = [...kBases, ...kJoints, ...kSplines, ...kSteps, ...kTensors, ...kPatches, ...kUses, ...kMoving]
    .sort((a, b) => number(a) - number(b));

function number(page: Page): number { return Number(page.row.slice(1)); }

const kGroups: readonly (readonly [Text, number])[] = [
    [t("Kurven", "Curves"), 1], [t("Splines und Rationales", "Splines and rational curves"), 11], [t("Zeichnen und Messen", "Drawing and measuring"), 17],
    [t("Flächen", "Surfaces"), 21], [t("Anwendungen", "Uses"), 32]];

const groupOf = (page: Page): number => kGroups.reduce((best, [, from], i) => (number(page) >= from ? i : best), 0);

function contents(current: string): HTMLElement {
    const list = h("nav", { class: "contents", "aria-label": say(t("Inhalt", "Contents")) });
    kGroups.forEach(([title], i) => {
        list.append(h("h2", {}, say(title)), ...kPages.filter((page) => groupOf(page) === i).map((page) =>
            h("a", { href: address({ view: "explore", page: page.row }), "aria-current": page.row === current ? "page" : null },
                h("span", { class: "row" }, page.row), say(page.title))));
    });
    return list;
}

function overview(): HTMLElement {
    const box = h("div", { class: "tiles", tabindex: -1 }, h("h1", {}, say(t("Kurven und Flächen zum Anfassen", "Curves and surfaces to take hold of"))),
        h("p", {}, say(t("Jede Seite zeigt eine Sache, die sich bewegen lässt: ziehen Sie an Punkten, Gewichten und Knoten. Gerechnet wird hier im Browser, von derselben Bibliothek wie im Programm.",
            "Each page shows one thing that moves: drag points, weights and knots. All is computed here in the browser, by the same library as in the program."))));
    kGroups.forEach(([title], i) => {
        box.append(h("h2", {}, say(title)), h("div", { class: "grid-of" }, ...kPages.filter((page) => groupOf(page) === i).map((page) =>
            h("a", { class: "tile", href: address({ view: "explore", page: page.row }) },
                h("span", { class: "row" }, page.row), h("h3", {}, say(page.title)), h("p", {}, say(page.gist))))));
    });
    return box;
}

export interface Shown { readonly element: HTMLElement; dispose(): void }

/** The page of a row, or the overview; `open` takes a document to the editor. */
export function explore(row: string, open: (text: string) => void): Shown {
    const at = kPages.findIndex((page) => page.row === row);
    const page = kPages[at];
    const box = h("div", { style: "display:contents" }, contents(row));
    if (!page) {
        box.append(overview());
        return { element: box, dispose: () => undefined };
    }
    const stage = new Stage();
    page.build(stage);
    const turn = (to: Page | undefined, sign: string): HTMLElement | null => (to
        ? h("a", { class: "button", href: address({ view: "explore", page: to.row }), rel: sign === "←" ? "prev" : "next" },
            sign === "←" ? `← ${to.row}` : `${to.row} →`) : h("span"));
    const side = h("aside", { class: "side", "aria-label": say(page.title) },
        h("div", {}, h("span", { class: "hint" }, page.row), h("h1", {}, say(page.title))), h("p", { class: "text" }, say(page.text)));
    if (page.formula) {
        const math = h("div", { class: "formula" });
        math.innerHTML = formula(page.formula);
        side.append(math);
    }
    side.append(stage.knobs);
    const opened = stage.opened;
    if (opened) side.append(h("button", { class: "primary", onclick: () => { open(JSON.stringify(opened())); go({ view: "edit", page: "" }); } },
        say(t("Im Editor öffnen", "Open in editor"))));
    side.append(h("div", { class: "turn" }, turn(kPages[at - 1], "←"), turn(kPages[at + 1], "→")));
    box.append(h("article", { class: "page", "aria-label": say(page.title) }, stage.figures, side));
    stage.changed();
    return { element: box, dispose: () => { stage.dispose(); } };
}
