// Light, dark, or as the machine has it. Colours live in style.css as custom properties; canvases read them by `colour`.

export type Theme = "light" | "dark";
const kKey = "freiform.theme";
const listeners = new Set<() => void>();

export function theme(): Theme {
    const stored = localStorage.getItem(kKey);
    if (stored === "light" || stored === "dark") return stored;
    return matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
}

export function wear(theme: Theme): void {
    localStorage.setItem(kKey, theme);
    show();
}

export function show(): void {
    document.documentElement.dataset["theme"] = theme();
    for (const listener of listeners) listener();
}

/** Calls `f` after every change of the theme, until the result is called. */
export function onTheme(f: () => void): () => void {
    listeners.add(f);
    return () => listeners.delete(f);
}

/** The value of a colour of style.css, such as `colour("curve")`. */
export const colour = (name: string): string =>
    getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
