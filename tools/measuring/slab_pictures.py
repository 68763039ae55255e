"""Deflection and damage of the slab in several runs, side by side."""
import csv

import numpy as np

from slab import SlabAlone
from snapshot_files import by_time, open_snapshot
from solid_pictures import draw_section, draw_view
from style import colour_bar, plt, save, time_text

VIEW = (-0.58, 0.58, -0.53, 0.53)  # m, of the slab seen from its front or back
SECTION = (0.0, 0.56, 0.38, 0.54)


def deflections(folders, picture):
    """Displacement of the front face and at mid-depth over time, all runs in one picture."""
    figure, panels = plt.subplots(1, 2, figsize=(8.6, 3.2), layout="constrained")
    for folder in folders:
        with open(folder / "gauges.csv", newline="") as file:
            rows = list(csv.reader(file))
        data = np.array([[float(v) for v in row] for row in rows[1:]])
        for panel, place in zip(panels, ("front face", "mid-depth")):
            for column, head in enumerate(rows[0]):
                if place in head and ".displacement_z" in head:
                    panel.plot(1e3 * data[:, 0], 1e3 * data[:, column], label=folder.name.replace("_", " "))
            panel.set_title(f"centre, {place}", loc="left")
            panel.set_xlabel("time [ms]")
            panel.set_ylabel("displacement [mm]")
            panel.grid(alpha=0.25, linewidth=0.5)
    panels[1].legend(loc="upper left")
    return save(figure, picture)


def damage(folders, picture):
    """Front, back and a section of the slab at the last time that all runs have, a row for each run."""
    files = [by_time(folder, "solid") for folder in folders]
    last = max(set(files[0]).intersection(*files[1:]))
    figure, panels = plt.subplots(len(folders), 3, figsize=(11.0, 0.3 + 2.5 * len(folders)), squeeze=False, layout="constrained")
    for row, folder, found in zip(panels, folders, files):
        slab = SlabAlone(open_snapshot(found[last]))
        mirror = {d: slab.lower[d] for d in (0, 1)}
        for axes, (what, direction) in zip(row, (("front", -1.0), ("back", 1.0))):
            mappable, _ = draw_view(axes, slab, "damage", np.array([0.0, 0.0, direction]), mirror, bounds=VIEW)
            axes.set_title(f"{folder.name.replace('_', ' ')}, {what}", loc="left")
        draw_section(row[2], slab, "damage", 1, slab.lower[1] + 0.5 * slab.size(), mirror, bounds=SECTION)
        row[2].set_aspect("auto")
        row[2].set_title(f"section, y = 0, {time_text(slab.time, slab.time_unit)}", loc="left")
    colour_bar(figure, mappable, list(panels.flat), "damage", fraction=0.02)
    return save(figure, picture)


def draw(folders):
    """Both pictures, into the folder of the last run."""
    pictures = folders[-1] / "pictures"
    pictures.mkdir(parents=True, exist_ok=True)
    print("pictures:", deflections(folders, pictures / "slab_deflections.png"), damage(folders, pictures / "slab_damages.png"))
