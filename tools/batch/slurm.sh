#!/usr/bin/env bash
# A Slurm job that runs a deck to its end, in as many jobs as it takes.
#
#   sbatch tools/batch/slurm.sh DECK [OPTIONS of brisance]
#
# Copy this file, fit the lines below to your machine, and submit the copy. (What is given to sbatch on the command line holds
# for the first job only; the jobs that follow read these lines.)
#SBATCH --job-name=brisance
#SBATCH --output=%x-%j.log
#SBATCH --nodes=1
#SBATCH --ntasks-per-node=32
#SBATCH --time=24:00:00
#
# Shortly before the time is up brisance writes a restart file and ends with status 4: then this script submits itself again,
# with --restart. On any other status it stops: 0 is done, 2 a bad deck, 3 a failed computation. To end a chain: scancel.
# To be set in the environment, where the defaults do not fit:
#   BRISANCE             the program (default: build/release/brisance under the folder of submission, else the one in PATH)
#   BRISANCE_LAUNCHER    default srun
#   BRISANCE_WALL_LIMIT  seconds that a job may compute (default: up to BRISANCE_MARGIN before its end)
#   BRISANCE_MARGIN      seconds kept for the restart file, default 300
#   BRISANCE_JOBS_LEFT   how many more jobs may follow this one, default 50
set -u
if [ $# -lt 1 ]; then
  echo "usage: sbatch slurm.sh DECK [OPTIONS of brisance]" >&2
  exit 2
fi
cd "${SLURM_SUBMIT_DIR:-.}" || exit 2
brisance=${BRISANCE:-build/release/brisance}
[ -x "$brisance" ] || brisance=$(command -v brisance) || { echo "error: there is no brisance; set BRISANCE to its path" >&2; exit 2; }
margin=${BRISANCE_MARGIN:-300}
jobs_left=${BRISANCE_JOBS_LEFT:-50}

if [ -n "${BRISANCE_WALL_LIMIT:-}" ]; then
  wall_limit=$BRISANCE_WALL_LIMIT
elif [ -n "${SLURM_JOB_END_TIME:-}" ]; then # Slurm 22.05 and newer
  wall_limit=$((SLURM_JOB_END_TIME - $(date +%s) - margin))
else # d-hh:mm:ss, hh:mm:ss, mm:ss or ss are left
  left=$(squeue --noheader --jobs="$SLURM_JOB_ID" --format=%L)
  wall_limit=$(awk -v left="$left" -v margin="$margin" 'BEGIN {
    if (left !~ /^[0-9]/) { print 0; exit } # UNLIMITED: brisance takes 0 for no limit
    n = split(left, part, "[-:]"); days = (left ~ /-/) ? part[1] : 0
    for (i = (left ~ /-/) ? 2 : 1; i <= n; i++) seconds = 60*seconds + part[i]
    print 86400*days + seconds - margin }')
fi

export GLIBC_TUNABLES=${GLIBC_TUNABLES:-glibc.malloc.hugetlb=1} # huge pages for large arrays (glibc 2.35)
${BRISANCE_LAUNCHER:-srun} "$brisance" "$@" --wall-limit "$wall_limit"
status=$?
echo "brisance ended with status $status"
[ $status -eq 4 ] || exit $status
if [ "$jobs_left" -le 0 ]; then
  echo "error: not done, but no further job may follow (BRISANCE_JOBS_LEFT)" >&2
  exit $status
fi

# Go on from the newest restart file, whatever this job began from.
arguments=()
for argument in "$@"; do
  case $argument in --restart | --restart=*) ;; *) arguments+=("$argument") ;; esac
done
export BRISANCE_JOBS_LEFT=$((jobs_left - 1))
# $0 is Slurm's copy of this script, which lasts as long as the job: sbatch takes a copy of its own.
sbatch "$0" "${arguments[@]}" --restart || exit 1
