#!/usr/bin/env bash
# test_shards.sh SLUICE_BAKE MAKE_PICTURE BAKE_SH: plans, shards and catalogues. Prints TAP.
bake=$(realpath "$1") make=$(realpath "$2") driver=$(realpath "$3")
# shellcheck source=/dev/null
. "$(dirname "${BASH_SOURCE[0]}")/facts.sh"
# shellcheck disable=SC2034 # it is what run runs
tool=$bake
shards=3 settings=(--format bc7 --quality fast --compression 3)

mkdir -p in/sub
for i in 1 2 3 4 5 6 7; do
    "$make" rgb $((i * 60)) 130 $i "in/p$i.png"
done
"$make" gray 300 300 8 in/sub/$'tab\tand\\line\nbreak.png'
run 0 in -o one.d "${settings[@]}" --threads 1
fact pictures_can_be_made_and_baked_by_one_process

run 0 in -o many.d "${settings[@]}" --plan the.plan --json && grep -q '"pictures": 8, "texels": 308400' out &&
    [ ! -e many.d ] && grep -q $'^pictures\t8$' the.plan &&
    [ "$(grep -c $'\t420\t130\t1\t' the.plan)" -eq 1 ]
fact a_plan_lists_pictures_and_bakes_none

run 1 --merge the.plan -o the.tsv --shard 1/$shards && [ ! -e the.tsv ] && grep -q '^0 of 8 stores are there' out &&
    [ "$(grep -c ': is missing$' out)" -eq 8 ] && grep -q '^shards to run again, of 3: 1,2,3$' out
fact without_stores_there_is_no_catalogue

: >said
for ((i = 1; i <= shards; i++)); do
    run 0 --shard $i/$shards the.plan --threads $i --json || break
    sed "s/^/$i /" out >>said
