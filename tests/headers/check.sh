#!/bin/sh
# check.sh INCLUDE HEADERS COMPILER...: each header, alone in a file, compiles without a warning.
# HEADERS is one argument, names separated by blanks. Prints TAP.
include=$1 headers=$2
shift 2

# shellcheck disable=SC2086 # a list of words
set_count() { echo "1..$#"; }
# shellcheck disable=SC2086
set_count $headers

number=0 status=0
for name in $headers; do
    number=$((number + 1))
    if output=$(printf '#include <sluice/%s.h>\nextern int something;\n' "$name" | "$@" -I"$include" -fsyntax-only \
        -Wall -Wextra -Wpedantic -Wconversion -Werror - 2>&1); then
        echo "ok $number - sluice/$name.h compiles alone"
    else
        echo "not ok $number - sluice/$name.h compiles alone"
        echo "$output" | sed 's/^/# /'
        status=1
    fi
done
exit $status
