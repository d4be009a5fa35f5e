#!/usr/bin/env bash
# A sweep through a real Slurm on this machine: starts one of its own (munge, controller, node; own ports, everything in
# one folder), runs a sweep as an array job, kills a task on the way, compares the table with that of a plain sweep, and
# stops what it started. Needs root; asked for by DEPTHGRID_TEST_SLURM=1 (./dev test --with-slurm).
# usage: run.sh PROGRAM
set -euo pipefail

if [ "${DEPTHGRID_TEST_SLURM:-0}" != 1 ]; then
  echo "skipped: the Slurm test runs with ./dev test --with-slurm"
  exit 77
fi
program=$(readlink -f "$1")
work=$(mktemp -d /tmp/depthgrid-slurm.XXXXXX)
chmod 755 "$work"
started=()
stop() {
  for pid in "${started[@]}"; do kill "$pid" 2>/dev/null || true; done
  for pid in "${started[@]}"; do wait "$pid" 2>/dev/null || true; done
  rm -rf "$work"
}
trap stop EXIT
fail() {
  echo "FAILED: $*" >&2
  tail -n 20 "$work"/*.log "$work"/out/slurm/*.log >&2 2>/dev/null || true
  exit 1
}
wait_for() {  # wait_for SECONDS COMMAND...
  local tries=$(($1 * 5))
  shift
  until "$@" >/dev/null 2>&1; do
    tries=$((tries - 1))
    [ $tries -gt 0 ] || return 1
    sleep 0.2
  done
}

# munge: who is who. Its key and socket lie in our folder, owned by munge's user.
mkdir "$work/munge"
dd if=/dev/urandom of="$work/munge/key" bs=128 count=1 status=none
chmod 400 "$work/munge/key"
chown -R munge "$work/munge"
setpriv --reuid=munge --regid=munge --clear-groups munged --foreground --key-file="$work/munge/key" \
  --socket="$work/munge/socket" --pid-file="$work/munge/pid" --seed-file="$work/munge/seed" \
  --log-file="$work/munge/log" >"$work/munged.log" 2>&1 &
started+=($!)
wait_for 10 test -S "$work/munge/socket" || fail "munged did not start"

cpus=2
[ "$(nproc)" -ge 2 ] || cpus=1
controller_port=$((20000 + RANDOM % 10000))
mkdir "$work/state" "$work/spool"
cat >"$work/slurm.conf" <<CONF
ClusterName=test
SlurmctldHost=localhost
SlurmUser=root
SlurmdUser=root
SlurmctldPort=$controller_port
SlurmdPort=$((controller_port + 1))
AuthType=auth/munge
AuthInfo=socket=$work/munge/socket
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
MpiDefault=none
ReturnToService=2
SchedulerParameters=batch_sched_delay=1,sched_interval=2
NodeName=localhost NodeAddr=127.0.0.1 CPUs=$cpus State=UNKNOWN
PartitionName=all Nodes=localhost Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF=$work/slurm.conf
slurmctld -D >"$work/slurmctld.log" 2>&1 &
started+=($!)
slurmd -D -N localhost >"$work/slurmd.log" 2>&1 &
started+=($!)
node_idle() { sinfo --noheader --format=%t | grep -qx idle; }
wait_for 30 node_idle || fail "the node did not come up"
echo "Slurm $(sbatch --version | cut -d' ' -f2) is up with $cpus CPUs"

cat >"$work/sweep.yaml" <<'YAML'
experiment: living_room
set: {frames: 40, sensor.width: 160, sensor.height: 120}
axes:
  mapper.fusion.gain: {from: 0, to: 1, count: 40}
  slam_seed: {seeds: 16}
YAML
cd "$work"
"$program" sweep ./sweep.yaml -o plain -j "$cpus" || fail "the plain sweep"
"$program" sweep ./sweep.yaml -o out --executor slurm --slurm-tasks 4 >coordinator.log 2>&1 &
coordinator=$!
started+=("$coordinator")

# The first task that has begun to write is killed, and so is the coordinator, which is started again.
begun() { compgen -G "$work/out/shards/*/progress.txt"; }
wait_for 60 begun || fail "no task began"
task=$(pgrep -f -- "--shard [0-9]+/4 .* $work/out/shards/" | head -1) || fail "no task is running"
kill -9 "$task" && echo "killed a task"
kill -9 "$coordinator" && echo "killed the coordinator"
wait "$coordinator" 2>/dev/null || true
timeout 240 "$program" sweep ./sweep.yaml -o out --executor slurm --slurm-tasks 4 >coordinator.log 2>&1 ||
  fail "the sweep through Slurm: $(cat coordinator.log)"

untimed() {  # the table less its timing columns
  awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) keep[i] = $i !~ /time|_us/ }
           { line = ""; for (i = 1; i <= NF; i++) if (keep[i]) line = line "," $i; print line }' "$1"
}
cmp <(untimed plain/results.csv) <(untimed out/results.csv) || fail "the tables differ"
jobs=$(wc -l <out/slurm/jobs.txt)
[ "$jobs" -ge 2 ] || fail "the killed task was not submitted again"
echo "the same table of $(($(wc -l <out/results.csv) - 1)) runs through $jobs array jobs"
