#!/bin/bash
# test_inputs.sh FACTS TRACE PROGRAM...: what programs do with inputs that are no files, in TAP.
facts=$1 trace=$2
shift 2
mapfile -t programs < <(realpath "$@")
# shellcheck source=tests/bake/facts.sh
source "$facts"
mkfifo pipe

# program NAME: its path, or nothing if this build has none
program() {
    local path
    for path in "${programs[@]}"; do
        [ "${path##*/}" = "$1" ] && echo "$path"
    done
}

# refuses TOOL ARGUMENTS...: ends by itself with a status of its own, having named pipe or device
refuses() {
    local got=0
    timeout 20 "$@" >out 2>err </dev/null || got=$?
    [ "$got" -ge 1 ] && [ "$got" -le 2 ] && grep -q 'not a regular file' err
}

replay=$(program sluice-replay) info=$(program sluice-info) bake=$(program sluice-bake)
tradeoff=$(program sluice-tradeoff) streaming=$(program streaming)

refuses "$replay" pipe && refuses "$replay" "$trace" --expect pipe && refuses "$replay" /dev/zero
fact replay_refuses_pipes_and_devices

refuses "$info" pipe && refuses "$info" /dev/zero && refuses "$info" pipe --png picture.png && [ ! -e picture.png ]
fact info_refuses_pipes_and_devices

refuses "$tradeoff" play pipe && refuses "$tradeoff" trace pipe --results results
fact tradeoff_refuses_pipes_and_devices

if [ -n "$bake" ]; then
    refuses "$bake" pipe -o baked.store && refuses "$bake" /dev/zero -o baked.store && [ ! -e baked.store ] &&
        refuses "$bake" --verify pipe
    fact bake_refuses_pipes_and_devices
fi
if [ -n "$streaming" ]; then
    refuses "$streaming" --images pipe --generate-only --cache cache
    fact gallery_refuses_pipes_and_devices
fi

tool=$replay
run 0 - <"$trace" && cp out once && run 0 /dev/stdin <"$trace" && cmp -s out once && run 0 "$trace" && cmp -s out once
fact replay_reads_the_standard_input

run 0 <(cat "$trace") && cmp -s out once && run 0 "$trace" --expect <(grep '^hash' once)
fact replay_reads_streams_that_it_was_given

# shellcheck disable=SC2094 # that it does not write it is what is shown
cp "$trace" kept && run 1 - --record kept <kept && grep -q 'would replace a file that is read' err && cmp -s kept "$trace"
fact the_standard_input_is_not_replaced

run 1 - </dev/zero && grep -q 'is no trace' err && run 1 /dev/fd/77 && [ "$(wc -l <err)" -eq 1 ]
fact replay_looks_at_the_first_bytes_first

{ cat "$trace"; yes; } 2>/dev/null | run 1 - --memory 16 && grep -q 'more than 16 MiB; --memory' err
fact a_trace_is_bounded_by_the_memory_allowed

truncate -s 64G sparse && run 1 sparse && grep -q 'is no trace' err && cat "$trace" >large && truncate -s 64G large &&
    run 1 large --memory 8 && grep -q 'more than 8 MiB' err
fact files_larger_than_memory_are_refused

run 1 "$trace" --memory 16 --expect sparse && grep -q 'more than 16 MiB; --memory' err &&
    run 1 "$trace" --memory 16 --expect <(yes) && grep -q 'more than 16 MiB; --memory' err
fact an_expectation_is_bounded_by_the_memory_allowed

end_facts
