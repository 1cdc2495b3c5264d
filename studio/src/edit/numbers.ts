// Numbers as people write them: with spaces or semicolons between them, or with a comma and a space.

import { say, t, type Text } from "../ui/language";

const refusal = (word: string, text: Text): Error => Object.assign(new Error(say(text)), { kind: "usage", where: word });

function numberOf(word: string): number {
    const x = Number(word);
    if (Number.isFinite(x)) return x;
    // 1,5 may be one number or two.
    if (word.includes(",")) throw refusal(word, t("Zahlen haben einen Punkt, zwischen ihnen ist ein Leerzeichen: 1.5 oder 1 5.", "Numbers have a point, and a space between them: 1.5 or 1 5."));
    throw refusal(word, t("Das ist keine Zahl.", "This is no number."));
}

/** All numbers of a text. What is none is refused. */
export const numbersOf = (text: string): number[] => text.split(/(?:[\s;]|,(?=\s|$))+/).filter((word) => word !== "").map(numberOf);

/** The number that a text is; its point may be a comma. */
export function oneOf(text: string): number {
    const word = text.trim();
    if (word === "") throw refusal("", t("Hier fehlt eine Zahl.", "A number is missing."));
    return numberOf(word.replace(/^([-+]?\d*),(\d+)$/, "$1.$2"));
}
