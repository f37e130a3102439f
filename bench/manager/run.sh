#!/usr/bin/env bash
# Measures the manager and prints two tables: each figure beside RTXTS's, the ceiling that was set
# for it, and the bare copy of the same feedback maps; then what it shows beside a policy that knows
# the whole trace, and what prefetching adds. A minute and a half, half of it for the second table.
#
#   bench/manager/run.sh [options]
#
#   --json          one object per line (name, value, unit) instead of the tables, and more of them
#   --quick         each trace once, a tenth of the repetitions, and the policy that knows the whole
#                   trace for t1000 alone: to see that everything works
#   --harness DIR   the feedback-replay harness (default: $SLUICE_HARNESS, then ../shared/replay
#                   beside the checkout); without it only single calls are timed
#   --work DIR      keep what is built and generated there (default: a scratch folder, removed)
#   --only NAMES    some, with commas between: t100 t1000 t10000 t1000_fast_cap4 t10000_cap16, the
#                   parts of the micro program copy feedback follow idle add memory heaps growth cut
#                   floor, and clairvoyant, the second table (default: all)
#   --help
#
# The library is built with gcc -O2, static and without asserts, installed into the work folder and
# used from there through pkg-config. Timed runs of a trace leave the harness's quality figures out
# (quality=0), because working those out empties the caches between frames; of three runs the one
# with the least median is shown. Quality comes from one more run (quality=1). README.md in this
# folder's parent says what each figure is. Needs gcc, meson, ninja, pkg-config, awk.
#
# Environment: CC   compiler instead of gcc

set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
export CC=${CC:-gcc} LC_ALL=C
unset SLUICE_PREFETCH_LEVELS # of the adapter: set here where it is meant

json=no quick=no work='' only='' harness=${SLUICE_HARNESS:-$root/../shared/replay}
trace_runs='t100 t1000 t10000 t1000_fast_cap4 t10000_cap16'
micro_parts='copy feedback follow idle add memory heaps growth cut floor'

say() { printf '%s\n' "$*" >&2; }
die() {
    say "error: $*"
    exit 1
}

while [ $# -gt 0 ]; do
    case $1 in
    --json) json=yes ;;
    --quick) quick=yes ;;
    --harness | --work | --only)
        [ $# -ge 2 ] || die "$1 needs a value (see --help)"
        declare "${1#--}=$2"
        shift
        ;;
    --help) sed -n '2,/^$/s/^# \{0,1\}//p' "$0"; exit 0 ;;
    *) die "unknown option $1 (see --help)" ;;
    esac
    shift
done
for name in ${only//,/ }; do
    case " $trace_runs $micro_parts clairvoyant " in
    *" $name "*) ;;
    *) die "there is nothing named $name (see --help)" ;;
    esac
done

if [ -z "$work" ]; then
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
fi
mkdir -p "$work"
work=$(cd "$work" && pwd)
figures=$work/figures
: >"$figures"

# logged COMMAND...: quiet, but for the end of the log when it fails
logged() {
    "$@" >>"$work/log" 2>&1 </dev/null || {
        tail -n 40 "$work/log" >&2
        die "failed: $*"
    }
}

wants() { [ -z "$only" ] || [[ ",$only," = *",$1,"* ]]; }

build_library() {
    say "building the library"
    local again=()
    [ ! -d "$work/build" ] || again=(--reconfigure)
    logged meson setup "${again[@]}" "$work/build" "$root" --prefix="$work/prefix" --libdir=lib \
        --buildtype=release -Doptimization=2 -Db_ndebug=if-release -Ddefault_library=static \
        -Dtests=false -Dsamples=disabled -Dexr=disabled -Dstore=disabled -Dvulkan=disabled
    logged ninja -C "$work/build"
    logged meson install -C "$work/build" --no-rebuild
    export PKG_CONFIG_PATH=$work/prefix/lib/pkgconfig
}

# compile OUTPUT ARGUMENTS...: a program that uses the installed library
compile() {
    local output=$1
    shift
    # shellcheck disable=SC2046 # a list of words
    logged "$CC" -std=c11 -O2 "$@" $(pkg-config --static --cflags --libs sluice) -pthread -o "$work/$output"
}

