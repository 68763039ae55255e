"""Pictures of a shock that meets a helium bubble: schlieren at the times of the experiment, and positions over time."""
import numpy as np

from snapshot_files import open_snapshot
from style import LINES, plt, save

EXPERIMENT_TIMES = (32, 52, 62, 72, 82, 102, 245, 427, 674, 983)  # us after the shock met the bubble (Haas & Sturtevant 1987)
SHOWN = 110.0  # mm along x
FEATURES = {  # name in the diagram and colour
    "shock_by_the_wall": ("incident shock, by the wall", LINES[7]),
    "front_on_axis": ("refracted, then transmitted shock, on the axis", LINES[0]),
    "upstream_on_axis": ("upstream interface, on the axis: the jet", LINES[1]),
    "upstream_edge": ("upstream interface, rearmost", LINES[4]),
    "downstream_on_axis": ("downstream interface, on the axis", LINES[2]),
    "vortex_centre": ("vortex pair", LINES[3]),
}
STYLES = [dict(linewidth=1.5), dict(linewidth=1.1, dashes=(4, 1.5)), dict(linewidth=1.0, dashes=(1, 1)), dict(linewidth=0.9, dashes=(6, 1, 1, 1))]


def half(course, time):
    """Schlieren over y > 0 of the snapshot nearest to a time, its box, and the middle of the helium; None if there is none."""
    nearest = int(np.argmin(np.abs(course.times - time)))
    if abs(course.times[nearest] - time) > 3:
        return None
    snapshot = open_snapshot(course.paths[nearest])
    values, _ = snapshot.layer("schlieren", None, 0.0)
    helium, _ = snapshot.layer("volume_fraction_helium", None, 0.0)
    if snapshot.lower[1] < 0:
        values, helium = values[values.shape[0] // 2:], helium[values.shape[0] // 2:]
    left, right, high = snapshot.lower[0], snapshot.upper[0], snapshot.upper[1]
    snapshot.close()
    x = left + (np.arange(values.shape[1]) + 0.5) * (right - left) / values.shape[1]
    there = x[helium.max(axis=0) > 0.3]
    return values, (left, right, 0.0, high), 0.5 * (there.min() + there.max())


def schlieren_sheet(courses, picture):
    """All times; the first run above the axis, the second (or the first, mirrored) below."""
    figure, panels = plt.subplots(2, 5, figsize=(12.0, 4.3), layout="constrained")
    for panel, time in zip(panels.flat, EXPERIMENT_TIMES):
        above = half(courses[0], time)
        below = half(courses[-1], time)
        panel.set_xticks([])
        panel.set_yticks([])
        panel.set_title(f"{time} µs", loc="left")
        for part, sign in ((above, 1), (below, -1)):
            if part is None:
                continue
            values, (left, right, low, high), middle = part
            panel.imshow(values if sign > 0 else values[::-1], extent=(left, right, low, high) if sign > 0 else (left, right, -high, -low),
                         origin="lower", cmap="gray", vmin=0, vmax=1, interpolation="antialiased")
        panel.set_xlim(middle - SHOWN / 2, middle + SHOWN / 2)
        panel.set_ylim(-high, high)
        panel.set_aspect("equal")
    return save(figure, picture)


def wave_diagram(courses, table, picture):
    """Positions over time, all and the first 250 us, with the speeds of the experiment as short straight lines."""
    figure, panels = plt.subplots(1, 2, figsize=(10.5, 5.4), layout="constrained")
    for panel, last in zip(panels, (250, 1000)):
        for name, (label, colour) in FEATURES.items():
            for n, course in enumerate(courses):
                position = course.position[name]
                shown = np.isfinite(position) & (course.times > -20) & (course.times < last)
                if name == "front_on_axis":
                    shown &= position < 201
                if name == "shock_by_the_wall":
                    shown &= course.times < 100  # then waves off the bubble lead there
                if name == "vortex_centre":
                    shown &= course.times > 100
                panel.plot(position[shown], course.times[shown], color=colour, label=label if n == 0 else None, **STYLES[n % len(STYLES)])
        for _, feature, window, span, experiment, _ in table:
            chosen = courses[0].chosen(feature, window, span) & (courses[0].times < last)
            if experiment is None or chosen.sum() < 2 or feature not in FEATURES:
                continue
            t, x = courses[0].times[chosen], courses[0].position[feature][chosen]
            ends = np.array([t.min(), t.max()])
            panel.plot(x.mean() - 1e-3 * experiment * (ends - t.mean()), ends, color="black", linewidth=4, alpha=0.22, solid_capstyle="butt")
        panel.set_xlabel("x [mm]")
        panel.set_ylabel("time after the shock met the bubble [µs]")
        panel.set_ylim(-20, last)
        panel.margins(x=0.02)
        panel.grid(alpha=0.25, linewidth=0.5)
    panels[1].plot([], [], color="black", linewidth=4, alpha=0.22, label="speed in the experiment")
    for n, course in enumerate(courses if len(courses) > 1 else []):
        panels[1].plot([], [], color="black", label=course.name.replace("_", " "), **STYLES[n % len(STYLES)])
    figure.legend(*panels[1].get_legend_handles_labels(), loc="outside lower center", ncol=3)
    return save(figure, picture)
