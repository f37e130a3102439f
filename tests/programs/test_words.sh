#!/bin/bash
# test_words.sh FACTS TRACE PROGRAM...: what all programs print, where to, and how they say that they cannot, in TAP.
facts=$1 trace=$2
shift 2
mapfile -t programs < <(realpath "$@")
# shellcheck source=tests/bake/facts.sh
source "$facts"
escape=$'\e'
red="${escape}[31mred"

program() { # NAME: its path, or nothing if this build has none
    local path
    for path in "${programs[@]}"; do
        [ "${path##*/}" = "$1" ] && echo "$path"
    done
}
replay=$(program sluice-replay) info=$(program sluice-info) bake=$(program sluice-bake)
tradeoff=$(program sluice-tradeoff) streaming=$(program streaming) tracer=$(program demand-tracer)
minimal=$(program minimal) shared=$(program shared-tiles)

# plain TOOL ARGUMENTS...: names the red thing, and prints no escape code
plain() {
    "$@" >out 2>err </dev/null
    grep -q 'x1b\[31mred' out err && ! grep -q "$escape" out err
}

good=0
for path in "${programs[@]}"; do
    case ${path##*/} in
    sluice-tradeoff) { plain "$path" "--$red" && plain "$path" play "--$red" && plain "$path" "$red"; } || good=1 ;;
    sluice-bake) { plain "$path" "--$red" && plain "$path" "$red" -o "$red/there"; } || good=1 ;;
    *) plain "$path" "--$red" || good=1 ;;
    esac
done
[ $good -eq 0 ]
fact options_that_are_unknown_are_printed_plainly

plain "$info" "$red" && plain "$replay" "$red" && plain "$replay" "$trace" --expect "$red" && plain "$tradeoff" play "$red" &&
    plain "$replay" "$trace" --heap-tiles "$red"
fact tools_print_names_plainly

if [ -n "$streaming" ] && [ -n "$bake" ]; then
    printf 'P6 8 8 255\n%192s' '' >one.ppm
    "$bake" one.ppm -o "$red.store" >out 2>err && plain "$streaming" --images "$red.store" --generate-only &&
        plain "$bake" --verify "$red.store" && plain "$info" "$red.store"
    fact names_of_stores_are_printed_plainly

    cp "$red.store" "$red.damaged.store" && truncate -s 5000 "$red.damaged.store"
    plain "$streaming" --images "$red.damaged.store" --generate-only && plain "$streaming" --images "$red.gone" --generate-only &&
        plain "$bake" --verify "$red.damaged.store"
    fact messages_of_the_library_are_printed_plainly

    "$tracer" --textures "$red.damaged.store" --size 32x18 --samples 1 --needs off --launches 20 --output "$red" >out 2>err
    [ $? -eq 77 ] || { grep -q 'x1b\[31mred.damaged.store' err && ! grep -q "$escape" out err &&
        ! grep -q 'image cannot be used' err; }
    fact the_tracer_names_files_and_prints_them_plainly

    plain "$tracer" --textures "$red.gone" && plain "$tracer" --reference "$red" --camera "$red"
    fact the_tracer_prints_what_it_was_given_plainly
fi

# full TOOL ARGUMENTS...: what cannot be printed is a failure, and said
full() {
    local got=0
    "$@" >/dev/full 2>err </dev/null || got=$?
    [ "$got" -eq 77 ] || { [ "$got" -eq 1 ] && grep -q 'cannot write the answer' err; }
}

good=0
for path in "${programs[@]}"; do
    full "$path" --help || { echo "# $path" && good=1; }
done
[ $good -eq 0 ] && full "$tradeoff" play --help && full "$tradeoff" sweep --help
fact help_that_cannot_be_printed_is_a_failure

good=0
for path in $streaming $tracer $shared; do
    full "$path" --list-devices || good=1
done
[ -z "$minimal" ] || full "$minimal" --size 16x16 --frames 1 --output minimal.png || good=1
[ -z "$shared" ] || full "$shared" --size 16x16 --frames 1 --output shared.png || good=1
[ $good -eq 0 ] && full "$replay" "$trace" && full "$replay" "$trace" --json && full "$replay" "$trace" --dump
fact answers_that_cannot_be_printed_are_a_failure

# None of the tools takes what follows "--" for an option.
tool=$replay
cp "$trace" ./--trace && run 0 --json -- --trace && tool=$tradeoff && run 1 play -- --trace && ! grep -q 'no option' err && tool=$tradeoff && run 1 page -- --gone && tool=$info && run 1 -- --gone && grep -q -- '--gone: No such file' err
fact options_of_tools_end_at_two_dashes

if [ -n "$streaming" ] && [ -n "$bake" ]; then
    tool=$bake
    cp one.ppm ./--one.ppm && run 0 -o ./--one.store -- --one.ppm && run 0 --verify -- --one.store && tool=$info &&
        run 0 -- --one.store && tool=$streaming && run 0 --generate-only --images -- --one.store && [ "$(cat out)" = --one.store ] &&
        run 0 --generate-only --images one.ppm --cache cache -- && run 2 --generate-only -- one.ppm
    fact names_of_pictures_may_look_like_options

    run 2 --loads-in-flight 1 --output nothing && grep -q -- '--loads-in-flight 1: wants 2' err && [ ! -e nothing ]
    fact too_few_loads_in_flight_are_refused_at_once

    run 2 --budget 64Q && grep -q -- '--budget 64Q: wants a size like 512M or 2G, from 0 to 1T$' err &&
        run 2 --fps 0 && grep -q -- '--fps 0: wants a whole number from 1 to 10000$' err
    fact ranges_are_written_out
fi

# Of a loader without drivers, whatever is installed.
export VK_DRIVER_FILES=/nonexistent.json VK_ICD_FILENAMES=/nonexistent.json VK_LOADER_LAYERS_DISABLE='*'
good=0
for path in $streaming $tracer $minimal $shared; do
    tool=$path
    { run 77 && grep -q '^there is no Vulkan driver; install' err && [ ! -s out ] && ! grep -q -- '-9' err; } || good=1
done
for path in $streaming $tracer $shared; do
    tool=$path
    { run 77 --list-devices && grep -q '^there is no Vulkan driver; install' err; } || good=1
done
tool=$info
run 1 && grep -q '^sluice-info: ' err && { ! ldd "$info" | grep -q sluice-vulkan || grep -q 'there is no Vulkan driver; install' err; } &&
    [ $good -eq 0 ]
fact without_a_driver_all_say_the_same_sentence

end_facts
