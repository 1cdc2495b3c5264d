// Formulas as MathML from one line of text: letters, numbers and signs stand for themselves, `_` and `^` set the next
// item low or high, braces group, `frac{a}{b}`, `binom{n}{i}`, `sqrt{x}`, `bar{x}`, "text" upright, `sum`, `int`, `prod` large,
// and [a b; c d] is a matrix of items without spaces.

type Tokens = { text: string; at: number };

const kLarge: Record<string, string> = { sum: "∑", int: "∫", prod: "∏" };
const escape = (x: string): string => x.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");

export function formula(text: string): string {
    return text.trim().split("\n").map((line) => `<math display="block">${row({ text: line, at: 0 }, "")}</math>`).join("");
}

function row(t: Tokens, end: string): string {
    let out = "";
    while (t.at < t.text.length && !end.includes(t.text[t.at] ?? " ")) {
        if (t.text[t.at] === " ") { ++t.at; continue; }
        out += scripted(t);
    }
    return `<mrow>${out}</mrow>`;
}

function scripted(t: Tokens): string {
    let base = item(t), low = "", high = "";
    const large = base.startsWith("<mo data-large");
    for (let mark = t.text[t.at]; mark === "_" || mark === "^"; mark = t.text[t.at]) {
        ++t.at;
        if (mark === "_") low = item(t);
        else high = item(t);
    }
    base = base.replace("<mo data-large>", "<mo>");
    const under = large && base.includes("∑");
    if (low && high) return under ? `<munderover>${base}${low}${high}</munderover>` : `<msubsup>${base}${low}${high}</msubsup>`;
    if (low) return under ? `<munder>${base}${low}</munder>` : `<msub>${base}${low}</msub>`;
    return high ? `<msup>${base}${high}</msup>` : base;
}

function group(t: Tokens): string {
    ++t.at;
    const inner = row(t, "}");
    ++t.at;
    return inner;
}

function item(t: Tokens): string {
    const rest = t.text.slice(t.at);
    const c = rest[0] ?? "";
    if (c === "{") return group(t);
    if (c === "[") return matrix(t);
    const quoted = /^"([^"]*)"/.exec(rest);
    if (quoted) { t.at += quoted[0].length; return `<mtext>${escape(quoted[1] ?? "")}</mtext>`; }
    const word = /^(frac|binom|sqrt|bar|sum|int|prod)/.exec(rest)?.[0];
    if (word) {
        t.at += word.length;
        const large = kLarge[word];
        if (large) return `<mo data-large>${large}</mo>`;
        if (word === "sqrt") return `<msqrt>${group(t)}</msqrt>`;
        if (word === "bar") return `<mover>${group(t)}<mo>‾</mo></mover>`;
        const parts = [group(t), group(t)];
        return word === "frac" ? `<mfrac>${parts.join("")}</mfrac>` : table(parts.map((x) => [x]));
    }
    const number = /^\d+(\.\d+)?/.exec(rest)?.[0];
    if (number) { t.at += number.length; return `<mn>${number}</mn>`; }
    ++t.at;
    return /\p{L}/u.test(c) ? `<mi>${c}</mi>` : `<mo${"()|‖".includes(c) ? ' stretchy="false"' : ""}>${escape(c === "-" ? "−" : c)}</mo>`;
}

function matrix(t: Tokens): string {
    const end = t.text.indexOf("]", t.at);
    const rows = t.text.slice(t.at + 1, end).split(";").map((line) => line.trim().split(/\s+/));
    t.at = end + 1;
    return table(rows.map((line) => line.map((x) => row({ text: x, at: 0 }, ""))));
}

/** In brackets that style.css draws: signs that stretch need a font for formulas, which not every machine has. */
function table(rows: readonly (readonly string[])[]): string {
    const cells = rows.map((line) => `<mtr>${line.map((x) => `<mtd>${x}</mtd>`).join("")}</mtr>`);
    return `<mtable class="matrix">${cells.join("")}</mtable>`;
}
