#!/bin/sh
# test_tool.sh SLUICE_REPLAY DATA: what the command line promises, in TAP.
replay=$1
trace=$2/first_light.trace
expected=$2/first_light.expected
n=0
failed=0
folder=$(mktemp -d) || exit 99
trap 'rm -rf "$folder"' EXIT

report() { # name, whether it holds
    n=$((n + 1))
    if [ "$2" = 0 ]; then
        echo "ok $n $1"
    else
        echo "not ok $n $1"
        failed=1
    fi
}

status() { # expected exit status, command
    want=$1
    shift
    "$@" >"$folder/out" 2>"$folder/err"
    [ $? = "$want" ]
}

status 0 "$replay" --help && grep -q 'timeout SECONDS.*\[1\]' "$folder/out"
report help_names_defaults $?

wrong=0
for arguments in '' '--no-such-option x' 'a b' 'a --latency' 'a --latency -1' 'a --tiles-per-frame 0' 'a --budget 5' '-- a b' \
    'a --latency 4294967296' 'a --timeout nan' 'a --timeout 0' 'a --dump --json' 'a --standby 1x' \
    'a --heap-tiles 1048577'; do
    # shellcheck disable=SC2086
    status 2 "$replay" $arguments && [ -s "$folder/err" ] || wrong=1
done
report wrong_usage_exits_with_2_and_says_why $wrong

status 2 "$replay" "$trace" --budget 5 && grep -q -- '--budget is called --tiles-per-frame' "$folder/err" &&
    status 0 "$replay" "$trace" --tiles-per-frame 5
report tiles_per_frame_have_a_name_of_their_own $?

cp "$trace" "$folder/--trace" &&
    (tool=$(realpath "$replay") && cd "$folder" && status 0 "$tool" --json -- --trace)
report names_that_look_like_options_follow_two_dashes $?

status 0 "$replay" "$trace" && grep -q '^hash [0-9a-f]\{16\} events [0-9]*$' "$folder/out"
report statistics_end_with_the_hash $?

status 0 "$replay" "$trace" --dump && cmp -s "$folder/out" "$expected"
report dump_is_the_expected_file $?

status 0 "$replay" "$trace" --json && grep -q '"name": "mapped_total", "value": [0-9]*, "unit"' \
    "$folder/out" && ! grep -qv '^{"name": ".*", "value": .*, "unit": ".*"}$' "$folder/out"
report json_has_one_object_per_line $?

sed 5s/=/~/ "$expected" >"$folder/changed"
status 1 "$replay" "$trace" --expect "$folder/changed" && grep -q 'changed:5 differs' "$folder/err"
report first_line_that_differs_is_named $?

sed '$d' "$expected" >"$folder/short"
status 1 "$replay" "$trace" --expect "$folder/short"
report missing_line_is_a_difference $?

{ cat "$expected"; echo more; } >"$folder/long"
status 1 "$replay" "$trace" --expect "$folder/long"
report additional_line_is_a_difference $?

{ echo '# a comment'; tail -n 1 "$expected"; } >"$folder/hash"
status 0 "$replay" "$trace" --expect "$folder/hash"
report hash_line_alone_can_be_expected $?

echo 'hash 0000000000000000 events 1' >"$folder/hash"
status 1 "$replay" "$trace" --expect "$folder/hash" && grep -q 'hash:1 differs' "$folder/err"
report other_hash_is_a_difference $?

head -c 60 "$trace" >"$folder/cut"
status 1 "$replay" "$folder/cut" && grep -q 'at byte [0-9][0-9]*' "$folder/err"
report damaged_trace_exits_with_1_and_names_the_byte $?

status 1 "$replay" "$folder/absent" && grep -q absent "$folder/err"
report absent_trace_exits_with_1 $?

status 0 "$replay" "$trace" --record "$folder/again" && cmp -s "$folder/again" "$trace"
report recorded_again_is_the_same_trace $?

echo "1..$n"
exit $failed
