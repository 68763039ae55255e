"""Reads the lines of flow_bench and writes Markdown tables."""
import csv


def read_lines(path):
    """The lines as dictionaries; measures as {name: (value, bound or None)}, numbers as numbers."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    for row in rows:
        for name, text in row.items():
            if name not in ("case", "title", "scheme", "verdict", "measures"):
                row[name] = number(text)
        row["measures"] = measures(row.get("measures") or "")
    return rows


def number(text):
    """Fortran's numbers; nan for what is none."""
    try:
        return float(text)
    except (TypeError, ValueError):
        return float("nan")


def measures(text):
    found = {}
    for item in filter(None, text.split("|")):
        name, _, value = item.partition("=")
        value, _, bound = value.partition("<")
        found[name] = (number(value), number(bound) if bound else None)
    return found


def markdown(head, rows):
    """A table; cells are strings."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def ordered(values):
    """Without repetition, in order of appearance."""
    return list(dict.fromkeys(values))


def machine(rows):
    """The calibration, in a sentence."""
    triad = max(row["triad_gb_s"] for row in rows)
    flops = max(row["multiply_add_gflop_s"] for row in rows)
    return (f"One core of this machine did {triad:.1f} GB/s (stream triad) and {flops:.1f} GFLOP/s (multiply-adds) at its best "
            "during these runs.\n")
