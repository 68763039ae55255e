"""Tables over time as curves: gauges.csv, history.csv."""
import fnmatch
import os
import re

import numpy as np

from snapshot_files import SnapshotError
from style import readable, save, titled, words, plt


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
        component = re.fullmatch(r"(.*)_([xyz])", self.quantity)
        if component:
            self.quantity = component.group(1)
            self.owner = ", ".join(part for part in (self.owner, component.group(2)) if part)


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
    groups = {}
    for k in chosen:
        groups.setdefault((columns[k].quantity, columns[k].unit), []).append(k)
    across = 1 if len(groups) == 1 else 2
    down = -(-len(groups) // across)
    figure, panels = plt.subplots(down, across, figsize=(5.2 * across, 0.6 + 2.6 * down), sharex=True, squeeze=False)
    time_factor, time_unit = readable(numbers[:, 0], columns[0].unit)
    for panel, ((quantity, unit), members) in zip(panels.flat, groups.items()):
        factor, unit = readable(numbers[:, members], unit)
        for k in members:
            panel.plot(time_factor * numbers[:, 0], factor * numbers[:, k], label=columns[k].owner or None, linewidth=1.1)
        panel.set_ylabel(titled(quantity, unit))
        panel.grid(alpha=0.25, linewidth=0.5)
        panel.margins(x=0.01)
        panel.set_title(words(quantity), loc="left")
        if any(columns[k].owner for k in members):
            panel.legend(ncol=1 if len(members) < 7 else 2, fontsize=7, frameon=True, framealpha=0.75, edgecolor="none")
    for panel in panels.flat[len(groups):]:
        panel.set_visible(False)
    for number in range(len(groups)):
        if number + across >= len(groups):
            panels.flat[number].tick_params(labelbottom=True)
            panels.flat[number].set_xlabel(titled(columns[0].name, time_unit))
    figure.tight_layout()
    return save(figure, picture)
