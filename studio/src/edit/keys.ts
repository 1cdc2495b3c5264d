// Keys that users of Inkscape, Blender and Rhino guess.

import { t, type Text } from "../ui/language";

export type Command = "undo" | "redo" | "save" | "open" | "all" | "none" | "remove" | "copy" | "cut" | "paste" | "duplicate" | "fit" | "pen" | "finish" | "help"
    | "grab" | "scale" | "rotate" | "join" | "gizmo";

const kWithControl: Record<string, Command> = { z: "undo", "shift+z": "redo", y: "redo", s: "save", o: "open", a: "all", c: "copy", x: "cut", v: "paste", d: "duplicate" };
const kAlone: Record<string, Command> = { escape: "none", delete: "remove", backspace: "remove", x: "remove", f: "fit", home: "fit", ".": "fit", b: "pen", enter: "finish", "?": "help", "shift+?": "help",
    g: "grab", s: "scale", r: "rotate", j: "join", t: "gizmo", a: "all", "shift+d": "duplicate" };

/** What a key asks for; Enter and Space on a button are the button's. */
export function keyOf(event: Pick<KeyboardEvent, "key" | "ctrlKey" | "metaKey" | "shiftKey" | "altKey"> & { target?: EventTarget | null }): Command | undefined {
    if (event.altKey) return undefined;
    const key = `${event.shiftKey ? "shift+" : ""}${event.key.toLowerCase()}`;
    if (event.ctrlKey || event.metaKey) return kWithControl[key];
    if (key === "enter" && event.target instanceof Element && event.target.closest("button, a, .handle")) return undefined;
    return kAlone[key];
}

export const kHelp: readonly (readonly [string, Text])[] = [
    ["B, Enter", t("Stift: Punkte klicken, beenden", "Pen: click points, finish")], ["Tab, arrows", t("zum nächsten Punkt, Punkt bewegen (Umschalt: zehnmal so weit)", "to the next point, move it (Shift: ten times as far)")],
    ["Enter, Space", t("Punkt wählen (Umschalt: dazu)", "choose a point (Shift: as well)")], ["Shift + drag", t("Rahmen wählt Punkte", "a frame chooses points")],
    ["G, R, S", t("verschieben, drehen, vergrößern mit Zahlen", "move, turn, scale by numbers")], ["T", t("Gizmo im Raum: Pfeile verschieben, Bögen drehen, Quadrate vergrößern", "gizmo in space: arrows move, arcs turn, squares scale")], ["J", t("zwei Kurven verbinden", "join two curves")],
    ["Ctrl+Z, Ctrl+Shift+Z", t("rückgängig, wiederholen", "undo, redo")], ["Ctrl+C, X, V, D", t("kopieren, ausschneiden, einfügen, verdoppeln", "copy, cut, paste, duplicate")],
    ["Ctrl+A, Esc", t("alles wählen, nichts wählen", "choose all, none")], ["Del, X", t("löschen", "delete")], ["Ctrl+O, Ctrl+S", t("öffnen, speichern", "open, save")],
    ["F, Home", t("alles zeigen", "show all")], ["1, 3, 7, 5", t("im Raum: vorn, rechts, oben, parallel", "in space: front, right, top, parallel")], ["Alt", t("ohne Einrasten ziehen", "drag without snapping")]];
