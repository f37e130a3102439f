#!/bin/sh
# check_info.sh SLUICE-INFO ROOT: what it prints of files is the same on every system. Prints TAP.
#
# info.expected is what the program prints on x86-64 Linux.
info=$(realpath "$1") root=$2
echo 1..2
cd "$root/tests/container/data" || exit 1
# shellcheck disable=SC2086 # the wrapper is a command with its arguments, or empty
difference=$(for file in nvtt_bc1.dds nvtt_rgb.dds parse_rgba.ktx2; do
    $MESON_EXE_WRAPPER "$info" --json "$file"
done 2>&1 | tr -d '\r' | diff "$root/tests/cross/info.expected" -)
if [ -z "$difference" ]; then
    echo "ok 1 - files_are_described_as_on_linux"
else
    echo "not ok 1 - files_are_described_as_on_linux"
    printf '%s\n' "$difference" | sed 's/^/# /'
fi
# shellcheck disable=SC2086
message=$($MESON_EXE_WRAPPER "$info" no-such-file.dds 2>&1)
if [ $? = 1 ] && [ "${message#*no-such-file.dds}" != "$message" ]; then
    echo "ok 2 - a_missing_file_is_an_error_that_names_it"
else
    echo "not ok 2 - a_missing_file_is_an_error_that_names_it"
    printf '%s\n' "$message" | sed 's/^/# /'
fi
