"""The flow as a picture: slices, schlieren, lines along x."""
import numpy as np

from snapshot_files import AXES, place_text
from solid_pictures import mirrored
from style import LogNorm, colour_bar, colour_range, readable, robust_top, save, time_text, titled, words, plt


def plane_axes(flow, axis):
    """The two directions in the plane, and the one across it."""
    if axis is None:
        axis = [d for d in range(3) if d not in flow.active][-1]
    first, second = [d for d in range(3) if d != axis]
    return first, second, axis


def unfolded(values, extent, first, second, mirror):
    """A plane with its mirror images. extent: (left, right, low, high); mirror: {axis: place}."""
    left, right, low, high = extent
    if first in mirror:
        at_low = abs(mirror[first] - left) <= abs(mirror[first] - right)
        values = np.concatenate([values[:, ::-1], values] if at_low else [values, values[:, ::-1]], axis=1)
        left, right = (2 * left - right, right) if at_low else (left, 2 * right - left)
    if second in mirror:
        at_low = abs(mirror[second] - low) <= abs(mirror[second] - high)
        values = np.concatenate([values[::-1], values] if at_low else [values, values[::-1]], axis=0)
        low, high = (2 * low - high, high) if at_low else (low, 2 * high - low)
    return values, (left, right, low, high)


def draw_slice(axes, flow, name, axis=None, position=0.0, mirror=None, wanted=None, log=None, solid=None, interfaces=True):
    """Draws one slice; gives a mappable for the colour bar, the title of its scale, and the place of the slice."""
    mirror = mirror or {}
    first, second, across = plane_axes(flow, axis)
    plane, place = flow.layer(name, axis, position)
    box = (flow.lower[first], flow.upper[first], flow.lower[second], flow.upper[second])
    factor, unit = readable([robust_top(name, plane)], flow.unit(name))
    values, extent = unfolded(factor * plane, box, first, second, mirror)
    norm, colours = colour_range(name, values, wanted, log)
    if isinstance(norm, LogNorm):
        values = np.maximum(values, norm.vmin)
    axes.imshow(values, extent=extent, origin="lower", norm=norm, cmap=colours, interpolation="antialiased")
    if interfaces and name != "schlieren" and not name.startswith("volume_fraction"):
        for fraction in [f for f in flow.data if f.startswith("volume_fraction")][:-1]:
            share, _ = flow.layer(fraction, axis, position)
            if share.min() < 0.5 < share.max():
                share, _ = unfolded(share, box, first, second, mirror)
                axes.contour(*cell_centres(share, extent), share, levels=[0.5], colors="white", linewidths=0.7, alpha=0.8)
    if solid is not None:
        draw_outline(axes, solid, across, place if across in flow.active else None, first, second, mirror,
                     min(flow.spacing[first], flow.spacing[second]))
    elif "cell_type" in flow.data:
        draw_closed_cells(axes, flow, axis, position, box, first, second, mirror)
    axes.set_xlim(extent[0], extent[1])
    axes.set_ylim(extent[2], extent[3])
    axes.set_aspect("equal")
    for setter, d in ((axes.set_xlabel, first), (axes.set_ylabel, second)):
        setter(AXES[d] + ("" if flow.length_unit in ("-", "") else f" [{flow.length_unit}]"))
    return plt.cm.ScalarMappable(norm, colours), titled(name, unit), place


def cell_centres(values, extent):
    ny, nx = values.shape
    dx, dy = (extent[1] - extent[0]) / nx, (extent[3] - extent[2]) / ny
    return extent[0] + (np.arange(nx) + 0.5) * dx, extent[2] + (np.arange(ny) + 0.5) * dy


