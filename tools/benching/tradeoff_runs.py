"""Runs a scene of the trade-off, on one core: what each run costs, and how far it is off."""
import json
import math
import os
import pathlib
import resource
import subprocess
import sys
import time
from dataclasses import dataclass, field

from tables import read_lines

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("BRISANCE_EXE") or ROOT / "build/release/brisance"
FLOW_BENCH = os.environ.get("FLOW_BENCH_EXE") or ROOT / "build/release/tests/bench/flow_bench"


@dataclass
class Line:
    """A run: the series and the mesh that name it, its size and cost, and each measure as (value, reference, error). The error is
    value / reference - 1, or the value itself where that is an error already (reference nan)."""
    scene: str
    series: str
    mesh: str
    cells: int
    particles: int
    user_s: float
    wall_s: float
    memory_mb: float
    measures: dict = field(default_factory=dict)

    @property
    def core_hours(self):
        return self.user_s / 3600


def compared(value, reference):
    """A measure beside its reference; what was not found in a run is nan."""
    return value, reference, value / reference - 1


def arguments(settings):
    """--set for each setting 'group%key=value'; words get the quotes that a deck wants."""
    for setting in settings:
        key, value = setting.split("=", 1)
        is_word = not value.startswith(".") and value.replace(".", "").replace("-", "").replace("_", "").isalpha()
        yield from ("--set", f"{key}='{value}'" if is_word else setting)


def timed(command):
    """Runs a command; processor and wall seconds, its output. None where it fails, which is said."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime, time.monotonic()
    done = subprocess.run(command, env={**os.environ, "OMP_NUM_THREADS": "1"}, capture_output=True, text=True)
    if done.returncode != 0:
        print(f"warning: {' '.join(map(str, command))}: {done.stderr.strip().splitlines()[-1:]}", file=sys.stderr)
        return None
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before, time.monotonic() - start, done.stdout


def deck_command(scene, settings):
    """The program with a deck and settings; 'deck=NAME' among them takes another deck than the scene's."""
    decks = [setting[5:] for setting in settings if setting.startswith("deck=")]
    others = [setting for setting in settings if not setting.startswith("deck=")]
    return [PROGRAM, ROOT / f"input/{(decks or [scene.deck])[-1]}.nml",
            *arguments([*scene.settings, *others, "output%restart_interval=0"])]


def deck_run(scene, series, mesh, settings, folder):
    """The line of one run of a deck, without measures."""
    for left in folder.glob("snapshot_*"):  # of another run
        left.unlink()
    cost = timed([*deck_command(scene, settings), "--quiet", "--output", folder])
    if cost is None:
        return None
    summary = json.loads((folder / "summary.json").read_text())
    return Line(scene.name, series, mesh, math.prod(summary["cells"]) if "flow" in summary["wall_seconds_by_phase"] else 0,
                summary.get("particles", 0), cost[0], cost[1], summary["peak_memory_bytes"] / 1e6)


def deck_lines(scene, folder, quick):
    """The lines of a scene that is a deck, as they come: first the reference if it is a run."""
    reference = scene.reference
    if not isinstance(reference, dict):
        mesh, settings = reference
        where = folder / f"tradeoff_{scene.name}_reference"
        line = deck_run(scene, "reference", mesh, settings, where)
        if line is None:
            return
        reference = {name: measure(where) for name, measure in scene.measures.items()}
        line.measures = {name: compared(value, value) for name, value in reference.items()}
        yield line
    for i, (series, mesh, settings) in enumerate(scene.runs):
        if quick and mesh not in scene.quick:
            continue
        where = folder / f"tradeoff_{scene.name}_{i}"
        line = deck_run(scene, series, mesh, settings, where)
        if line is not None:
            line.measures = {name: compared(measure(where), reference[name]) for name, measure in scene.measures.items()}
            yield line


def problem_lines(scene, folder, quick):
    """The lines of a problem of flow_bench, which knows the exact solution: relative L1 errors. It measures wall times, of which we take
    the least of some calls; the processor had that part of them that it had of the call. Its memory is mostly that of the calibration."""
    command = [FLOW_BENCH, "accuracy", "--case", scene.problem, "--schemes", ",".join(scene.schemes.values()), *["--quick"] * quick]
    calls = [timed(command) for _ in range(scene.calls)]
    if None in calls:
        return
    path = folder / f"tradeoff_{scene.name}.lines.csv"
    tables = []
    for user, wall, output in calls:
        path.write_text(output)
        tables.append([(row["wall_s"] * min(1, user / wall), row["wall_s"], row) for row in read_lines(path)])
    names = {scheme: name for name, scheme in scene.schemes.items()}
    for same in zip(*tables):
        row = same[0][-1]
        cells = [int(row[f"cells_{axis}"]) for axis in "xyz"]
        mesh = "x".join(map(str, cells)) if cells[1] > 1 else str(cells[0])
        errors = {name: (row["measures"][name][0], math.nan, row["measures"][name][0]) for name in scene.measures}
        yield Line(scene.name, names[row["scheme"]], mesh, math.prod(cells), 0, min(user for user, _, _ in same),
                   min(wall for _, wall, _ in same), math.nan, errors)


def lines_of(scene, folder, quick):
    """All lines of a scene, as they come."""
    return (problem_lines if scene.problem else deck_lines)(scene, folder, quick)
