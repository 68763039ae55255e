#!/usr/bin/env bash
# The job scripts of tools/batch against stand-ins of brisance, Slurm and PBS: they go on while the exit status is 4, and only then.
# timeout: 60
set -u
source_folder=${BRISANCE_SOURCE:-$(cd "$(dirname "$0")/../../.." && pwd)}
work=$PWD/batch
passed=0 failed=0
rm -rf "$work" && mkdir -p "$work/bin"
export PATH="$work/bin:$PATH"

check() { # check NAME COMMAND...: the command must succeed
  local name=$1
  shift
  if "$@"; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "  FAILED: $name"; cat "$work"/log "$work"/calls 2>/dev/null; fi
}

# brisance: notes its arguments and ends with the next status of the file `statuses`.
cat >"$work/bin/brisance" <<'END'
#!/usr/bin/env bash
echo "$*" >>"$WORK/calls"
status=$(head -n 1 "$WORK/statuses")
sed -i 1d "$WORK/statuses"
exit "$status"
END
# The queues run a job at once, from a copy as the real ones do.
cat >"$work/bin/sbatch" <<'END'
#!/usr/bin/env bash
copy=$(mktemp "$WORK/script.XXXXXX") && cp "$1" "$copy" && shift && echo submitted >>"$WORK/submissions"
SLURM_JOB_ID=1 SLURM_SUBMIT_DIR=$WORK bash "$copy" "$@"
END
cat >"$work/bin/qsub" <<'END'
#!/usr/bin/env bash
[ "$1" = -V ] || exit 9
copy=$(mktemp "$WORK/script.XXXXXX") && cp "$2" "$copy" && echo submitted >>"$WORK/submissions"
PBS_O_WORKDIR=$WORK bash "$copy"
END
printf '#!/usr/bin/env bash\nexec "$@"\n' | tee "$work/bin/srun" >"$work/bin/mpirun"
printf '#!/usr/bin/env bash\necho "$LEFT"\n' >"$work/bin/squeue"
chmod +x "$work"/bin/*
export WORK=$work BRISANCE=$work/bin/brisance
unset BRISANCE_WALL_LIMIT BRISANCE_MARGIN BRISANCE_JOBS_LEFT BRISANCE_LAUNCHER BRISANCE_JOB_SCRIPT SLURM_JOB_END_TIME PBS_WALLTIME OPTIONS

# Submits with the given exit statuses of brisance to come; leaves calls, submissions and log behind.
slurm() { # slurm 'STATUSES' ARGUMENTS...
  printf '%s\n' $1 >"$work/statuses"
  shift
  rm -f "$work/calls" "$work/submissions"
  sbatch "$source_folder/tools/batch/slurm.sh" "$@" >"$work/log" 2>&1
}
pbs() { # pbs 'STATUSES'
  printf '%s\n' $1 >"$work/statuses"
  rm -f "$work/calls" "$work/submissions"
  BRISANCE_JOB_SCRIPT=$source_folder/tools/batch/pbs.sh qsub -V "$source_folder/tools/batch/pbs.sh" >"$work/log" 2>&1
}
calls() { # calls EXPECTED: what brisance was called with, a line per job
  [ "$(cat "$work/calls")" = "$1" ]
}
submissions() { [ "$(wc -l <"$work/submissions")" -eq "$1" ]; }

export BRISANCE_WALL_LIMIT=1000
slurm '4 4 0' a.nml --until 3; status=$?
check 'slurm: it ends well' [ $status -eq 0 ]
check 'slurm: later jobs restart' calls "a.nml --until 3 --wall-limit 1000
a.nml --until 3 --restart --wall-limit 1000
a.nml --until 3 --restart --wall-limit 1000"
check 'slurm: one job after each stop' submissions 3
for end in 0 2 3 137; do
  slurm "$end" a.nml; status=$?
  check "slurm: status $end is returned" [ $status -eq $end ]
  check "slurm: status $end ends the chain" submissions 1
done
slurm '4 0' a.nml --restart=old.h5
check 'slurm: the first restart file is not used again' calls "a.nml --restart=old.h5 --wall-limit 1000
a.nml --restart --wall-limit 1000"
BRISANCE_JOBS_LEFT=2 slurm '4 4 4 4 4' a.nml; status=$?
check 'slurm: the chain has a limit' submissions 3
check 'slurm: at the limit the status tells' [ $status -ne 0 ]

export DECK=b.nml
OPTIONS='--set mesh%cells=8,8,8' pbs '4 4 0'; status=$?
check 'pbs: it ends well' [ $status -eq 0 ]
check 'pbs: later jobs restart' calls "b.nml --set mesh%cells=8,8,8 --wall-limit 1000
b.nml --set mesh%cells=8,8,8 --restart --wall-limit 1000
b.nml --set mesh%cells=8,8,8 --restart --wall-limit 1000"
for end in 0 2 3 137; do
  pbs "$end"; status=$?
  check "pbs: status $end is returned" [ $status -eq $end ]
  check "pbs: status $end ends the chain" submissions 1
done
BRISANCE_JOBS_LEFT=2 pbs '4 4 4 4 4'; status=$?
check 'pbs: the chain has a limit' submissions 3
check 'pbs: at the limit the status tells' [ $status -ne 0 ]

unset BRISANCE_WALL_LIMIT
LEFT=1-02:03:04 slurm 0 a.nml
check 'slurm: time left with days' calls "a.nml --wall-limit $((86400 + 2*3600 + 3*60 + 4 - 300))"
LEFT=10:00 BRISANCE_MARGIN=60 slurm 0 a.nml
check 'slurm: time left in minutes' calls 'a.nml --wall-limit 540'
LEFT=UNLIMITED slurm 0 a.nml
check 'slurm: no limit' calls 'a.nml --wall-limit 0'
SLURM_JOB_END_TIME=$(($(date +%s) + 5000)) slurm 0 a.nml
limit=$(sed 's/.* //' "$work/calls")
check 'slurm: time left from the end time' [ $((limit >= 4690 && limit <= 4700)) -eq 1 ]
pbs 0
check 'pbs: the walltime of the script' calls 'b.nml --wall-limit 86100'
PBS_WALLTIME=3600 pbs 0
check 'pbs: the walltime of the queue' calls 'b.nml --wall-limit 3300'

echo "test_batch: $passed passed, $failed failed"
[ $failed -eq 0 ]
