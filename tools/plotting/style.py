"""How all pictures look: fonts, colours, axis titles, ranges."""
import re

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402  (the backend comes first)
from matplotlib.colors import LinearSegmentedColormap, LogNorm, Normalize  # noqa: E402
from matplotlib.ticker import LogLocator, NullFormatter  # noqa: E402

DAMAGE = LinearSegmentedColormap.from_list(
    "damage", ["#e4e2dd", "#e3d3b3", "#e0a458", "#c8553d", "#7c1d2b", "#2b0a17"])
COLOURS = {
    "pressure": "inferno", "peak_overpressure": "inferno", "impulse": "inferno", "density": "viridis",
    "arrival_time": "viridis_r", "sound_speed": "cividis", "speed": "magma", "mach": "magma", "schlieren": "gray",
    "damage": DAMAGE, "plastic_strain": DAMAGE, "von_mises": "cividis", "material": "tab10", "body": "tab20",
}
SIGNED = ("velocity_x", "velocity_y", "velocity_z")
LINES = ["#1f4e79", "#c8553d", "#3f8f5f", "#8e5ea2", "#d19a2a", "#4f9fb8", "#7c1d2b", "#6b6b6b"]

plt.rcParams.update({
    "font.family": "DejaVu Sans", "font.size": 9, "axes.titlesize": 9.5, "axes.labelsize": 9, "legend.fontsize": 8,
    "legend.frameon": False, "axes.spines.top": False, "axes.spines.right": False, "axes.linewidth": 0.8,
    "axes.prop_cycle": matplotlib.cycler(color=LINES), "lines.linewidth": 1.4, "figure.dpi": 100, "savefig.dpi": 160,
    "image.interpolation": "nearest", "image.origin": "lower", "axes.formatter.useoffset": False,
    "axes.formatter.limits": (-3, 4),
})


def words(name):
    """A field's name as a person writes it."""
    if name == "mach":
        return "Mach number"
    if name == "schlieren":
        return "numerical schlieren"
    if name == "cell_type":
        return "cell type"
    match = re.fullmatch(r"(.*)_([xyz])", name)
    if match:
        return f"{words(match.group(1))} along {match.group(2)}"
    return name.replace("volume_fraction_", "volume fraction of ").replace("von_mises", "von Mises stress").replace("_", " ")


def titled(name, unit):
    """Words and unit, as on an axis."""
    return words(name) if unit in ("-", "") else f"{words(name)} [{unit.replace('^2', '²').replace('^3', '³')}]"


PREFIX = {"Pa": [(1e9, "GPa"), (1e6, "MPa"), (1e3, "kPa")], "s": [(1.0, "s"), (1e-3, "ms"), (1e-6, "µs")],
          "Pa s": [(1e6, "MPa s"), (1e3, "kPa s")], "J": [(1e9, "GJ"), (1e6, "MJ"), (1e3, "kJ")],
          "m": [(1.0, "m"), (1e-3, "mm")]}


def readable(values, unit, only=None):
    """Factor and unit in which the largest of the values is a handy number: 2.1e7 Pa becomes 21 MPa."""
    if unit not in PREFIX or (only and unit not in only):
        return 1.0, unit
    finite = np.abs(np.asarray(values, dtype=float))
    finite = finite[np.isfinite(finite)]
    largest = finite.max() if finite.size else 0.0
    for scale, name in PREFIX[unit]:
        if largest >= scale * (1 if scale >= 1 else 0.999):
            return 1.0 / scale, name
    if unit in ("s", "m") and largest > 0:
        scale, name = PREFIX[unit][-1]
        return 1.0 / scale, name
    return 1.0, unit


def time_text(time, unit):
    """'t = 0.25 ms'."""
    factor, unit = readable([time], unit)
    return f"t = {time * factor:.4g}" + ("" if unit in ("-", "") else f" {unit}")


def robust_top(name, values):
    """The largest value that the colours need to reach: a few cells inside a charge must not take the whole scale."""
    finite = np.asarray(values, dtype=float)
    finite = finite[np.isfinite(finite)]
    share = {"peak_overpressure": 98.5, "impulse": 98.5, "pressure": 99.95, "speed": 99.95, "von_mises": 99.95, "mach": 99.95}
    if finite.size == 0:
        return 0.0
    return float(np.percentile(finite, share[name])) if name in share and finite.size > 1000 else float(finite.max())


def colour_range(name, values, wanted=None, log=None):
    """A norm and a colour map for these values. wanted: (low, high) asked for; log: True, False or None (to be chosen)."""
    finite = np.asarray(values)[np.isfinite(values)]
    colours = COLOURS.get(name, "viridis")
    if name.startswith("volume_fraction"):
        colours = "Blues"
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    if finite.size:
        high = max(robust_top(name, finite), low)
    if name.startswith("volume_fraction") or name in ("damage", "schlieren"):
        low, high = 0.0, 1.0
    if name in SIGNED or (low < 0 < high and name == "pressure" and -low > 0.05 * high):
        high = max(abs(float(np.percentile(finite, 0.1))), abs(float(np.percentile(finite, 99.9))), 1e-30) if finite.size else 1.0
        low = -high
        colours = "RdBu_r"
    if name == "material" or name == "body":
        low, high = 0.5, (10.5 if name == "material" else 20.5)
    if wanted:
        low, high = wanted
    if log is None:
        log = name in ("pressure", "peak_overpressure", "impulse") and low >= 0 and high > 30 * max(low, high * 1e-9)
    if log and high > 0:
        if not wanted:
            low = max(low, high * 1e-4)
        if low > 0 and high > low:
            return LogNorm(low, high), colours
    if high <= low:
        high = low + (abs(low) * 1e-3 or 1.0)
    return Normalize(low, high), colours


def colour_bar(figure, mappable, axes, title, **placing):
    """A slim bar beside the axes, with plain numbers on it."""
    bar = figure.colorbar(mappable, ax=axes, **{"pad": 0.02, "fraction": 0.046, "aspect": 26, **placing})
    bar.set_label(title)
    bar.outline.set_linewidth(0.5)
    bar.ax.tick_params(labelsize=8)
    if isinstance(mappable.norm, LogNorm):
        decades = np.log10(mappable.norm.vmax / mappable.norm.vmin)
        bar.ax.yaxis.set_major_locator(LogLocator(subs=(1.0,) if decades > 2.5 else (1.0, 2.0, 5.0)))
        bar.ax.yaxis.set_minor_locator(LogLocator(subs=np.arange(2, 10)))
        bar.ax.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
        bar.ax.yaxis.set_minor_formatter(NullFormatter())
    return bar


def save(figure, path):
    cropped = "tight" if figure.get_layout_engine() is None else None  # a layout engine has used the paper well
    figure.savefig(path, bbox_inches=cropped, facecolor="white")
    plt.close(figure)
    return path
