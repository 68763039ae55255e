"""A blast of particles (pure MPM) against the same blast by the flow solver in one spherical direction: pressure over the distance from
the charge at the origin, and how far the particles scatter around it.

The first run is the reference; snapshots of the same times are compared."""
import numpy as np

from snapshot_files import open_snapshot
from style import LINES, plt, save


def time_of(snapshot):
    """Time of a snapshot [s]."""
    return float(np.ravel(snapshot.time)[0])


def at_times(folder, kind):
    """Snapshots of a run by time, rounded to a millionth of the last one."""
    paths = sorted(folder.glob(f"snapshot_{kind}_*.vtkhdf"))
    found = {}
    for path in paths:
        snapshot = open_snapshot(path)
        found[round(time_of(snapshot), 9)] = path
        snapshot.close()
    return found


def profile(path):
    """Distance and pressure of the reference, and the place of its shock."""
    snapshot = open_snapshot(path)
    r, pressure = snapshot.line("pressure")
    ambient = pressure[-1]
    shock = r[np.nonzero(pressure > 1.5 * ambient)[0][-1]]
    snapshot.close()
    return r, pressure, shock


def fluid_particles(path, within):
    """Distance, pressure and mass of the fluid particles between the charge and what it may hit."""
    snapshot = open_snapshot(path)
    bodies = [name.strip() for name in snapshot.bodies]
    fluid = np.isin(snapshot.field("body").astype(int), [i + 1 for i, name in enumerate(bodies) if name in ("air", "charge")])
    r = np.sqrt((snapshot.position ** 2).sum(axis=1))
    chosen = fluid & (r < within)
    figures = (r[chosen], snapshot.field("pressure")[chosen],
               (snapshot.field("density") * snapshot.field("volume"))[chosen])
    snapshot.close()
    return figures


def measure_all(folders):
    """Table and picture; the picture goes to the second run."""
    reference = at_times(folders[0], "flow")
    runs = [(folder, at_times(folder, "solid")) for folder in folders[1:]]
    shared = sorted(t for t in reference if t > 0 and all(t in found for _, found in runs))
    if not shared:
        raise SystemExit("error: the runs have no snapshot at the same time")
    print("| run | time [us] | shock [mm] | mean pressure behind the shock over that of the flow solver | its standard deviation over "
          "its mean | outermost particle at twice the ambient pressure [mm] |")
    print("|" + "---|" * 6)
    shown = shared[:2]
    figure, panels = plt.subplots(2, len(runs), figsize=(4.4 * len(runs), 6.2), squeeze=False, constrained_layout=True)
    for column, (folder, found) in enumerate(runs):
        for row, t in enumerate(shown):
            r, pressure, shock = profile(reference[t])
            where, p, mass = fluid_particles(found[t], r[-1])
            peak = pressure[r > 0.5 * shock].max()
            shell = (where > 0.9 * shock) & (where < shock)
            mean = np.average(p[shell], weights=mass[shell])
            deviation = np.sqrt(np.average((p[shell] - mean) ** 2, weights=mass[shell]))
            exact = np.interp(where[shell], r, pressure)
            outermost = where[p > 2 * pressure[-1]].max()
            print(f"| {folder.name} | {1e6 * t:.0f} | {1e3 * shock:.0f} | {mean / np.average(exact, weights=mass[shell]):.2f} "
                  f"| {deviation / mean:.2f} | {1e3 * outermost:.0f} |")
            panel = panels[row, column]
            panel.plot(1e3 * where, 1e-6 * p, ".", ms=1.2, color=LINES[1], label="particles", rasterized=True)
            panel.plot(1e3 * r, 1e-6 * pressure, color=LINES[0], lw=1, label="flow solver, fine")
            panel.set_xlim(0, 1e3 * r[-1])
            panel.set_ylim(-0.15e-6 * peak, 2.2e-6 * peak)
            panel.set_title(f"{folder.name.replace('_', ' ')}, {1e6 * t:.0f} µs")
            panel.set_xlabel("distance [mm]")
            panel.set_ylabel("pressure [MPa]")
    panels[0, 0].legend()
    picture = folders[1] / "pictures" / "particle_blast.png"
    picture.parent.mkdir(parents=True, exist_ok=True)
    save(figure, picture)
    print(f"\npicture: {picture}")
