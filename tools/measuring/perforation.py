"""Residual velocity of a projectile that went through a plate, from the gauge on its rear, against the tests of Hanchak et al. (1992) on
178 mm of concrete of 48 MPa. One table of all runs, and one picture."""
import csv
import pathlib

import numpy as np

from style import LINES, plt, save

TESTS = [(301, 0), (360, 67), (381, 136), (434, 214), (606, 449), (749, 615), (1058, 947)]  # striking, residual velocity [m/s]
PICTURE = pathlib.Path("docs/pictures/perforation.png")


def velocities(folder):
    """Striking and residual velocity: slopes of the displacement over the first and the last tenth of the time, and how far it came."""
    with open(folder / "gauges.csv", newline="") as file:
        rows = list(csv.reader(file))
    column = next(i for i, head in enumerate(rows[0]) if head.startswith("rear.displacement_z"))
    data = np.array([[float(row[0]), float(row[column])] for row in rows[1:]])
    time, way = data.T
    first, last = time < 0.03 * time[-1], time > 0.9 * time[-1]
    return np.polyfit(time[first], way[first], 1)[0], np.polyfit(time[last], way[last], 1)[0], way[-1]


def measure_all(folders):
    """The table and the picture."""
    runs = [(folder, *velocities(folder)) for folder in folders]
    print("| run | striking [m/s] | residual [m/s] | test | | way of the rear [mm] |")
    print("|" + "---|" * 6)
    for folder, striking, residual, way in runs:
        near = min(TESTS, key=lambda test: abs(test[0] - striking))
        test = near[1] if abs(near[0] - striking) < 10 else None
        error = f"{residual - test:+.0f} m/s" if test is not None else ""
        print(f"| {folder.name} | {striking:.0f} | {residual:.0f} | {test if test is not None else ''} | {error} | {1e3 * way:.0f} |")
    figure, panel = plt.subplots(figsize=(4.6, 3.8), constrained_layout=True)
    panel.plot(*zip(*TESTS), "k+", ms=8, label="tests, Hanchak et al. 1992")
    order = sorted(runs, key=lambda run: run[1])
    panel.plot([run[1] for run in order], [run[2] for run in order], "o-", color=LINES[1], label="runs")
    panel.plot([0, 1100], [0, 1100], color="#b0b0b0", lw=0.8)
    panel.set_xlabel("striking velocity [m/s]")
    panel.set_ylabel("residual velocity [m/s]")
    panel.set_xlim(250, 1100)
    panel.set_ylim(-20, 1000)
    panel.legend()
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    save(figure, PICTURE)
    print(f"picture: {PICTURE}")
