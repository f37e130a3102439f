#!/usr/bin/env bash
# Renders frames in N tasks, runs tasks that failed again, and makes a contact sheet. docs/cluster.md says more.
#
#   render.sh FIRST-LAST N FOLDER [--local JOBS] [--rounds N] [--sbatch OPTION]... -- COMMAND...
#
#   --local JOBS     no cluster: JOBS tasks at a time on this machine
#   --rounds N       run failed tasks again so many times (default: 3)
#   --sbatch OPTION  an option for sbatch, as --sbatch --mem=4G; may be given again
#   --help
#
# COMMAND renders one frame: %f in it is the frame's number, %o the picture to write (PNG). Or it renders the frames
# from %a to %b and writes them into the folder %d as frame-NUMBER.png, each complete when it has its name. Pictures
# are FOLDER/frame-NNNNN.png, and those that are there are not rendered again. FOLDER/contact-sheet.png shows all.
# Other files of %d go to FOLDER; a name without frames of the range, as A-B, gets them in front.
# The exit status is 0 if all frames and the sheet were written, and no range failed that has all its pictures.
#
# Environment: SLUICE_CONTACT_SHEET   the program that makes the sheet (default: contact-sheet of PATH)

set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
sheet=${SLUICE_CONTACT_SHEET:-contact-sheet}

usage() { sed -n '2,/^$/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; }
die() {
    echo "render.sh: $*" >&2
    exit 2
}

words=() options=() local_jobs=0 rounds=3
while [ $# -gt 0 ]; do
    case $1 in
    --help) usage; exit 0 ;;
    --local) local_jobs=${2:?--local needs a number}; shift ;;
    --rounds) rounds=${2:?--rounds needs a number}; shift ;;
    --sbatch) options+=("${2:?--sbatch needs an option}"); shift ;;
    --) shift; break ;;
    -*) die "unknown option $1 (see --help)" ;;
    *) words+=("$1") ;;
    esac
    shift
done
[ ${#words[@]} -eq 3 ] || die "FIRST-LAST, N and FOLDER are needed (see --help)"
[[ ${words[0]} =~ ^([0-9]{1,6})-([0-9]{1,6})$ ]] || die "frames are FIRST-LAST, as in 0-95"
first=$((10#${BASH_REMATCH[1]})) last=$((10#${BASH_REMATCH[2]})) count=${words[1]} folder=${words[2]}
[[ $count =~ ^[0-9]{1,6}$ ]] || die "N is the number of tasks"
case $local_jobs$rounds in *[!0-9]*) die "JOBS and rounds are numbers" ;; esac
count=$((10#$count))
if [ "$first" -gt "$last" ] || [ "$count" -eq 0 ]; then die "there is no frame, or no task"; fi
case "$*" in
*%o*%[abd]* | *%[abd]*%o*) die "COMMAND has %o of one frame, and %a, %b or %d of a range; use one of both" ;;
*%o* | *%a*%b*%d* | *%a*%d*%b* | *%d*%a*%b*) ;;
*) die "COMMAND has no %o, and not %a, %b and %d, so it writes no picture" ;;
esac
[ "$local_jobs" -gt 0 ] || command -v sbatch >/dev/null || die "there is no sbatch; --local JOBS needs no cluster"
command -v "$sheet" >/dev/null || die "there is no $sheet; SLUICE_CONTACT_SHEET names one"
[ "$count" -le $((last - first + 1)) ] || count=$((last - first + 1))
mkdir -p "$folder"
# Left by tasks that were killed.
find "$folder" -maxdepth 1 \( -name '.frame-*.png' -o -name '.frames-*' \) -mmin +1440 -exec rm -r {} +

picture() { printf -v path '%s/frame-%05d.png' "$folder" "$1"; }

# The tasks that lack a picture, as 1,5,7.
tasks_to_run() {
    local task frame frames=$((last - first + 1))
    for ((task = 1; task <= count; task++)); do
        for ((frame = first + (task - 1) * frames / count; frame < first + task * frames / count; frame++)); do
            picture "$frame"
            [ -e "$path" ] || { echo "$task"; break; }
        done
    done | paste -sd ,
}

run_tasks() { # LIST COMMAND...
    local list=$1
    shift
    if [ "$local_jobs" -gt 0 ]; then
        tr , '\n' <<<"$list" | xargs -P "$local_jobs" -I @TASK@ env SLURM_ARRAY_TASK_ID=@TASK@ \
            bash "$here/render.sbatch" "$first" "$last" "$count" "$folder" "$@" || true
    else
        sbatch --wait --array="$list" "${options[@]}" "$here/render.sbatch" "$first" "$last" "$count" "$folder" "$@" || true
    fi
}

for ((round = 0; ; round++)); do
    list=$(tasks_to_run)
    [ -n "$list" ] || break
    if [ "$round" -gt "$rounds" ]; then
        echo "render.sh: tasks $list of $count lack pictures" >&2
        exit 1
    fi
    [ "$round" -eq 0 ] || echo "render.sh: round $round of $rounds: tasks $list of $count run again"
    run_tasks "$list" "$@"
done
pictures=()
for ((frame = first; frame <= last; frame++)); do
    picture "$frame"
    pictures+=("$path")
done
"$sheet" -o "$folder/contact-sheet.png" "${pictures[@]}"
echo "$folder/contact-sheet.png: ${#pictures[@]} frames"

# Ranges whose command failed although it wrote all pictures.
status=0
for mark in "$folder"/.failed-*; do
    [[ $mark =~ \.failed-([0-9]+)-([0-9]+)$ && -e $mark ]] || continue
    if [ "${BASH_REMATCH[1]}" -gt "$last" ] || [ "${BASH_REMATCH[2]}" -lt "$first" ]; then continue; fi
    echo "render.sh: frames ${BASH_REMATCH[1]}-${BASH_REMATCH[2]}: all pictures are there, but $(cat "$mark")" >&2
    echo "render.sh: remove $mark to accept them, or the pictures to render them again" >&2
    status=1
done
exit $status
