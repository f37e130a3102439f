#!/bin/bash
# test_sweep.sh SLUICE_TRADEOFF SCENE RECORDING: sweeps of a program that draws nothing, in TAP.
tool=$(realpath "$1") scene=$(realpath "$2") recording=$(realpath "$3")
n=0
failed=0
folder=$(mktemp -d) || exit 99
trap 'chmod -R u+rwx "$folder"; rm -rf "$folder"' EXIT
cd "$folder" || exit 99
export SCENE_LOG=$folder/log
touch log

report() { # name, whether it holds
    n=$((n + 1))
    if [ "$2" = 0 ]; then
        echo "ok $n $1"
    else
        echo "not ok $n $1"
        sed 's/^/# /' err out
        failed=1
    fi
}

status() { # expected exit status, command
    want=$1
    shift
    "$@" >out 2>err
    got=$?
    [ $got = "$want" ] || { echo "exit status $got, not $want" >>err; return 1; }
}

# shellcheck disable=SC2317 # called by status
sweep() { "$tool" gallery --program "$scene" "$@"; }

# The cell of a CSV file without quoted commas: file, line's beginning, column's name.
cell() {
    awk -F, -v start="$2" -v name="$3" '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) column = i }
        index($0, start) == 1 && column { print $column }' "$1"
}

status 0 "$tool" --help && grep -q -- '--repeats N .*(3; 5 with --full)' out
report help_names_defaults $?

wrong=0
for arguments in '' 'nowhere' 'trace' 'neural' 'gallery gallery' 'gallery --no-such-option' 'gallery --sweep' \
    'gallery --repeats 0' 'gallery --repeats 1x' 'gallery --jobs 0' 'gallery --run-limit nan' \
    'gallery --run-limit 0' 'gallery --grid' 'gallery --results' 'page' 'page a b'; do
    # shellcheck disable=SC2086
    status 2 "$tool" $arguments && [ -s err ] && [ ! -s out ] && [ ! -e tradeoff-out ] || wrong=1
done
report wrong_usage_exits_with_2_and_writes_nothing $wrong

status 0 sweep --results a --sweep budget=8,16 --sweep probability=1/4 --repeats 3 &&
    [ "$(wc -l <log)" = 12 ] && [ "$(wc -l <a/points.csv)" = 5 ] && [ "$(wc -l <a/runs.csv)" = 13 ]
report each_point_is_run_as_often_as_asked $?

[ "$(tail -n 1 out)" = 'The page, with plots and pictures: a/page.html' ]
report the_last_line_names_the_page $?

[ "$(cell a/points.csv 1,budget resident_bytes_peak)" = 8388608 ] &&
    [ "$(cell a/points.csv 1,budget resident_bytes_peak_half_width)" = 0 ] &&
    [ "$(cell a/points.csv 1,budget resident_bytes_peak_delta)" = -96468992 ] &&
    [ "$(cell a/points.csv 0,base psnr_mean_db)" = 30 ] &&
    [ "$(cell a/points.csv 0,base flip_mean)" = 0.5 ] &&
    [ "$(cell a/points.csv 0,base psnr_mean_db_delta)" = 0 ]
report points_hold_means_intervals_and_differences $?

# Of 11, 12 and 13 the first does not count: 12.5 +- 12.7062 / 2; of one alone it does.
[ "$(cell a/points.csv 0,base gpu_ms_median)" = 12.5 ] &&
    cell a/points.csv 0,base gpu_ms_median_half_width | grep -q '^6\.3531' &&
    [ "$(cell a/points.csv 0,base psnr_mean_db_half_width)" = 0 ] &&
    status 0 sweep --results k --sweep budget=8 --repeats 1 &&
    [ "$(cell k/points.csv 0,base gpu_ms_median)" = 11 ] &&
    [ "$(cell k/points.csv 0,base resident_bytes_peak)" = 104857600 ]
report times_of_first_runs_count_only_alone $?

sed -n '1,12s/.*--seed \([0-9]*\).*/\1/p' log | tr -d '\n' | grep -q '^111122223333$'
report repeats_take_turns $?

