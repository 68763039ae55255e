"""Damage of a column by a charge in contact with it, against the rule of Morishita, Tanaka, Ito & Yamaguchi (J. Struct. Eng. JSCE
46A, 2000, 1787-1797) from tests of charges in contact with slabs of reinforced concrete: with the thickness over the cube root of
the mass [cm/g^(1/3)] above 3.6 a crater only, from there to 2.0 crater and spall of the back, below a hole. A table, and a picture
of the damage in the plane of symmetry. The charge is at x = 0, y = 0, z = 0; the column is along z; a quarter of it is in the run."""
import pathlib
import re

import numpy as np

from snapshot_files import open_snapshot
from style import DAMAGE, colour_bar, plt, save

PICTURE = pathlib.Path("docs/pictures/contact_column.png")
THROWN = 5.0  # m/s


def column(folder):
    """Mass of the charge, what has failed where in the last snapshot, and the cut to draw."""
    text = (folder / "deck.nml").read_text()
    mass = float(re.search(r"&charge\b.*?\bmass\s*=\s*([0-9.eE+-]+)", text, re.DOTALL).group(1))
    files = sorted(folder.glob("snapshot_solid_*.vtkhdf"))
    first, last = open_snapshot(files[0]), open_snapshot(files[-1])
    pitch = first.size()
    order = np.argsort(first.field("id"))
    start, number = first.position[order], first.field("id")[order]
    concrete = first.field("material")[order] == np.min(first.field("material"))
    damage = np.ones(len(start))  # what has left the domain has failed
    speed = np.full(len(start), np.inf)
    found = np.searchsorted(number, last.field("id"))
    damage[found], speed[found] = last.field("damage"), last.field("speed")
    failed = damage >= 1
    low, high = start.min(axis=0) - pitch / 2, start.max(axis=0) + pitch / 2
    height = np.floor((start[:, 2] - low[2]) / pitch).astype(int)

    def length(part, share):
        """Length of the column over which more than a share of some particles of each layer has failed."""
        part = part & concrete
        all_of = np.bincount(height[part], minlength=height.max() + 1)
        lost = np.bincount(height[part & failed], minlength=height.max() + 1)
        return 2 * pitch * np.count_nonzero(lost > share * np.maximum(all_of, 1))

    # what parts from the bars before it: concrete of the back cover and bars behind the charge
    late = start[found]
    behind = (late[:, 0] > high[0] - 0.06) & (late[:, 1] < 0.06) & (late[:, 2] < 0.06)
    cover = behind & concrete[found] & (late[:, 0] > high[0] - 0.04)
    parting = last.field("velocity_x")[cover].mean() - last.field("velocity_x")[behind & ~concrete[found]].mean()
    on_axis = concrete & (start[:, 1] < 0.03) & (start[:, 2] < 0.03)
    layer = np.floor((start[on_axis, 0] - low[0]) / pitch).astype(int)
    broken = np.bincount(layer, failed[on_axis]) >= 0.5 * np.maximum(np.bincount(layer), 1)
    whole = np.nonzero(~broken)[0]
    cut = last.position[:, 1] < pitch
    return {"folder": folder, "mass": mass, "time": last.time, "pitch": pitch, "thickness": high[0] - low[0],
            "front": length(start[:, 0] < low[0] + pitch, 0.5), "back": length(start[:, 0] > high[0] - pitch, 0.5),
            "side": length(start[:, 1] > high[1] - pitch, 0.5), "through": length(concrete, 0.95),
            "whole on the axis": (whole[0] * pitch, whole[-1] * pitch + pitch) if len(whole) else None,
            "failed": failed[concrete].mean(), "parting": parting, "thrown": 4 * np.median(first.field("volume")[order][concrete])
            * np.median(first.field("density")) * np.count_nonzero(failed & concrete & (speed > THROWN)),
            "cut": (last.position[cut], last.field("damage")[cut])}


def measure_all(folders):
    """The table and the picture."""
    runs = sorted((column(folder) for folder in folders), key=lambda run: run["mass"])
    print("| run | TNT [kg] | thickness over root [cm/g^(1/3)] | slabs | failed length of front, back, side [m] "
          f"| of whole sections [m] | whole on the axis [mm] | back cover less bars [m/s] | failed | faster than {THROWN:g} m/s [kg] |")
    print("|" + "---|" * 10)
    for run in runs:
        scaled = 100 * run["thickness"] / (1e3 * run["mass"]) ** (1 / 3)
        kind = "crater" if scaled > 3.6 else "crater and spall" if scaled > 2.0 else "hole"
        part = run["whole on the axis"]
        whole = "none" if part is None else f"{1e3 * part[0]:.0f} to {1e3 * part[1]:.0f}"
        print(f"| {run['folder'].name} | {run['mass']:g} | {scaled:.2f} | {kind} | {run['front']:.2f}, {run['back']:.2f}, "
              f"{run['side']:.2f} | {run['through']:.2f} | {whole} | {run['parting']:.1f} "
              f"| {100 * run['failed']:.0f} % | {run['thrown']:.0f} |")
    figure, panels = plt.subplots(1, len(runs), figsize=(2.1 * len(runs) + 0.8, 5.6), constrained_layout=True, squeeze=False,
                                  sharey=True)
    for panel, run in zip(panels[0], runs):
        place, damage = run["cut"]
        for side in (1, -1):
            image = panel.scatter(place[:, 0], side * place[:, 2], c=damage, cmap=DAMAGE, vmin=0, vmax=1, marker="s", lw=0,
                                  s=(195 * run["pitch"]) ** 2, rasterized=True)
        panel.set_title(f"{run['mass']:g} kg, {1e3 * run['time']:g} ms")
        panel.set_aspect("equal")
        panel.set_xlim(-0.1, 0.5)
        panel.set_ylim(-1, 1)
        panel.set_xlabel("x [m]")
    panels[0, 0].set_ylabel("z [m]")
    colour_bar(figure, image, panels[0, -1], "damage")
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    save(figure, PICTURE)
    print(f"picture: {PICTURE}")
