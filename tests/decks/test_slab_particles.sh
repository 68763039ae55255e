#!/usr/bin/env bash
# The decks of the slab by particles alone run, the books close, two ranks give the bits of one; tools/measure slab-particles
# puts them beside the coupled slab.
# timeout: 300
set -u
source "$(dirname "$0")/../support/checks.sh" slab_particles

drift() { sed -n "/\"drift\"/,/}/s/.*\"$2\": \([-+.E0-9]*\).*/\1/p" "$1/summary.json"; }
checksum() { sed -n 's/.*"state_checksum": "\(.*\)".*/\1/p' "$1/summary.json"; }
figure() { awk -F'|' -v name="$1" -v c="$2" 'index($2, name) { print $c + 0 }' table.md; }

small="--set mesh%cells=16,16,16 --set body(1)%spacing=0.01"
alone="$small --set body(2)%spacing=0.005 --set body(3)%spacing=0.019"
run() { # run DECK FOLDER OPTIONS...: coarse, until the blast has met the slab
  local deck=$1 folder=$2
  shift 2
  "$BRISANCE_EXE" "$source_folder/input/$deck.nml" --output "$folder" --quiet "$@"
}
check "particles alone" run rc_slab_mpm_coarse alone $alone --until 0.18e-3
check "energy kept" close "$(drift alone energy)" -0.05 0.05
check "momentum kept" close "$(drift alone momentum)" -1e-10 1e-10
check "one rank" run rc_slab_mpm one $alone --steps 8
check "two ranks" "$MPIEXEC" -n 2 "$BRISANCE_EXE" "$source_folder/input/rc_slab_mpm.nml" --output two --quiet $alone --steps 8
check "same bits" [ -n "$(checksum one)" -a "$(checksum one)" = "$(checksum two)" ]
check "coupled to the flow" run rc_slab_coarse coupled $small --until 0.18e-3
check "the tool runs" "$source_folder/tools/measure" slab-particles coupled alone
cp log table.md
check "the shock runs towards the slab" close "$(figure 'outermost place' 4)" 150 400
check "the slab is pushed away from the charge" close "$(figure 'momentum of the slab' 6)" 1 100
check "pictures" [ -s alone/pictures/slab_particles_pressure.png -a -s alone/pictures/slab_particles_deflection.png ]

echo "test_slab_particles: $passed passed, $failed failed"
[ "$failed" -eq 0 ]
