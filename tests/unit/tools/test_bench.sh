#!/usr/bin/env bash
# What tools/bench reads from the lines of flow_bench, and that it refuses what it does not know.
# timeout: 60
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
explains() { bash "$source_folder/tools/bench" --help | grep -q -e '--schemes'; }

check "lines are read" "${PYTHON:-python3}" read.py "$source_folder"
check "help" explains
check "no command" refuses
check "unknown command" refuses dance
check "unknown option" refuses speed --fast
echo "test_bench: $passed passed, $failed failed"
[ "$failed" -eq 0 ]