sed -i '13,$d' log
[ "$(grep -c -- '--write-frames some' log)" = 4 ] && [ "$(grep -c -- '--needs-trace' log)" = 4 ] &&
    [ "$(grep -c -- '--write-frames some --needs on' log)" = 4 ] && [ "$(grep -c -- '--needs off' log)" = 8 ]
report first_runs_alone_write_pictures_and_find_out_needs $?

status 0 sweep --results a --sweep budget=8,16 --sweep probability=1/4 --repeats 3 --json &&
    [ "$(wc -l <log)" = 12 ] && grep -q '"runs_kept", "value": 12' out &&
    grep -q '{"name": "recommended: small memory", "value": "budget 8", "unit": "point"}' out &&
    grep -q '"psnr_mean_db", "value": 40, "unit": "dB", "half_width": 0, "point": "probability 1/4"' out
report what_is_there_is_not_run_again $?

python3 -c 'import json, sys
for line in open("out"): json.loads(line)' 2>>err
report json_lines_are_json $?

status 0 sweep --results a --sweep budget=8,16,32 --sweep probability=1/4 --repeats 3 &&
    [ "$(wc -l <log)" = 15 ]
report a_wider_sweep_runs_what_is_new $?

mv a moved
status 0 "$tool" page moved && [ "$(wc -l <log)" = 15 ] && grep -q '^budget 32 ' out
report results_are_shown_again_without_a_run $?

# Another build of the tool gives runs other names.
cp -r moved renamed
echo 0123456789abcdef >renamed/program-build.txt
status 0 "$tool" page renamed && ! grep -q 'not yet run' out && [ "$(wc -l <renamed/runs.csv)" = 16 ] &&
    grep -q '^1,budget 8,1,done' renamed/runs.csv
report results_of_another_build_are_found_by_their_names $?

sed -i 's|^\([0-9]\) [^ ]* \(budget 8\)$|\1 ../../renamed \2|' renamed/sweep.runs
status 1 "$tool" page renamed && grep -q '^budget 8 *not yet run' out
report names_do_not_lead_out_of_the_folder $?

status 1 "$tool" page nowhere && grep -q nowhere err
report folder_without_a_sweep_has_no_page $?

status 0 sweep --results moved --sweep budget=8 --repeats 1 --fresh &&
    [ "$(wc -l <log)" = 17 ] && [ "$(find moved/runs -mindepth 1 -maxdepth 1 -type d | wc -l)" = 2 ]
report fresh_forgets_the_runs $?

# What lies in the folder is of three kinds: marked as the tool's own, of an older version, of others.
mkdir -p theirs/runs theirs/reference && echo precious | tee theirs/runs/photo theirs/reference/photo >theirs/libraries.txt
: >log
status 1 sweep --results theirs --sweep budget=8 --repeats 1 --fresh &&
    grep -q 'theirs/runs: has no file made-by-sluice-tradeoff.txt.*another folder with --results' err &&
    [ ! -s log ] && [ "$(cat theirs/runs/photo theirs/reference/photo)" = "$(printf 'precious\nprecious')" ]
report fresh_leaves_folders_that_it_has_not_made $?

status 0 sweep --results theirs --sweep budget=8 --repeats 1 && [ "$(wc -l <log)" = 2 ] &&
    status 0 sweep --results theirs --sweep budget=8 --repeats 1 && [ "$(wc -l <log)" = 2 ] &&
    [ "$(cat theirs/runs/photo theirs/libraries.txt)" = "$(printf 'precious\nprecious')" ] &&
    status 1 sweep --results theirs --fresh && [ "$(cat theirs/reference/photo)" = precious ]
report folders_without_a_mark_are_used_but_never_removed $?

mkdir tables && echo precious >tables/points.csv
status 1 sweep --results tables --repeats 1 && grep -q 'tables/points.csv is not of a sweep' err &&
    [ "$(cat tables/points.csv)" = precious ] && [ ! -e tables/runs ]
report tables_of_somebody_else_are_not_replaced $?

