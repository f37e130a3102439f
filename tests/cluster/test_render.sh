#!/usr/bin/env bash
# test_render.sh CONTACT_SHEET RENDER_SH FACTS: frames in tasks, without a cluster. Prints TAP.
# shellcheck disable=SC2016 # words in single quotes are for other shells
sheet=$(realpath "$1") driver=$(realpath "$2") facts=$(realpath "$3")
# shellcheck source=/dev/null
. "$facts"
printf '#!/bin/sh\nexec "%s" --cell 16x8 "$@"\n' "$sheet" >small-sheet && chmod +x small-sheet
export SLUICE_CONTACT_SHEET=$PWD/small-sheet
# shellcheck disable=SC2034 # it is what run runs
tool=$driver

# Pictures of 32 x 16 pixels of one color: red is 20 times the frame.
cat >paint.py <<'END'
import struct, zlib
def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
for frame in range(9):
    rows = (b"\0" + bytes([20 * frame, 100, 200]) * 32) * 16
    with open(f"painted-{frame}", "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 32, 16, 8, 2, 0, 0, 0)) +
                   chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
END
python3 paint.py
# Frame 3 fails once, and frame 9 always.
printf '#!/bin/sh\necho "$1" >>rendered\n[ "$1" != 3 ] || [ -e failed ] || { touch failed; exit 1; }\n' >renderer
printf 'cp "painted-$1" "$2"\n' >>renderer
# The colors in the middle of the sheet's cells, for pictures without filters or with those that libpng chooses.
cat >colors.py <<'END'
import struct, sys, zlib
data, at, packed = open(sys.argv[1], "rb").read(), 8, b""
while at < len(data):
    size, name = struct.unpack(">I4s", data[at:at + 8])
    if name == b"IHDR":
        width, height, bits, kind = struct.unpack(">IIBB", data[at + 8:at + 18])
    packed += data[at + 8:at + 8 + size] if name == b"IDAT" else b""
    at += 12 + size
n = {2: 3, 6: 4}[kind]
raw, rows, above = zlib.decompress(packed), [], bytes(n * width)
for y in range(height):
    start, row = y * (n * width + 1), bytearray()
    for i, byte in enumerate(raw[start + 1:start + 1 + n * width]):
        a, b, c = row[i - n] if i >= n else 0, above[i], above[i - n] if i >= n else 0
        p = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
        row.append((byte + (0, a, b, (a + b) // 2, p)[raw[start]]) & 255)
    rows.append(row)
    above = row
print(width, height, *(rows[2 + 4 + r * (8 + 11)][n * (2 + 8 + c * 18)] for r in range(int(sys.argv[2])) for c in range(8)))
END

render() { run "$@" -- sh renderer %f %o; }
render 0 0-8 04 frames --local 2 && [ "$(find frames -name 'frame-0000[0-8].png' | wc -l)" = 9 ] &&
    [ "$(sort -n rendered | tr '\n' ' ')" = "0 1 2 3 3 4 5 6 7 8 " ] && [ -z "$(find frames -name '.*png')" ]
fact each_frame_is_rendered_once_and_again_if_it_failed
grep -q 'round 1 of 3: tasks 2 of 4 run again' out
fact the_task_of_the_frame_that_failed_is_named
# 8 columns of 16 + 2 pixels, 2 rows of 8 + 2 and a caption of 9.
[ "$(python3 colors.py frames/contact-sheet.png 2)" = "146 40 0 20 40 60 80 100 120 140 160 0 0 0 0 0 0 0" ]
fact the_sheet_shows_the_frames_in_their_order

rm rendered frames/frame-00005.png && render 0 0-8 4 frames --local 2 && [ "$(cat rendered)" = 5 ]
fact a_second_run_renders_what_is_missing
render 1 8-9 2 broken --local 1 --rounds 1 && grep -q 'tasks 2 of 2 lack pictures' err && [ ! -e broken/contact-sheet.png ]
fact without_all_frames_there_is_no_sheet

# This sbatch runs the tasks of an array one after the other, with their numbers. One word has blanks.
mkdir bin && printf '#!/bin/sh\nwhile [ "${1#--}" != "$1" ]; do echo "$1" >>sbatch.log; shift; done\n' >bin/sbatch &&
    printf 'for task in 1 2 3; do SLURM_ARRAY_TASK_ID=$task bash "$@"; done\n' >>bin/sbatch && chmod +x bin/sbatch &&
    PATH=$PWD/bin:$PATH run 0 10-12 3 "by slurm & co" --sbatch --mem=1G -- sh -c 'cp frames/frame-00001.png "$1"' 'a word' %o &&
    [ "$(tr '\n' ' ' <sbatch.log)" = "--wait --array=1,2,3 --mem=1G " ] && cmp "by slurm & co/frame-00012.png" frames/frame-00001.png
fact tasks_of_slurm_get_the_same_command
# This renderer writes the pictures of a range and two other files. It fails in frame 2 of the first run.
printf '#!/bin/sh\nfor i in $(seq "$1" "$2"); do cp "painted-$i" "$3/frame-$i.png"; done\necho "$1" >"$3/frames-$1-$2.csv"\n' >ranges
printf 'echo "$2" >"$3/log"\n[ "$1" != 2 ] || [ -e ended ] || { touch ended; exit 7; }\n' >>ranges
ranges() { run "$1" 0-3 2 ranged --local 2 -- sh ranges %a %b %d; }
ranges 1 && [ -e ranged/contact-sheet.png ] && [ -z "$(find ranged -name '.frames-*')" ] &&
    grep -q 'render.sh: frames 2-3: all pictures are there, but the command failed with exit status 7' err
fact a_range_that_fails_after_its_last_picture_is_reported
[ "$(cat ranged/frames-0-1.csv ranged/frames-2-3.csv ranged/0-1-log ranged/2-3-log | tr '\n' ' ')" = "0 2 1 3 " ]
fact other_files_of_a_range_are_kept
ranges 1 && rm ranged/frame-00002.png ranged/frame-00003.png && ranges 0 && [ -z "$(find ranged -name '.failed*')" ]
fact a_range_that_is_rendered_again_has_not_failed
run 2 0-1 1 mixed --local 1 -- sh renderer %f %o 'shot %d' && grep -q 'COMMAND has %o of one frame, and' err && [ ! -e mixed ] &&
    run 2 0-1 1 mixed --local 1 -- sh renderer %a %o && mkdir mixed &&
    SLURM_ARRAY_TASK_ID=1 bash "$(dirname "$driver")/render.sbatch" 4 5 1 mixed sh renderer %f %o 'shot %d' &&
    cmp mixed/frame-00005.png painted-5
fact a_command_renders_one_frame_or_a_range
run 2 5-3 2 frames --local 1 -- x %o && run 2 0-3 2 frames --local 1 -- x && run 2 0-3 frames --local 1 -- x %o
fact wrong_words_are_refused
end_facts
