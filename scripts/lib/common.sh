# Shared by the scripts: messages, folders, and running a step with its output kept in a log.
# shellcheck shell=bash

SLUICE_ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
SLUICE_BUILD=${SLUICE_BUILD:-$SLUICE_ROOT/build}
# An absolute path, because the steps run in folders of their own.
case $SLUICE_BUILD in
/*) ;;
*) SLUICE_BUILD=$PWD/$SLUICE_BUILD ;;
esac

say() { printf '%s\n' "$*"; }
title() { printf '\n== %s\n' "$*"; }
warn() { printf 'warning: %s\n' "$*" >&2; }
die() {
    printf 'error: %s\n' "$*" >&2
    exit 1
}

# The usage text of a script is the comment at its top.
usage_of() { sed -n '2,/^$/s/^# \{0,1\}//p' "$1"; }

# Every 15 seconds the last line of a log, until it is killed or the script is gone.
watch_log() {
    local from=$SECONDS
    while sleep 15 >/dev/null 2>&1 && kill -0 $$ 2>/dev/null; do
        printf '    %3s s: %.100s\n' $((SECONDS - from)) "$(tail -n 1 "$1")"
    done
}

# logged LOG COMMAND...: shows of its output only how far it is, and on failure the end of it.
# Returns its status.
logged() {
    local log=$1 status=0 watcher
    shift
    mkdir -p "$(dirname "$log")"
    : >"$log"
    watch_log "$log" &
    watcher=$!
    "$@" >"$log" 2>&1 </dev/null || status=$?
    kill "$watcher" 2>/dev/null || true
    wait "$watcher" 2>/dev/null || true
    if [ "$status" -ne 0 ]; then
        printf 'failed (%s): %s\n' "$status" "$*"
        tail -n 60 "$log" | sed 's/^/    /'
        printf '    the whole log: %s\n' "$log"
    fi
    return "$status"
}

# Under sudo the build folder would stay root's, and the next build without sudo would fail.
give_back_build() {
    if [ "$(id -u)" -eq 0 ] && [ "${SUDO_UID:-0}" -ne 0 ] && [ -d "$SLUICE_BUILD" ]; then
        chown -R "$SUDO_UID:${SUDO_GID:-$SUDO_UID}" "$SLUICE_BUILD" || true
    fi
}
