#!/bin/sh
# archives.sh NM ARCHIVE...: what the static libraries define for others to link to. Prints TAP.
#
# A name in two archives breaks a program that links both, or lets it call the wrong one. Weak symbols
# (inline functions of C++) may be there as often as wanted.
nm=$1
shift
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
status=0
echo 1..2

for archive; do
    "$nm" -g --defined-only "$archive" 2>/dev/null |
        awk -v archive="${archive##*/}" 'NF == 3 && $2 !~ /[WVu]/ { print $3, archive }'
done | sort >"$folder/symbols"

report() { # fact, whether something is in the file "found"
    number=$((number + 1))
    if [ -s "$folder/symbols" ] && [ ! -s "$folder/found" ]; then
        echo "ok $number - $1"
    else
        echo "not ok $number - $1"
        head -n 20 "$folder/found" | sed 's/^/# /'
        status=1
    fi
}

awk '{ in_archive[$1] = in_archive[$1] " " $2; count[$1]++ }
    END { for (name in count) if (count[name] > 1) print name ":" in_archive[name] }' \
    "$folder/symbols" >"$folder/found"
report "no two static libraries define the same name"

grep -v -E '^(slc_|sluice[A-Z])' "$folder/symbols" >"$folder/found"
report "static libraries define only names that begin with slc_ or sluice"
exit $status
