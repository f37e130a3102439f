#!/usr/bin/env bash
# test_interrupted.sh SLUICE_BAKE MAKE_PICTURE [TIMES]: bakes that are killed at random moments. Prints TAP.
#
# Whenever it is killed, under the store's name is nothing or a whole file, and the next run completes
# it to what an undisturbed one writes on one thread. TIMES: 40. The moments come from a fixed seed.
bake=$(realpath "$1") make=$(realpath "$2") times=${3:-40}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
RANDOM=1

"$make" rgb 1280 1280 7 in.png || exit 1
start=$(date +%s%N)
"$bake" in.png -o whole.store --threads 1 --compression 3 >/dev/null || exit 1
duration=$((($(date +%s%N) - start) / 1000000))
wrong=0 killed=0 resumed=0 unfinished=0
for ((i = 0; i < times; i++)); do
    rm -f out.store out.store.sluice-part
    "$bake" in.png -o out.store --threads 3 --compression 3 >/dev/null 2>&1 &
    pid=$!
    sleep "$(printf '0.%03d' $((RANDOM % (duration + 20) % 1000)))"
    kill -9 $pid 2>/dev/null
    wait $pid 2>/dev/null
    [ $? -eq 137 ] && killed=$((killed + 1))
    if [ -e out.store ] && ! cmp -s out.store whole.store; then
        wrong=$((wrong + 1))
    fi
    "$bake" in.png -o out.store --threads 3 --compression 3 --json >second 2>&1 || unfinished=$((unfinished + 1))
    grep -q '"resumed_tiles": [1-9]' second && resumed=$((resumed + 1))
    cmp -s out.store whole.store || unfinished=$((unfinished + 1))
    [ ! -e out.store.sluice-part ] || unfinished=$((unfinished + 1))
done

report() {
    if [ "$2" -eq 0 ]; then echo "ok $1 - $3"; else echo "not ok $1 - $3 ($2 of $times)"; fi
}
echo "# $killed of $times killed, $resumed resumed"
report 1 $wrong a_killed_bake_leaves_no_file_that_is_wrong
report 2 $unfinished the_next_run_completes_it
report 3 $((killed == 0)) some_were_killed_indeed
echo 1..3
[ $wrong -eq 0 ] && [ $unfinished -eq 0 ] && [ $killed -gt 0 ]
