#!/usr/bin/env bash
# test_slurm.sh SLUICE_BAKE MAKE_PICTURE BAKE_SH: two nodes of Slurm on this machine bake a plan. Prints TAP.
#
# One node is killed while it works. Skipped without Slurm, without root, or with another Slurm running.
bake=$(realpath "$1") make=$(realpath "$2") driver=$(realpath "$3")
skip() { echo "1..0 # SKIP $*"; exit 0; }
PATH=$PATH:/usr/sbin:/sbin
for program in slurmctld slurmd sbatch; do
    command -v $program >/dev/null || skip "$program is missing (packages slurmctld slurmd slurm-client)"
done
[ "$(id -u)" -eq 0 ] || skip "slurmd needs root"
pgrep -x slurmctld >/dev/null && skip "another slurmctld runs"
# shellcheck source=/dev/null
. "$(dirname "${BASH_SOURCE[0]}")/../bake/facts.sh"
# shellcheck disable=SC2034 # it is what run runs
tool=$bake
shards=6
folder=${folder:?} # made by facts.sh

mkdir state
cat >slurm.conf <<END
ClusterName=test
SlurmctldHost=localhost(127.0.0.1)
SlurmUser=root
SlurmctldPort=16817
AuthType=auth/none
CredType=cred/none
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool-%n
SlurmctldPidFile=$folder/ctld.pid
SlurmdPidFile=$folder/slurmd-%n.pid
SlurmctldLogFile=$folder/ctld.log
SlurmdLogFile=$folder/slurmd-%n.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=sched_interval=5,batch_sched_delay=1
ReturnToService=2
SlurmdTimeout=10
KillWait=5
NodeName=n[1-2] NodeHostname=localhost NodeAddr=127.0.0.1 Port=[17001-17002] CPUs=$(nproc) RealMemory=1000
PartitionName=all Nodes=ALL Default=YES State=UP
END
export SLURM_CONF=$folder/slurm.conf SLUICE_BAKE=$bake
end_cluster() {
    pkill -9 -f "^slurmd -N n[12]" 2>/dev/null
    pkill -9 -x slurmstepd 2>/dev/null
    kill "$(cat ctld.pid 2>/dev/null)" 2>/dev/null
    sleep 0.5
    rm -rf "$folder"
}
trap end_cluster EXIT
slurmctld && slurmd -N n1 && slurmd -N n2
for ((i = 0; i < 100; i++)); do
    [ "$(sinfo -h -o %D -t idle 2>/dev/null)" = 2 ] && break
    sleep 0.1
done
[ "$(sinfo -h -o %D -t idle 2>/dev/null)" = 2 ] || skip "Slurm does not start here: $(tail -n 1 ctld.log)"

mkdir in
for i in 1 2 3 4 5 6 7 8 9 10 11 12; do
    "$make" rgb 1400 1400 $i in/p$i.png
done
"$bake" in -o one.d --plan one.plan --compression 15 >/dev/null && "$bake" --shard 1/1 one.plan --threads 1 >/dev/null &&
    "$bake" in -o many.d --plan the.plan --compression 15 >/dev/null
fact a_plan_is_made_and_baked_by_one_process

"$driver" the.plan $shards the.tsv -- -c 1 --mem=300 >driver.out 2>&1 &
driver_pid=$!
# Kills node n1 with all it runs once it has begun a store.
for ((i = 0; i < 300; i++)); do
    [ "$(squeue -h -r -t R -w n1 -o %i | wc -l)" -gt 0 ] && ls many.d/*.sluice-part >/dev/null 2>&1 && break
    sleep 0.1
done
squeue -h -r -t R -w n1 -o %i >killed.tasks
kill -STOP "$(cat slurmd-n1.pid)"
killed=0
while read -r environment; do
    process=${environment%/environ}
    kill -9 "${process#/proc/}" 2>/dev/null && killed=$((killed + 1))
done < <(grep -lz '^SLURMD_NODENAME=n1$' /proc/[0-9]*/environ 2>/dev/null)
pkill -9 -f 'slurmstepd: .*' 2>/dev/null
kill -9 "$(cat slurmd-n1.pid)"
cp killed.tasks out
[ "$killed" -gt 0 ] && [ -s killed.tasks ]
fact a_node_is_killed_while_it_works

wait $driver_pid && cp driver.out out && grep -q '^12 of 12 stores are there' driver.out && [ "$(wc -l <the.tsv)" -eq 14 ]
fact its_tasks_are_run_again_and_the_catalogue_is_written

diff -r one.d many.d
fact the_stores_have_the_bytes_of_one_process
end_facts
