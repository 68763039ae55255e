"""The solid as a picture: particles seen from a direction, or cut by a plane.

The particles are painted far to near into a picture with a depth for each point; the slope of the depth gives the light, so that
craters, cracks and bulges show. That is fast for millions of particles and keeps true coordinates on the axes."""
import numpy as np

from snapshot_files import AXES, place_text
from style import colour_bar, colour_range, readable, save, time_text, titled, words, plt

BACKGROUND = 1.0
LARGEST_PICTURE = 1100  # points along its longer side


def mirrored(position, values, planes):
    """The particles with their mirror images. planes: {axis: place of the symmetry plane}."""
    for axis, place in planes.items():
        image = position.copy()
        image[:, axis] = 2 * place - image[:, axis]
        position = np.concatenate([position, image])
        values = np.concatenate([values, values])
    return position, values


def view_frame(direction):
    """Directions to the right, up and towards the eye of a picture seen from `direction`; the axes they are, if they are axes."""
    towards = np.asarray(direction, dtype=float)
    towards = towards / np.linalg.norm(towards)
    axis = int(np.argmax(np.abs(towards)))
    if abs(towards[axis]) > 1 - 1e-9:
        right_axis, up_axis = {0: (1, 2), 1: (0, 2), 2: (0, 1)}[axis]
        right, up = np.eye(3)[right_axis], np.eye(3)[up_axis]
        if np.dot(np.cross(right, up), towards) < 0:
            right = -right  # seen from the other side the picture is turned round, as it is for the eye
        return right, up, towards, (right_axis, up_axis)
    up = np.array([0.0, 0.0, 1.0]) if abs(towards[2]) < 0.99 else np.array([0.0, 1.0, 0.0])
    right = np.cross(up, towards)
    right /= np.linalg.norm(right)
    return right, np.cross(towards, right), towards, None


def paint(position, values, size, frame, bounds=None):
    """A picture of the particles. Gives values and depths [up, right] (not a number where there is nothing) and its extent."""
    right, up, towards = frame[:3]
    u, v, depth = position @ right, position @ up, position @ towards
    if bounds is None:
        bounds = (u.min() - size, u.max() + size, v.min() - size, v.max() + size)
    width, height = bounds[1] - bounds[0], bounds[3] - bounds[2]
    point = max(size / 4, max(width, height) / LARGEST_PICTURE)
    nx, ny = max(int(np.ceil(width / point)), 1), max(int(np.ceil(height / point)), 1)
    oblique = frame[3] is None
    span = max(int(round(size * (1.3 if oblique else 1.0) / point)), 1)
    order = np.argsort(depth, kind="stable")
    i = np.floor((u[order] - bounds[0]) / point - (span - 1) / 2 + 1e-6).astype(int)
    j = np.floor((v[order] - bounds[2]) / point - (span - 1) / 2 + 1e-6).astype(int)
    owner = np.full((ny, nx), -1)
    number = np.arange(len(order))
    for dj in range(span):
        for di in range(span):
            inside = (i + di >= 0) & (i + di < nx) & (j + dj >= 0) & (j + dj < ny)
            place = (j[inside] + dj) * nx + i[inside] + di
            flat = owner.reshape(-1)
            nearest = np.full(nx * ny, -1)
            nearest[place] = number[inside]  # of several, the last and so the nearest stays
            np.maximum(flat, nearest, out=flat)
    seen = owner >= 0
    picture = np.full((ny, nx), np.nan)
    depths = np.full((ny, nx), np.nan)
    picture[seen] = values[order][owner[seen]]
    depths[seen] = depth[order][owner[seen]]
    close_gaps([picture, depths], max(int(round(0.6 * size / point)), 1))
    return picture, depths, (bounds[0], bounds[0] + nx * point, bounds[2], bounds[2] + ny * point), point


def close_gaps(layers, radius):
    """Fills the narrow gaps that open between the particles of a stretched body (not wider than about a particle) with the mean of
    what lies around them; wider ones stay open."""
    seen = np.isfinite(layers[0])
    closed = ~window_any(~window_any(seen, radius), radius, outside=True)
    gaps = closed & ~seen
    if not gaps.any():
        return
    for layer in layers:
        layer[gaps] = blurred(layer, radius, everywhere=True)[gaps]


def window_any(mask, radius, outside=False):
    """True where the mask is true anywhere within the radius; outside: what it is beyond the border."""
    padded = np.pad(mask, radius, constant_values=outside)
    wide = np.zeros((padded.shape[0], mask.shape[1]), dtype=bool)
    for shift in range(2 * radius + 1):
        wide |= padded[:, shift:shift + mask.shape[1]]
    tall = np.zeros_like(mask)
    for shift in range(2 * radius + 1):
        tall |= wide[shift:shift + mask.shape[0]]
    return tall


def blurred(values, radius, everywhere=False):
    """Mean over a square window, leaving out what is not a number; there it stays so, unless it is wanted everywhere."""
    good = np.isfinite(values)
    total, count = np.where(good, values, 0.0), good.astype(float)
    for axis in (0, 1):
        total, count = window_sum(total, radius, axis), window_sum(count, radius, axis)
    return np.where(good | everywhere, total / np.maximum(count, 1), np.nan)


def window_sum(values, radius, axis):
    padding = [(0, 0), (0, 0)]
    padding[axis] = (radius + 1, radius)
    sums = np.cumsum(np.pad(values, padding), axis=axis)
    n = values.shape[axis]
    high = np.take(sums, np.arange(2 * radius + 1, 2 * radius + 1 + n), axis=axis)
    return high - np.take(sums, np.arange(n), axis=axis)


