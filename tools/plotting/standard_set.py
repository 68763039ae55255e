"""The pictures that every run gets, by what the run has written."""
import glob
import os
import re

import numpy as np

from comparison_pictures import comparison_picture
from curve_pictures import curves_picture, read_table
from flow_pictures import draw_slice, lines_picture, plane_axes, slice_picture
from snapshot_files import AXES, SnapshotError, open_snapshot, place_text
from solid_pictures import default_bounds, draw_section, draw_view, side_name, view_frame
from style import colour_bar, colour_range, readable, save, time_text, words, plt


class Run:
    """The files of an output folder, and what its deck says of symmetry."""

    def __init__(self, folder):
        self.folder = folder
        self.flow = sorted_snapshots(folder, "snapshot_flow_")
        self.solid = sorted_snapshots(folder, "snapshot_solid_")
        self.peaks = os.path.join(folder, "peaks.vtkhdf")
        self.pictures = os.path.join(folder, "pictures")
        self.deck = read_deck(os.path.join(folder, "deck.nml"))
        if not (self.flow or self.solid or glob.glob(os.path.join(folder, "*.csv"))):
            raise SnapshotError(f"{folder}: there are no snapshots and no tables here; is it the output folder of a run?")

    def mirror_axes(self):
        """Directions whose low face is a symmetry plane."""
        return [d for d in range(3) if self.deck.get(f"{AXES[d]}_low") == "symmetry"
                and self.deck.get(f"{AXES[d]}_high") != "symmetry"]

    def path(self, name):
        return os.path.join(self.pictures, name + ".png")

    def solid_of(self, flow):
        """The particles at the time of a flow snapshot, if they were written."""
        path = flow.path.replace("snapshot_flow_", "snapshot_solid_")
        return open_snapshot(path) if os.path.exists(path) and path != flow.path else None


def sorted_snapshots(folder, prefix):
    """In the order of the list beside them, which leaves out what a restart has struck off; else of their steps."""
    kind = prefix.split("_")[1]
    listed = os.path.join(folder, f"{kind}.vtkhdf.series")
    if os.path.exists(listed):
        with open(listed, encoding="utf-8") as file:
            names = re.findall(r'"name": "([^"]*)"', file.read())
        paths = [os.path.join(folder, name) for name in names]
        return [path for path in paths if os.path.exists(path)]
    paths = glob.glob(os.path.join(folder, prefix + "*.vtkhdf"))
    return sorted(paths, key=lambda path: int(re.search(r"_(\d+)\.vtkhdf$", path).group(1)))


def read_deck(path):
    """Keys and values of the effective deck that are plain words, lower case."""
    if not os.path.exists(path):
        return {}
    with open(path, encoding="utf-8") as file:
        return {key.lower(): value.lower() for key, value in re.findall(r"^\s*(\w+)\s*=\s*'([^']*)'", file.read(), re.M)}


def chosen(paths, n):
    """n of the paths, evenly spread, the last always, the first only if there are few."""
    if len(paths) <= n:
        return paths
    return [paths[int(round(k))] for k in np.linspace(len(paths) / n - 1 if len(paths) > n else 0, len(paths) - 1, n)]


def flow_planes(run, flow, solid):
    """Planes through the scene worth seeing: of symmetry where there are any, else through the middle. At most two."""
    if len(flow.active) < 3:
        return [(None, 0.0)]
    symmetric = [d for d in run.mirror_axes()]
    thin = thin_axis(solid) if solid is not None and solid.n else None
    order = [d for d in (1, 0, 2) if d != thin]
    return [(d, flow.lower[d] if d in symmetric else 0.5 * (flow.lower[d] + flow.upper[d])) for d in order][:2]


def thin_axis(solid):
    """The direction across a plate; None for a body that is no plate."""
    low, high = solid.extent()
    size = np.sort(high - low)
    return int(np.argmin(high - low)) if len(solid.active) == 3 and size[0] < 0.4 * size[1] else None


def long_axis(solid):
    """The direction along a rod; None for a body that is no rod."""
    low, high = solid.extent()
    size = np.sort(high - low)
    return int(np.argmax(high - low)) if len(solid.active) == 3 and size[2] > 1.7 * size[1] else None


def symmetry_planes(run, snapshot, among=(0, 1, 2)):
    return {d: snapshot.lower[d] for d in run.mirror_axes() if d in among and d in snapshot.active}