: >log
sed 's/999/998/; $a# another build' "$scene" >scene2
chmod +x scene2
: >log
status 0 "$tool" gallery --program ./scene2 --results moved --sweep budget=8 --repeats 1 &&
    [ "$(wc -l <log)" = 2 ]
report another_build_is_run_again $?

: >log
status 1 sweep --results b --sweep mode=crash,fail,hang,rubbish,flood,slow --repeats 2 --run-limit 0.7 &&
    [ "$(cell b/points.csv 0,base state)" = 'done' ] &&
    [ "$(cell b/points.csv '6,mode slow' state)" = 'done' ] && [ "$(wc -l <log)" = 9 ] &&
    grep -q '^1,mode crash,failed,signal 11' b/points.csv &&
    grep -q '^3,mode hang,failed,it took longer than the time limit,' b/points.csv &&
    grep -q '^4,mode rubbish,failed,it printed no figures,' b/points.csv &&
    grep -q '^5,mode flood,failed,it ' b/points.csv && grep -q 'mode hang *failed: it took' out
report failed_runs_are_failed_points_and_the_sweep_goes_on $?

grep -q '^2,mode fail,failed,"exit status 3: the lights, and ""all"" of them, went out",' b/points.csv
report commas_and_quotes_are_quoted $?

python3 - <<'END' 2>>err
import csv
for name in "b/points.csv", "b/runs.csv":
    rows = list(csv.reader(open(name, newline="")))
    assert {len(row) for row in rows} == {len(rows[0])}
    assert len(set(rows[0])) == len(rows[0])
END
report every_line_has_a_cell_for_each_column $?

: >log
status 1 sweep --results b --sweep mode=crash,fail --repeats 2 && [ "$(wc -l <log)" = 2 ]
report failed_runs_are_tried_again $?

status 77 sweep --results c --base mode=nodevice && grep -q 'there is no device' err &&
    [ ! -e c/points.csv ]
report without_a_device_the_sweep_ends_with_77 $?

status 1 "$tool" gallery --program ./absent --results d && grep -q absent err
report a_missing_program_is_named $?

mkdir -p far/away
cp "$tool" far/away/sluice-tradeoff
LD_LIBRARY_PATH=$(dirname "$tool")/../../lib status 1 far/away/sluice-tradeoff gallery --results d && grep -q 'build the samples' err
report samples_that_were_not_built_are_asked_for $?

status 2 "$tool" gallery --program "$scene" --results d --jobs 1 --sweep && status 1 sweep --results d \
    --sweep nothing=1 && grep -q 'no option --nothing' err
report a_setting_that_the_program_lacks_is_named $?

mkdir -p locked && chmod 500 locked
if [ "$(id -u)" = 0 ]; then
    touch file
    status 1 sweep --results file/below && grep -q file err
else
    status 1 sweep --results locked/below && grep -q locked err
fi
report an_unwritable_folder_is_named $?

# Files of 8 KiB at most: the program's own is too large, which is that point's failure.
(ulimit -f 8; trap '' XFSZ; status 1 sweep --results e --sweep mode=full --repeats 1) &&
    grep -q '^1,mode full,failed,exit status 1' e/points.csv && grep -q '^0,base,done' e/points.csv
report a_full_disk_fails_the_run_that_met_it $?

# No file can be written at all.
(ulimit -f 0; trap '' XFSZ; status 1 sweep --results f --repeats 1) && [ ! -e f/points.csv ]
report a_full_disk_ends_a_sweep_that_cannot_be_kept $?

wait_for() { # command: until it holds, ten seconds at most
    for _ in $(seq 200); do
        "$@" && return
        sleep 0.05
    done
    return 1
}

# shellcheck disable=SC2317 # called by wait_for
begun() { [ "$(wc -l <log)" -ge "$1" ]; }

: >log
slow=(--results g --base mode=slow --sweep 'budget=1,2,3' --repeats 2)
"$tool" gallery --program "$scene" "${slow[@]}" >out 2>err &
pid=$!
wait_for begun 3
kill -9 $pid
wait $pid 2>/dev/null
kept=$(find g/runs -mindepth 1 -maxdepth 1 -name '*[0-9a-f]' | wc -l)
[ ! -e g/points.csv ] && [ "$kept" -ge 1 ] && : >log && status 0 sweep "${slow[@]}" &&
    [ "$(wc -l <log)" = $((8 - kept)) ] && [ "$(wc -l <g/runs.csv)" = 9 ] &&
    [ -z "$(find g -name '*.partial')" ]
