"""Checks of the readers and of the painter behind tools/plot, on the runs of test_plot.sh: plotting_checks.py PLOTTING RUNS."""
import glob
import os
import sys

sys.path.insert(0, sys.argv[1])

import numpy as np  # noqa: E402

from curve_pictures import Column, read_table  # noqa: E402
from flow_pictures import unfolded  # noqa: E402
from snapshot_files import open_snapshot  # noqa: E402
from solid_pictures import close_gaps, mirrored, paint, view_frame  # noqa: E402
from style import readable, time_text  # noqa: E402


def snapshot(run, kind, which):
    return open_snapshot(sorted(glob.glob(os.path.join(sys.argv[2], run, f"snapshot_{kind}_*.vtkhdf")))[which])


def close(a, b, tolerance=1e-6):
    return np.allclose(a, b, rtol=tolerance, atol=0)


def check_flow():
    first = snapshot("one", "flow", 0)
    x, density = first.line("density")
    assert first.time == 0 and len(x) == first.cells[0]
    assert close(density[0], 1.0) and close(density[-1], 0.125)
    assert close(x[0], first.lower[0] + 0.5 * first.spacing[0])
    assert abs(x[np.argmax(density < 0.5)] - 0.5) < first.spacing[0]
    bubble = snapshot("two", "flow", 0)
    plane, _ = bubble.layer("density", None, 0.0)
    assert plane.shape == (bubble.cells[1], bubble.cells[0])
    x = bubble.lower[0] + (np.arange(bubble.cells[0]) + 0.5) * bubble.spacing[0]
    middle = plane[0]  # beside the plane of symmetry
    assert close(middle[np.argmin(abs(x - 175))], 0.138, 1e-4), "the bubble lies where the deck puts it"
    assert close(middle[np.argmin(abs(x - 300))], 1.3764, 1e-4), "the shocked air lies to the right"
    share = sum(bubble.layer(name, None, 0.0)[0] for name in bubble.data if name.startswith("volume_fraction"))
    assert close(share, 1.0), "volume fractions add up to one"
    blast = snapshot("three", "flow", 0)
    for axis in range(3):
        pressure, place = blast.layer("pressure", axis, 0.0)
        assert np.unravel_index(np.argmax(pressure), pressure.shape) == (0, 0), "the charge is in the corner"
        assert close(place, 0.5 * blast.spacing[axis])
    speed, _ = snapshot("three", "flow", -1).layer("speed", 1, 0.0)
    assert speed.max() > 100 and blast.layer("speed", 1, 0.0)[0].max() == 0


def check_solid():
    slab = snapshot("three", "solid", 0)
    low, high = slab.extent()
    assert np.allclose(low, [0, 0, 0.40], atol=0.006) and np.allclose(high, [0.55, 0.5, 0.44], atol=0.006)
    assert close(slab.size(), 0.004, 0.02)
    volume = slab.field("volume").sum()
    assert close(volume, 0.55 * 0.5 * 0.04, 1e-3)
    mass = (slab.field("density") * slab.field("volume"))[slab.field("material") == 1].sum()
    assert close(mass, 2440 * slab.field("volume")[slab.field("material") == 1].sum(), 0.2)


def check_painter():
    lattice = np.stack(np.meshgrid([0.5, 1.5, 2.5], [0.5, 1.5], [0.5, 1.5], indexing="ij"), axis=-1).reshape(-1, 3)
    values = lattice[:, 2].copy()
    for side, seen in ((1, 1.5), (-1, 0.5)):
        picture, depths, extent, _ = paint(lattice, values, 1.0, view_frame([0, 0, side]))
        assert np.nanmin(picture) == np.nanmax(picture) == seen, "the near layer hides the far one"
        area = np.isfinite(picture).sum() * (extent[1] - extent[0]) * (extent[3] - extent[2]) / picture.size
        assert abs(area - 6) < 0.4, area
    right, up, towards, _ = view_frame([0, 0, -1])
    assert close(np.cross(right, up), towards)
    twice, doubled = mirrored(lattice, values, {0: 0.0, 1: 0.0})
    assert len(twice) == 4 * len(lattice) == len(doubled) and close(twice[:, :2].sum(axis=0) + 1, 1)
    row = np.array([[1.0, 1.0, np.nan, 3.0, 3.0, np.nan, np.nan, np.nan, np.nan, np.nan, np.nan, 5.0]] * 3)
    close_gaps([row], 1)
    assert row[1, 2] == 2 and np.isnan(row[1, 8]), "narrow gaps are closed, wide ones are not"
    plane, extent = unfolded(np.array([[1.0, 2.0]]), (0, 2, 0, 1), 0, 1, {0: 0.0})
    assert plane.tolist() == [[2, 1, 1, 2]] and extent == (-2, 2, 0, 1)


def check_tables():
    columns, numbers = read_table(os.path.join(sys.argv[2], "three", "gauges.csv"))
    assert columns[0].name == "time" and len(columns) == numbers.shape[1] and len(numbers) > 2
    assert all(np.diff(numbers[:, 0]) > 0)
    column = Column("centre of the face.velocity_z [m/s]", False)
    assert (column.quantity, column.component, column.owner_alone, column.unit) == ("velocity", "z", "centre of the face", "m/s")
    column = Column("solid.internal_energy.steel [J]", True)
    assert (column.quantity, column.owner) == ("internal_energy", "solid steel")
    assert Column("balance.momentum_x [N s]", True).quantity == "momentum_balance"
    assert readable([2.1e7], "Pa") == (1e-6, "MPa") and readable([5.0], "mm") == (1.0, "mm")
    assert time_text(2.5e-4, "s") == "t = 250 µs" and time_text(3.0, "-") == "t = 3"


for check in (check_flow, check_solid, check_painter, check_tables):
    check()
    print(f"{check.__name__} passed")
