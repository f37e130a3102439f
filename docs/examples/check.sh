#!/bin/sh
# check.sh PROGRAM SOURCE EXPECTED PAGE: the example prints what is promised, and the page shows its
# main function as it is. Prints TAP.
program=$1 source=$2 expected=$3 page=$4
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
status=0
echo 1..2

if "$program" >"$folder/output" && diff -u "$expected" "$folder/output" >"$folder/diff"; then
    echo "ok 1 - prints what is promised"
else
    echo "not ok 1 - prints what is promised"
    sed 's/^/# /' "$folder/diff"
    status=1
fi

awk '/^```c$/ { inside = 1; next } /^```$/ { inside = 0 } inside' "$page" >"$folder/shown"
sed -n '/^int main/,$p' "$source" >"$folder/source"
if diff -u "$folder/source" "$folder/shown" >"$folder/diff"; then
    echo "ok 2 - the page shows it as it is"
else
    echo "not ok 2 - the page shows it as it is"
    sed 's/^/# /' "$folder/diff"
    status=1
fi
exit $status
