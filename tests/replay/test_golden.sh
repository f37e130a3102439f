#!/bin/sh
# test_golden.sh SLUICE_REPLAY DATA TRACES: every golden replay, in TAP.
replay=$1
data=$2
# The folder of the other test data may be elsewhere, then so are the traces.
traces=${SLUICE_TEST_DATA:+$SLUICE_TEST_DATA/../replay/traces}
traces=${traces:-$3}
n=0
failed=0

check() { # name, trace, expected
    n=$((n + 1))
    if "$replay" "$2" --heap-tiles 1024 --standby 1000 --expect "$3" >/dev/null; then
        echo "ok $n $1"
    else
        echo "not ok $n $1"
        failed=1
    fi
}

for trace in "$data"/*.trace; do
    check "$(basename "$trace" .trace)_decides_as_expected" "$trace" "${trace%.trace}.expected"
done
for expected in "$data"/*.hash; do
    name=$(basename "$expected" .hash)
    if [ -f "$traces/$name.slt" ]; then
        check "${name}_has_its_hash" "$traces/$name.slt" "$expected"
    else
        n=$((n + 1))
        echo "ok $n ${name}_has_its_hash # SKIP $traces/$name.slt is not there"
    fi
done
echo "1..$n"
exit $failed