report a_killed_sweep_goes_on_where_it_was $?

: >log
nap=1000.$$
SCENE_SLEEP=$nap "$tool" gallery --program "$scene" --results h --base mode=hang >out2 2>err2 &
pid=$!
wait_for begun 1 && wait_for pgrep -f "^sleep $nap" >/dev/null
status 1 sweep --results h && grep -q 'another sweep' err
report one_sweep_at_a_time_in_a_folder $?

kill -TERM $pid
wait $pid
[ $? = 130 ] && grep -q 'the same command goes on' err2 && [ ! -e h/points.csv ] &&
    [ -z "$(find h/runs -mindepth 1 -type d)" ] && ! pgrep -f "^sleep $nap" >/dev/null
report an_interruption_ends_what_was_started_and_keeps_the_rest $?

status 0 sweep --results i --sweep name='a b,it'\''s' --repeats 1 --jobs 2 -- --generate-scale 9 &&
    grep -q "^1,name a b,done" i/points.csv && [ "$(wc -l <i/runs.csv)" = 4 ]
report several_jobs_measure_the_same $?

escape=$(printf '\033')
status 0 sweep --results j --base "name=${escape}[31mred" --sweep "name=${escape}[1mbold" --repeats 1 &&
    grep -q 'x1b\[1mbold' out && ! grep -q "$escape" out err
report values_are_printed_plainly $?

status 1 sweep --results i --sweep name=a --repeats 1 -- --budget 9 &&
    grep -q -- '--budget is a setting: --base budget=VALUE' err
report a_setting_given_to_the_program_is_refused $?

# The name holds a blank, a quote and what a shell would run.
odd="it's \$(touch pwned) <b>"
: >log
status 0 sweep --results "$odd" --repeats 1 -- --size 64x32 --name "$odd" &&
    grep -q -- '--generate-scale 4 --samples 1 --frames 100 .*--size 64x32' log &&
    [ "$(grep -o -- '--size' log | wc -l)" = "$(wc -l <log)" ]
report what_the_command_line_says_of_the_scene_is_said_once $?

page_text() { # results folder, path in the page's JSON
    python3 -c 'import json, re, sys
text = open(sys.argv[1] + "/page.html", encoding="utf-8").read()
sweep = json.loads(re.search(r"""<script[^>]*id="sweep-data"[^>]*>(.*?)</script>""", text, re.S).group(1))
print(eval("sweep" + sys.argv[2]))' "$1" "$2"
}

: >log
before=$(cat "$odd"/runs/base*/figures.jsonl "$odd"/runs/base*/frames.csv | cksum)
mkdir "$odd/again" && page_text "$odd" '["points"][0]["command_line"]' >pasted && status 0 sh pasted &&
    grep -q 'resident_bytes_peak' out && [ "$(wc -l <log)" = 1 ] && [ ! -e pwned ] &&
    [ "$(cat "$odd"/runs/base*/figures.jsonl "$odd"/runs/base*/frames.csv | cksum)" = "$before" ]
report a_pasted_command_line_repeats_a_run_beside_the_results $?

page_text "$odd" '["machine"]' | grep -q '^a "fast" one; [0-9]* processors, ' &&
    echo 'another one' >"$odd/machine.txt" && cp -r "$odd" copied && status 0 "$tool" page copied &&
    [ "$(page_text copied '["machine"]')" = 'another one' ] && ! grep -q 'not yet run' out
report a_copied_folder_says_where_it_was_measured $?

status 0 sweep --results o --sweep budget=8 --repeats 1 && ! grep -q 'several devices' err &&
    SCENE_DEVICE=another status 0 sweep --results o --sweep budget=8,16 --repeats 1 &&
    grep -q 'several devices' err && page_text o '["machine"]' | grep -q '^a "fast" one and others; '
