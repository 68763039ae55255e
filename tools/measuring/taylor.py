"""Final shape of Taylor bars that hit the plane z = 0, from the outermost particles and half their spacing, against the tests of
Johnson & Cook (1983) on OFHC copper, 7.62 mm in diameter and 25.4 mm long. One table of all runs, and their profiles in one picture."""
import pathlib

import numpy as np

from snapshot_files import open_snapshot
from style import LINES, plt, save

# velocity [m/s]: final length, foot diameter, diameter at 0.2 of the first length [mm]
TESTS = {130: (19.56, 9.906, 8.92), 146: (18.69, 10.67, 9.3), 190: (16.2, 13.56, 10.1)}
PICTURE = pathlib.Path("docs/pictures/taylor_bars.png")


def profile(position, half):
    """Radius of the surface over the height, in slices of two spacings; the radius of the particles' centres and half a spacing."""
    z = position[:, 2]
    radius = np.hypot(position[:, 0], position[:, 1])
    edges = np.arange(0, z.max() + 4 * half, 4 * half)
    slices = np.digitize(z, edges) - 1
    top = np.array([radius[slices == i].max() + half if (slices == i).any() else np.nan for i in range(len(edges) - 1)])
    return 0.5 * (edges[1:] + edges[:-1]), top


def shape(folder):
    """Velocity of the impact, time, length, foot diameter, diameter at 0.2 of the first length, profile, speed of the rear at the end."""
    files = sorted(folder.glob("snapshot_solid_*.vtkhdf"))
    first, last = open_snapshot(files[0]), open_snapshot(files[-1])
    half = 0.5 * first.size()
    speed = float(np.abs(first.field("velocity_z")).mean())
    height = first.position[:, 2].max() + half
    rear = last.position[:, 2] > last.position[:, 2].max() - 4 * half
    z, radius = profile(last.position, half)
    foot = np.hypot(last.position[:, 0], last.position[:, 1])[last.position[:, 2] < 4 * half].max() + half
    return {"speed": speed, "time": last.time, "unit": last.time_unit, "length": last.position[:, 2].max() + half, "foot": 2 * foot,
            "fifth": 2 * np.interp(0.2 * height, z, radius), "profile": (z, radius),
            "rest": float(last.field("velocity_z")[rear].mean())}


def measure_all(folders):
    """The table and the picture."""
    runs = [(folder, shape(folder)) for folder in folders]
    print("| run | impact [m/s] | length [mm] | test | | foot diameter [mm] | test | | at 0.2 L [mm] | test | | rear at the end [m/s] |")
    print("|" + "---|" * 12)
    for folder, run in runs:
        test = TESTS.get(round(run["speed"]))
        cells = [folder.name, f"{run['speed']:.0f}"]
        for i, key in enumerate(("length", "foot", "fifth")):
            error = f"{100 * (run[key] / test[i] - 1):+.1f} %" if test else ""
            cells += [f"{run[key]:.2f}", f"{test[i]:g}" if test else "", error]
        print("| " + " | ".join(cells + [f"{run['rest']:.1f}"]) + " |")
    speeds = sorted({round(run["speed"]) for _, run in runs})
    figure, panels = plt.subplots(1, len(speeds), figsize=(3.4 * len(speeds), 4.6), constrained_layout=True, sharey=True, squeeze=False)
    for panel, speed in zip(panels[0], speeds):
        for i, (folder, run) in enumerate(r for r in runs if round(r[1]["speed"]) == speed):
            z, radius = run["profile"]
            for side in (-1, 1):
                panel.plot(side * radius, z, color=LINES[i % len(LINES)], label=folder.name if side > 0 else None)
        if speed in TESTS:
            length, foot, fifth = TESTS[speed]
            for height, width in ((0.1, foot), (5.08, fifth), (length, 7.62)):
                panel.plot([-width / 2, width / 2], [height, height], "k+", ms=9)
            panel.plot([], [], "k+", label="test")
        panel.set_title(f"{speed} m/s")
        panel.set_aspect("equal")
        panel.set_xlabel("radius [mm]")
        panel.set_ylim(-1, 27)
        panel.legend(fontsize=7, loc="upper center")
    panels[0][0].set_ylabel("height [mm]")
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    save(figure, PICTURE)
    print(f"picture: {PICTURE}")
