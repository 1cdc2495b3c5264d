#!/usr/bin/env bash
# Shows what the program does on two models and checks what it says: out/*.glb, out/*.png and a table.
# FREIFORM names the program. Fails if a bound is above the tolerance that was asked for, or if the solid is not closed.
set -euo pipefail
cd "$(dirname "$0")/.."
freiform=${FREIFORM:-build/bin/freiform}
mkdir -p out

# The value of a number in a report.
number() {
    grep -o "\"$2\": *[-+0-9.eE]*" "$1" | head -n 1 | sed 's/.*: *//'
}
fail() {
    echo "demo: $*" >&2
    exit 1
}

rows=""
# show NAME FILE TOLERANCE [closed]
show() {
    local name=$1 file=$2 tolerance=$3 kind=${4:-open} report=out/$1.json began ended
    local triangles faces open bound refused seconds
    [ -r "$file" ] || fail "$file is not there"
    began=$(date +%s%N)
    "$freiform" tessellate "$file" --tolerance "$tolerance" -o "out/$name.glb" --json >"$report" ||
        fail "tessellate $file: exit code $?: $(cat "$report")"
    ended=$(date +%s%N)
    "$freiform" draw "$file" -o "out/$name.png" || fail "draw $file: exit code $?"

    triangles=$(number "$report" triangles) faces=$(number "$report" faces)
    open=$(number "$report" open_edges) bound=$(number "$report" error_bound)
    [ -n "$triangles" ] && [ -n "$open" ] && [ -n "$bound" ] || fail "$report lacks triangles, open_edges or error_bound"
    [ "$triangles" -gt 0 ] || fail "$file: no triangles"
    awk -v b="$bound" -v t="$tolerance" 'BEGIN { exit !(b >= 0 && b <= t) }' ||
        fail "$file: the bound $bound is not within the tolerance $tolerance"
    refused=$(tr -d ' \n' <"$report" | grep -c '"refused":\[{' || true)
    [ "$refused" -eq 0 ] || fail "$file: faces were refused, see $report"
    if [ "$kind" = closed ] && [ "$open" -ne 0 ]; then
        fail "$file is a closed solid, but the mesh has $open open edges"
    fi
    seconds=$(awk -v n=$((ended - began)) 'BEGIN { printf "%.2f", n / 1e9 }')
    rows+=$(printf '%-10s %6s %10s %10s %10s %10.3g %8s' "$name" "$faces" "$triangles" "$open" "$tolerance" "$bound" "$seconds")$'\n'
}

solid=$(find examples -maxdepth 1 -name '*.step' 2>/dev/null | sort | head -n 1)
[ -n "$solid" ] || fail "no STEP file in examples/"
show teapot examples/teapot.bpt 0.001
show solid "$solid" 0.01 closed

printf '\n%-10s %6s %10s %10s %10s %10s %8s\n' model faces triangles "open edges" tolerance bound seconds
printf '%s\n' "$rows"
echo "The teapot is open by design (bottom, spout); no point of its triangles is further from the surface than the bound."
echo "Written: "
for file in out/teapot.glb out/teapot.png out/teapot.json out/solid.glb out/solid.png out/solid.json; do
    echo "  $(pwd)/$file"
done
[ "$freiform" = build/bin/freiform ] ||
    echo "This program was built quickly, with little optimisation: \`make build\` makes the fast one, build/bin/freiform."
