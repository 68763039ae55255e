#!/usr/bin/env bash
# tools/measure building: its figures against those that the files of a short run show.
# timeout: 180
set -u
source "$(dirname "$0")/../../support/checks.sh" building

close() { # close VALUE REFERENCE TOLERANCE
  awk -v v="$1" -v a="$2" -v t="$3" 'BEGIN { exit !(v > a - t && v < a + t && a != 0) }'
}
column() { # column FILE HEAD: the largest number in the column whose heading begins so
  awk -F, -v head="$2" 'NR == 1 { for (i = 1; i <= NF; i++) if (index($i, head) == 1) c = i; next } $c + 0 > m { m = $c + 0 } END { print m }' "$1"
}
coarse=(--set mesh%cells=50,17,48 --set mesh%brick=25,17,24 --set charge%start=none)
for body in 1 2 3 4; do coarse+=(--set "body($body)%spacing=0.02225"); done
"$BRISANCE_EXE" "$source_folder/input/building.nml" --output run --quiet --until 0.45e-3 "${coarse[@]}"
check "the tool runs" "$source_folder/tools/measure" building run
cp log table.txt
check "displacement of the middle" close "$(sed -n 's/.*displacement of the middle: peak \([0-9.]*\) mm.*/\1/p' table.txt)" \
  "$(awk -v m="$(column run/gauges.csv 'column middle.displacement_x')" 'BEGIN { print 1e3*m }')" 0.01
check "overpressure" close "$(sed -n 's/.*front, middle:.* overpressure \([0-9.]*\) MPa.*/\1/p' table.txt)" \
  "$(awk -v m="$(column run/gauges.csv 'front middle.overpressure')" 'BEGIN { print 1e-6*m }')" 0.01
check "impulse on the column" close "$(sed -n 's/.*over its front: \([0-9]*\) Pa s.*/\1/p' table.txt)" \
  "$(awk -v m="$(column run/loads.csv 'column.impulse_x')" 'BEGIN { print m/(0.0445*0.9345) }')" 1
check "picture" [ -s run/pictures/building.png ]

echo "test_building: $passed passed, $failed failed"
[ "$failed" -eq 0 ]
