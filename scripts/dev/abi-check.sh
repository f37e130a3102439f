#!/usr/bin/env bash
# abi-check.sh OLD NEW [HEADERS]: compares the interface of all libraries in two folders, for example of two builds
# with debug information: abi-check.sh ../sluice-0.1.0/build/lib build/lib. Types count if they are in HEADERS (default:
# include/sluice). Needs abidiff (abigail-tools). Exit status: 0 programs go on to work; 1 they may not, as the report
# says; 2 wrong usage, or nothing to compare.
set -u
if [ $# -lt 2 ] || [ $# -gt 3 ]; then
    sed -n '2s/^# //p' "$0" >&2
    exit 2
fi
command -v abidiff >/dev/null || { echo "abi-check.sh: there is no abidiff (package abigail-tools)" >&2; exit 2; }
old=$1 new=$2 headers=${3:-$(dirname "${BASH_SOURCE[0]}")/../../include/sluice}
status=0 count=0
for library in "$old"/libsluice*.so; do
    [ -e "$library" ] || continue
    count=$((count + 1))
    name=$(basename "$library")
    if [ ! -e "$new/$name" ]; then
        echo "$name: is gone"
        status=1
        continue
    fi
    # Bits 1 and 2: abidiff failed; 4: a change; 8: a change that breaks programs. Added functions break none.
    abidiff --headers-dir1 "$headers" --headers-dir2 "$headers" --no-added-syms "$library" "$new/$name"
    result=$?
    [ $((result & 3)) -eq 0 ] || { echo "$name: abidiff failed" >&2; exit 2; }
    if [ $result -ne 0 ]; then
        status=1
        echo "$name: changed"
    else
        echo "$name: as before"
    fi
done
[ $count -gt 0 ] || { echo "abi-check.sh: $old has no libsluice*.so" >&2; exit 2; }
exit $status
