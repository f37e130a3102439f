#!/bin/sh
# update_golden.sh WRITE_GOLDEN SLUICE_REPLAY DATA TRACES: writes the golden replays of tests/data anew.
# Read the diff before committing it.
set -eu
write_golden=$1
replay=$2
data=$3
traces=${SLUICE_TEST_DATA:+$SLUICE_TEST_DATA/../replay/traces}
traces=${traces:-$4}

mkdir -p "$data"
"$write_golden" "$data" >/dev/null
for trace in "$data"/*.trace; do
    "$replay" "$trace" --heap-tiles 1024 --standby 1000 --dump >"${trace%.trace}.expected"
done
for trace in "$traces"/*.slt; do
    [ -f "$trace" ] || continue
    "$replay" "$trace" --heap-tiles 1024 --standby 1000 | grep '^hash ' >"$data/$(basename "$trace" .slt).hash"
done
