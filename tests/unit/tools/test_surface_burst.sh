#!/usr/bin/env bash
# tools/measure surface-burst: its curves against the simplified ones of Swisdak (1994), and the table and picture of a short run.
# timeout: 120
set -u
source "$(dirname "$0")/../../support/checks.sh" surface_burst

field() { awk -F'|' -v z="$1" -v c="$2" '$2 + 0 == z && NF > 5 { print $c + 0 }' table.md; }

"$BRISANCE_EXE" "$source_folder/input/surface_burst.nml" --output run --quiet --set mesh%cells=300 --set mesh%upper=3.0 \
  --set 'gauge(7)%position=2.5' --set 'gauge(8)%position=2.5' --set 'gauge(9)%position=2.5' --set 'gauge(10)%position=2.5' \
  --set 'gauge(11)%position=2.5' --set run%end_time=1.6e-3
check "the tool runs" "$source_folder/tools/measure" surface-burst run
cp log table.md
# ln y = A + B ln Z + ...: 1359 kPa and 0.4675 ms at Z = 1 (Swisdak: exp(7.2106), exp(-0.7604)); 551 kPa at 1.5
check "curve of the pressure" close "$(field 1 4)" 1330 1380
check "curve of the arrival" close "$(field 1 10)" 0.463 0.472
check "curve of the pressure further out" close "$(field 1.5 4)" 540 565
check "pressure of the run" close "$(field 1 5)" -20 20
check "impulse of the run" close "$(field 0.75 8)" -25 15
check "arrival of the run" close "$(field 1 11)" -15 2
check "gauges that the wave has not passed are left out" [ -z "$(field 3 4)" ]
check "picture" [ -s docs/pictures/surface_burst.png ]

echo "test_surface_burst: $passed passed, $failed failed"
[ "$failed" -eq 0 ]
