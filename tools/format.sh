#!/usr/bin/env bash
# tools/format.sh [--check]: formats every C++ file of the repository, or says which are not formatted.
# clang-format 14 is the judge (Debian 12); other versions differ in details.
set -euo pipefail
cd "$(dirname "$0")/.."
mode=(-i)
[ "${1:-}" != --check ] || mode=(--dry-run --Werror)
git ls-files -z --cached --others --exclude-standard -- '*.cpp' '*.hpp' '*.inl' |
    xargs -0 -r "${CLANG_FORMAT:-clang-format}" "${mode[@]}"
