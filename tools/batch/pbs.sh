#!/usr/bin/env bash
# A PBS job that runs a deck to its end, in as many jobs as it takes. qsub hands a script no arguments, so they are in the environment:
#
#   DECK=input/rc_slab.nml qsub -V tools/batch/pbs.sh
#   DECK=input/rc_slab.nml OPTIONS='--until 1.5e-3' qsub -V tools/batch/pbs.sh
#
# Copy this file, fit the lines below to your machine, and submit the copy with BRISANCE_JOB_SCRIPT set to its path.
#PBS -N brisance
#PBS -j oe
#PBS -l select=1:ncpus=32:mpiprocs=32
#PBS -l walltime=24:00:00
#
# Shortly before the time is up brisance writes a restart file and ends with status 4: then this script submits itself again,
# with --restart. On any other status it stops: 0 is done, 2 a bad deck, 3 a failed computation. To end a chain: qdel.
# To be set in the environment, where the defaults do not fit:
#   BRISANCE             the program (default: build/release/brisance under the folder of submission, else the one in PATH)
#   BRISANCE_LAUNCHER    default mpirun
#   BRISANCE_WALL_LIMIT  seconds that a job may compute (default: BRISANCE_MARGIN less than its walltime, as PBS_WALLTIME tells
#                        or else as the line above asks)
#   BRISANCE_MARGIN      seconds kept for the restart file, default 300
#   BRISANCE_JOBS_LEFT   how many more jobs may follow this one, default 50
#   BRISANCE_JOB_SCRIPT  this script (default: tools/batch/pbs.sh under the folder of submission)
set -u
if [ -z "${DECK:-}" ]; then
  echo "usage: DECK=file.nml [OPTIONS='options of brisance'] qsub -V pbs.sh" >&2
  exit 2
fi
cd "${PBS_O_WORKDIR:-.}" || exit 2
script=${BRISANCE_JOB_SCRIPT:-tools/batch/pbs.sh}
brisance=${BRISANCE:-build/release/brisance}
[ -x "$brisance" ] || brisance=$(command -v brisance) || { echo "error: there is no brisance; set BRISANCE to its path" >&2; exit 2; }
margin=${BRISANCE_MARGIN:-300}
jobs_left=${BRISANCE_JOBS_LEFT:-50}

if [ -n "${BRISANCE_WALL_LIMIT:-}" ]; then
  wall_limit=$BRISANCE_WALL_LIMIT
else
  walltime=${PBS_WALLTIME:-$(awk '/^#PBS -l walltime=/ { split($3, part, "="); n = split(part[2], t, ":")
    for (i = 1; i <= n; i++) seconds = 60*seconds + t[i]; print seconds }' "$script")}
  wall_limit=$((walltime - margin))
fi

export GLIBC_TUNABLES=${GLIBC_TUNABLES:-glibc.malloc.hugetlb=1} # huge pages for large arrays (glibc 2.35)
# OPTIONS is split at blanks on purpose: it holds several options.
${BRISANCE_LAUNCHER:-mpirun} "$brisance" "$DECK" ${OPTIONS:-} --wall-limit "$wall_limit"
status=$?
echo "brisance ended with status $status"
[ $status -eq 4 ] || exit $status
if [ "$jobs_left" -le 0 ]; then
  echo "error: not done, but no further job may follow (BRISANCE_JOBS_LEFT)" >&2
  exit $status
fi

# Go on from the newest restart file, whatever this job began from.
remaining=''
for option in ${OPTIONS:-}; do
  case $option in --restart | --restart=*) ;; *) remaining="$remaining $option" ;; esac
done
export DECK OPTIONS="$remaining --restart" BRISANCE_JOBS_LEFT=$((jobs_left - 1))
qsub -V "$script" || exit 1
