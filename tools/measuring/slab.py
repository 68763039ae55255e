"""Deflection and spall of the slab. Spall: material that has moved away from the front face before it by more than an opening; its
radius is that of a circle with the same area, its depth the thickness between the back face and the deepest particle that has moved
so, for several openings."""
import csv

import numpy as np

from snapshot_files import Solid, open_snapshot

OPENINGS = (0.004, 0.008, 0.016)  # m
QUARTERS = 4  # of the slab that the model leaves out, itself included


class SlabAlone(Solid):
    """The particles of the first body of a snapshot, the slab: explosive and air may be particles too."""

    def __init__(self, snapshot):
        super().__init__(snapshot.path, snapshot.file)
        self.chosen = snapshot.field("body") == 1
        self.position = self.position[self.chosen]
        self.n = len(self.position)

    def field(self, name):
        values = super().field(name)
        return values[self.chosen]


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
    first, last = SlabAlone(first), SlabAlone(last)
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
    reference = {}
    front = concrete & (z < z.min() + 1.5 * pitch)
    for k, d in zip(key[front], moved[front]):
        reference.setdefault(k, []).append(d)
    reference = {k: np.nanmean(v) for k, v in reference.items()}
    behind = np.nonzero(concrete & np.isfinite(moved))[0]
    opening = np.array([moved[i] - reference.get(key[i], np.nan) for i in behind])
    for least in OPENINGS:
        deepest = {}
        for i in behind[opening > least]:
            deepest[key[i]] = min(deepest.get(key[i], np.inf), z[i])
        within = [z.max() + pitch - low for k, low in deepest.items() if np.hypot(k // 100000, k % 100000) * pitch < 0.06]
        radius = np.sqrt(len(deepest) * pitch ** 2 * QUARTERS / np.pi)
        print(f"  spall (opening over {1e3 * least:.0f} mm): radius {1e3 * radius:.0f} mm, depth "
              f"{1e3 * np.mean(within) if within else 0:.0f} mm (mean over 60 mm around the centre) of "
              f"{1e3 * (z.max() - z.min() + pitch):.0f} mm")
    for name, face in (("front", z < z.min() + pitch), ("back", z > z.max() - pitch)):
        print(f"  failed part of the {name} face: {100 * failed[concrete & face].mean():.0f} %")
