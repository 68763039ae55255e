#!/usr/bin/env bash
# The arithmetic of tools/bench tradeoff, with stand-ins of brisance and flow_bench, and what it measures of made-up runs.
# timeout: 120
set -u
source "$(dirname "$0")/../../support/checks.sh" tradeoff
source "$source_folder/tools/setup.sh"
setup_python >/dev/null || exit 1

# brisance: a tenth too much pressure with lg_cfibm, a tenth too little else; the finest mesh fails.
cat >brisance <<'END'
#!/usr/bin/env bash
[[ $* == *cells=400,1,1* ]] && { echo "error: too fine" >&2; exit 3; }
pressure=1.58427
[[ $* == *"coupling%method='lg_cfibm'"* ]] && pressure=1.93633
while [ "$1" != --output ]; do shift; done
mkdir -p "$2"
printf 'time [-],gas.pressure [-]\n0.0,1.0\n0.5,%s\n0.6' "$pressure" >"$2/gauges.csv"
echo '{"cells": [100, 2, 1], "particles": 40, "peak_memory_bytes": 3e6, "wall_seconds_by_phase": {"flow": 1}}' >"$2/summary.json"
for ((i = 0; i < 20000; i++)); do :; done
END
# flow_bench: two lines of Sod's tube; the second call is the fastest.
cat >flow_bench <<'END'
#!/usr/bin/env bash
echo "$*" >>flow_bench_arguments
tens=$((($(wc -l <flow_bench_arguments) + 1) % 3 + 1)) # 3, 1, 2
for ((i = 0; i < 20000; i++)); do :; done
echo 'case,scheme,cells_x,cells_y,cells_z,wall_s,measures'
echo "sod,paper,100,1,1,${tens}0.0,"'"density=2.0E-02|velocity=1.0E-02|pressure=5.0E-03|"'
echo 'sod,fifth_order+sensor,100,1,1,0.5,"density=1.0E-02|velocity=1.0E-02|pressure=5.0E-03|"'
END
chmod +x brisance flow_bench
tradeoff() { BRISANCE_EXE=$work/brisance FLOW_BENCH_EXE=$work/flow_bench "$python" "$source_folder/tools/benching" tradeoff . "$@"; }
row() { grep -q -- "$1" tradeoff.md; }

check "it runs" tradeoff --case piston
cp log first
check "what fails is said" grep -q 'warning: .*too fine' first
check "what fails has no line" [ "$(grep -c '| 400x1x1 |' tradeoff.md)" -eq 0 ]
check "errors, cells, particles, memory" row '^| lg_cfibm | 100x1x1 | 200 | 40 | .* | 3 | .* | +10.00 % |$'
check "an error has its sign" row '^| moving_wall | 200x1x1 | 200 | 40 | .* | -10.00 % |$'
check "core-hours are those of the processor" \
  awk -F, '$1 == "piston" { n++; wrong += !($6 > 0 && $9 > 0.999 * $6 / 3600 && $9 < 1.001 * $6 / 3600) } END { exit !(n == 6 && !wrong) }' tradeoff.csv
check "another scene runs" tradeoff --case sod --quick
check "schemes of flow_bench" grep -q -- '--case sod --schemes paper,muscl+third_order+sensor,fifth_order+sensor --quick' flow_bench_arguments
check "its errors, the least time" row '^| paper | 100 | 100 | - | .* | 10.0 | - | .* | 2.00 % | 1.00 % | 0.50 % |$'
check "processor time is part of the wall time" awk -F, '$1 == "sod" { n++; wrong += !($6 > 0 && $6 <= $7) } END { exit !(n == 6 && !wrong) }' tradeoff.csv
check "names of its schemes" row '^| fifth order | 100 | 100 | - | .* | 0.5 | - | .* | 1.00 % |'
check "lines of other scenes are kept" row '^| lg_cfibm | 100x1x1 |.*+10.00 % |$'
check "a scene that runs again is replaced" tradeoff --case piston
check "no line twice" [ "$(grep -c '^| lg_cfibm | 100x1x1 |' tradeoff.md)" -eq 1 ]
check "pictures" [ -s tradeoff_tubes.png -a -s tradeoff_bodies.png ]

cat >measures.py <<'END'
import pathlib
import sys
for folder in ("benching", "measuring", "plotting"):
    sys.path.insert(0, f"{sys.argv[1]}/tools/{folder}")
