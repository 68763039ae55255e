"""The tables that a run writes: gauges.csv, loads.csv, history.csv."""
import csv

import numpy as np


def read_columns(path):
    """Columns of a table by their heads without the unit; a last line that is cut off is left out."""
    with open(path, newline="") as file:
        heads, *rows = list(csv.reader(file))
    data = np.array([[float(value) for value in row] for row in rows if len(row) == len(heads)])
    return {head.split(" [")[0]: data[:, i] for i, head in enumerate(heads)}
