"""Tables over time as curves: gauges.csv, history.csv."""
import fnmatch
import os
import re

import numpy as np

from snapshot_files import SnapshotError
from style import LINES, readable, save, titled, words, plt


class Column:
    """One column: 'flow.mass.air [kg]' is the quantity mass of 'flow air'; 'centre.velocity_x [m/s]' the velocity of 'centre'."""

    def __init__(self, heading, is_history):
        match = re.fullmatch(r"\s*(.*?)\s*(?:\[([^\]]*)\])?\s*", heading)
        self.name, self.unit = match.group(1), match.group(2) or "-"
        if is_history:
            parts = self.name.split(".")
            self.quantity = parts[1] if len(parts) > 1 else parts[0]
            rest = [parts[0]] + parts[2:] if len(parts) > 1 else []
            self.owner = " ".join(rest)
            if parts[0] == "balance":
                self.quantity, self.owner = re.sub(r"(_[xyz])?$", r"_balance\1", self.quantity, count=1), ""
        else:
            self.owner, _, self.quantity = self.name.rpartition(".")
        self.owner_alone, self.component = self.owner, ""
        component = re.fullmatch(r"(.*)_([xyz])", self.quantity)
        if component:
            self.quantity, self.component = component.groups()
            self.owner = ", ".join(part for part in (self.owner, self.component) if part)


def read_table(path):
    """Columns and numbers [row, column] of a table."""
    try:
        with open(path, encoding="utf-8") as file:
            headings = file.readline().rstrip("\n").split(",")
            rows = [line for line in file if line.count(",") == len(headings) - 1]
    except OSError as error:
        raise SnapshotError(f"{path}: {error.strerror}") from None
    is_history = "history" in os.path.basename(path)
    columns = [Column(heading, is_history) for heading in headings]
    numbers = np.array([[float(number) for number in row.split(",")] for row in rows]) if rows else np.empty((0, len(headings)))
    return columns, numbers


def curves_picture(path, picture, pattern=None):
    """All columns (or those whose names fit the pattern) over the first one, a panel for each quantity."""
    columns, numbers = read_table(path)
    if len(numbers) == 0:
        raise SnapshotError(f"{path}: there are no rows")
    chosen = [k for k in range(1, len(columns)) if pattern is None or fnmatch.fnmatch(columns[k].name, pattern)]
    if not chosen:
        raise SnapshotError(f"{path}: no column fits '{pattern}'; there are: {', '.join(c.name for c in columns[1:])}")
    groups = grouped(columns, numbers, chosen, pattern is not None)
    across = min(len(groups), 1 if len(groups) == 1 else 2 if len(groups) <= 6 else 3)
    down = -(-len(groups) // across)
    figure, panels = plt.subplots(down, across, figsize=((6.5, 9.6, 12.6)[across - 1], 0.5 + 2.5 * down), sharex=True, squeeze=False)
    time_factor, time_unit = readable(numbers[:, 0], columns[0].unit)
    for panel, (title, members) in zip(panels.flat, groups.items()):
        draw_group(panel, title, [columns[k] for k in members], time_factor * numbers[:, 0], numbers[:, members])
    for panel in panels.flat[len(groups):]:
        panel.set_visible(False)
    for number in range(max(len(groups) - across, 0), len(groups)):
        panels.flat[number].tick_params(labelbottom=True)
        panels.flat[number].set_xlabel(titled(columns[0].name, time_unit))
    figure.tight_layout()
    return save(figure, picture)


def grouped(columns, numbers, chosen, all_of_them):
    """Columns of a panel, by its title. Unless all are asked for, those that stay zero are left out, and components that are nothing
    beside the others of their panel."""
    on_solid = {column.owner.partition(",")[0] for column in columns if column.quantity == "displacement"}
    groups = {}
    for k in chosen:
        column = columns[k]
        title = words(column.quantity)
        if column.quantity == "velocity" and column.owner.partition(",")[0] in on_solid:
            title = "velocity of the solid"
        if column.quantity == "dt":
            title = "time step"
        groups.setdefault((title, column.unit), []).append(k)
    if not all_of_them:
        for key, members in list(groups.items()):
            sizes = [np.max(np.abs(numbers[:, k]), initial=0.0, where=np.isfinite(numbers[:, k])) for k in members]
            kept = [k for k, size in zip(members, sizes) if size > 0 and (not columns[k].component or size > 0.02 * max(sizes))]
            still = all(np.all(numbers[:, k] == numbers[0, k]) for k in kept)
            if not kept or (columns[kept[0]].unit == "-" and still):
                del groups[key]
            else:
                groups[key] = kept
    return {title: members for (title, _), members in groups.items()} if len({t for t, _ in groups}) == len(groups) else groups


def draw_group(panel, title, columns, time, values):
    """One panel: a colour for each gauge or material, a dash for each component; what hardly changes is drawn as its change."""
    change = values - values[0]
    largest = np.nanmax(np.abs(values), initial=0.0)
    small = len(values) > 1 and largest > 0 and 0 < np.nanmax(np.abs(change), initial=0.0) < 1e-6 * largest
    factor, unit = (1.0, columns[0].unit) if small else readable(values, columns[0].unit)
    owners = list(dict.fromkeys(column.owner_alone for column in columns))
    components = sorted({column.component for column in columns})
    for n, column in enumerate(columns):
        panel.plot(time, factor * (change if small else values)[:, n], label=column.owner or None, linewidth=1.2,
                   color=LINES[owners.index(column.owner_alone) % len(LINES)] if len(owners) > 1 else LINES[n % len(LINES)],
                   linestyle=("-", "--", ":")[components.index(column.component) % 3] if len(owners) > 1 else "-")
    title = title if isinstance(title, str) else title[0]
    panel.set_title(title + (f": change from {values[0, 0]:.6g}" if small and len(columns) == 1 else ": change" if small else ""), loc="left")
    panel.set_ylabel("" if unit in ("-", "") else titled("", unit).strip())
    panel.grid(alpha=0.25, linewidth=0.5)
    panel.margins(x=0.01)
    if any(column.owner for column in columns):
        panel.legend(ncol=1 if len(columns) < 7 else 2, fontsize=7, frameon=True, framealpha=0.75, edgecolor="none")
