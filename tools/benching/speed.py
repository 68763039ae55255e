"""ns per cell and stage by scene, scheme and brick."""
import numpy as np

from style import plt, save
from tables import machine, markdown, ordered, read_lines


def picture(folder, lines):
    """A group of bars for each scene, a bar for each scheme and size of brick."""
    cases = ordered(line["title"] for line in lines)
    kinds = ordered((line["scheme"], place(line)) for line in lines)
    figure, panel = plt.subplots(figsize=(8.4, 4.0), layout="constrained")
    width = 0.8 / len(kinds)
    for k, kind in enumerate(kinds):
        chosen = [line for line in lines if (line["scheme"], place(line)) == kind]
        x = [cases.index(line["title"]) + (k - 0.5 * (len(kinds) - 1)) * width for line in chosen]
        bars = panel.bar(x, [line["ns_per_cell_stage"] for line in chosen], width * 0.92,
                         label=f"{kind[0].replace('_', ' ')}, {kind[1]}")
        panel.bar_label(bars, fmt="%.0f", fontsize=7)
    panel.set_xticks(range(len(cases)), [case.replace(", ", "\n") for case in cases], fontsize=8)
    panel.set_ylabel("ns per cell and stage")
    panel.set_ylim(0, 1.25 * np.nanmax([line["ns_per_cell_stage"] for line in lines]))
    panel.legend(ncols=2)
    return save(figure, folder / "speed.png")


def place(line):
    """Small or large bricks: which cells that is depends on the dimensions."""
    sides = sorted(SIDES[line["case"]])
    return "small bricks" if line["brick"] == sides[0] else "large bricks"


SIDES = {}


def report(folder):
    lines = read_lines(folder / "speed.csv")
    if not lines:
        return []
    for line in lines:
        SIDES.setdefault(line["case"], set()).add(line["brick"])
    rows = []
    for line in lines:
        dimensions = 3 if line["case"].endswith("3d") else 2
        cycles = line["ns_per_cell_stage"] * line["multiply_add_gflop_s"]
        rows.append([line["title"], line["scheme"], f"{line['cells']:.0f}^{dimensions}", f"{line['brick']:.0f}^{dimensions}",
                     f"{line['ns_per_cell_stage']:.1f}", f"{100 * line['bookkeeping_share']:.1f} %", f"{cycles:.0f}",
                     f"{line['triad_gb_s']:.1f}", f"{line['multiply_add_gflop_s']:.1f}"])
    head = ["scene", "scheme", "mesh", "brick", "ns per cell and stage", "ghosts and time step", "in peak FLOP", "triad [GB/s]",
            "multiply-add [GFLOP/s]"]
    text = ["# Speed\n", machine(lines), "Wall time of whole steps (ghost cells, boundaries, search for the time step and all) over "
            "three times the cells, the fastest of several windows; one core. *In peak FLOP*: the operations that the core could "
            "have done in that time, a figure that compares between machines.\n", markdown(head, rows)]
    (folder / "speed.md").write_text("\n".join(text))
    return [folder / "speed.md", picture(folder, lines)]