def light(depths, point, size):
    """Brightness 0..1 from the slope of the surface, and darker where it drops away."""
    radius = max(int(round(size / point)), 1)
    smooth = blurred(depths, radius)
    slope_up, slope_right = np.gradient(smooth, point)
    normal_length = np.sqrt(1 + slope_right ** 2 + slope_up ** 2)
    lamp = np.array([-0.45, 0.55, 0.75]) / np.linalg.norm([-0.45, 0.55, 0.75])
    diffuse = (-slope_right * lamp[0] - slope_up * lamp[1] + lamp[2]) / normal_length
    diffuse = np.clip(np.nan_to_num(diffuse, nan=lamp[2]), 0, 1)
    hollow = np.clip(np.nan_to_num(blurred(depths, 3 * radius) - smooth) / (3 * size), 0, 1)
    return np.clip(0.5 + 0.62 * diffuse, 0, 1.06) * (1 - 0.45 * hollow)


def coloured(picture, norm, colours, brightness=None):
    """The picture as red, green, blue, transparent where there is nothing."""
    image = plt.get_cmap(colours)(norm(np.nan_to_num(picture)))
    if brightness is not None:
        image[..., :3] = np.clip(image[..., :3] * brightness[..., None], 0, 1)
    image[..., 3] = np.isfinite(picture)
    return image


def side_name(direction):
    """'+z' of a direction along an axis, else its numbers."""
    axis = int(np.argmax(np.abs(direction)))
    if abs(direction[axis]) == np.abs(direction).sum():
        return ("+" if direction[axis] > 0 else "-") + AXES[axis]
    return "(" + ", ".join(f"{c:g}" for c in direction) + ")"


def draw_view(axes, solid, name, direction, mirror=None, wanted=None, log=None, bounds=None, scale=None):
    """Draws the solid seen from a direction; gives a mappable for the colour bar and the title of its scale.

    mirror: {axis: place of a symmetry plane}; wanted: range of the colours; scale: factor and unit of the numbers."""
    factor, unit = scale or readable(solid.field(name), solid.unit(name))
    position, values = mirrored(solid.position, factor * solid.field(name), mirror or {})
    frame = view_frame(direction)
    size = solid.size()
    picture, depths, extent, point = paint(position, values, size, frame, bounds or default_bounds(solid, frame, mirror))
    norm, colours = colour_range(name, picture, wanted, log)
    image = coloured(picture, norm, colours, light(depths, point, size))
    axes.imshow(image, extent=extent, origin="lower", interpolation="antialiased")
    axes.set_aspect("equal")
    label_axes(axes, frame, solid.length_unit)
    return plt.cm.ScalarMappable(norm, colours), titled(name, unit)


def draw_section(axes, solid, name, axis, place, mirror=None, wanted=None, log=None, bounds=None, scale=None):
    """Draws the particles at a plane across an axis, those nearest to it on top; x and z look towards the eye, y away from it."""
    factor, unit = scale or readable(solid.field(name), solid.unit(name))
    size = solid.size()
    position, values = mirrored(solid.position, factor * solid.field(name), mirror or {})
    distance = np.abs(position[:, axis] - place)
    near = distance <= 2 * size  # a stretched body has none nearer in places
    direction = np.eye(3)[axis] * (-1 if axis == 1 else 1)
    frame = view_frame(direction)
    bounds = bounds or default_bounds(solid, frame, mirror)
    if not near.any():
        axes.text(0.5, 0.5, "no particle here", ha="center", va="center", transform=axes.transAxes)
        return None, None
    position = position[near].copy()
    position[:, axis] = -direction[axis] * distance[near]
    picture, _, extent, _ = paint(position, values[near], 1.15 * size, frame, bounds)
    norm, colours = colour_range(name, picture, wanted, log)
    axes.imshow(coloured(picture, norm, colours), extent=extent, origin="lower", interpolation="antialiased")
    axes.set_aspect("equal")
    label_axes(axes, frame, solid.length_unit)
    return plt.cm.ScalarMappable(norm, colours), titled(name, unit)


def default_bounds(solid, frame, mirror):
    """The bulk of the solid with its mirror images, and a margin."""
    low, high = solid.extent()
    corners = np.array([[(low, high)[k >> d & 1][d] for d in range(3)] for k in range(8)])
    corners, _ = mirrored(corners, np.zeros(8), mirror or {})
    u, v = corners @ frame[0], corners @ frame[1]
    margin = 0.04 * max(np.ptp(u), np.ptp(v))
    return u.min() - margin, u.max() + margin, v.min() - margin, v.max() + margin


def label_axes(axes, frame, unit):
    if frame[3] is None:
        axes.set_axis_off()
        return
    suffix = "" if unit in ("-", "") else f" [{unit}]"
    axes.set_xlabel(AXES[frame[3][0]] + suffix)
    axes.set_ylabel(AXES[frame[3][1]] + suffix)
    if frame[0].sum() < 0:  # the axis runs to the left in this view
        axes.xaxis.set_major_formatter(lambda value, _: f"{-value:g}" if abs(value) > 1e-12 else "0")


def solid_picture(solid, name, path, direction=None, axis=None, place=None, mirror=None, wanted=None, log=None):
    """One view or one section, saved."""
    figure, axes = plt.subplots(figsize=(7.2, 5.4))
    if axis is None:
        mappable, title = draw_view(axes, solid, name, direction, mirror, wanted, log)
        what = f"seen from {side_name(direction)}"
    else:
        mappable, title = draw_section(axes, solid, name, axis, place, mirror, wanted, log)
        what = f"cut at {place_text(solid, axis, place)}"
    if mappable is not None:
        colour_bar(figure, mappable, axes, title)
    axes.set_title(f"{words(name)}, {what}, {time_text(solid.time, solid.time_unit)}", loc="left")
    return save(figure, path)
