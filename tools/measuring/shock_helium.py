"""Velocities of waves and interfaces in the run of a shock that meets a helium bubble, as Haas & Sturtevant (1987) measured them.

Each is the slope of a straight line through the positions of a feature in a window of time. Positions are found on the axis or,
where said, over the whole bubble, between cells by linear interpolation. Times are microseconds after the shock met the bubble."""
import numpy as np

from snapshot_files import open_snapshot

SPEED = 343.3 / np.sqrt(1.4)  # m/s of the experiment per unit of velocity of the deck
MICROSECONDS = 1e-3 / SPEED * 1e6  # per unit of time of the deck: lengths are in mm
IMPACT = (225.0 - 200.0) / (1.22 * np.sqrt(1.4))  # time at which the shock meets the bubble
AHEAD, BUBBLE_LOW, BUBBLE_HIGH = 1.0, 150.0, 200.0

# name, feature, window [us] or range of positions [mm], experiment and Quirk & Karni (1996), m/s
TABLE = [
    ("incident shock", "shock_by_the_wall", (-15, 90), None, 410, 422),
    ("refracted shock in the bubble", "front_on_axis", None, (154, 194), 900, 943),
    ("transmitted shock behind the bubble", "front_on_axis", None, (60, 140), 393, 377),
    ("upstream interface, first", "upstream_on_axis", (5, 60), None, 170, 178),
    ("upstream interface, later", "upstream_edge", (300, 700), None, 113, None),
    ("downstream interface, first", "downstream_on_axis", (70, 240), None, 145, 146),
    ("downstream interface, later", "downstream_on_axis", (240, 450), None, 97, None),
    ("head of the air jet", "upstream_on_axis", (130, 230), None, 230, 227),
    ("front of the vortex pair", "downstream_edge", (740, 980), None, 128, None),
]


def crossing(x, values, level, last):
    """Position where values cross the level, the last or the first along x; nan if they do not."""
    above = values > level
    change = np.nonzero(above[1:] != above[:-1])[0]
    if len(change) == 0:
        return np.nan
    i = change[-1] if last else change[0]
    return x[i] + (level - values[i]) / (values[i + 1] - values[i]) * (x[i + 1] - x[i])


def features(snapshot):
    """Positions of all features in one snapshot."""
    pressure, _ = snapshot.layer("pressure", None, 0.0)
    helium, _ = snapshot.layer("volume_fraction_helium", None, 0.0)
    n_y, n_x = pressure.shape
    x = snapshot.lower[0] + (np.arange(n_x) + 0.5) * snapshot.spacing[0]
    middle = slice((n_y - 1) // 2, n_y // 2 + 1)
    p, a = pressure[middle].mean(axis=0), helium[middle].mean(axis=0)
    by_wall = pressure[-max(1, n_y // 30):].mean(axis=0)
    most = helium.max(axis=0)
    return {
        "shock_by_the_wall": crossing(x, by_wall, 1.28 * AHEAD, False),
        "front_on_axis": crossing(x, p, 1.03 * AHEAD, False),
        "upstream_on_axis": crossing(x, a, 0.5, True),
        "downstream_on_axis": crossing(x, a, 0.5, False),
        "upstream_edge": crossing(x, most, 0.5, True),
        "downstream_edge": crossing(x, most, 0.5, False),
    }


def measure(folder):
    """Prints the table for one run."""
    times, found = [], []
    for path in sorted(folder.glob("snapshot_flow_*.vtkhdf")):
        snapshot = open_snapshot(path)
        times.append((float(np.ravel(snapshot.time)[0]) - IMPACT) * MICROSECONDS)
        found.append(features(snapshot))
        snapshot.close()
    times = np.array(times)
    print(f"{folder}: {len(times)} snapshots")
    print(f"{'feature':38s} {'run':>7s} {'exper.':>7s} {'Q&K':>6s} {'error':>7s}  window, points")
    for name, feature, window, span, experiment, published in TABLE:
        position = np.array([f[feature] for f in found])
        if span:
            chosen = (position > span[0]) & (position < span[1])
            where = f"{span[0]}..{span[1]} mm"
        else:
            chosen = (times > window[0]) & (times < window[1]) & np.isfinite(position)
            where = f"{window[0]}..{window[1]} us"
        if chosen.sum() < 2:
            print(f"{name:38s} {'-':>7s} {experiment:7d} {published or '-':>6} {'-':>7s}  {where}, {chosen.sum()} points")
            continue
        speed = -np.polyfit(times[chosen], position[chosen], 1)[0] * 1e3
        print(f"{name:38s} {speed:7.0f} {experiment:7d} {published or '-':>6} {100 * (speed / experiment - 1):6.1f}%"
              f"  {where}, {chosen.sum()} points")
