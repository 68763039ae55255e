"""Final length and foot diameter of a Taylor bar that hits the plane z = 0, from the outermost particles and half their spacing."""
import numpy as np

from snapshot_files import open_snapshot


def measure(folder):
    """Prints the figures of one run."""
    files = sorted(folder.glob("snapshot_solid_*.vtkhdf"))
    first, last = open_snapshot(files[0]), open_snapshot(files[-1])
    half = 0.5 * first.size()
    length = last.position[:, 2].max() + half
    radius = np.hypot(last.position[:, 0], last.position[:, 1])
    foot = 2 * (radius[last.position[:, 2] < 4 * half].max() + half)
    print(f"{folder}: time {last.time:.4g} {last.time_unit}, length {length:.2f}, foot diameter {foot:.2f} {last.length_unit}")
