#!/usr/bin/env bash
# Bakes a plan in N shards, runs failed shards again, and merges. docs/cluster.md says more.
#
#   bake.sh PLAN N CATALOGUE [--local JOBS] [--rounds N] [-- SBATCH_OPTIONS...]
#
#   --local JOBS   no cluster: JOBS shards at a time on this machine
#   --rounds N     run failed shards again so many times (default: 3)
#   --help
#
# Without --local the shards are tasks of a Slurm job array. Options behind -- go to sbatch:
# -c 4 --mem=4G -p PARTITION. The exit status is 0 if the catalogue was written.
#
# Environment: SLUICE_BAKE   the program (default: sluice-bake of PATH)

set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bake=${SLUICE_BAKE:-sluice-bake}
export SLUICE_BAKE=$bake

usage() { sed -n '2,/^$/s/^# \{0,1\}//p' "${BASH_SOURCE[0]}"; }
die() {
    echo "bake.sh: $*" >&2
    exit 2
}

words=() local_jobs=0 rounds=3
while [ $# -gt 0 ]; do
    case $1 in
    --help) usage; exit 0 ;;
    --local) local_jobs=${2:?--local needs a number}; shift ;;
    --rounds) rounds=${2:?--rounds needs a number}; shift ;;
    --) shift; break ;;
    -*) die "unknown option $1 (see --help)" ;;
    *) words+=("$1") ;;
    esac
    shift
done
[ ${#words[@]} -eq 3 ] || die "PLAN, N and CATALOGUE are needed (see --help)"
plan=${words[0]} count=${words[1]} catalogue=${words[2]}
case $count$local_jobs$rounds in *[!0-9]*) die "N, JOBS and rounds are numbers" ;; esac
command -v "$bake" >/dev/null ||
    die "there is no $bake; add the folder of sluice-bake to PATH, or name the program: SLUICE_BAKE=FOLDER/sluice-bake"
[ "$local_jobs" -gt 0 ] || command -v sbatch >/dev/null || die "there is no sbatch; --local JOBS needs no cluster"

# run_shards LIST SBATCH_OPTIONS...: shards as 1,5,7 or 1-8. Failed ones are found by the merge.
run_shards() {
    local list=$1
    shift
    if [ "$local_jobs" -gt 0 ]; then
        case $list in *-*) list=$(seq -s , "${list%-*}" "${list#*-}") ;; esac
        # The merge names what failed.
        tr , '\n' <<<"$list" | xargs -P "$local_jobs" -I @TASK@ "$bake" --shard "@TASK@/$count" "$plan" || true
    else
        sbatch --wait --array="$list" "$@" "$here/bake.sbatch" "$plan" "$count" || true
    fi
}

run_shards "1-$count" "$@"
for ((round = 0; ; round++)); do
    status=0
    said=$("$bake" --merge "$plan" --shard "1/$count" -o "$catalogue") || status=$?
    if [ $status -eq 0 ] || [ "$round" -ge "$rounds" ]; then
        echo "$said"
        exit $status
    fi
    again=$(sed -n 's/^shards to run again, of [0-9]*: //p' <<<"$said")
    [ -n "$again" ] || { echo "$said"; exit "$status"; }
    echo "bake.sh: round $((round + 1)) of $rounds: shards $again of $count run again"
    run_shards "$again" "$@"
done