build_programs() {
    say "building the programs"
    local sources=("$here"/{micro,micro_feedback,micro_growth,micro_heaps,micro_memory,micro_scale,figures,rig}.c
        "$root"/tools/common/{chosen_names,nearest,option_help,option_table,option_value,shared_options,text}.c)
    if [ "$have_harness" = no ]; then
        compile micro "${sources[@]}" -lm
        return
    fi
    compile micro -DWITH_HARNESS -I"$harness" "${sources[@]}" "$here/micro_trace.c" -lm
    compile replay -I"$harness" "$harness/replay.c" "$here/backend_sluice.c"
    compile generate -I"$harness" "$harness/sltrace_gen.c"
    compile clairvoyant -I"$root"/lib -I"$root"/tools/{clairvoyant,feedback-trace} "$here/clairvoyant.c" \
        "$root"/tools/{clairvoyant,feedback-trace}/*.c "$root"/tools/common/{input,output_file,output_names,text}.c -lm
}

find_harness() {
    have_harness=yes
    local file
    for file in backend.h sltrace.h replay.c sltrace_gen.c traces/t100.slt traces/t1000.slt; do
        [ -f "$harness/$file" ] || have_harness=no
    done
    [ "$have_harness" = no ] || return 0
    say "no feedback-replay harness in $harness (--harness DIR, SLUICE_HARNESS):"
    say "what plays traces and the camera cut are left out, single calls are timed all the same"
    local name
    for name in ${only//,/ }; do
        case " $trace_runs cut floor clairvoyant " in
        *" $name "*) die "$name needs the harness" ;;
        esac
    done
}

make_traces() {
    say "generating traces"
    cp "$harness/traces/t100.slt" "$harness/traces/t1000.slt" "$work/"
    logged "$work/generate" "$work/t10000.slt" 10000 1500 64 3 1 200 300 1
    logged "$work/generate" "$work/t1000_fast.slt" 1000 1200 32 3 1 400 300 2 100000
}

# What the harness prints becomes lines of "name value unit".
parse_replay() {
    awk -v run="$1" -v what="$2" '
        function value_after(word, i) {
            for (i = 1; i < NF; i++)
                if ($i == word)
                    return $(i + 1) + 0
            return ""
        }
        what == "times" && / median .* us / {
            name = $0
            sub(/ *median .*/, "", name)
            sub(/^ */, "", name)
            gsub(/ /, "_", name)
            n = split("median mean p99 max", parts, " ")
            for (i = 1; i <= n; i++)
                print run "." tolower(name) "." parts[i], value_after(parts[i]), "us"
        }
        what == "quality" && /^ *end: heaps/ {
            print run ".heaps", value_after("heaps"), "heaps"
            print run ".uploads", value_after("uploads"), "tiles"
            print run ".unmaps", value_after("unmaps"), "tiles"
        }
        what == "quality" && /^ *quality:/ {
            print run ".levels_too_coarse", value_after("deficit"), "levels"
            match($0, /\([0-9.]+%/)
            print run ".regions_too_coarse", substr($0, RSTART + 1, RLENGTH - 2), "%"
            print run ".stale_uploads", value_after("uploads"), "%"
        }'
}

# measure_quality NAME TRACE KEY=VALUE...
measure_quality() {
    local name=$1 trace=$work/$2.slt
    shift 2
    "$work/replay" "$trace" "$@" quality=1 >"$work/run" || die "the replay of $name failed"
    parse_replay "$name" quality <"$work/run" >>"$figures"
}

# run_trace NAME TRACE KEY=VALUE...
run_trace() {
    local name=$1 trace=$2 times=3 best='' median i
    shift 2
    wants "$name" || return 0
    [ "$quick" = no ] || times=1
    say "$name: $times x timed, 1 x for quality"
    for ((i = 0; i < times; i++)); do
        "$work/replay" "$work/$trace.slt" "$@" quality=0 >"$work/run" || die "the replay of $name failed"
        median=$(awk '$1 == "TOTAL" { print $3 }' "$work/run")
        if awk -v a="$median" -v b="$best" 'BEGIN { exit !(b == "" || a + 0 < b + 0) }'; then
            best=$median
            cp "$work/run" "$work/best"
        fi
    done
    parse_replay "$name" times <"$work/best" >>"$figures"
    measure_quality "$name" "$trace" "$@"
}

