#!/usr/bin/env bash
# test_frame_ranges.sh CONTACT_SHEET RENDER_SH FACTS STREAMING: a walk through the gallery in two tasks is that of one
# run. Prints TAP.
sheet=$(realpath "$1") driver=$(realpath "$2") facts=$(realpath "$3") streaming=$(realpath "$4")
# shellcheck source=/dev/null
. "$facts"
export SLUICE_CONTACT_SHEET=$sheet
walk=("$streaming" --cache cache --generate-scale 16 --size 128x72 --frames 20 --rest-frames 5 --samples 1 --deterministic
    --threads 1 --write-frames all)
"${walk[@]}" --output one >out 2>err
status_of_walk=$?
if [ "$status_of_walk" = 77 ]; then
    echo "1..0 # SKIP $(tail -n 1 err)"
    exit 0
fi
[ "$status_of_walk" = 0 ] && [ "$(find one -name 'frame-*.png' | wc -l)" = 20 ]
fact one_run_writes_all_frames

# The second task is killed once, when it has written a few of its pictures.
cat >renderer <<'END'
#!/usr/bin/env bash
echo "$2" >>ranges
if [ "$2" = 10-19 ] && [ ! -e killed ]; then
    touch killed
    "${@:3}" --range 10-13 --output "$1"
    exit 1
fi
"${@:3}" --range "$2" --output "$1"
END
chmod +x renderer
# shellcheck disable=SC2034 # it is what run runs
tool=$driver
run 0 0-19 2 frames --local 2 -- ./renderer %d %a-%b "${walk[@]}" &&
    [ "$(sort ranges | tr '\n' ' ')" = "0-9 10-19 14-19 " ] && grep -q 'round 1 of 3: tasks 2 of 2' out
fact a_task_that_was_killed_goes_on_with_the_frames_that_it_lacks
different=0
for ((frame = 0; frame < 20; frame++)); do
    cmp "$(printf one/frame-%04d.png $frame)" "$(printf frames/frame-%05d.png $frame)" >>err 2>&1 || different=1
done
[ $different = 0 ] && ! cmp -s one/frame-0000.png one/frame-0019.png
fact pictures_of_two_ranges_are_those_of_one_run
[ -s frames/contact-sheet.png ] && [ -z "$(find frames -name '.frame*')" ]
fact a_contact_sheet_shows_them_and_nothing_is_left
[ -s frames/frames-0-9.csv ] && [ -s frames/report-0-9.html ] && [ -s frames/frames-14-19.csv ]
fact tables_and_reports_of_the_ranges_are_kept

columns() { cut -d, -f1,2,7- "$1" | tail -n +2; } # without those of time
"${walk[@]}" --range 0-9 --output parts >out 2>err && "${walk[@]}" --range 10-19 --output parts >>out 2>>err &&
    { columns parts/frames-0-9.csv && columns parts/frames-10-19.csv; } | cmp - <(columns one/frames.csv) >>err 2>&1 &&
    [ -s parts/report-10-19.html ] && [ ! -e parts/frames.csv ]
fact lines_of_two_ranges_are_those_of_one_run
"${walk[@]}" --range 16-19 --play-in 4 --output late >out 2>err && grep -q 'playing: 4 frames' err &&
    [ "$(find late -name 'frame-*.png' | wc -l)" = 4 ]
fact a_range_may_play_a_few_frames_alone
refused() {
    local result=0
    "${walk[@]}" --output refused "$@" >out 2>err || result=$?
    [ $result = 2 ]
}
refused --range 5-20 && refused --range 5-4 && refused --range 5 && refused --range 0-4294967296 &&
    refused --range 0-1 --needs-trace x && [ ! -e refused ]
fact ranges_that_are_none_are_refused
end_facts
