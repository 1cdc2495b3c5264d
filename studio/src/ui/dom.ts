// Elements in one line: h("button", {class: "x", onclick: f}, "text"). `on...` are listeners, everything else attributes;
// false, null and undefined leave an attribute out, true writes it empty.

type Child = Node | string | number | null | undefined | false;
type Value = string | number | boolean | null | undefined;
type Attributes = Record<string, Value | ((event: never) => void)>;

function dress(element: Element, attributes: Attributes, children: readonly Child[]): void {
    for (const [name, value] of Object.entries(attributes)) {
        if (name.startsWith("on")) {
            if (typeof value === "function") element.addEventListener(name.slice(2), value as EventListener);
        } else if (typeof value !== "function") set(element, name, value);
    }
    for (const child of children) {
        if (child === null || child === undefined || child === false) continue;
        element.append(child instanceof Node ? child : String(child));
    }
}

/** Writes one attribute; false, null and undefined remove it. */
export function set(element: Element, name: string, value: Value): void {
    if (value === false || value === null || value === undefined) element.removeAttribute(name);
    else element.setAttribute(name, value === true ? "" : String(value));
}

/** An HTML element. */
export function h<K extends keyof HTMLElementTagNameMap>(
    tag: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
    const element = document.createElement(tag);
    dress(element, attributes, children);
    return element;
}

/** An SVG element. */
export function s<K extends keyof SVGElementTagNameMap>(
    tag: K, attributes: Attributes = {}, ...children: Child[]): SVGElementTagNameMap[K] {
    const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
    dress(element, attributes, children);
    return element;
}

/** A number for people: `digits` significant digits, no exponent where it can be avoided. */
export function shown(x: number, digits = 4): string {
    if (x === 0) return "0";
    const size = Math.abs(x);
    return size < 1e-4 || size >= 1e7 ? x.toExponential(Math.max(0, digits - 2)) : String(Number(x.toPrecision(digits)));
}

/** Runs `f` once before the next picture, however often the result is called until then. */
export function coalesced(f: () => void): () => void {
    let waiting = false;
    return () => {
        if (waiting) return;
        waiting = true;
        requestAnimationFrame(() => { waiting = false; f(); });
    };
}

/** True where the reader asked for less motion. */
export const calm = (): boolean => matchMedia("(prefers-reduced-motion: reduce)").matches;

/** Hands bytes or text to the reader as a file. */
export function download(name: string, content: BlobPart, type: string): void {
    const url = URL.createObjectURL(new Blob([content], { type }));
    const link = h("a", { href: url, download: name });
    document.body.append(link);
    link.click();
    link.remove();
    setTimeout(() => { URL.revokeObjectURL(url); }, 10_000);
}
