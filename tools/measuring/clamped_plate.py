"""Deflection of a square plate that is clamped all around and gets an impulse, against the fits of Nurick & Martin to tests on
steel plates (Deformation of thin plates subjected to impulsive loading - a review, part II, Int. J. Impact Engng 8, 1989, 171-186):
deflection over thickness is 0.471 f + 0.001 with f = I/(2 t^2 sqrt(B L density yield stress)) for rectangular plates of B x L with
the static yield stress, and 0.425 f + 0.277 with f = I/(pi R t^2 sqrt(density yield stress)) for circular ones, here of the same
area. Nine of ten tests are within one thickness. The tests had impulses that were even and over before the plate
had moved. For others there is an estimate: the plate as an oscillator with its mass and a stiffness by which an even impulse gives
the first fit, under the load over time, of which what is far from the centre counts less, by a cosine in x and y. A quarter of the
plate is in the run, the plate is across z."""
import pathlib
import re

import h5py
import numpy as np

from run_tables import read_columns
from style import LINES, plt, save

PICTURE = pathlib.Path("docs/pictures/clamped_plate.png")


def number(text, key, group, which=0):
    """Numbers of a key of a group of the deck as it was run."""
    body = re.findall(rf"^&{group}\b.*?^/", text, re.DOTALL | re.MULTILINE)[which]
    return [float(v) for v in re.search(rf"\b{key} = ([-0-9.eE+, ]*)", body).group(1).split(",") if v.strip()]


def share_of_mode(folder, time, half):
    """Impulse by its map of that time or before, weighted with cosines, over what it would be if it were even."""
    files = [h5py.File(path) for path in sorted(folder.glob("loads_*.vtkhdf"))]
    file = [f for f in files if f["brisance"].attrs["time"][0] <= time][-1]
    place, impulse = file["VTKHDF/Points"][:], file["VTKHDF/PointData/impulse"][:]
    patch = np.minimum(np.floor(16 * place[:, :2] / half).astype(int), 15) @ (16, 1)
    # particles under the surface have less: those that have most count
    even = np.array([np.percentile(impulse[patch == k], 75) for k in range(256)]).reshape(16, 16)
    wave = np.cos(0.5 * np.pi * (np.arange(16) + 0.5) / 16)
    mode = np.outer(wave, wave)
    return (even * mode).sum() / mode.sum() / even.mean()


def plate(folder):
    """Impulse of the whole plate, its dimensionless number, and the deflection of the centre over time."""
    deck = (folder / "deck.nml").read_text()
    low, high = number(deck, "lower", "body"), number(deck, "upper", "body")
    width, thickness = 2 * (high[0] - low[0]), high[2] - low[2]
    steel = [body for body in re.findall(r"^&material\b.*?^/", deck, re.DOTALL | re.MULTILINE) if "jc_a" in body][0]
    density, yield_stress = (float(re.search(rf"\b{key} = ([-0-9.eE+]*)", steel).group(1)) for key in ("density", "jc_a"))
    gauge = read_columns(folder / "gauges.csv")
    time, way = gauge["time"], gauge["centre.displacement_z"]
    top = int(np.argmax(way))
    loads = folder / "loads.csv"
    if loads.exists():
        load = read_columns(loads)
        share = load["plate.impulse_z"]
        impulse = 4 * np.interp(time[top], load["time"], share)
        mode = share_of_mode(folder, time[top], width / 2)
        half = load["time"][np.argmax(share > 0.1 * share.max())], load["time"][np.argmax(share > 0.9 * share.max())]
    else:
        impulse, half = density * width ** 2 * thickness * number(deck, "velocity", "body")[2], (0.0, 0.0)
        mode = 1.0
        load, share = {"time": np.array([0.0, 1e-9])}, np.array([0.0, impulse / 4])
    rigid = impulse / (thickness ** 2 * np.sqrt(density * yield_stress))
    mass = density * width ** 2 * thickness
    frequency = impulse / mass / (0.471 * rigid / (2 * width) * thickness)
    steps, at_step = np.diff(4 * share), 0.5 * (load["time"][1:] + load["time"][:-1])
    answers = [np.sum(steps * np.sin(frequency * (t - at_step)) * (t > at_step)) for t in time[::5]]
    oscillator = mode * max(answers) / (mass * frequency)
    rest = way[time > time[top] + 0.25 * (time[-1] - time[top])].mean()
    return {"folder": folder, "time": time, "way": way, "thickness": thickness, "impulse": impulse, "number": rigid / (2 * width),
            "number_of_a_circle": rigid / (np.sqrt(np.pi) * width), "largest": way[top], "at": time[top], "rest": rest,
            "duration": half[1] - half[0], "oscillator": oscillator,
            "mode": mode}


def measure_all(folders):
    """The table and the picture."""
    runs = [plate(folder) for folder in folders]
    print("| run | impulse [N s] | 10 to 90 % of it in [us] | f | largest deflection / t | mean afterwards / t "
          "| fit, rectangles | | fit, circles | | share of the mode | estimate | |")
    print("|" + "---|" * 13)
    for run in runs:
        fit = 0.471 * run["number"] + 0.001
        circle = 0.425 * run["number_of_a_circle"] + 0.277
        rest, slow = run["rest"] / run["thickness"], run["oscillator"] / run["thickness"]
        print(f"| {run['folder'].name} | {run['impulse']:.1f} | {1e6 * run['duration']:.0f} | {run['number']:.2f} "
              f"| {run['largest'] / run['thickness']:.2f} at {1e3 * run['at']:.2f} ms | {rest:.2f} | {fit:.2f} | {rest - fit:+.2f} "
              f"({100 * (rest / fit - 1):+.0f} %) | {circle:.2f} | {rest - circle:+.2f} ({100 * (rest / circle - 1):+.0f} %) "
              f"| {run['mode']:.2f} | {slow:.2f} | {100 * (rest / slow - 1):+.0f} % |")
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.6), constrained_layout=True)
    f = np.linspace(0, 1.15 * max(run["number"] for run in runs), 50)
    right.fill_between(f, 0.471 * f - 1, 0.471 * f + 1, color="#e4e2dd", lw=0, label="$\\pm$ one thickness")
    right.plot(f, 0.471 * f + 0.001, color="#6b6b6b", label="Nurick & Martin 1989, rectangular plates")
    for i, run in enumerate(runs):
        colour = LINES[i % len(LINES)]
        name = run["folder"].name.replace("_", " ")
        left.plot(1e3 * run["time"], 1e3 * run["way"], color=colour, label=name)
        right.plot(run["number"], run["rest"] / run["thickness"], "osv^D"[i % 5], color=colour, label=name)
    left.set_xlabel("time [ms]")
    left.set_ylabel("deflection of the centre [mm]")
    left.set_ylim(bottom=0)
    right.set_xlabel("dimensionless impulse f")
    right.set_ylabel("deflection over thickness")
    right.set_xlim(0, f[-1])
    right.set_ylim(0, 0.6 * f[-1])
    left.legend(loc="lower right")
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    save(figure, PICTURE)
    print(f"picture: {PICTURE}")
