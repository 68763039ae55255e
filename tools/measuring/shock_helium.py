"""Velocities of waves and interfaces in runs of a shock that meets a helium bubble, as Haas & Sturtevant (1987) measured them.

Each is the slope of a straight line through the positions of a feature in a window of time. Positions are found on the axis or,
where said, over the whole bubble, between cells by linear interpolation. Times are microseconds after the shock met the bubble."""
import numpy as np

from shock_helium_pictures import schlieren_sheet, wave_diagram
from snapshot_files import open_snapshot

SPEED = 343.3 / np.sqrt(1.4)  # m/s of the experiment per unit of velocity of the deck
MICROSECONDS = 1e-3 / SPEED * 1e6  # per unit of time of the deck: lengths are in mm
IMPACT = (225.0 - 200.0) / (1.22 * np.sqrt(1.4))  # time at which the shock meets the bubble
AHEAD = 1.0  # pressure

# name, feature, window [us] or range of positions [mm], experiment and Quirk & Karni (1996), m/s
TABLE = [
    ("incident shock", "shock_by_the_wall", (-15, 90), None, 410, 422),
    ("refracted shock in the bubble", "front_on_axis", None, (154, 194), 900, 943),
    ("transmitted shock behind the bubble", "front_on_axis", None, (60, 140), 393, 377),
    ("upstream interface, first", "upstream_on_axis", (5, 60), None, 170, 178),
    ("upstream interface, later", "upstream_edge", (300, 700), None, 113, None),
    ("downstream interface, behind the shock", "downstream_on_axis", (60, 110), None, None, None),
    ("downstream interface, first", "downstream_on_axis", (70, 240), None, 145, 146),
    ("downstream interface, later", "downstream_on_axis", (240, 450), None, 97, None),
    ("head of the air jet", "upstream_on_axis", (130, 230), None, 230, 227),
    ("vortex pair", "vortex_centre", (430, 990), None, 128, None),
    ("foremost helium", "downstream_edge", (740, 990), None, None, None),
]


def crossing(x, values, level, last):
    """Position where values cross the level, the last or the first along x; nan if they do not."""
    above = values > level
    change = np.nonzero(above[1:] != above[:-1])[0]
    if len(change) == 0:
        return np.nan
    i = change[-1] if last else change[0]
    return x[i] + (level - values[i]) / (values[i + 1] - values[i]) * (x[i + 1] - x[i])


def upper_half(snapshot, name):
    """A field over y > 0, from the row at the axis on; the row in the middle of an odd number of rows is taken whole."""
    values, _ = snapshot.layer(name, None, 0.0)
    return values if snapshot.lower[1] >= 0 else values[values.shape[0] // 2:]


def vortex_centre(snapshot, x, helium):
    """Centre of the clockwise vorticity around the bubble: the core of the vortex above the axis."""
    along, across = upper_half(snapshot, "velocity_x"), upper_half(snapshot, "velocity_y")
    vorticity = np.gradient(across, snapshot.spacing[0], axis=1) - np.gradient(along, snapshot.spacing[1], axis=0)
    clockwise = np.maximum(-vorticity, 0.0)[:, helium > 0.02].sum(axis=0)
    return np.average(x[helium > 0.02], weights=clockwise) if clockwise.sum() > 0 else np.nan


def features(snapshot):
    """Positions of all features in one snapshot."""
    pressure, share = upper_half(snapshot, "pressure"), upper_half(snapshot, "volume_fraction_helium")
    n_y, n_x = pressure.shape
    x = snapshot.lower[0] + (np.arange(n_x) + 0.5) * snapshot.spacing[0]
    most = share.max(axis=0)
    return {
        "shock_by_the_wall": crossing(x, pressure[-max(1, n_y // 15):].mean(axis=0), 1.28 * AHEAD, False),
        "front_on_axis": crossing(x, pressure[0], 1.03 * AHEAD, False),
        "upstream_on_axis": crossing(x, share[0], 0.5, True),
        "downstream_on_axis": crossing(x, share[0], 0.5, False),
        "upstream_edge": crossing(x, most, 0.5, True),
        "downstream_edge": crossing(x, most, 0.5, False),
        "vortex_centre": vortex_centre(snapshot, x, most),
    }


class Course:
    """Positions of the features over time in one run."""

    def __init__(self, folder):
        self.name = folder.name
        self.paths = sorted(folder.glob("snapshot_flow_*.vtkhdf"))
        times, found = [], []
        for path in self.paths:
            snapshot = open_snapshot(path)
            times.append((snapshot.time - IMPACT) * MICROSECONDS)
            found.append(features(snapshot))
            self.spacing = float(snapshot.spacing[0])
            snapshot.close()
        self.times = np.array(times)
        self.position = {name: np.array([f[name] for f in found]) for name in found[0]}

    def chosen(self, feature, window, span):
        """Which snapshots count for the speed of a feature."""
        position = self.position[feature]
        if span:
            return (position > span[0]) & (position < span[1])
        return (self.times > window[0]) & (self.times < window[1]) & np.isfinite(position)

    def speed(self, feature, window, span):
        """m/s downstream, and the number of points; nan where there are too few or the run ends before half of the window."""
        chosen = self.chosen(feature, window, span)
        if chosen.sum() < 2 or (window and self.times[-1] < 0.5 * (window[0] + window[1])):
            return np.nan, 0
        return -np.polyfit(self.times[chosen], self.position[feature][chosen], 1)[0] * 1e3, int(chosen.sum())


def measure_all(folders):
    """A table with a column for each run; the pictures go to the first one. The sheet shows it above the second, if there is one."""
    courses = [Course(folder) for folder in folders]
    print("| m/s | experiment | Quirk & Karni | " + " | ".join(f"{c.name}, h = {c.spacing:g} | " for c in courses) + " | points |")
    print("|" + "---|" * (4 + 2 * len(courses)))
    for name, feature, window, span, experiment, published in TABLE:
        cells = []
        for course in courses:
            speed, points = course.speed(feature, window, span)
            cells += ["-", ""] if np.isnan(speed) else [f"{speed:.0f}", f"{100 * (speed / experiment - 1):+.0f} %" if experiment else ""]
        where = f"{span[0]}..{span[1]} mm" if span else f"{window[0]}..{window[1]} us"
        print(f"| {name} | {experiment or '-'} | {published or '-'} | " + " | ".join(cells) + f" | {points}, {where} |")
    pictures = folders[0] / "pictures"
    pictures.mkdir(parents=True, exist_ok=True)
    print("\npictures:", schlieren_sheet(courses[:2], pictures / "schlieren_sheet.png"),
          wave_diagram(courses, TABLE, pictures / "wave_diagram.png"))
