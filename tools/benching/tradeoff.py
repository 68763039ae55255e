"""Error against processor time and memory over cell sizes, schemes and what a scene can leave out: runs the decks, then a table and a
picture for each scene."""
import csv
import itertools
import json
import os
import pathlib
import resource
import subprocess
import sys

import numpy as np

from style import plt, save
from tables import markdown, ordered

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("BRISANCE_EXE") or ROOT / "build/release/brisance"


class Scene:
    """A deck, the runs to compare (groups of settings by name), what is measured, and against what."""

    def __init__(self, name, deck, runs, measures, reference, settings=(), quick=()):
        self.name, self.deck, self.runs, self.measures = name, deck, runs, measures
        self.reference = reference  # settings of the run that is taken as true, or the numbers themselves
        self.settings = settings
        self.quick = quick  # endings of the names of runs that --quick leaves out


def cells(*counts):
    return [("x".join(map(str, c)), [f"mesh%cells={','.join(map(str, c))}"]) for c in counts]


def runs(*groups):
    """All combinations of one run of each group: their names joined, their settings in a row."""
    return [(", ".join(name for name, _ in group if name), sum((list(settings) for _, settings in group), []))
            for group in itertools.product(*groups)]


def table(folder, file="gauges.csv"):
    with open(folder / file, newline="") as lines:
        rows = list(csv.reader(lines))
    data = np.array([[float(x) for x in row] for row in rows[1:]])
    return {name.split(" [")[0]: data[:, i] for i, name in enumerate(rows[0])}


def last(column, file="gauges.csv"):
    return lambda folder: table(folder, file)[column][-1]


def largest(column):
    return lambda folder: np.nanmax(table(folder)[column])


def arrival(column):
    """Time at which half of the peak is reached."""
    def measure(folder):
        data = table(folder)
        rise = np.argmax(data[column] >= 0.5 * np.nanmax(data[column]))
        return float(np.interp(0.5 * np.nanmax(data[column]), data[column][rise - 1:rise + 1], data["time"][rise - 1:rise + 1]))
    return measure


def blast(place):
    return {"peak": largest(f"{place}.overpressure"), "arrival": arrival(f"{place}.overpressure"), "impulse": largest(f"{place}.impulse")}


METHODS = [(method, [f"coupling%method={method}"]) for method in ("lg_cfibm", "moving_wall")]

SCENES = [
    Scene("surface_blast_3d", "surface_blast_3d",
          runs([("direct", ["charge%start=none"]), ("start to 1 m", []), ("start to 2.1 m", ["charge%start_stop=2.1"])],
               cells((24, 24, 24), (32, 32, 32), (48, 48, 48))) + runs([("direct, no sleep", ["charge%start=none", "flow%sleep=.false."])],
               cells((48, 48, 48))), blast("2.0 m"),
          ["charge%start=none", "mesh%geometry=spherical", "mesh%cells=4800,1,1"], quick=("48x48x48",)),
    Scene("piston", "piston", runs(METHODS, cells((100, 1, 1), (200, 1, 1), (400, 1, 1))), {"pressure": last("gas.pressure")},
          {"pressure": 1.7603}),
    Scene("lift_off", "lift_off", runs(METHODS[1:], [("", ["body%spacing=0.00125"])], cells((160, 32), (200, 40), (400, 80))),
          {"x": last("cylinder.center_x", "loads.csv"), "y": last("cylinder.center_y", "loads.csv")},
          {"x": 0.630, "y": 0.141}, quick=("400x80",)),
    Scene("taylor_bar", "taylor_bar",
          runs([("linear", []), ("quadratic", ["solid%shape=quadratic"])],
               [("1 mm", ["mesh%cells=10,10,28", "body%spacing=0.5"]), ("0.5 mm", [])]),
          {"rear": last("rear.displacement_z"), "foot": last("foot.displacement_x")},
          ["mesh%cells=30,30,84", "body%spacing=0.1666666667"], quick=("0.5 mm",)),
    Scene("rc_slab_coarse", "rc_slab_coarse",
          runs([("all always on", ["stages%solid_start=at_once", "flow%sleep=.false."]), ("default", []),
                ("flow dropped when faded to 0.05", ["stages%flow_end=faded", "stages%faded_part=0.05"]),
                ("flow dropped at 1 ms", ["stages%flow_end_time=1e-3"])]),
          {"deflection": largest("centre of the front face.displacement_z")}, ["stages%solid_start=at_once", "flow%sleep=.false."],
          ["run%end_time=5e-3"], quick=("",)),
]


