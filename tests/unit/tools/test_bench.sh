#!/usr/bin/env bash
# What tools/bench reads from the lines of flow_bench, the trade-off of a small scene, and that it refuses what it does not know.
# timeout: 120
set -u
source_folder=${BRISANCE_SOURCE:-$(cd "$(dirname "$0")/../../.." && pwd)}
passed=0 failed=0

check() { # check NAME COMMAND...: the command must succeed
  local name=$1
  shift
  if "$@"; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "  FAILED: $name"; fi
}

cat >lines.csv <<'END'
case,scheme,cells_x,cfl,verdict,wall_s,measures,title
# no such scheme: x
sod,paper,100,0.50,"cell (1, 2, 3)", 1.5E-03,"density= 2.0000E-003< 4.00E-03|shock= 1.0E+000|","Sod's tube, one gas"
sod,paper,200,0.50,"passes",*****,"","Sod's tube, one gas"
END
cat >read.py <<'END'
import math
import sys
sys.path.insert(0, sys.argv[1] + "/tools/benching")
from tables import markdown, ordered, read_lines
first, second = read_lines("lines.csv")
assert first["cells_x"] == 100 and first["wall_s"] == 1.5e-3 and first["verdict"] == "cell (1, 2, 3)"
assert first["measures"] == {"density": (2e-3, 4e-3), "shock": (1.0, None)}
assert math.isnan(second["wall_s"]) and second["measures"] == {}
assert ordered(["b", "a", "b"]) == ["b", "a"]
assert markdown(["x", "y"], [["1", "2"]]) == "| x | y |\n|---|---|\n| 1 | 2 |\n"
END
refuses() { ! bash "$source_folder/tools/bench" "$@" >/dev/null 2>&1; }
tradeoff() ( # tradeoff SCENE: its sweep, by the program of this build
  source "$source_folder/tools/setup.sh"
  setup_python >/dev/null || exit 1
  OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_plm=isolated OMPI_MCA_ess_singleton_isolated=1 \
    "$python" "$source_folder/tools/benching" tradeoff . --case "$1" --quick
)
sweeps() { tradeoff piston >/dev/null && grep -q '^| moving_wall | 200x1x1 |.*| [+-]0.0[0-9] % |$' tradeoff.md && [ -s tradeoff_bodies.png ]; }
knows_scenes() { tradeoff nothing 2>&1 >/dev/null | grep -q 'no scene nothing'; }
explains() { bash "$source_folder/tools/bench" --help | grep -q -e '--schemes'; }

check "lines are read" "${PYTHON:-python3}" read.py "$source_folder"
check "trade-off" sweeps
check "unknown scene" knows_scenes
check "help" explains
check "no command" refuses
check "unknown command" refuses dance
check "unknown option" refuses speed --fast
echo "test_bench: $passed passed, $failed failed"
[ "$failed" -eq 0 ]
