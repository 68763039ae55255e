"""Fragments of one or more runs: a table, and one picture of where they are and of the distributions of mass, speed and size."""
import csv
import re

import numpy as np

from snapshot_files import open_snapshot
from style import LINES, LogLocator, NullFormatter, plt, readable, save

LOOSE = "#dedbd4"  # particles of no fragment
STEP = re.compile(r"fragments_(\d+)\.csv")


def read_fragments(path):
    """Columns of a table by name, without their units, and the units; numbers as arrays."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    names = [re.match(r"(\w+)(?: \[(.*)\])?$", head).groups() for head in rows[0]]
    units = {name: unit or "" for name, unit in names}
    columns = {}
    for i, (name, _) in enumerate(names):
        values = [row[i] for row in rows[1:]]
        columns[name] = np.array(values) if name in ("body", "material") else np.array([float(v) for v in values])
    columns["speed"] = np.sqrt(sum(columns[f"velocity_{d}"] ** 2 for d in "xyz"))
    units["speed"] = units["velocity_x"]
    return columns, units


def last_table(folder):
    """The newest table of a run."""
    tables = sorted((int(STEP.match(path.name).group(1)), path) for path in folder.glob("fragments_*.csv")
                    if STEP.match(path.name))
    if not tables:
        raise SystemExit(f"error: {folder} has no fragments_*.csv (the deck must have &output fragments = .true.)")
    return tables[-1][1]


def table(folder, path, columns, units):
    """Prints the sums and the largest fragments of one run."""
    mass = columns["mass"]
    print(f"{path}: {len(mass)} fragments, {mass.sum():.5g} {units['mass']} in all")
    if not len(mass):
        return
    half = np.searchsorted(np.cumsum(mass), 0.5 * mass.sum()) + 1
    print(f"  half of that is in the {half} largest; median mass {np.median(mass):.4g} {units['mass']}, "
          f"{int((columns['particles'] == 1).sum())} of a single particle")
    print(f"  mean speed by mass {np.average(columns['speed'], weights=mass):.4g} {units['speed']}, "
          f"fastest {columns['speed'].max():.4g} {units['speed']}, kinetic energy {columns['kinetic_energy'].sum():.4g} "
          f"{units['kinetic_energy']}\n")
    print(f"| fragment | body | material | particles | mass [{units['mass']}] | diameter [{units['diameter']}] "
          f"| speed [{units['speed']}] | kinetic energy [{units['kinetic_energy']}] |")
    print("|" + "---|" * 8)
    for i in range(min(10, len(mass))):
        print(f"| {i + 1} | {columns['body'][i]} | {columns['material'][i]} | {columns['particles'][i]:.0f} | {mass[i]:.4g} "
              f"| {columns['diameter'][i]:.4g} | {columns['speed'][i]:.4g} | {columns['kinetic_energy'][i]:.4g} |")
    print()


def draw_map(panel, path, title):
    """Particles along the shortest extent of the scene, each fragment in a colour of its own; says if there is a snapshot."""
    panel.set_title(title)
    name = path.with_name(path.name.replace("fragments_", "snapshot_solid_")).with_suffix(".vtkhdf")
    if not name.exists():
        panel.set_axis_off()
        return
    snapshot = open_snapshot(name)
    x = np.asarray(snapshot.position)
    number = np.asarray(snapshot.field("fragment")).astype(int)
    across = int(np.argmin(np.ptp(x, axis=0)))
    a, b = [d for d in range(3) if d != across]
    hue = np.random.default_rng(0).permutation(max(number.max(), 1))
    colours = plt.get_cmap("turbo")((hue[np.maximum(number - 1, 0)] + 0.5) / len(hue))
    colours[number == 0] = matplotlib_colour(LOOSE)
    factor, unit = readable(x, snapshot.length_unit)
    order = np.argsort(x[:, across], kind="stable")
    panel.scatter(factor * x[order, a], factor * x[order, b], c=colours[order], s=(260 * snapshot.size() / np.ptp(x, axis=0).max()) ** 2,
                  marker="s", lw=0, rasterized=True)
    panel.set_aspect("equal")
    panel.set_xlabel(f"{'xyz'[a]} [{unit}]")
    panel.set_ylabel(f"{'xyz'[b]} [{unit}]")
    snapshot.close()


def matplotlib_colour(name):
    """RGBA of a colour."""
    return plt.matplotlib.colors.to_rgba(name)


def distribution(panel, values, label, colour):
    """Number of fragments of at least a value."""
    ordered = np.sort(values[values > 0])[::-1]
    panel.loglog(ordered, np.arange(1, len(ordered) + 1), drawstyle="steps-pre", color=colour, label=label)


def measure_all(folders):
    """Tables of all runs and one picture of them, in the pictures of the first."""
    runs = []
    for folder in folders:
        path = last_table(folder)
        columns, units = read_fragments(path)
        table(folder, path, columns, units)
        runs.append((folder, path, columns, units))
    figure = plt.figure(figsize=(3.7 * max(3, len(runs)), 7.0), constrained_layout=True)
    upper, lower = figure.subfigures(2, 1, height_ratios=(1.25, 1))
    for panel, (folder, path, columns, units) in zip(np.ravel(upper.subplots(1, len(runs))), runs):
        draw_map(panel, path, f"{folder.name.replace('_', ' ')}: {len(columns['mass'])} fragments")
    panels = lower.subplots(1, 3)
    for panel, (name, title) in zip(panels, (("mass", "mass"), ("speed", "speed"), ("diameter", "equivalent diameter"))):
        for i, (folder, path, columns, units) in enumerate(runs):
            distribution(panel, columns[name], folder.name.replace("_", " "), LINES[i % len(LINES)])
        panel.set_xlabel(f"{title} [{units[name]}]")
        panel.set_ylabel("fragments of at least that")
        if np.ptp(np.log10(panel.get_xlim())) < 2:
            panel.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
            panel.xaxis.set_major_formatter("{x:g}")
        panel.xaxis.set_minor_formatter(NullFormatter())
        panel.grid(True, which="both", alpha=0.15)
    panels[0].legend()
    picture = folders[0] / "pictures" / "fragments.png"
    picture.parent.mkdir(parents=True, exist_ok=True)
    save(figure, picture)
    print(f"picture: {picture}")