report runs_of_several_devices_are_not_taken_for_those_of_one $?

# One texture of 64 + 16 + 4 + 1 tiles and a packed one, all of it wanted in each of 20 frames.
python3 - <<'END' 2>>err
from struct import pack
with open("needs.trace", "wb") as file:
    file.write(b"SLTRACE1" + pack("<14I", 1, 20, *[0] * 12))
    file.write(pack("<2I2H4BI4H3I", 1024, 1024, 128, 128, 11, 4, 7, 1, 0, 128, 128, 8, 8, 65536, 85, 0))
    for frame in range(20):
        file.write(pack("<QIII2B", 16667 * (frame + 1), 1, 0, 2, 64, 0))
END

status 0 "$tool" trace needs.trace --results j --sweep budget=2,16 --repeats 2 &&
    [ "$(cell j/points.csv 0,base clairvoyant_tiles)" = 86 ] &&
    [ "$(cell j/points.csv 2,budget needed_bytes)" = $((86 * 65536)) ] &&
    [ "$(cell j/points.csv 2,budget clairvoyant_tiles_half_width)" = 0 ] &&
    [ "$(cell j/points.csv 1,budget resident_bytes_peak)" -le 2097152 ]
report a_trace_is_played_without_a_program $?

cp needs.trace j/runs/needs.trace && cp needs.trace before
status 1 "$tool" trace j/runs/needs.trace --results j --fresh && grep -q 'fresh would remove it' err &&
    cmp before j/runs/needs.trace && rm j/runs/needs.trace && [ -s j/points.csv ]
report fresh_does_not_remove_the_trace_that_it_is_to_play $?

mkdir p && ln needs.trace p/frames.csv
status 1 "$tool" play needs.trace --output p && grep -q 'p/frames.csv: would replace a file that is read' err &&
    cmp before needs.trace && cmp before p/frames.csv
report a_trace_is_not_replaced_by_its_own_table $?

# Of 86 tiles 32 fit at 2 MiB, so that some regions stay coarser for good; at 16 MiB none does.
awk -v a="$(cell j/points.csv 1,budget clairvoyant_levels_too_coarse)" \
    -v b="$(cell j/points.csv 2,budget clairvoyant_levels_too_coarse)" 'BEGIN { exit !(a > b && b >= 0) }' &&
    [ "$(find j/clairvoyant -name '*.jsonl' | wc -l)" = 3 ]
report a_policy_that_knows_the_trace_is_asked_once_per_budget $?

# The later loads arrive the more frames lack them.
status 0 "$tool" trace needs.trace --results m --sweep latency=8 --repeats 1 &&
    awk -v a="$(cell m/points.csv 0,base clairvoyant_levels_too_coarse)" \
        -v b="$(cell m/points.csv 1,latency clairvoyant_levels_too_coarse)" 'BEGIN { exit !(a > 0 && b > a) }'
report the_policy_waits_for_loads_as_long_as_the_point $?

export SCENE_RECORDING=$recording SCENE_NEEDS=$folder/needs.trace
status 0 sweep --results l --sweep budget=16 --sweep probability=1/4 --repeats 2 &&
    [ "$(cell l/points.csv 0,base clairvoyant_tiles)" = 86 ] &&
    [ "$(find l/clairvoyant -name '*.jsonl' | wc -l)" = 2 ] &&
    awk -v v="$(cell l/points.csv 0,base core_us_per_frame)" 'BEGIN { exit !(v > 0) }' &&
    status 0 "$tool" page l --json && grep -q '"clairvoyant_tiles", "value": 86, .*"point": "budget 16"' out
report recordings_of_first_runs_are_played $?

# Of the 48 tiles of 3 MiB heaps of 32 make use of 32.
status 0 sweep --results n --sweep budget=3,24 --repeats 1 -- --heap-tiles 32 &&
    [ "$(cell n/points.csv 1,budget clairvoyant_tiles)" = 32 ] && [ "$(cell n/points.csv 2,budget clairvoyant_tiles)" = 86 ]
report the_policy_has_heaps_of_the_same_size $?

echo "1..$n"
exit $failed
