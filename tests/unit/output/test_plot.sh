#!/usr/bin/env bash
# tools/plot on short runs in one, two and three dimensions: the pictures are there, the numbers in them are those of the run.
# labels: decks
# timeout: 300
set -u
here=$(cd "$(dirname "$0")" && pwd)
source_folder=${BRISANCE_SOURCE:-$(cd "$here/../../.." && pwd)}
work=$PWD/plot
passed=0 failed=0
rm -rf "$work" && mkdir -p "$work" && cd "$work" || exit 1

check() { # check NAME COMMAND...: the command must succeed
  local name=$1
  shift
  if "$@" >log 2>&1; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "  FAILED: $name"; cat log; fi
}
fails() { ! "$@"; }
plot() { "$source_folder/tools/plot" "$@"; }
run() { # run DECK FOLDER OPTIONS...
  local deck=$1 folder=$2
  shift 2
  "$BRISANCE_EXE" "$source_folder/input/$deck.nml" --output "$folder" --quiet "$@"
}
pictures() { # pictures FOLDER NAME...: they exist and are no empty frames
  local folder=$1 name
  shift
  for name in "$@"; do
    [ "$(wc -c <"$folder/$name.png")" -gt 8000 ] || { echo "$folder/$name.png is missing or empty"; return 1; }
  done
}
says() { # says TEXT COMMAND...: the command's output has the text
  local text=$1
  shift
  "$@" 2>&1 | tee said | grep -qF -- "$text" || { cat said; return 1; }
}

check 'sod runs' run sod one
check 'shock and bubble runs' run shock_helium_coarse two --steps 20 --set mesh%cells=65,9,1
check 'taylor bar runs' run taylor_bar bar --steps 40 --set body%spacing=0.5
check 'slab runs' run rc_slab_coarse three --steps 12
check 'material tests run' run material_tests points
check 'standard pictures' plot --standard one two bar three points --standard one
check 'pictures in one dimension' pictures one/pictures flow_lines peaks gauges history
check 'pictures in two dimensions' pictures two/pictures flow_pressure flow_density flow_schlieren peaks history
check 'pictures of a solid' pictures bar/pictures solid_plastic_strain solid_pressure solid_plastic_strain_in_time gauges history
check 'pictures of material tests' pictures points/pictures hjc_triaxial copper_ramp
check 'pictures in three dimensions' pictures three/pictures flow_pressure flow_last_schlieren peaks solid_pressure solid_speed gauges

flow=$(ls three/snapshot_flow_*.vtkhdf | tail -n 1)
solid=$(ls three/snapshot_solid_*.vtkhdf | tail -n 1)
check 'slice, view, cut and curves' plot "$flow" "$solid" three/gauges.csv --field pressure --mirror xy --output some
check 'cut by a plane' plot "$solid" --field von_mises --plane y=0.1 --range 0,2 --output some
check 'oblique view from below' plot "$solid" --view -1,-1,-0.5 --output some
check 'tables over a column of their own' plot points/hjc_tension.csv points/rht_tension.csv --against strain_xx --columns=-stress_xx,damage --output some
check 'their picture' pictures some hjc_tension_stress_xx_damage_over_strain_xx
check 'a wrong column is named with the right ones' says "no column 'stress'; there are: " plot points/hjc_tension.csv --against strain_xx --columns stress
check 'some pictures' pictures some "$(basename "$flow" .vtkhdf)_pressure_y" "$(basename "$solid" .vtkhdf)_pressure_+z" gauges \
  "$(basename "$solid" .vtkhdf)_von_mises_cut_y" "$(basename "$solid" .vtkhdf)_damage_-1_-1_-0.5"
check 'a wrong field is named with the right ones' says "no field 'presure'; there are: " plot "$flow" --field presure
check 'a wrong field is an error' fails plot "$flow" --field presure
check 'a folder without a run is an error' fails plot "$source_folder/input"
check 'a file that is missing is an error' fails plot none.vtkhdf
check 'numbers' "$source_folder/build/venv/bin/python" -B "$here/plotting_checks.py" "$source_folder/tools/plotting" "$work"

echo "test_plot: $passed passed, $failed failed"
[ $failed -eq 0 ]
