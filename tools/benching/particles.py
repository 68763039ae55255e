"""ns per particle and step by scene and bricks."""
import numpy as np

from style import plt, save
from tables import machine, markdown, ordered, read_lines


def bricks(line):
    return "chosen" if line["bricks"] == 0 else "eight"


def picture(folder, lines):
    """A group of bars for each scene, a bar for each way to cut the domain into bricks."""
    cases = ordered(line["title"] for line in lines)
    kinds = ordered(bricks(line) for line in lines)
    figure, panel = plt.subplots(figsize=(8.4, 4.0), layout="constrained")
    width = 0.8 / len(kinds)
    for k, kind in enumerate(kinds):
        chosen = [line for line in lines if bricks(line) == kind]
        x = [cases.index(line["title"]) + (k - 0.5 * (len(kinds) - 1)) * width for line in chosen]
        bars = panel.bar(x, [line["ns_per_particle_step"] for line in chosen], width * 0.92, label=f"bricks: {kind}")
        panel.bar_label(bars, fmt="%.0f", fontsize=7)
    panel.set_xticks(range(len(cases)), [case.replace(", ", "\n") for case in cases], fontsize=7)
    panel.set_ylabel("ns per particle and step")
    panel.set_ylim(0, 1.2 * np.nanmax([line["ns_per_particle_step"] for line in lines]))
    panel.legend()
    return save(figure, folder / "particles.png")


def report(folder):
    lines = read_lines(folder / "particles.csv")
    if not lines:
        return []
    rows = [[line["title"], f"{line['particles']:.0f}", bricks(line), f"{line['ns_per_particle_step']:.1f}",
             f"{line['ns_per_particle_step'] * line['multiply_add_gflop_s']:.0f}", f"{line['triad_gb_s']:.1f}",
             f"{line['multiply_add_gflop_s']:.1f}"] for line in lines]
    head = ["scene", "particles", "bricks", "ns per particle and step", "in peak FLOP", "triad [GB/s]", "multiply-add [GFLOP/s]"]
    text = ["# Speed of particles\n", machine(lines), "Processor time of whole steps (transfers, stresses, sorting, search for the "
            "time step and all) over the particles, eight per cell; the fastest of many windows of two steps; one core.\n",
            markdown(head, rows)]
    (folder / "particles.md").write_text("\n".join(text))
    return [folder / "particles.md", picture(folder, lines)]
