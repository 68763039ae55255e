"""Errors over resolutions and schemes: a table, and for each problem a picture of error against wall time and against cells."""
import numpy as np

from style import plt, save
from tables import machine, markdown, ordered, read_lines

VARIABLES = ("density", "velocity", "pressure")


def order(coarse, fine, name):
    """Order of convergence between two lines."""
    error = [line["measures"].get(name, (np.nan,))[0] for line in (coarse, fine)]
    ratio = fine["cells_x"] / coarse["cells_x"]
    return np.log(error[0] / error[1]) / np.log(ratio) if min(error) > 0 and ratio > 1 else np.nan


def time_to(error, lines):
    """Wall time at which a scheme reaches an error of density, on the straight line through its two nearest runs in logarithms."""
    found = [(line["measures"]["density"][0], line["wall_s"]) for line in lines if "density" in line["measures"]]
    if len(found) < 2:
        return np.nan
    e, t = np.log(np.array(sorted(found))).T
    i = int(np.clip(np.searchsorted(e, np.log(error)), 1, len(e) - 1))
    return float(np.exp(t[i - 1] + (np.log(error) - e[i - 1]) * (t[i] - t[i - 1]) / (e[i] - e[i - 1])))


def summary(lines, yardstick="muscl+third_order+sensor"):
    """Table: wall time that each scheme takes to the error of density that the yardstick has on its finest mesh, over its time."""
    schemes = ordered(line["scheme"] for line in lines)
    if yardstick not in schemes:
        return ""
    rows, ratios = [], {scheme: [] for scheme in schemes}
    for case in ordered(line["case"] for line in lines):
        by_scheme = {s: [line for line in lines if line["case"] == case and line["scheme"] == s] for s in schemes}
        finest = by_scheme[yardstick][-1:]
        if not finest or "density" not in finest[0]["measures"]:
            continue
        for scheme in schemes:
            ratios[scheme].append(time_to(finest[0]["measures"]["density"][0], by_scheme[scheme]) / finest[0]["wall_s"])
        rows.append([case, *(f"{ratios[scheme][-1]:.2f}" for scheme in schemes)])
    rows.append(["median", *(f"{np.nanmedian(ratios[scheme]):.2f}" for scheme in schemes)])
    return markdown(["problem", *schemes], rows)


def picture(folder, title, case, lines):
    """Two panels: relative L1 error of density against wall time and against cells, a line for each scheme."""
    figure, panels = plt.subplots(1, 2, figsize=(8.4, 3.6), layout="constrained", sharey=True)
    for scheme in ordered(line["scheme"] for line in lines):
        chosen = [line for line in lines if line["scheme"] == scheme and "density" in line["measures"]]
        error = [line["measures"]["density"][0] for line in chosen]
        panels[0].plot([line["wall_s"] for line in chosen], error, "o-", markersize=3.5, label=scheme.replace("_", " "))
        panels[1].plot([line["cells_x"] for line in chosen], error, "o-", markersize=3.5)
    panels[0].set(xlabel="wall time [s]", ylabel="relative L1 error of density")
    panels[1].set(xlabel="cells along x")
    for panel in panels:
        panel.set(xscale="log", yscale="log")
        panel.grid(True, which="both", linewidth=0.3, alpha=0.5)
    panels[0].legend()
    figure.suptitle(title, fontsize=9.5)
    return save(figure, folder / f"accuracy_{case}.png")


def report(folder):
    lines = read_lines(folder / "accuracy.csv")
    if not lines:
        return []
    files, text = [], ["# Accuracy\n", machine(lines), "Relative L1 errors, sum|e|/sum|exact|; order of that of density.\n"]
    text += ["Wall time to the error of density that MUSCL with the third-order limiter has on its finest mesh, over its time:\n",
             summary(lines)]
    for case in ordered(line["case"] for line in lines):
        mine = [line for line in lines if line["case"] == case]
        rows = []
        for scheme in ordered(line["scheme"] for line in mine):
            before = None
            for line in (entry for entry in mine if entry["scheme"] == scheme):
                errors = [line["measures"].get(name, (np.nan,))[0] for name in VARIABLES]
                rate = order(before, line, "density") if before else np.nan
                rows.append([scheme, f"{line['cells_x']:.0f}", f"{line['steps']:.0f}", f"{line['wall_s']:.3g}",
                             f"{line['ns_per_cell_stage']:.1f}", *(f"{e:.3e}" for e in errors),
                             "" if np.isnan(rate) else f"{rate:.2f}"])
                before = line
        head = ["scheme", "cells", "steps", "wall [s]", "ns per cell and stage", *VARIABLES, "order"]
        text += [f"## {case}\n", mine[0]["title"] + "\n", markdown(head, rows)]
        files.append(picture(folder, mine[0]["title"], case, mine))
    (folder / "accuracy.md").write_text("\n".join(text))
    return [folder / "accuracy.md", *files]
