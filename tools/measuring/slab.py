"""Deflection and spall of the slab. Spall: material of the back half that has moved away from the middle of the slab by more than
OPENING; its radius is that of a circle with the same area, its depth the mean thickness between the back face and the deepest
particle that has moved so."""
import csv

import numpy as np

from snapshot_files import open_snapshot

OPENING = 0.004  # m
QUARTERS = 4  # of the slab that the model leaves out, itself included


def deflection(folder):
    """Largest displacement of the gauges on the solid and its time."""
    with open(folder / "gauges.csv", newline="") as file:
        rows = list(csv.reader(file))
    data = np.array([[float(v) for v in row] for row in rows[1:]])
    for column, head in enumerate(rows[0]):
        if ".displacement_z" not in head:
            continue
        curve = data[:, column]
        rising = np.nonzero(np.diff(curve) <= 0)[0]
        peaks = [i for i in rising if curve[i] > 0.5 * np.nanmax(curve)]
        first = peaks[0] if peaks else len(curve) - 1
        kind = "first peak" if peaks else "still rising at the end"
        print(f"  {head.split('.displacement')[0]:28s} {1e3 * curve[first]:6.1f} mm at {1e3 * data[first, 0]:.2f} ms ({kind}), "
              f"largest {1e3 * np.nanmax(curve):.1f} mm, last {1e3 * curve[-1]:.1f} mm at {1e3 * data[-1, 0]:.2f} ms")


def measure(folder):
    """Prints deflection, spall radius and spall depth of one run."""
    files = sorted(folder.glob("snapshot_solid_*.vtkhdf"))
    first, last = open_snapshot(files[0]), open_snapshot(files[-1])
    print(f"{folder}: {float(np.ravel(last.time)[0]) * 1e3:.3f} ms")
    deflection(folder)
    order = np.argsort(first.field("id"))
    start = first.position[order]
    ids = first.field("id")[order]
    now = np.searchsorted(ids, last.field("id"))
    moved = np.full(len(start), np.nan)
    moved[now] = last.position[:, 2] - start[now, 2]
    failed = np.zeros(len(start))
    failed[now] = last.field("damage") >= 1
    concrete = first.field("material")[order] == 1
    pitch = first.size()
    column = np.floor(start[:, :2] / pitch).astype(int)
    key = column[:, 0] * 100000 + column[:, 1]
    z = start[:, 2]
    middle = 0.5 * (z.min() + z.max())
    reference, spalled, depths = {}, 0, []
    near = concrete & (np.abs(z - middle) < 1.01 * pitch)
    for k, d in zip(key[near], moved[near]):
        reference.setdefault(k, []).append(d)
    reference = {k: np.nanmean(v) for k, v in reference.items()}
    back = concrete & (z > middle) & np.isfinite(moved)
    opened = np.array([moved[i] - reference.get(key[i], np.nan) > OPENING for i in np.nonzero(back)[0]])
    if opened.any():
        chosen = np.nonzero(back)[0][opened]
        for k in np.unique(key[chosen]):
            depths.append(z.max() + 0.5 * pitch - z[chosen][key[chosen] == k].min() + 0.5 * pitch)
        spalled = len(depths)
    area = spalled * pitch ** 2 * QUARTERS
    print(f"  spall: radius {1e3 * np.sqrt(area / np.pi):.0f} mm, mean depth {1e3 * np.mean(depths) if depths else 0:.0f} mm "
          f"of {1e3 * (z.max() - z.min() + pitch):.0f} mm (opening over {1e3 * OPENING:.0f} mm)")
    for name, face in (("front", z < z.min() + pitch), ("back", z > z.max() - pitch)):
        print(f"  failed part of the {name} face: {100 * failed[concrete & face].mean():.0f} %")
