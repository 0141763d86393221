#!/bin/bash
# Tests rendering under a real Slurm, which the script starts on this machine alone and ends again:
#
#   tests/farm/slurm_test.sh build/release/deburr
#
# It renders a picture as an array of tiles by farm/slurm.sh, where Slurm requeues one task and another is killed, and
# as an array of ranges of samples. Merged, both must have the bytes of the picture that one run makes. Run it as root,
# as Slurm's daemons need, with Debian's slurm-wlm. The daemons use 127.0.0.1 and files in a temporary folder.
set -euo pipefail
source=$(cd "$(dirname "$0")/../.." && pwd)
program=$(readlink -f "${1:?expected the program deburr}")
[ "$(id -u)" = 0 ] || { echo "slurm_test: expected to be root" >&2; exit 2; }
for daemon in munged slurmctld slurmd; do
    command -v $daemon >/dev/null || { echo "slurm_test: expected $daemon of the package slurm-wlm, found none" >&2; exit 2; }
done
fail() { echo "slurm_test: $*" >&2; for log in "$place"/*.log; do echo "== $log" >&2; tail -n 20 "$log" >&2; done; exit 1; }

place=$(mktemp -d)
daemons=()
end() {
    scancel --user=root --quiet 2>/dev/null || true
    for daemon in "${daemons[@]}"; do kill "$daemon" 2>/dev/null || true; done
    for daemon in "${daemons[@]}"; do wait "$daemon" 2>/dev/null || true; done
    rm -rf "$place"
}
trap end EXIT

# This Slurm has its own key, ports and folders, so that another Slurm on the machine is not touched. It uses neither
# systemd nor control groups, which a container may not have.
mkdir "$place/bin" "$place/state" "$place/spool" "$place/work"
ln -s "$program" "$place/bin/deburr"
export PATH=$place/bin:$PATH SLURM_CONF=$place/slurm.conf SOURCE_DATE_EPOCH=0
first_port=$((20000 + $$ % 20000))
cat >"$SLURM_CONF" <<END
ClusterName=deburr
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=$first_port
SlurmdPort=$((first_port + 1))
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$place/munge.socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=requeue_delay=0,sched_interval=2,bf_interval=2
SwitchType=switch/none
MpiDefault=none
ReturnToService=2
StateSaveLocation=$place/state
SlurmdSpoolDir=$place/spool
SlurmctldPidFile=$place/slurmctld.pid
SlurmdPidFile=$place/slurmd.pid
SlurmctldLogFile=$place/slurmctld.log
SlurmdLogFile=$place/slurmd.log
NodeName=localhost NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=localhost Default=YES MaxTime=10 State=UP
END
head -c 128 /dev/urandom >"$place/munge.key"
chmod 400 "$place/munge.key"
munged --foreground --force --key-file="$place/munge.key" --socket="$place/munge.socket" --pid-file="$place/munge.pid" \
    --log-file="$place/munged.log" --seed-file="$place/munge.seed" >"$place/munged.out.log" 2>&1 & daemons+=($!)
for _ in $(seq 100); do [ -S "$place/munge.socket" ] && break; sleep 0.1; done
slurmctld -D >"$place/slurmctld.out.log" 2>&1 & daemons+=($!)
slurmd -D -N localhost >"$place/slurmd.out.log" 2>&1 & daemons+=($!)
for _ in $(seq 100); do [ "$(sinfo --noheader --format=%t 2>/dev/null)" = idle ] && break; sleep 0.2; done
[ "$(sinfo --noheader --format=%t)" = idle ] || fail "expected a node that is idle, got '$(sinfo --noheader --format=%t)'"

cd "$place/work"
cp "$source/scenes/csg_examples.lua" scene.lua
picture=(--size 320x200 --spp 160 --threads 1)
deburr render scene.lua -q "${picture[@]}" -o whole.exr

# The process of this test whose command line contains the text.
process_with() {
    local found
    for found in $(pgrep -f -- "$1"); do
        if [ "$(readlink "/proc/$found/cwd")" = "$place/work" ] && [ "$(cat "/proc/$found/comm")" = deburr ]; then echo "$found"; fi
    done
}

echo "an array of tiles, of which one is requeued and one is killed"
"$source/farm/slurm.sh" scene.lua 4 tiles.exr "${picture[@]}" --checkpoint-every 0.2 & farm=$!
for _ in $(seq 300); do
    if [ -s tiles.exr.parts/0.sums ] && [ -s tiles.exr.parts/1.sums ]; then break; fi
    sleep 0.1
done
array=$(squeue --noheader --format=%F | sort -n | head -n 1)
scontrol requeue "${array}_0" || fail "expected a task to requeue"
killed=$(process_with tiles.exr.parts/1.sums)
[ -n "$killed" ] || fail "expected a task to kill"
kill -KILL "$killed"
# A requeued task waits for two minutes unless its start time is set.
while kill -0 $farm 2>/dev/null; do
    for job in $(squeue --noheader --states=pending --format=%A:%r | sed -n 's/:BeginTime$//p'); do
        scontrol update JobId="$job" StartTime=now 2>/dev/null || true
    done
    sleep 0.3
    [ $SECONDS -lt 300 ] || fail "expected an end within five minutes"
done
wait $farm || fail "farm/slurm.sh failed"
grep -q "DUE TO JOB REQUEUE" "$place/slurmd.log" || fail "expected a task that was requeued"
[ "$(grep -c "Launching batch job" "$place/slurmd.log")" = 7 ] ||
    fail "expected four tasks, two of them twice, and a merge, got $(grep -c "Launching batch job" "$place/slurmd.log")"
cmp whole.exr tiles.exr || fail "expected the bytes of the whole picture of tiles, got others"

echo "an array of ranges of samples"
mkdir ranges
cat >ranges.sh <<'END'
#!/bin/sh
i=$SLURM_ARRAY_TASK_ID
exec deburr render scene.lua -q --size 320x200 --spp 160 --samples "$((40 * i))-$((40 * i + 40))" --checkpoint "ranges/$i.sums"
END
sbatch --wait --quiet --array=0-3 --cpus-per-task=1 --output=ranges/%a.log ranges.sh || fail "an array of ranges failed"
deburr merge ranges/*.sums -o ranges.exr
cmp whole.exr ranges.exr || fail "expected the bytes of the whole picture of ranges, got others"
echo "slurm_test: passed in $SECONDS s"
