#!/bin/sh
# One picture as a Slurm array, a share of its rows for each task, and a job that merges them:
#
#   farm/slurm.sh scene.lua 64 picture.exr --spp 1024
#
# A task that is preempted, or that runs out of time, ends with a checkpoint and is run again from there; so is one that
# was killed, three times.
set -eu
scene=$1 shares=$2 picture=$3
shift 3
parts=$picture.parts
mkdir -p "$parts"

array=$(sbatch --parsable --array="0-$((shares - 1))" --requeue --signal=B:TERM@60 --output="$parts/%a.log" --open-mode=append <<END
#!/bin/sh
# The shell would keep SIGTERM to itself.
deburr render '$scene' $* --tile "auto/$shares" --checkpoint '$parts'/"\$SLURM_ARRAY_TASK_ID.sums" --resume --progress lines &
trap 'kill -TERM \$!' TERM
code=0
wait \$! || code=\$?
if kill -0 \$! 2>/dev/null; then code=0; wait \$! || code=\$?; fi
if [ "\$code" = 75 ] || { [ "\$code" -gt 128 ] && [ "\${SLURM_RESTART_COUNT:-0}" -lt 3 ]; }; then
    scontrol requeue "\${SLURM_ARRAY_JOB_ID}_\$SLURM_ARRAY_TASK_ID"
fi
exit "\$code"
END
)
sbatch --wait --dependency="afterok:$array" --kill-on-invalid-dep=yes --output="$parts/merge.log" \
    --wrap="deburr merge '$parts'/*.sums -o '$picture'"
