# For sourcing: `step TEXT COMMAND...` says what is done and how long it took; a step that fails ends the script.
steps_began=$(date +%s)

step() {
    local what=$1 began now
    shift
    began=$(date +%s)
    printf '\n==> %s\n' "$what"
    if ! "$@"; then
        printf '==> FAILED: %s\n' "$what" >&2
        exit 1
    fi
    now=$(date +%s)
    printf '==> %s: %d s (%d s since the start)\n' "$what" $((now - began)) $((now - steps_began))
}