parse_clairvoyant() {
    awk -v run="$1" '
        function figure(name, unit) { print run "." name, $3, unit }
        $1 == "reactive_floor" && $4 == "levels" {
            figure($1 "." $2, "levels")
            floor += $3
        }
        $1 == "reactive_floor" && $2 == "too_coarse" { figure($1 ".regions_too_coarse", "%") }
        $1 == "Belady" && $2 == "uploads" { figure("belady.uploads", "tiles") }
        $2 == "mean_too_coarse" { figure($1 ".levels_too_coarse", "levels") }
        $1 == "priced" && $2 == "too_coarse" { figure("priced.regions_too_coarse", "%") }
        $1 == "priced" && $4 == "tiles" { figure("priced." $2, "tiles") }
        END { print run ".reactive_floor.levels_too_coarse", floor, "levels" }'
}

# run_clairvoyant NAME TRACE KEY=VALUE...: what the manager shows there is known from run_trace,
# unless this part runs alone. Without a cap hold=1 changes nothing.
run_clairvoyant() {
    local name=$1 trace=$2 options=(hold=1)
    shift 2
    wants "$name" || measure_quality "$name" "$trace" "$@"
    if [ "$quick" = yes ] && [ "$name" != t1000 ]; then
        say "$name: --quick leaves out the clairvoyant schedule and the bound"
        options+=(rounds=0)
    else
        say "$name: looking for the clairvoyant schedule and the bound"
    fi
    "$work/clairvoyant" "$work/$trace.slt" "$@" "${options[@]}" >"$work/run" ||
        die "the clairvoyant run of $name failed"
    parse_clairvoyant "$name" <"$work/run" >>"$figures"
}

# run_prefetching TRACE STANDBY: the same room twice, so that what is shown is prefetching alone
run_prefetching() {
    local name=$1_standby$2
    say "$name: with and without prefetching"
    measure_quality "$name" "$1" standby="$2"
    SLUICE_PREFETCH_LEVELS=1 measure_quality "${name}_prefetch1" "$1" standby="$2"
}

run_against_clairvoyant() {
    wants clairvoyant || return 0
    run_clairvoyant t1000 t1000
    run_clairvoyant t10000 t10000
    run_clairvoyant t1000_fast_cap4 t1000_fast maxHeaps=4
    run_clairvoyant t10000_cap16 t10000 maxHeaps=16
    run_prefetching t1000 4000
    run_prefetching t10000 4000
    run_prefetching t10000 40000
}

# Runs the micro program, or the parts that --only names and those that their ratios refer to.
run_micro() {
    local options=() parts='' part
    [ "$quick" = no ] || options+=(--quick)
    if [ "$have_harness" = yes ]; then
        for part in t100 t1000 t10000 t1000_fast; do options+=(--trace "$work/$part.slt"); done
    fi
    for part in ${only//,/ }; do
        case $part in
        clairvoyant) ;;
        t1*) parts+=,floor ;;
        feedback | follow) parts+=,copy,$part ;;
        *) parts+=,$part ;;
        esac
    done
    [ -z "$only" ] || [ -n "$parts" ] || return 0
    [ -z "$parts" ] || options+=(--only "${parts#,}")
    "$work/micro" "${options[@]}" >>"$figures" || die "the micro program failed"
}

machine() {
    local model
    model=$(awk -F': *' '/^model name/ { print $2; exit }' /proc/cpuinfo)
    printf '%s, %s cores, %s, load %s\n' "${model:-$(uname -m)}" "$(nproc)" \
        "$("$CC" --version | head -n 1)" "$(cut -d' ' -f1 /proc/loadavg)"
}

print_json() {
    local escaped
    escaped=$(machine | sed 's/[\\"]/\\&/g')
    printf '{"name": "machine", "value": "%s", "unit": "text"}\n' "$escaped"
    awk '{ printf "{\"name\": \"%s\", \"value\": %s, \"unit\": \"%s\"}\n", $1, $2, $3 }' "$figures"
}

