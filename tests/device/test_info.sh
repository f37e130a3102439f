#!/bin/sh
# test_info.sh SLUICE_INFO CHECK CHECK_FORMATS: what the command line promises, in TAP.
info=$1
check=$2
check_formats=$3
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
        sed 's/^/# /' "$folder/err"
        failed=1
    fi
}

status() { # expected exit status, command
    want=$1
    shift
    "$@" >"$folder/out" 2>"$folder/err"
    [ $? = "$want" ]
}

status 0 "$info" --help && grep -q 'exit status\|Exit status' "$folder/out" &&
    grep -q 'WxH.*\[4096x4096\]' "$folder/out"
report help_names_defaults $?

wrong=0
for arguments in '--no-such-option' '--device' '--png x' '--level 1' '--tile 1,1' 'x --device 0' 'x --formats' 'x --png y --tile 1' '--image' '--image 0x4' '--image 4' '--image 4x' \
    '--image 4x4x4' '--image -4x4' '--image 1048577x1'; do
    # shellcheck disable=SC2086
    status 2 "$info" $arguments && [ -s "$folder/err" ] || wrong=1
done
report wrong_usage_exits_with_2_and_says_why $wrong

# A loader that finds no driver says so, whatever is installed.
VK_DRIVER_FILES=/nonexistent.json VK_ICD_FILENAMES=/nonexistent.json VK_LOADER_LAYERS_DISABLE='*' \
    status 1 "$info" && grep -q '^sluice-info: .*Vulkan' "$folder/err" && [ ! -s "$folder/out" ]
report without_a_driver_it_exits_with_1_and_says_so $?

if ! "$info" --list-devices >"$folder/devices" 2>/dev/null; then
    echo "ok 4 # SKIP no Vulkan device"
    echo "1..4"
    exit $failed
fi

status 0 "$info" && grep -q '^device 0: ' "$folder/out" && grep -q '^  BC7_SRGB_BLOCK ' \
    "$folder/out" && [ "$(grep -c '^device ' "$folder/out")" = "$(wc -l <"$folder/devices")" ]
report table_has_every_device_and_format $?

status 0 "$info" --json && python3 "$check" <"$folder/out" >"$folder/names" 2>"$folder/err" &&
    sed 's/^[0-9]*: //' "$folder/devices" | cmp -s - "$folder/names"
report json_is_one_sound_object_per_device $?

name=$(sed -n '1s/^[0-9]*: //p' "$folder/devices" | cut -c1-5)
status 0 "$info" --device 0 && grep -q '^device 0: ' "$folder/out" &&
    status 0 "$info" --json --device "$name" && grep -q "\"deviceName\":\"$name" "$folder/out"
report device_is_picked_by_number_or_name $?

status 1 "$info" --device no-such-device && grep -q "no device is called 'no-such-device'" \
    "$folder/err" && grep -qF "$(head -n 1 "$folder/devices")" "$folder/err"
report unknown_device_exits_with_1_and_names_those_there_are $?

status 0 "$info" --image 1x1 && grep -q 'of 1x1$' "$folder/out"
report layout_of_the_size_asked_for $?

# The header is a row, too, so the count of the rows is one more than that of the formats.
status 0 "$info" --formats --device 0 && grep -q '^  format  *linear  *sparse  *paged  *dense  *demand$' "$folder/out" &&
    rows=$(sed '1,/^$/d' "$folder/out" | wc -l) && status 0 "$info" --formats --json --device 0 &&
    python3 "$check_formats" <"$folder/out" >"$folder/count" 2>"$folder/err" &&
    [ "$rows" -eq $(($(cat "$folder/count") + 1)) ]
report formats_has_a_row_for_each_format $?

status 2 "$info" --group fades && status 2 "$info" --report x && status 2 "$info" x --self-test
report wrong_usage_of_the_self_test_is_refused $?

# A build without it says so.
status 0 "$info" --self-test --group sampler --json --device 0 --report "$folder/report.txt"
ran=$?
if grep -q 'has no self-test' "$folder/err"; then
    n=$((n + 1))
    echo "ok $n # SKIP this build has no self-test"
else
    [ $ran = 0 ] && python3 "$(dirname "$check")/check_self_test.py" <"$folder/out" 2>"$folder/err"
    report self_test_reports_each_check $?

    lines=$(grep -c '^{"check"' "$folder/out") && [ "$(grep -c '^  [a-z]*  sampler ' "$folder/report.txt")" = "$lines" ] &&
        grep -q "^  groups  *sampler\$" "$folder/report.txt" && grep -q '^device 0: ' "$folder/report.txt" &&
        tail -n 1 "$folder/report.txt" | grep -q "^$lines passed, 0 failed, 0 skipped in .*; processor time [0-9]* s; validation o[nf]*\$"
    report the_file_of_a_report_has_the_device_each_check_and_their_sum $?
fi

echo "1..$n"
exit $failed