def flow_panels(run, name, n_times, picture):
    """A field at several times (side by side) on each plane (one below the other)."""
    flows = [open_snapshot(path) for path in chosen(run.flow, n_times)]
    solids = [run.solid_of(flow) for flow in flows]
    planes = flow_planes(run, flows[0], solids[0])
    first, second, _ = plane_axes(flows[0], planes[0][0])
    mirror = {} if len(flows[0].active) < 3 else None
    shape = (flows[0].upper - flows[0].lower)[[first, second]]
    wide = shape[0] > 1.6 * shape[1]  # long scenes are stacked
    rows, columns = (len(planes) * len(flows), 1) if wide else (len(planes), len(flows))
    width = 7.6 if wide else 3.6 * columns
    figure, panels = plt.subplots(rows, columns, squeeze=False, layout="constrained",
                                  figsize=(width, 0.5 + rows * (0.74 * width / columns * shape[1] / shape[0] + (0.4 if wide else 0.6))))
    for p, (axis, position) in enumerate(planes):
        for t, (flow, solid) in enumerate(zip(flows, solids)):
            panel = panels[p * len(flows) + t, 0] if wide else panels[p, t]
            mappable, title, place = draw_slice(panel, flow, name, axis, position, mirror, solid=solid)
            where = "" if axis is None else ", " + place_text(flow, axis, place)
            panel.set_title(time_text(flow.time, flow.time_unit) + where, loc="left")
            if name != "schlieren":
                colour_bar(figure, mappable, panel, title)
            if wide and t < len(flows) - 1:
                panel.set_xlabel("")
                panel.tick_params(labelbottom=False)
            if not wide and t > 0:
                panel.set_ylabel("")
                panel.tick_params(labelleft=False)
    figure.suptitle(f"{words(name)}   {flows[0].title}", fontsize=10, x=0.01, ha="left")
    return save(figure, picture)


def flow_pictures(run):
    last = open_snapshot(run.flow[-1])
    if len(last.active) == 1:
        flows = [open_snapshot(path) for path in chosen(run.flow, 5)]
        fields = [name for name in ("density", f"velocity_{AXES[last.active[0]]}", "pressure") if name in last.names()]
        fields += [name for name in last.data if name.startswith("volume_fraction")][:1]
        yield lines_picture(flows, fields, run.path("flow_lines"))
        return
    n = 3 if len(last.active) == 3 else 4
    yield flow_panels(run, "pressure", n, run.path("flow_pressure"))
    yield flow_panels(run, "density", n, run.path("flow_density"))
    if len(last.active) == 2:
        yield flow_panels(run, "schlieren", n, run.path("flow_schlieren"))
    solid = run.solid_of(last)
    axis, position = flow_planes(run, last, solid)[0]
    mirror = symmetry_planes(run, last)
    if solid is not None and solid.n:
        mirror.pop(thin_axis(solid), None)
    yield slice_picture(last, "schlieren", run.path("flow_last_schlieren"), axis, position, mirror, solid=solid)


def peak_pictures(run):
    peaks = open_snapshot(run.peaks)
    if len(peaks.active) == 1:
        yield lines_picture([peaks], ["peak_overpressure", "impulse", "arrival_time"], run.path("peaks"))
        return
    solid = open_snapshot(run.solid[0]) if run.solid else None
    axis, position = flow_planes(run, peaks, solid)[0]
    first, second, _ = plane_axes(peaks, axis)
    slope = (peaks.upper - peaks.lower)[second] / (peaks.upper - peaks.lower)[first]
    rows, columns, size = (2, 1, (7.6, 1.0 + 12.0 * slope)) if slope < 0.6 else (1, 2, (10.5, 0.8 + 3.7 * min(slope, 2.0)))
    figure, panels = plt.subplots(rows, columns, figsize=size, layout="constrained")
    for panel, name in zip(panels, ("peak_overpressure", "impulse")):
        mappable, title, place = draw_slice(panel, peaks, name, axis, position, solid=solid)
        colour_bar(figure, mappable, panel, title)
        where = "" if axis is None else ", " + place_text(peaks, axis, place)
        panel.set_title(words(name) + where, loc="left")
    yield save(figure, run.path("peaks"))


def solid_field(solid):
    """What tells most of the solid's state: damage, else plastic strain, else the stress."""
    for name in ("damage", "plastic_strain"):
        if name in solid.data and np.max(solid.field(name), initial=0.0) > 0:
            return name
    return "von_mises"


