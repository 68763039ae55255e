"""The hard problems: what passes, by how much, and what had to be repaired."""
from matplotlib.colors import ListedColormap

from style import plt, save
from tables import machine, markdown, ordered, read_lines

REPAIRS = ("negative mass set to nil", "volume fraction clipped", "relaxation by bisection", "pressure lifted to its floor",
           "redone in first order")


def worst(line):
    """The measure nearest to or farthest above its bound, and all without reach of it left out."""
    with_bound = [(value / bound if bound else float(value > 0), name, value, bound)
                  for name, (value, bound) in line["measures"].items() if bound is not None]
    if not with_bound:
        return ""
    _, name, value, bound = max(with_bound)
    return f"{name} {value:.2e} of {bound:.0e}"


def repairs(line):
    return ", ".join(f"{line[name]:.0f} {name}" for name in REPAIRS if line.get(name, 0) > 0)


def picture(folder, lines, cases, columns):
    """Green for what passes, red for what does not, a figure for the cells redone or repaired."""
    verdict = [[float("nan")] * len(columns) for _ in cases]
    figure, panel = plt.subplots(figsize=(2.6 + 1.5 * len(columns), 1.2 + 0.22 * len(cases)), layout="constrained")
    for line in lines:
        row, column = cases.index(line["case"]), columns.index((line["scheme"], line["cfl"]))
        verdict[row][column] = float(line["verdict"] == "passes")
        count = sum(line.get(name, 0) for name in REPAIRS)
        panel.text(column, row, f"{count:.0f}", ha="center", va="center", fontsize=7)
    panel.imshow(verdict, cmap=ListedColormap(["#e3a49a", "#a9d3b2"]), vmin=0, vmax=1, aspect="auto", origin="upper")
    panel.set_xticks(range(len(columns)), [f"{scheme.replace('+', chr(10))}\nCFL {cfl:g}" for scheme, cfl in columns], fontsize=7)
    panel.set_yticks(range(len(cases)), cases, fontsize=8)
    panel.set_title("passes (green) and cells repaired or redone")
    return save(figure, folder / "stability.png")


def report(folder):
    lines = read_lines(folder / "stability.csv")
    if not lines:
        return []
    cases = ordered(line["case"] for line in lines)
    columns = ordered((line["scheme"], line["cfl"]) for line in lines)
    passed = sum(line["verdict"] == "passes" for line in lines)
    text = ["# Stability\n", f"{passed} of {len(lines)} runs pass.\n", machine(lines)]
    for case in cases:
        mine = [line for line in lines if line["case"] == case]
        rows = [[line["scheme"], f"{line['cfl']:g}", line["verdict"].rstrip("; "), worst(line), repairs(line) or "none",
                 f"{line['steps']:.0f}", f"{line['wall_s']:.2g}"] for line in mine]
        head = ["scheme", "CFL", "verdict", "nearest to its bound", "repairs", "steps", "wall [s]"]
        text += [f"## {case}\n", mine[0]["title"] + f", {mine[0]['cells_x']:.0f} cells along x\n", markdown(head, rows)]
    (folder / "stability.md").write_text("\n".join(text))
    return [folder / "stability.md", picture(folder, lines, cases, columns)]