# figure | RTXTS | ceiling | name | floor: a row for each; RTXTS 0.7 was measured on another day on
# a machine of the same kind (one core of a 2-core Xeon, g++ -O2), with the harness and traces used
# here.
rows() {
    cat <<'ROWS'
t100: frame, median | 6.8 | - | t100.total.median | floor.t100.median
t100: frame, mean | 11.5 | - | t100.total.mean | floor.t100.mean
t100: frame, p99 | 61 | - | t100.total.p99 | floor.t100.p99
t1000: frame, median | 75 | 7 | t1000.total.median | floor.t1000.median
t1000: frame, mean | 151 | 15 | t1000.total.mean | floor.t1000.mean
t1000: frame, p99 | 665 | 65 | t1000.total.p99 | floor.t1000.p99
t10000: frame, median | 432 | 40 | t10000.total.median | floor.t10000.median
t10000: frame, mean | 956 | 95 | t10000.total.mean | floor.t10000.mean
t10000: frame, p99 | 4600 | 450 | t10000.total.p99 | floor.t10000.p99
camera cut, 3334 maps, old view held | 101000 | 10000 | cut.total.median |
camera cut, 3334 maps, old view lapsed | 101000 | 10000 | cut_lapsed.total.median |
camera cut, its tiles arrive at once | - | - | cut.arrival.median |
feedback 16384: nothing touched | 0.34 | 0.1 | feedback.untouched.median | copy.4096_bytes.median
feedback 16384: the same window | 13.6 | 1 | feedback.window.median | copy.4096_bytes.median
feedback 16384: window, 30 % missing | - | - | feedback.stochastic.median | copy.4096_bytes.median
feedback 16384: the same, all at level 0 | 38.4 | 40 | feedback.all.median | copy.4096_bytes.median
feedback 16384: all to level 0, first | 38.4 | 40 | feedback.all_first.median | copy.4096_bytes.median
feedback 16384: all to level 0, again | 38.4 | 40 | feedback.all_to_fine.median | copy.4096_bytes.median
feedback 16384: all from level 0 to 1 | - | - | feedback.all_to_coarse.median | copy.4096_bytes.median
feedback 16384: level 0 and 1 held | - | - | feedback.all_held_fine.median | copy.4096_bytes.median
follower of the window: equal | 1131 | 5 | follow.equal.median | copy.4096_bytes.median
follower of the window: half size | - | - | follow.half_size.median | copy.4096_bytes.median
follower of the window: other tiles | - | - | follow.other_tiles.median | copy.4096_bytes.median
follower of the window: 30 % missing | - | - | follow.equal_stochastic.median | copy.4096_bytes.median
follower of the window: permanent | 1131 | 5 | follow.permanent.median | copy.4096_bytes.median
memcpy of 4096 bytes | - | - | copy.4096_bytes.median |
memcpy of the maps of a t1000 frame | - | - | floor.t1000.median |
memcpy of the maps of a t10000 frame | - | - | floor.t10000.median |
100000 idle textures: frame | 1014 | <1 | idle.100000_textures.median |
add a texture: typical | 0.5 | 0.5 | add.median |
add a texture: worst of 100000 | 590000 | 200 | add.worst |
map a tile, 256 heaps | 0.66 | - | heaps.256.map.median |
map a tile, 1024 heaps | 3.0 | - | heaps.1024.map.median |
map a tile, 4096 heaps | 19 | 0.1 | heaps.4096.map.median |
map, answer, unmap a tile, 4096 heaps | - | - | heaps.4096.map_answer_unmap.median |
defragment, 16 moves, 4096 heaps | - | - | growth.defragment.4096 |
the same, as many times that of 2048 | - | 3 | growth.defragment.ratio |
20000 failures before 20000 due later | - | - | growth.failures.20000 |
the same, as many times that of 10000 | - | 3 | growth.failures.ratio |
remove 20000 followers, newest first | - | - | growth.followers.20000 |
the same, as many times that of 10000 | - | 3 | growth.followers.ratio |
remove 20000 with given-up tiles | - | - | growth.reports.20000 |
the same, as many times that of 10000 | - | 3 | growth.reports.ratio |
ask for 20000 heaps, give them back | - | - | growth.heaps.20000 |
the same, as many times that of 10000 | - | 3 | growth.heaps.ratio |
memory per virtual tile | 40 | 8 | memory.virtual_tile.rss |
the same, every texture seen once | 40 | 8 | memory.virtual_tile_seen.rss |
memory per resident tile in addition | 78 | 64 | memory.resident_tile.rss |
t1000_fast, 4 heaps: too coarse | 1.67 | 0.40 | t1000_fast_cap4.levels_too_coarse |
t1000_fast, 4 heaps: uploads | 94277 | 27000 | t1000_fast_cap4.uploads |
t1000_fast, 4 heaps: stale | 77 | 2 | t1000_fast_cap4.stale_uploads |
t1000_fast, 4 heaps: frame, median | - | - | t1000_fast_cap4.total.median | floor.t1000_fast.median
t10000, 16 heaps: too coarse | 2.33 | 0.80 | t10000_cap16.levels_too_coarse |
t10000, 16 heaps: uploads | 164269 | 46000 | t10000_cap16.uploads |
t10000, 16 heaps: stale | 87 | 2 | t10000_cap16.stale_uploads |
t10000, 16 heaps: frame, median | - | - | t10000_cap16.total.median | floor.t10000.median
ROWS
}

