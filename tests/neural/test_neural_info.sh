#!/usr/bin/env bash
# test_neural_info.sh SLUICE_INFO MAKE_NEURAL_FILE: what sluice-info says of neural textures, and the floats that it
# decodes. Prints TAP.
info=$(realpath "$1") make=$(realpath "$2")
# shellcheck source=/dev/null
. "$(dirname "${BASH_SOURCE[0]}")/../bake/facts.sh"
# shellcheck disable=SC2034 # it is what run runs
tool=$info

"$make" a.ntc
fact a_file_can_be_made

run 0 a.ntc && grep -q 'neural textures, schema 3' out && grep -q '4 x 4 texels, 1 mips' out &&
    grep -q 'texture 0  *two: channels 0 to 1' out && grep -q 'INT8, 9472 bytes' out
fact it_says_what_is_in_a_file

run 0 a.ntc a.ntc --json && [ "$(grep -c '^{.*}$' out)" -eq 2 ] && { ! command -v python3 >/dev/null ||
    python3 -c 'import json
for line in open("out"):
    j = json.loads(line)
    assert j["mips"][0]["positionScale"] == 0.25 and j["latentImages"][1]["parts"][0]["size"] == 2
    assert j["channels"][1]["colorSpace"] == "sRGB"'; }
fact json_has_an_object_per_file

# 0.242919921875 and 0.0140380859375 are texel (1, 2) of the worked example
run 0 a.ntc --decode 0 -o a.f32 && [ "$(stat -c %s a.f32)" -eq 128 ] &&
    [ "$(od -An -tx4 -j 72 -N 8 a.f32 | tr -d ' \n')" = 3e78c0003c660000 ]
fact a_mip_is_decoded_to_floats

run 1 a.ntc --decode 1 -o b.f32 && grep -q 'mip is 1; the file has 1' err && [ ! -e b.f32 ] &&
    run 1 a.ntc --decode 0 --weights fp8 -o b.f32 && grep -q 'has no FP8 weights' err && [ ! -e b.f32 ]
fact mips_and_weights_that_are_not_there_are_errors

run 2 a.ntc --decode 0 && run 2 a.ntc -o b.f32 && run 2 a.ntc a.ntc --decode 0 -o b.f32
fact decoding_takes_one_file_and_an_output

cp a.ntc same.ntc && run 1 same.ntc --decode 0 -o same.ntc && cmp -s a.ntc same.ntc
fact the_input_is_not_overwritten

head -c 700 a.ntc >cut.ntc && run 1 cut.ntc && [ "$(grep -c . err)" -eq 1 ] && grep -q 'cut.ntc: ' err
fact a_damaged_file_is_named

end_facts
