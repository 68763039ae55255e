"""Peak overpressure, impulse and arrival on a facade beside a charge on the ground, in the cells before the wall, against the curves
of Kingery & Bulmash for hemispherical surface bursts: a table of points, and a picture of the impulse.

Oblique points have what LOAD_BLAST and ConWep take: y_r cos(a)^2 + y_i (1 + cos(a)^2 - 2 cos(a)) of the reflected and the incident
pressure or impulse at the slant distance, a between the ray and the normal of the wall (Randers-Pehrson & Bannister, Airblast
loading model for DYNA2D and DYNA3D, ARL-TR-1310, 1997). It knows of no edges and no openings. The charge is at (0, 0, 0), the
wall across x."""
import pathlib
import re

import numpy as np

from snapshot_files import open_snapshot
from style import LINES, plt, save
from surface_burst import curve, hemisphere

# y, z [m]
POINTS = [(0, 0), (0, 0.5), (1, 0), (2, 0), (2.9, 0), (1, 1.5), (2, 1.5), (2.9, 1.5), (0, 2.5), (1, 2.5), (2, 2.5), (2.9, 2.9)]
PICTURE = pathlib.Path("docs/pictures/facade.png")


def facade(folder):
    """Where the wall is and what it felt: distance, width, height, y and z of the cells, maps [z, y] that are nan in openings."""
    deck = (folder / "deck.nml").read_text()
    body = re.search(r"&body\b.*?^/", deck, re.DOTALL | re.MULTILINE).group(0)
    low, high = ([float(v) for v in re.search(rf"\b{key} = ([-0-9.eE+, ]*)", body).group(1).split(",")]
                 for key in ("lower", "upper"))
    peaks = open_snapshot(folder / "peaks.vtkhdf")
    first = open_snapshot(sorted(folder.glob("snapshot_flow_*.vtkhdf"))[0])
    half = 0.5 * peaks.spacing[0]
    closed = first.layer("cell_type", 0, low[0] + half)[0] > 0.5
    maps = {name: np.where(closed, peaks.layer(name, 0, low[0] - half)[0], np.nan)
            for name in ("peak_overpressure", "impulse", "arrival_time")}
    y, z = (peaks.lower[d] + (np.arange(peaks.cells[d]) + 0.5) * peaks.spacing[d] for d in (1, 2))
    return {"folder": folder, "distance": low[0], "width": high[1], "height": high[2], "y": y, "z": z, "h": peaks.spacing[0],
            "mass": hemisphere(folder), **maps}


def rule(run, y, z):
    """Reflected peak [kPa], impulse [kPa ms], arrival [ms] that the curves give at a point of the wall, and its angle in degrees."""
    slant = np.sqrt(run["distance"] ** 2 + y ** 2 + z ** 2)
    cosine = run["distance"] / slant
    root = run["mass"] ** (1 / 3)
    distance = slant / root
    oblique = 1 + cosine ** 2 - 2 * cosine
    peak = curve("reflected pressure", distance) * cosine ** 2 + curve("pressure", distance) * oblique
    impulse = root * (curve("reflected impulse", distance) * cosine ** 2 + curve("impulse", distance) * oblique)
    return peak, impulse, root * curve("arrival", distance), np.degrees(np.arccos(cosine))


def at(run, name, y, z):
    """Value of the cell that holds a point."""
    return run[name][min(int(z / run["h"]), len(run["z"]) - 1), min(int(y / run["h"]), len(run["y"]) - 1)]


def table(run):
    """Prints the points of one run, as a table in Markdown."""
    print(f"{run['folder']}: {run['mass']:g} kg at {run['distance']:g} m, cells of {1e3 * run['h']:.0f} mm\n")
    print("| y, z [m] | angle | peak overpressure [kPa] | curve | | impulse [kPa ms] | curve | | arrival [ms] | curve | |")
    print("|" + "---|" * 11)
    ratios = []
    for y, z in POINTS:
        found = at(run, "peak_overpressure", y, z) / 1e3, at(run, "impulse", y, z), 1e3 * at(run, "arrival_time", y, z)
        *expected, angle = rule(run, (int(y / run["h"]) + 0.5) * run["h"], (int(z / run["h"]) + 0.5) * run["h"])
        cells = [f"{a:.4g} | {b:.4g} | {100 * (a / b - 1):+.0f} %" for a, b in zip(found, expected)]
        ratios.append([a / b for a, b in zip(found, expected)])
        print(f"| {y:g}, {z:g} | {angle:.0f} | " + " | ".join(cells) + " |")
    whole = run["impulse"].copy()
    grid_y, grid_z = np.meshgrid(run["y"], run["z"])
    expected = np.vectorize(lambda y, z: rule(run, y, z)[1])(grid_y, grid_z)
    on_wall = np.isfinite(whole)
    area = 2 * run["h"] ** 2
    found, by_curves = whole[on_wall].sum() * area / 1e3, expected[on_wall].sum() * area / 1e3
    peak, impulse, arrival = np.mean(ratios, axis=0)
    print(f"\nimpulse of the whole wall {found:.2f} kN s, by the curves {by_curves:.2f} kN s ({100 * (found / by_curves - 1):+.0f} %); "
          f"mean of the ratios above: peak {peak:.2f}, impulse {impulse:.2f}, arrival {arrival:.2f}\n")
    run["ratio"] = whole / expected


def draw_map(figure, panel, run, values, title, colours, limits):
    """A field of the whole wall: half of it is computed."""
    whole = np.hstack([values[:, ::-1], values])
    image = panel.imshow(whole, extent=(-run["y"][-1], run["y"][-1], 0, run["z"][-1]), cmap=colours, vmin=limits[0], vmax=limits[1])
    panel.set_xlim(-run["width"], run["width"])
    panel.set_ylim(0, run["height"])
    panel.set_title(title)
    panel.set_xlabel("y [m]")
    panel.set_ylabel("z [m]")
    figure.colorbar(image, ax=panel, pad=0.02, fraction=0.03)


def measure_all(folders):
    """Tables of all runs; maps of the last, and its lines beside those of the others."""
    runs = [facade(folder) for folder in folders]
    for run in runs:
        table(run)
    run = runs[-1]
    figure = plt.figure(figsize=(10.5, 5.2), constrained_layout=True)
    left, right = figure.subplots(2, 2, width_ratios=(1.5, 1)).T
    draw_map(figure, left[0], run, run["impulse"], "impulse [Pa s]", "inferno", (0, np.nanmax(run["impulse"])))
    draw_map(figure, left[1], run, run["ratio"], "impulse over that of the curves", "RdBu_r", (0.5, 1.5))
    for panel, place in zip(right, (0.0, 1.5)):
        z = np.linspace(0, run["height"], 200)
        panel.plot(z, [rule(run, place, v)[1] for v in z], color="#6b6b6b", label="Kingery & Bulmash, oblique")
        for i, other in enumerate(runs):
            column = min(int(place / other["h"]), len(other["y"]) - 1)
            panel.plot(other["z"], other["impulse"][:, column], color=LINES[i % len(LINES)],
                       label=f"{other['folder'].name.replace('_', ' ')}: cells of {1e3 * other['h']:.0f} mm")
        panel.set_title(f"impulse at y = {place:g} m [Pa s]")
        panel.set_xlim(0, run["height"])
        panel.set_ylim(bottom=0)
    right[1].set_xlabel("z [m]")
    right[0].legend(loc="lower center")
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    save(figure, PICTURE)
    print(f"picture: {PICTURE}")