def execute(scene, settings, folder):
    """Runs the deck; processor seconds and peak memory in MB."""
    command = [PROGRAM, ROOT / f"input/{scene.deck}.nml", "--quiet", "--output", folder]
    for setting in [*scene.settings, *settings, "output%restart_interval=0"]:
        key, value = setting.split("=", 1)
        words = value.replace(".", "").replace("-", "").replace("_", "")
        text = not value.startswith(".") and words.isalpha()
        command += ["--set", f"{key}='{value}'" if text else setting]
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    done = subprocess.run(command, env={**os.environ, "OMP_NUM_THREADS": "1"}, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        print(f"warning: {folder.name}: {done.stderr.strip().splitlines()[-1:]}", file=sys.stderr)
        return None
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    return seconds, json.loads((folder / "summary.json").read_text())["peak_memory_bytes"] / 1e6


def sweep(scene, folder, quick):
    """The lines of one scene."""
    reference = scene.reference
    if not isinstance(reference, dict):
        where = folder / f"tradeoff_{scene.name}_reference"
        if execute(scene, reference, where) is None:
            return []
        reference = {name: measure(where) for name, measure in scene.measures.items()}
    lines = []
    for i, (name, settings) in enumerate(scene.runs):
        if quick and name.endswith(tuple(scene.quick) or "\n"):
            continue
        where = folder / f"tradeoff_{scene.name}_{i}"
        cost = execute(scene, settings, where)
        if cost is None:
            continue
        errors = {m: measure(where) / reference[m] - 1 for m, measure in scene.measures.items()}
        lines.append({"scene": scene.name, "run": name, "seconds": cost[0], "memory_mb": cost[1], **errors})
        print(scene.name, name, f"{cost[0]:.1f} s", {m: f"{100 * e:+.2f} %" for m, e in errors.items()}, flush=True)
    return lines


def picture(folder, scene, lines):
    """Largest error of a run against its processor time."""
    figure, panel = plt.subplots(figsize=(6.4, 4.0), layout="constrained")
    groups = ordered(line["run"].rpartition(", ")[0] or line["run"] for line in lines)
    for group in groups:
        mine = [line for line in lines if (line["run"].rpartition(", ")[0] or line["run"]) == group]
        panel.plot([line["seconds"] for line in mine], [100 * max(abs(line[m]) for m in scene.measures) for line in mine], "o-",
                   markersize=4, label=group)
    panel.set(xscale="log", yscale="log", xlabel="processor time [s]", ylabel="largest error [%]", title=scene.name)
    panel.grid(True, which="both", linewidth=0.3, alpha=0.5)
    panel.legend()
    return save(figure, folder / f"tradeoff_{scene.name}.png")


def run(folder, names, quick):
    """Sweeps the scenes of these names, or all; the files that were written."""
    unknown = set(names) - {scene.name for scene in SCENES}
    if unknown:
        sys.exit(f"error: no scene {', '.join(sorted(unknown))}; there are {', '.join(scene.name for scene in SCENES)}")
    text, files, every = ["# What a scene can leave out, and what it costs\n", "Errors against the exact or the finest run; "
                          "processor time of one core, all included; peak memory.\n"], [], []
    for scene in SCENES:
        if names and scene.name not in names:
            continue
        lines = sweep(scene, folder, quick)
        if not lines:
            continue
        every += lines
        rows = [[line["run"], f"{line['seconds']:.1f}", f"{line['memory_mb']:.0f}", *(f"{100 * line[m]:+.2f} %" for m in scene.measures)]
                for line in lines]
        text += [f"## {scene.name}\n", markdown(["run", "seconds", "memory [MB]", *scene.measures], rows)]
        files.append(picture(folder, scene, lines))
    with open(folder / "tradeoff.csv", "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["scene", "run", "seconds", "memory_mb", "measure", "error"])
        for line in every:
            for name in list(line)[4:]:
                writer.writerow([line["scene"], line["run"], line["seconds"], line["memory_mb"], name, line[name]])
    (folder / "tradeoff.md").write_text("\n".join(text))
    return [folder / "tradeoff.md", folder / "tradeoff.csv", *files]
