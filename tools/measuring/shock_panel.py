"""Tip of the panel that a shock tube bends: largest displacement and when, against Giordano et al. (2005). Table and picture.

Of the experiment the largest displacement is known, 6.2 +- 0.4 mm; their own computation has 6.6 mm."""
import csv

import numpy as np

from style import LINES, plt, save

EXPERIMENT, SPREAD, COMPUTED = 6.2, 0.4, 6.6  # mm


def tip(folder):
    """Time [ms] and displacement [mm] of the gauge `tip`."""
    with open(folder / "gauges.csv", newline="") as file:
        rows = list(csv.reader(file))
    column = next(i for i, head in enumerate(rows[0]) if head.startswith("tip.displacement_x"))
    return 1e3 * np.array([[float(row[0]), float(row[column])] for row in rows[1:]]).T


def measure_all(folders):
    """The table and the picture; the picture goes to the first run."""
    figure, panel = plt.subplots(figsize=(5.2, 3.4), constrained_layout=True)
    panel.axhspan(EXPERIMENT - SPREAD, EXPERIMENT + SPREAD, color="#dedbd4", lw=0, label="largest in the experiment")
    panel.axhline(COMPUTED, color="#6b6b6b", lw=0.8, ls="--", label="largest, computed by Giordano et al.")
    print("| run | largest displacement [mm] | at [ms] | experiment [mm] |")
    print("|" + "---|" * 4)
    for i, folder in enumerate(folders):
        time, way = tip(folder)
        k = int(np.argmax(way))
        print(f"| {folder.name} | {way[k]:.2f} | {time[k]:.2f} | {EXPERIMENT} +- {SPREAD} |")
        panel.plot(time, way, color=LINES[i % len(LINES)], label=folder.name.replace("_", " "))
    panel.set_xlabel("time [ms]")
    panel.set_ylabel("displacement of the tip [mm]")
    panel.legend(loc="lower left")
    picture = folders[0] / "pictures" / "shock_panel.png"
    picture.parent.mkdir(parents=True, exist_ok=True)
    save(figure, picture)
    print(f"picture: {picture}")
