#!/bin/sh
# scene.sh [OPTION ...]: draws nothing and prints what a scene's program would, for test_sweep.sh.
#
# --mode says what becomes of it. Each run adds a line to $SCENE_LOG.
mode=good budget=0 probability=0.0625 output='' repeat=1
case " $* " in
*' --help '*)
    cat <<'END'
scene [OPTION ...]

  --probability P             that a pixel quad writes feedback [0.0625]
  --budget MIB                MiB at most [0]
  --heap-tiles N              tiles per heap [256]
  --seed N                    of all choices [1]
  --mode MODE                 what becomes of it [good]
  --name TEXT                 of no importance [x]
  --output DIR                where everything is written
  --write-frames some|none    pictures to write [some]
  --needs auto|on|off         find out what frames need
  --record TRACE              of the manager
  --needs-trace TRACE         of what frames need
  --json                      figures as JSON lines on stdout
  --help                      this text
END
    exit ;;
esac
[ -z "${SCENE_LOG-}" ] || echo "$*" >>"$SCENE_LOG"
while [ $# -gt 0 ]; do
    case $1 in
    --mode) mode=$2; shift ;;
    --budget) budget=$2; shift ;;
    --probability) probability=$2; shift ;;
    --seed) repeat=$2; shift ;;
    --output) output=$2; shift ;;
    --record) [ -z "${SCENE_RECORDING-}" ] || cp "$SCENE_RECORDING" "$2"; shift ;;
    --needs-trace) [ -z "${SCENE_NEEDS-}" ] || cp "$SCENE_NEEDS" "$2"; shift ;;
    --name | --write-frames | --needs | --generate-scale | --size | --samples | --frames | --rest-frames | --fps | --heap-tiles) shift ;;
    --json) ;;
    *) echo "scene: there is no option $1" >&2; exit 2 ;;
    esac
    shift
done

figure() { echo "{\"name\": \"$1\", \"value\": $2, \"unit\": \"$3\"}"; }

case $mode in
crash) kill -SEGV $$ ;;
fail) printf 'first\nthe lights, and "all" of them, went out\n' >&2; exit 3 ;;
hang) sleep "${SCENE_SLEEP:-1000}" ;;
slow) sleep 0.2 ;;
rubbish) echo 'no JSON at all' "$output"; exit ;;
flood) exec yes ;;
nodevice) echo 'there is no device' >&2; exit 77 ;;
full) head -c 100000 /dev/zero >"$output/frames.csv" || exit 1 ;;
esac
printf 'frame,flip\n0,0.25\n1,0.75\n' >"$output/frames.csv"
echo 'some words between'
figure resident_bytes_peak $((1048576 * (budget > 0 ? budget : 100))) bytes
figure gpu_ms_median $((10 + repeat)) ms
figure psnr_mean_db "$([ "$probability" = 1/4 ] && echo 40 || echo 30)" dB
figure frames 2 frames
echo '{"name": "device", "value": "'"${SCENE_DEVICE-a \\\"fast\\\" one}"'", "unit": "name"}'