done
[ "$(wc -l <said)" -eq 8 ] && [ "$(grep -o '"output": "[^"]*"' said | sort -u | wc -l)" -eq 8 ] && diff -r one.d many.d
fact shards_bake_each_picture_once_and_write_the_bytes_of_one_process

# The longest shard takes at most the mean and one picture more.
python3 - the.plan said $shards <<'PY' >out 2>err
import json, sys
plan, said, count = sys.argv[1], sys.argv[2], int(sys.argv[3])
cost, loads = {}, [0.0] * count
for line in open(plan).read().split("\n")[5:]:
    if line:
        words = line.split("\t")
        cost[words[7].replace("\\t", "\t").replace("\\n", "\n").replace("\\\\", "\\")] = float(words[0])
for line in open(said):
    shard, text = line.split(" ", 1)
    loads[int(shard) - 1] += cost[json.loads(text)["output"]]
assert max(loads) <= sum(loads) / count + max(cost.values()), loads
assert min(loads) > 0.0, loads
PY
fact shards_are_balanced_by_work

run 0 --merge the.plan -o the.tsv && grep -q '^8 of 8 stores are there' out && [ "$(wc -l <the.tsv)" -eq 10 ] &&
    grep -q $'BC7_SRGB_BLOCK\t420\t130\t1\t[0-9]*\tin/p7.png\tmany.d/p7.store$' the.tsv && cp the.tsv before &&
    run 0 --merge the.plan -o the.tsv && cmp the.tsv before
fact the_catalogue_names_all_stores
mkdir -p other && run 0 --merge the.plan -o many.d/list.tsv && grep -q $'in/p7.png\tp7.store$' many.d/list.tsv &&
    run 0 --merge the.plan -o ./many.d/list.tsv && grep -q $'in/p7.png\tp7.store$' many.d/list.tsv &&
    run 0 --merge the.plan -o "$PWD/many.d/list.tsv" && grep -q $'in/p7.png\tp7.store$' many.d/list.tsv &&
    run 0 --merge the.plan -o other/list.tsv && grep -q $'in/p7.png\t'"$(realpath many.d/p7.store)"'$' other/list.tsv &&
    rm many.d/list.tsv
fact stores_are_named_from_the_folder_of_the_catalogue

run 0 --shard 2/$shards the.plan && grep -q ' 0 failed' out && grep -q '^0 baked' out
fact a_shard_that_runs_again_leaves_stores_alone

rm many.d/p7.store && cp many.d/p1.store many.d/p2.store && truncate -s -1 many.d/p3.store &&
    "$bake" in/p4.png -o many.d/p4.store >/dev/null && run 1 --merge the.plan -o again.tsv --shard 1/$shards &&
    [ ! -e again.tsv ] && grep -q 'p7.store: is missing' out && grep -q 'p2.store: was made from another picture' out &&
    grep -q 'p3.store: SLUICE_ERROR' out && grep -q 'p4.store: was made with other settings' out &&
    grep -q '^4 of 8 stores are there' out
fact stores_that_do_not_fit_the_plan_are_named

run 0 --merge the.plan -o again.tsv --shard 1/$shards || SLUICE_BAKE=$bake "$driver" the.plan $shards again.tsv --local 2 >out 2>err
cmp again.tsv the.tsv && diff -r one.d many.d
fact shards_that_lack_stores_run_again
mkdir -p "I I" && cp the.plan "I I/I.plan" && ln -s "$bake" "I I/bake" && rm many.d/p1.store again.tsv &&
    SLUICE_BAKE="$PWD/I I/bake" "$driver" "I I/I.plan" $shards again.tsv --local 1 --rounds 0 >out 2>err && cmp again.tsv the.tsv
fact paths_may_have_blanks_and_capitals

code=0
SLUICE_BAKE=$PWD/absent/sluice-bake "$driver" the.plan 2 absent.tsv --local 1 >out 2>err || code=$?
[ $code -eq 2 ] && [ "$(grep -c . err)" -eq 1 ] && grep -q "^bake.sh: there is no $PWD/absent/sluice-bake; " err && [ ! -s out ]
fact a_driver_without_the_program_says_so_at_once

lines=$(wc -l <the.plan) wrong=0
for ((i = 0; i < lines; i++)); do
    head -n $i the.plan >cut.plan
    run 1 --shard 1/2 cut.plan && grep -q "^sluice-bake: cut.plan: line $((i + 1)): " err || wrong=$((wrong + 1))
done
size=$(stat -c %s the.plan)
for ((i = 0; i < size; i += 41)); do
    cp the.plan hurt.plan && printf '\377' | dd of=hurt.plan bs=1 seek=$i conv=notrunc 2>/dev/null
    "$bake" --merge hurt.plan -o hurt.tsv >out 2>err
    [ $? -le 1 ] || wrong=$((wrong + 1))
done
[ $wrong -eq 0 ]
fact damaged_plans_are_refused_with_the_line

sed 's/quality=1/quality=2/' the.plan >other.plan && run 1 --shard 1/2 other.plan && grep -q 'line 3: .*make the plan again' err
fact settings_that_do_not_fit_their_hash_are_refused

run 2 --shard 0/3 the.plan && run 2 --shard 4/3 the.plan && grep -q 'shard 4/3: wants I/N, with I from 1 to N' err && run 2 --shard 1 the.plan && run 2 --shard 1/2 the.plan -o x &&
    run 2 --merge the.plan && run 2 --merge the.plan in -o x.tsv && run 2 in -o x --plan p --merge &&
    run 2 --cube in/p{1,2,3,4,5,6}.png -o x.store --plan p && run 1 --shard 1/2 absent.plan && grep -q 'absent.plan: No such file' err
fact wrong_usage_is_refused

echo junk >in/junk.png
run 1 in -o many.d --plan with.plan && grep -q 'in/junk.png: left out of the plan' err && grep -q $'^pictures\t8$' with.plan
fact pictures_that_cannot_be_read_are_named_and_left_out

end_facts
