"""Peak overpressure, impulse and arrival on a facade beside a charge on the ground, in the cells before the wall, against the
curves of Kingery & Bulmash for hemispherical surface bursts: a table of points, and a picture of the impulse.

Oblique points have two references at the slant distance: the curves of normal reflection, and what ConWep and LOAD_BLAST make of
them, y_r cos(a)^2 + y_i (1 + cos(a)^2 - 2 cos(a)) of the reflected and the incident pressure or impulse, a between the ray and the
normal of the wall (Randers-Pehrson & Bannister, Airblast loading model for DYNA2D and DYNA3D, ARL-TR-1310, 1997). Neither knows of
edges and openings. The charge is at (0, 0, 0), the wall across x."""
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


def reference(run, y, z):
    """Angle at a point of the wall [degrees], and what the curves give there: peak [kPa] and impulse [kPa ms], each by the rule for
    oblique points and as if it were normal, and arrival [ms]."""
    slant = np.sqrt(run["distance"] ** 2 + y ** 2 + z ** 2)
    cosine = run["distance"] / slant
    root = run["mass"] ** (1 / 3)
    distance = slant / root
    incident = 1 + cosine ** 2 - 2 * cosine
    peak = curve("reflected pressure", distance)
    impulse = root * curve("reflected impulse", distance)
    return {"angle": np.degrees(np.arccos(cosine)), "peak": peak, "impulse": impulse, "arrival": root * curve("arrival", distance),
            "oblique peak": peak * cosine ** 2 + incident * curve("pressure", distance),
            "oblique impulse": impulse * cosine ** 2 + incident * root * curve("impulse", distance)}


def at(run, name, y, z):
    """Value of the cell that holds a point."""
    return run[name][min(int(z / run["h"]), len(run["z"]) - 1), min(int(y / run["h"]), len(run["y"]) - 1)]


def table(run):
    """Prints the points of one run, as a table in Markdown."""
    print(f"{run['folder']}: {run['mass']:g} kg at {run['distance']:g} m, cells of {1e3 * run['h']:.0f} mm\n")
    print("| y, z [m] | angle | peak [kPa] | oblique | normal | impulse [kPa ms] | oblique | normal | arrival [ms] | curve |")
    print("|" + "---|" * 10)
    for y, z in POINTS:
        expected = reference(run, *((int(v / run["h"]) + 0.5) * run["h"] for v in (y, z)))
        found = {"peak": at(run, "peak_overpressure", y, z) / 1e3, "impulse": at(run, "impulse", y, z),
                 "arrival": 1e3 * at(run, "arrival_time", y, z)}
        cells = [f"{y:g}, {z:g}", f"{expected['angle']:.0f}"]
        for name, value in found.items():
            others = [expected[key] for key in (f"oblique {name}", name) if key in expected]
            cells += [f"{value:.4g}"] + [f"{other:.4g} ({100 * (value / other - 1):+.0f} %)" for other in others]
        print("| " + " | ".join(cells) + " |")
    expected = [[reference(run, y, z) for y in run["y"]] for z in run["z"]]
    closed = np.isfinite(run["impulse"])
    sums = [2 * run["h"] ** 2 / 1e3 * values[closed].sum() for values in (
        run["impulse"], *(np.array([[point[key] for point in row] for row in expected]) for key in ("oblique impulse", "impulse")))]
    print(f"\nimpulse of the whole wall {sums[0]:.2f} kN s; curves, oblique, {sums[1]:.2f} kN s; as if normal {sums[2]:.2f} kN s\n")
    run["ratio"] = run["impulse"] / np.array([[point["oblique impulse"] for point in row] for row in expected])


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
    draw_map(figure, left[1], run, run["ratio"], "impulse over that of the curves, oblique", "RdBu_r", (0.5, 1.5))
    for panel, place in zip(right, (0.0, 1.5)):
        z = np.linspace(0, run["height"], 200)
        panel.plot(z, [reference(run, place, v)["oblique impulse"] for v in z], color="#6b6b6b", label="Kingery & Bulmash, oblique")
        panel.plot(z, [reference(run, place, v)["impulse"] for v in z], "--", color="#6b6b6b", label="the same, as if normal")
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