def solid_pictures(run):
    last = open_snapshot(run.solid[-1])
    if last.n == 0 or len(last.active) < 2:
        return
    name = solid_field(last)
    mirror = symmetry_planes(run, last)
    if len(last.active) == 2:
        yield solid_panels(run, [last], name, [("view", [0, 0, 1])], mirror, run.path(f"solid_{name}"))
        return
    thin, long = thin_axis(last), long_axis(last)
    kept = thin if thin is not None else long if long is not None else 2  # a wall that the body hits may be a symmetry plane: no image there
    mirror.pop(kept, None)
    across = [d for d in (1, 0, 2) if d != kept][0]
    place = last.lower[across] + 0.5 * last.size() if across in mirror else float(np.median(last.position[:, across]))
    if thin is not None:
        views = [("view", -np.eye(3)[thin]), ("view", np.eye(3)[thin]), ("section", (across, place))]
    else:
        views = [("view", -np.eye(3)[1 if kept != 1 else 0]), ("section", (across, place))]
    for field in [name] + [field for field in ("pressure", "speed") if field != name]:
        yield solid_panels(run, [last], field, views, mirror, run.path(f"solid_{field}"))
    several = [open_snapshot(path) for path in chosen(run.solid, 5)]
    if len(several) > 1:
        yield solid_panels(run, several, name, views[-1:], mirror, run.path(f"solid_{name}_in_time"))


def solid_panels(run, solids, name, views, mirror, picture):
    """Views and sections of each state. Wide panels stand one below the other, others in a row."""
    bounds = []
    for kind, what in views:
        direction = what if kind == "view" else np.eye(3)[what[0]] * (-1 if what[0] == 1 else 1)
        boxes = np.array([default_bounds(solid, view_frame(direction), mirror) for solid in solids])
        bounds.append((boxes[:, 0].min(), boxes[:, 1].max(), boxes[:, 2].min(), boxes[:, 3].max()))
    panels = [(solid, n) for solid in solids for n in range(len(views))]
    flat = [(solid, n) for solid, n in panels if slope_of(bounds[n]) < 0.4]
    row = [panel for panel in panels if panel not in flat]
    rows = ([row] if row else []) + [[panel] for panel in flat]
    heights = [min(max(slope_of(bounds[n]) for _, n in row) * 8.2 / len(row), 6.5) + 0.55 for row in rows]
    width = min(10.0, 1.6 + max(sum((height - 0.55) / slope_of(bounds[n]) + 0.7 for _, n in row) for row, height in zip(rows, heights)))
    scale = wanted = None
    if len(solids) > 1:  # one scale for all times
        values = np.concatenate([solid.field(name) for solid in solids])
        scale = readable(values, solids[-1].unit(name))
        norm, _ = colour_range(name, scale[0] * values)
        wanted = (norm.vmin, norm.vmax)
    figure = plt.figure(figsize=(max(width, 5.0), sum(heights) + 0.4), layout="constrained")
    parts = figure.subfigures(len(rows), 1, height_ratios=heights, squeeze=False)[:, 0]
    for row, part in zip(rows, parts):
        axes = part.subplots(1, len(row), squeeze=False)[0]
        for panel, (solid, n) in zip(axes, row):
            kind, what = views[n]
            if kind == "view":
                mappable, title = draw_view(panel, solid, name, what, mirror, wanted, bounds=bounds[n], scale=scale)
                caption = f"seen from {side_name(what)}, "
            else:
                mappable, title = draw_section(panel, solid, name, *what, mirror, wanted, bounds=bounds[n], scale=scale)
                caption = f"cut at {place_text(solid, *what)}, "
            if len(row) > 3:
                caption = ""
            panel.set_title(caption + time_text(solid.time, solid.time_unit), loc="left")
        if mappable is not None:
            colour_bar(part, mappable, list(axes), title, fraction=0.03)
    figure.suptitle(f"{words(name)}   {solids[-1].title}", fontsize=10, x=0.01, ha="left")
    return save(figure, picture)


def slope_of(bounds):
    """Height over width."""
    return (bounds[3] - bounds[2]) / (bounds[1] - bounds[0])


def table_pictures(run):
    for table in ("gauges", "history"):
        path = os.path.join(run.folder, table + ".csv")
        if os.path.exists(path) and len(read_table(path)[1]) > 1:
            yield curves_picture(path, run.path(table))


def material_pictures(run):
    """The curves of material tests."""
    for path in sorted(glob.glob(os.path.join(run.folder, "*.csv"))):
        if {"strain_xx", "stress_xx"} <= {column.name for column in read_table(path)[0]}:
            name = os.path.splitext(os.path.basename(path))[0]
            yield comparison_picture([path], "strain_xx", ["stress_xx", "pressure", "von_mises"], run.path(name))


def draw_standard(folder):
    """Draws everything; a picture that fails does not stop the others. Gives paths and messages of failures."""
    run = Run(folder)
    os.makedirs(run.pictures, exist_ok=True)
    paths, failures = [], []
    parts = [(run.flow, flow_pictures), (os.path.exists(run.peaks), peak_pictures), (run.solid, solid_pictures), (True, table_pictures),
             (True, material_pictures)]
    for there, part in parts:
        if not there:
            continue
        try:
            for path in part(run):
                paths.append(path)
        except SnapshotError as error:
            failures.append(str(error))
    return paths, failures