import numpy as np
import slab
from tradeoff_measures import arrival, burst, largest, slab_deflection
from tradeoff_scenes import SCENES, finest, meshes, runs, series

here = pathlib.Path(".")
# half of the peak lies between 1 and 2 s
(here / "gauges.csv").write_text("time [s],a.overpressure [Pa],centre of the front face.displacement_z [m]\n"
                                 "0,0,0\n1,2,0.02\n2,6,0.03\n3,8,0.01\n4,1,0.04\n5,0,0.05\n")
assert largest("a.overpressure")(here) == 8 and arrival("a.overpressure")(here) == 1.5
assert slab_deflection(here) == 0.03

# a wave at 1 m from a hemisphere of 1 kg: its peak, and its impulse until the overpressure is negative
(here / "deck.nml").write_text("&charge\n  mass = 2.0\n/\n")
(here / "gauges.csv").write_text("time [s],1.00 m.overpressure [Pa],1.00 m.impulse [Pa s]\n0,0,0\n1,5000,1\n2,3000,7\n3,-10,9\n4,-20,8\n")
measures, curves = burst((1, 2))
assert measures["peak, Z = 1"](here) == 5 and measures["impulse, Z = 1"](here) == 9
assert np.isnan(measures["peak, Z = 2"](here))  # no such gauge
assert 1330 < curves["peak, Z = 1"] < 1380

class Body:
    """A quarter of a slab of 10 x 10 x 4 particles of 10 mm; behind its middle, 3 x 3 columns wide, half of it has moved by 10 mm."""
    def __init__(self, time):
        self.time = time
        grid = np.stack(np.meshgrid(*(0.01 * (np.arange(n) + 0.5) for n in (10, 10, 4)), indexing="ij"), axis=-1).reshape(-1, 3)
        self.spalled = (grid[:, 0] < 0.03) & (grid[:, 1] < 0.03) & (grid[:, 2] > 0.02)
        self.position = grid + np.outer(0.01 * self.spalled * (time > 0), [0, 0, 1]) + 0.5 * time * np.array([0, 0, 1])
    def field(self, name):
        return {"id": np.arange(400), "material": np.ones(400), "damage": 1.0 * self.spalled}[name]
    def size(self):
        return 0.01
for i in range(2):
    (here / f"snapshot_solid_{i}.vtkhdf").touch()
slab.open_snapshot, slab.SlabAlone = (lambda path: Body(float(path.stem[-1]))), (lambda snapshot: snapshot)
found = slab.spall(here)
assert abs(found.extent[0.008][0] - np.sqrt(4 * 9e-4 / np.pi)) < 1e-12 and abs(found.extent[0.008][1] - 0.02) < 1e-12
assert found.extent[0.016] == (0.0, 0.0) and abs(found.thickness - 0.04) < 1e-12
assert abs(found.failed["back"] - 0.09) < 1e-12 and found.failed["front"] == 0

assert runs(series({"a": ["x=1"], "b": []}), meshes((4, 2, 1))) == (("a", "4x2x1", ["x=1", "mesh%cells=4,2,1"]), ("b", "4x2x1", ["mesh%cells=4,2,1"]))
assert finest(8, 8, 8, settings=["y=2"]) == ("8x8x8", ["mesh%cells=8,8,8", "y=2"])
names = [(scene.name, series, mesh) for scene in SCENES for series, mesh, _ in scene.runs]
assert len(set(names)) == len(names)
END
check "measures and scenes" "$python" measures.py "$source_folder"

# Every run of every scene is a deck that the program accepts.
cat >accepted.py <<'END'
import subprocess
import sys
for folder in ("benching", "measuring", "plotting"):
    sys.path.insert(0, f"{sys.argv[1]}/tools/{folder}")
from tradeoff_runs import deck_command
from tradeoff_scenes import SCENES
for scene in (scene for scene in SCENES if scene.deck):
    finest = [] if isinstance(scene.reference, dict) else [("reference", *scene.reference)]
    for series, mesh, settings in [*scene.runs, *finest]:
        done = subprocess.run([*deck_command(scene, settings), "--check"], capture_output=True, text=True)
        assert done.returncode == 0, f"{scene.name}, {series}, {mesh}: {done.stderr}"
END
check "decks" "$python" accepted.py "$source_folder"

echo "test_tradeoff: $passed passed, $failed failed"
[ "$failed" -eq 0 ]