print_table() {
    [ "$only" != clairvoyant ] || return 0
    if [ "$quick" = yes ]; then
        echo "--quick: each trace once, few repetitions, memory with 1 M tiles"
    elif [ "$have_harness" = yes ]; then
        echo "traces: of 3 runs the one with the least median; times without, quality with quality=1"
    fi
    rows | awk -F ' *[|] *' -v figures="$figures" '
        function short(x) { return x >= 1000 ? sprintf("%.0f", x) : sprintf("%.3g", x) }
        function line(a, b, c, d, e, f) {
            text = sprintf("%-40s %10s %10s %10s %-10s %10s", a, b, c, d, e, f)
            sub(/ +$/, "", text)
            print text
        }
        BEGIN {
            while ((getline text < figures) > 0) {
                split(text, part, " ")
                value[part[1]] = part[2]
                unit[part[1]] = part[3]
            }
            line("figure", "RTXTS", "ceiling", "Sluice", "", "/ memcpy")
        }
        $4 in value {
            ratio = $5 in value && value[$5] > 0 ? sprintf("%.1f x", value[$4] / value[$5]) : ""
            line($1, $2, $3, short(value[$4]), unit[$4], ratio)
        }'
}

# What is printed of a policy that knows the whole trace: row | name of the run
clairvoyant_rows() {
    cat <<'ROWS'
t1000, no cap | t1000
t10000, no cap | t10000
t1000_fast, 4 heaps | t1000_fast_cap4
t10000, 16 heaps | t10000_cap16
t1000, standby 4000 | t1000_standby4000
t10000, standby 4000 | t10000_standby4000
t10000, standby 40000 | t10000_standby40000
ROWS
}

print_clairvoyant() {
    [ "$have_harness" = yes ] && wants clairvoyant || return 0
    clairvoyant_rows | awk -F ' *[|] *' -v figures="$figures" '
        function levels(run) {
            run = run ".levels_too_coarse"
            return run in value ? sprintf("%.3g", value[run]) : "-"
        }
        function both(run) {
            return levels(run) ((run ".uploads") in value ? " / " value[run ".uploads"] : "")
        }
        function line(a, b, c, d, e) {
            text = sprintf("%-22s %16s %16s %8s %8s", a, b, c, d, e)
            sub(/ +$/, "", text)
            print text
        }
        BEGIN {
            while ((getline text < figures) > 0) {
                split(text, part, " ")
                value[part[1]] = part[2]
            }
            print "\nagainst a policy that knows the whole trace: levels too coarse / uploads"
            line("", "Sluice", "clairvoyant", "bound", "reactive")
        }
        $2 ~ /standby/ {
            if (!pairs++) {
                print "\nprefetching the coarsest level, no cap: levels too coarse / uploads"
                line("", "without", "prefetching")
            }
            line($1, both($2), both($2 "_prefetch1"))
            next
        }
        { line($1, both($2), both($2 ".priced"), levels($2 ".bound"), levels($2 ".reactive_floor")) }'
}

find_harness
build_library
build_programs
if [ "$have_harness" = yes ]; then
    make_traces
    run_trace t100 t100
    run_trace t1000 t1000
    run_trace t10000 t10000
    run_trace t1000_fast_cap4 t1000_fast maxHeaps=4
    run_trace t10000_cap16 t10000 maxHeaps=16
fi
run_micro
[ "$have_harness" = no ] || run_against_clairvoyant
if [ "$json" = yes ]; then
    print_json
else
    machine
    print_table
    print_clairvoyant
fi
