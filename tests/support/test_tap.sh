#!/bin/sh
# test_tap.sh PROGRAM: the output of skipping.c is TAP, with reasons. Prints TAP.
output=$("$1" 2>/dev/null)
exit_status=$?
number=0 status=0

# expect FACT LINE
expect() {
    number=$((number + 1))
    if printf '%s\n' "$output" | grep -q -x -- "$2"; then
        echo "ok $number - $1"
    else
        echo "not ok $number - $1"
        printf '%s\n' "$output" | sed 's/^/# > /'
        status=1
    fi
}
echo 1..6
expect plan_comes_first '1\.\.4'
expect line_that_is_no_tap_becomes_a_comment '# no TAP'
expect skipped_test_has_name_and_reason 'ok 2 - is_skipped # SKIP no device 7'
expect skipped_test_without_reason_says_so 'ok 3 - is_skipped_silently # SKIP no reason given'
expect failing_test_stays_failing 'not ok 4 - fails'
output=$exit_status expect exit_status_tells_of_the_failure '[1-9][0-9]*'
exit $status
