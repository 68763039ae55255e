"""Deflection and spall of the slab. Spall: material that has moved away from the front face before it by more than an opening; its
radius is that of a circle with the same area, its depth the thickness between the back face and the deepest particle that has moved
so, for several openings."""
from collections import namedtuple

import numpy as np

from run_tables import read_columns
from snapshot_files import Solid, open_snapshot

OPENINGS = (0.004, 0.008, 0.016)  # m
NEAR = 0.06  # m from the centre: where the depth is taken
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


Deflection = namedtuple("Deflection", "gauge value time is_peak largest last end")
Spall = namedtuple("Spall", "time thickness extent failed")  # extent: {opening: (radius, depth)}; failed: {face: part}


def deflections(folder):
    """Of each gauge on the solid: first peak of its displacement [m], or the last value where there is none, its time [s] and which of
    the two it is; largest and last value, time of the end."""
    columns = read_columns(folder / "gauges.csv")
    times = columns["time"]
    for head, curve in columns.items():
        if not head.endswith(".displacement_z"):
            continue
        peaks = [i for i in np.nonzero(np.diff(curve) <= 0)[0] if curve[i] > 0.5 * np.nanmax(curve)]
        first = peaks[0] if peaks else len(curve) - 1
        yield Deflection(head.rpartition(".")[0], curve[first], times[first], bool(peaks), np.nanmax(curve), curve[-1], times[-1])


def spall(folder):
    """Time and thickness, spall radius and depth [m] for each opening, failed part of both faces: of the last snapshot."""
    files = sorted(folder.glob("snapshot_solid_*.vtkhdf"))
    first, last = SlabAlone(open_snapshot(files[0])), SlabAlone(open_snapshot(files[-1]))
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
    extent = {}
    for least in OPENINGS:
        deepest = {}
        for i in behind[opening > least]:
            deepest[key[i]] = min(deepest.get(key[i], np.inf), z[i])
        within = [z.max() + pitch - low for k, low in deepest.items() if np.hypot(k // 100000, k % 100000) * pitch < NEAR]
        extent[least] = np.sqrt(len(deepest) * pitch ** 2 * QUARTERS / np.pi), np.mean(within) if within else 0.0
    faces = {"front": z < z.min() + pitch, "back": z > z.max() - pitch}
    return Spall(last.time, z.max() - z.min() + pitch, extent, {name: failed[concrete & face].mean() for name, face in faces.items()})


def measure(folder):
    """Prints deflection, spall radius and spall depth of one run."""
    found = spall(folder)
    print(f"{folder}: {found.time * 1e3:.3f} ms")
    for d in deflections(folder):
        kind = "first peak" if d.is_peak else "still rising at the end"
        print(f"  {d.gauge:28s} {1e3 * d.value:6.1f} mm at {1e3 * d.time:.2f} ms ({kind}), largest {1e3 * d.largest:.1f} mm, "
              f"last {1e3 * d.last:.1f} mm at {1e3 * d.end:.2f} ms")
    for least, (radius, depth) in found.extent.items():
        print(f"  spall (opening over {1e3 * least:.0f} mm): radius {1e3 * radius:.0f} mm, depth {1e3 * depth:.0f} mm (mean over "
              f"{1e3 * NEAR:.0f} mm around the centre) of {1e3 * found.thickness:.0f} mm")
    for name, part in found.failed.items():
        print(f"  failed part of the {name} face: {100 * part:.0f} %")