def draw_outline(axes, solid, across, place, first, second, mirror, cell):
    """The particles near the plane in grey, with a line round them. Each covers half a cell, so that a sound body has no gaps.

    place: of the plane; None: all particles, in a scene that has no cells across it."""
    if solid.n == 0:
        return
    size = solid.size()
    points, _ = mirrored(solid.position, solid.position[:, 0], mirror)
    near = points if place is None else points[np.abs(points[:, across] - place) <= max(0.6 * cell, size)]
    if len(near) == 0:
        return
    point = max(size, cell / 3)
    left, low = near[:, first].min() - 2 * point, near[:, second].min() - 2 * point
    nx = int(np.ceil((near[:, first].max() + 2 * point - left) / point))
    ny = int(np.ceil((near[:, second].max() + 2 * point - low) / point))
    if nx * ny > 25_000_000:
        return
    mask = np.zeros((ny, nx))
    mask[((near[:, second] - low) / point).astype(int), ((near[:, first] - left) / point).astype(int)] = 1
    extent = (left, left + nx * point, low, low + ny * point)
    grey = np.zeros((ny, nx, 4))
    grey[..., :3] = 0.72
    grey[..., 3] = mask
    axes.imshow(grey, extent=extent, origin="lower", interpolation="nearest", zorder=2)
    axes.contour(*cell_centres(mask, extent), mask, levels=[0.5], colors="#303030", linewidths=0.6, zorder=3)


def draw_closed_cells(axes, flow, axis, position, box, first, second, mirror):
    """Cells that hold solid, in grey, where there is no file of the particles."""
    kind, _ = flow.layer("cell_type", axis, position)
    kind, extent = unfolded(kind, box, first, second, mirror)
    grey = np.full(kind.shape + (4,), 0.72)
    grey[..., 3] = kind > 0.5
    axes.imshow(grey, extent=extent, origin="lower", zorder=2)


def slice_title(flow, name, axis, place):
    where = "" if axis is None else ", " + place_text(flow, axis, place)
    return f"{words(name)}{where}, {time_text(flow.time, flow.time_unit)}"


def slice_picture(flow, name, path, axis=None, position=0.0, mirror=None, wanted=None, log=None, solid=None):
    """One slice, saved."""
    first, second, _ = plane_axes(flow, axis)
    shape = (flow.upper - flow.lower)[[first, second]] * [2 if d in (mirror or {}) else 1 for d in (first, second)]
    width = 7.2
    figure, axes = plt.subplots(figsize=(width, float(np.clip(0.84 * width * shape[1] / shape[0], 1.8, 7.5))))
    mappable, title, place = draw_slice(axes, flow, name, axis, position, mirror, wanted, log, solid)
    if name != "schlieren":
        colour_bar(figure, mappable, axes, title)
    axes.set_title(slice_title(flow, name, axis, place), loc="left")
    return save(figure, path)


def lines_picture(flows, names, path):
    """Fields of a scene of one dimension along x, a panel for each field and a line for each time."""
    figure, panels = plt.subplots(len(names), 1, figsize=(7.2, 1.1 + 1.9 * len(names)), sharex=True, squeeze=False)
    for panel, name in zip(panels[:, 0], names):
        lines = [flow.line(name) for flow in flows]
        factor, unit = readable(np.concatenate([values for _, values in lines]), flows[0].unit(name))
        for number, (flow, (x, values)) in enumerate(zip(flows, lines)):
            shade = 0.15 + 0.75 * number / max(len(flows) - 1, 1)
            panel.plot(x, factor * values, color=plt.get_cmap("viridis_r")(shade), label=time_text(flow.time, flow.time_unit))
        panel.set_ylabel(titled(name, unit).replace(" [", "\n["))
        panel.margins(x=0)
        panel.grid(alpha=0.25, linewidth=0.5)
    flow = flows[-1]
    panels[-1, 0].set_xlabel(AXES[flow.active[0]] + ("" if flow.length_unit in ("-", "") else f" [{flow.length_unit}]"))
    if len(flows) > 1:
        panels[0, 0].legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncol=min(len(flows), 5))
    else:
        panels[0, 0].set_title(time_text(flow.time, flow.time_unit), loc="left")
    return save(figure, path)
