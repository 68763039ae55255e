"""Columns of several tables over one of their columns: the curves of material tests."""
import os

from curve_pictures import read_table
from snapshot_files import SnapshotError
from style import LINES, readable, save, titled, words, plt


def column_of(path, columns, name):
    """Index and sign of a column; '-stress_xx' is the column with its sign changed."""
    sign = -1 if name.startswith("-") else 1
    for k, column in enumerate(columns):
        if column.name == name.lstrip("-"):
            return k, sign
    raise SnapshotError(f"{path}: no column '{name.lstrip('-')}'; there are: {', '.join(c.name for c in columns)}")


def comparison_picture(paths, over, names, picture):
    """A panel for each name, a curve for each table."""
    tables = [(path, *read_table(path)) for path in paths]
    figure, panels = plt.subplots(1, len(names), figsize=(0.8 + 4.3 * len(names), 3.4), squeeze=False)
    for panel, name in zip(panels.flat, names):
        curves = []
        for path, columns, numbers in tables:
            x, x_sign = column_of(path, columns, over)
            y, y_sign = column_of(path, columns, name)
            curves.append((path, x_sign * numbers[:, x], y_sign * numbers[:, y], columns[x].unit, columns[y].unit))
        # one unit for all of them: that of the largest numbers
        x_factor, x_unit = readable([max(abs(v) for c in curves for v in c[1])], curves[0][3])
        y_factor, y_unit = readable([max(abs(v) for c in curves for v in c[2])], curves[0][4])
        for n, (path, x, y, _, _) in enumerate(curves):
            label = os.path.splitext(os.path.basename(path))[0].replace("_", " ")
            panel.plot(x_factor * x, y_factor * y, label=label if len(curves) > 1 else None, linewidth=1.3, color=LINES[n % len(LINES)])
        panel.set_xlabel(titled(words(over), x_unit))
        panel.set_ylabel(titled(words(name), y_unit))
        panel.grid(alpha=0.25, linewidth=0.5)
        panel.margins(x=0.02)
        if len(curves) > 1:
            panel.legend(fontsize=7, frameon=True, framealpha=0.75, edgecolor="none")
    figure.tight_layout()
    return save(figure, picture)
