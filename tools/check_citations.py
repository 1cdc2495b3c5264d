#!/usr/bin/env python3
"""Fails if a citation such as [PT97, A5.1] or [Lyche & Morken 2018] is not in docs/references.bib.

The key of an entry is the citation without spaces and signs: LycheMorken2018. "et al." stands for any further names.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
# [Name 1989], [Name & Other 1989, Theorem 2] or [PT97, A5.1]; several in one pair of brackets are parted by ";".
# The text of a Markdown link, [...](...), is no citation.
CITATION = re.compile(r"\[([A-Z][^\[\]\n]*?(?:\b\d{4}[a-z]?|[A-Z]\d\d)(?:[,;][^\[\]\n]*)?)\](?!\()")
ONE = re.compile(r"([A-Z][^,;\d]*?)\s*(\d{4}[a-z]?|\d\d)\b")


def keys(text):
    """(key, has 'et al.') of each citation between one pair of brackets."""
    for part in text.split(";"):
        m = ONE.match(part.strip()) or ONE.search(part)
        # "Cohen, Lyche & Riesenfeld 1980" has a comma between names.
        whole = re.match(r"\s*([A-Z][^\d;]*?)\s*(\d{4}[a-z]?|\d\d)\b", part)
        m = whole or m
        if m:
            names = re.sub(r"\bet al\.?|\band\b", "", m[1])
            yield re.sub(r"[^A-Za-z]", "", names) + m[2], "et al" in m[1]


def is_known(key, et_al, known):
    if key in known:
        return True
    m = re.fullmatch(r"([A-Za-z]+?)(\d+[a-z]?)", key)
    return et_al and any(k.startswith(m[1]) and k.endswith(m[2]) for k in known)


def main():
    known = set(re.findall(r"^@\w+\{([^,\s]+),", (ROOT / "docs/references.bib").read_text(), re.M))
    problems, count = [], 0
    for top in ("include", "src", "apps", "tests", "docs", "bindings"):
        for path in sorted((ROOT / top).rglob("*")):
            if path.suffix not in (".hpp", ".cpp", ".inl", ".md"):
                continue
            for number, line in enumerate(path.read_text().split("\n"), 1):
                for citation in CITATION.finditer(line):
                    for key, et_al in keys(citation[1]):
                        count += 1
                        if not is_known(key, et_al, known):
                            problems.append(f"{path.relative_to(ROOT)}:{number}: [{citation[1]}]: no {key} in docs/references.bib")
    print("\n".join(problems) or f"{count} citations, {len(known)} references: all are known")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
