#!/bin/sh
# test_write_golden.sh WRITE_GOLDEN DATA: the recordings in DATA are what the program writes, in TAP.
# So nobody can change the program or the format and forget the recordings.
write_golden=$1
data=$2
n=0
failed=0
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT

"$write_golden" "$folder" >"$folder/log" || {
    sed 's/^/# /' "$folder/log"
    exit 99
}
for trace in "$data"/*.trace; do
    name=$(basename "$trace" .trace)
    [ "$name" = random_calls ] && continue # made by an older version, see README.md
    n=$((n + 1))
    if cmp "$folder/$name.trace" "$trace" >&2; then
        echo "ok $n ${name}_is_written_byte_by_byte"
    else
        echo "not ok $n ${name}_is_written_byte_by_byte"
        failed=1
    fi
    rm -f "$folder/$name.trace"
done
n=$((n + 1))
if ls "$folder"/*.trace >&2 2>/dev/null; then
    echo "not ok $n every_recording_is_in_the_folder"
    failed=1
else
    echo "ok $n every_recording_is_in_the_folder"
fi
echo "1..$n"
exit $failed
