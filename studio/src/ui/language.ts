// German and English. A text is a pair; the whole page is built anew when the language changes.

export interface Text { readonly de: string; readonly en: string }
export type Language = keyof Text;

const kKey = "freiform.language";

function first(): Language {
    const stored = localStorage.getItem(kKey);
    if (stored === "de" || stored === "en") return stored;
    return navigator.language.toLowerCase().startsWith("de") ? "de" : "en";
}

let current: Language = typeof localStorage === "undefined" ? "en" : first();

export const language = (): Language => current;

export function speak(language: Language): void {
    current = language;
    localStorage.setItem(kKey, language);
    document.documentElement.lang = language;
}

/** The text in the language of the page. */
export const say = (text: Text): string => text[current];

/** A number of things: one of them has a word of its own. */
export const counted = (n: number, one: Text, more: Text): string => `${n} ${say(n === 1 ? one : more)}`;

const kKeys: Readonly<Record<string, string>> = { Ctrl: "Strg", Shift: "Umschalt", Del: "Entf", Home: "Pos1", Space: "Leertaste", Enter: "Eingabe", arrows: "Pfeile", drag: "Ziehen" };

/** Names of keys as they stand on keyboards of the language. */
export const keyed = (keys: string): string => (current === "de" ? keys.replace(/[A-Za-z]+/g, (word) => kKeys[word] ?? word) : keys);

/** A pair of texts, German first. */
export const t = (de: string, en: string): Text => ({ de, en });
