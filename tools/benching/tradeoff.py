"""Error against processor time and memory over cell sizes, schemes and what a scene can leave out: runs the scenes, keeps all lines in
tradeoff.csv and makes a table of each scene and pictures of them."""
import csv
import math
import sys

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter

from style import plt, save
from tables import markdown, ordered
from tradeoff_runs import Line, lines_of
from tradeoff_scenes import SCENES

HEAD = ["scene", "series", "mesh", "cells", "particles", "user_s", "wall_s", "memory_mb", "core_hours", "measure", "value", "reference",
        "error"]


def write_lines(path, lines):
    """A row for each measure of each line."""
    with open(path, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(HEAD)
        for line in lines:
            for name, figures in line.measures.items():
                writer.writerow([line.scene, line.series, line.mesh, line.cells, line.particles, line.user_s, line.wall_s, line.memory_mb,
                                 line.core_hours, name, *figures])


def read_back(path):
    """The lines of an earlier call; none if there was none, or one of other columns."""
    lines = {}
    if path.exists():
        with open(path, newline="") as file:
            rows = csv.DictReader(file)
            for row in rows if "series" in (rows.fieldnames or []) else []:
                line = lines.setdefault((row["scene"], row["series"], row["mesh"]), Line(
                    row["scene"], row["series"], row["mesh"], int(row["cells"]), int(row["particles"]),
                    *(float(row[key]) for key in ("user_s", "wall_s", "memory_mb"))))
                line.measures[row["measure"]] = tuple(float(row[key]) for key in ("value", "reference", "error"))
    return list(lines.values())


def percent(figures):
    """An error; + or - where it has a sign. The reference itself shows its value."""
    value, reference, error = figures
    if math.isnan(error):
        return "-"
    if value == reference:
        return f"{value:.4g}"
    return f"{100 * error:{'' if math.isnan(reference) else '+'}.2f} %"


def seconds(value):
    return f"{value:.1f}" if value >= 1 else f"{value:.2g}"


def table(lines):
    rows = [[line.series, line.mesh, str(line.cells), str(line.particles or "-"), seconds(line.user_s), seconds(line.wall_s),
             "-" if math.isnan(line.memory_mb) else f"{line.memory_mb:.0f}", f"{line.core_hours:.2g}",
             *(percent(figures) for figures in line.measures.values())] for line in lines]
    head = ["run", "mesh", "cells", "particles", "processor [s]", "wall [s]", "memory [MB]", "core-hours"]
    return markdown([*head, *lines[0].measures], rows)


def largest_error(line):
    """In percent, of what was found."""
    return 100 * max((abs(error) for _, _, error in line.measures.values() if not math.isnan(error)), default=math.nan)


def picture(path, scenes, lines):
    """A panel for each scene: largest error of a run against its processor time, a line for each series."""
    columns = 2 if len(scenes) == 4 else min(3, len(scenes))
    rows = -(-len(scenes) // columns)
    figure, panels = plt.subplots(rows, columns, figsize=(max(3.7 * columns, 6.4), 4.0 if len(scenes) == 1 else 3.2 * rows),
                                  layout="constrained", squeeze=False)
    for panel in panels.flat[len(scenes):]:
        panel.set_axis_off()
    for panel, scene in zip(panels.flat, scenes):
        mine = [line for line in lines if line.scene == scene.name and line.series != "reference"]
        for name in ordered(line.series for line in mine):
            chosen = [line for line in mine if line.series == name]
            panel.plot([line.user_s for line in chosen], [largest_error(line) for line in chosen], "o-", markersize=4, label=name)
        panel.set(xscale="log", yscale="log", title=scene.name.replace("_", " "))
        for axis in (panel.xaxis, panel.yaxis):
            axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            axis.set_major_formatter("{x:g}")
            axis.set_minor_formatter(NullFormatter())
            if np.diff(np.log10(axis.get_view_interval())) > 1.9:
                axis.set_major_locator(LogLocator())
        panel.grid(True, which="both", linewidth=0.3, alpha=0.5)
        panel.legend(fontsize=7)
    figure.supxlabel("processor time [s]", fontsize=9)
    figure.supylabel("largest error [%]", fontsize=9)
    return save(figure, path)


def report(folder, lines):
    """Tables and pictures of all lines; the files that were written."""
    scenes = [scene for scene in SCENES if any(line.scene == scene.name for line in lines)]
    text = ["# Speed against error, scene by scene\n", "Processor time of one core, all included; peak memory. Core-hours are that time in "
            "hours. The line `reference` shows values, the others errors.\n"]
    for scene in scenes:
        text += [f"## {scene.name}\n", f"Errors against {scene.against}.\n", table([line for line in lines if line.scene == scene.name])]
    (folder / "tradeoff.md").write_text("\n".join(text))
    names = ordered(scene.picture for scene in scenes)
    return [folder / "tradeoff.md", folder / "tradeoff.csv", *(
        picture(folder / f"tradeoff_{name}.png", [scene for scene in scenes if scene.picture == name], lines) for name in names)]


def run(folder, names, quick):
    """Sweeps the scenes of these names, or all; the lines of others are kept. Returns the files that were written."""
    unknown = set(names) - {scene.name for scene in SCENES}
    if unknown:
        sys.exit(f"error: no scene {', '.join(sorted(unknown))}; there are {', '.join(scene.name for scene in SCENES)}")
    path = folder / "tradeoff.csv"
    lines = read_back(path)
    for scene in SCENES:
        if (names and scene.name not in names) or (quick and not scene.quick and not scene.problem):
            continue
        lines = [line for line in lines if line.scene != scene.name]
        for line in lines_of(scene, folder, quick):
            lines.append(line)
            write_lines(path, lines)
            print(f"{line.scene}, {line.series}, {line.mesh}: {seconds(line.user_s)} s",
                  {name: percent(figures) for name, figures in line.measures.items()}, flush=True)
    return report(folder, lines) if lines else []
