#!/usr/bin/env bash
# tools/measure shock-helium: speeds of a coarse run against one-dimensional theory; half of the domain gives what the whole one gives.
# timeout: 300
set -u
source "$(dirname "$0")/../../support/checks.sh" shock_helium

speed() { awk -F'|' -v name="$1" -v c="$2" 'index($2, name) { print $c + 0 }' table.md; }

run() { # run FOLDER OPTIONS...
  local folder=$1
  shift
  "$BRISANCE_EXE" "$source_folder/input/shock_helium_coarse.nml" --output "$folder" --quiet --until 50 --set output%snapshot_interval=2 "$@"
}
check "half of the domain runs" run half --set mesh%cells=162,22
check "the whole one runs" run whole --set mesh%cells=162,44 --set mesh%lower=0,-44.5
check "the tool runs" "$source_folder/tools/measure" shock-helium half whole
cp log table.md
# plane waves: 420 m/s in air, 1126 m/s refracted; the shock through a cylinder is slower than the plane one
check "incident shock" close "$(speed 'incident shock' 5)" 410 440
check "refracted shock" close "$(speed 'refracted shock' 5)" 980 1130
check "upstream interface" close "$(speed 'upstream interface, first' 5)" 150 215
check "the run ends before the later windows" grep -q '^| vortex pair | 128 | - | - |' table.md
for name in 'incident shock' 'refracted shock' 'upstream interface, first' 'downstream interface, behind'; do
  check "$name in the whole domain" [ "$(speed "$name" 5)" = "$(speed "$name" 7)" ]
done
check "pictures" [ -s half/pictures/schlieren_sheet.png -a -s half/pictures/wave_diagram.png ]

echo "test_shock_helium: $passed passed, $failed failed"
[ "$failed" -eq 0 ]
