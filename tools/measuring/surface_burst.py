"""Incident blast wave of a surface burst against the curves of Kingery & Bulmash: peak overpressure, impulse of the positive phase
and time of arrival at the gauges of one or more runs in one spherical direction, whose charge is a sphere of twice the mass.

Source of the curves: Kingery & Bulmash, Airblast parameters from TNT spherical air burst and hemispherical surface burst,
ARBRL-TR-02555 (1984), in the metric form of Swisdak, Simplified Kingery airblast calculations (1994). log10 y is a polynomial of
U = k0 + k1 log10 Z; Z is the distance over the cube root of the mass of the hemisphere."""
import csv
import pathlib
import re

import numpy as np

from style import LINES, plt, save

# quantity: for each range of Z [m/kg^(1/3)] its ends, k0, k1 and the coefficients; kPa, kPa ms/kg^(1/3), ms/kg^(1/3)
CURVES = {
    "pressure": [
        (0.0674, 40, -0.214362789151, 1.35034249993, [
            2.78076916577, -1.6958988741, -0.154159376846, 0.514060730593, 0.0988534365274,
            -0.293912623038, -0.0268112345019, 0.109097496421, 0.00162846756311, -0.0214631030242,
            0.0001456723382, 0.00167847752266]),
    ],
    "impulse": [
        (0.0674, 0.955, 2.06761908721, 3.0760329666, [
            2.52455620925, -0.502992763686, 0.171335645235, 0.0450176963051, -0.0118964626402]),
        (0.955, 40, -1.94708846747, 2.40697745406, [
            1.67281645863, -0.384519026965, -0.0260816706301, 0.00595798753822, 0.014544526107,
            -0.00663289334734, -0.00284189327204, 0.0013644816227]),
    ],
    "arrival": [
        (0.0674, 40, -0.202425716178, 1.37784223635, [
            -0.0591634288046, 1.35706496258, 0.052492798645, -0.196563954086, -0.0601770052288,
            0.0696360270891, 0.0215297490092, -0.0161658930785, -0.00232531970294, 0.00147752067524]),
    ],
    "reflected pressure": [
        (0.0674, 40, -0.240657322658, 1.36637719229, [
            3.40283217581, -2.21030870597, -0.218536586295, 0.895319589372, 0.24989009775,
            -0.569249436807, -0.11791682383, 0.224131161411, 0.0245620259375, -0.0455116002694,
            -0.0019093073888, 0.00361471193389]),
    ],
    "reflected impulse": [
        (0.0674, 40, -0.246208804814, 1.33422049854, [
            2.70588058103, -0.949516092853, 0.112136118689, -0.0250659183287]),
    ],
}

QUANTITIES = {"pressure": ("peak overpressure", "kPa"), "impulse": ("impulse of the positive phase", "kPa ms/kg$^{1/3}$"),
              "arrival": ("time of arrival", "ms/kg$^{1/3}$")}
PICTURE = pathlib.Path("docs/pictures/surface_burst.png")


def curve(quantity, z):
    """Kingery & Bulmash at a scaled distance."""
    for low, high, k0, k1, coefficients in CURVES[quantity]:
        if low <= z <= high:
            return 10 ** np.polynomial.polynomial.polyval(k0 + k1 * np.log10(z), coefficients)
    return np.nan


def hemisphere(folder):
    """Mass of the hemisphere [kg]: half of the sphere of the deck."""
    text = (folder / "deck.nml").read_text()
    return 0.5 * float(re.search(r"&charge\b.*?\bmass\s*=\s*([0-9.eE+-]+)", text, re.DOTALL).group(1))


def points(folder):
    """Scaled distance, peak overpressure, impulse and time of arrival of each gauge, whose name is its distance: '0.50 m'. The wave
    arrives with a tenth of its peak; the positive phase ends where the overpressure is negative for the first time after it."""
    with open(folder / "gauges.csv", newline="") as file:
        reader = csv.reader(file)
        heads = next(reader)
        data = np.array([[float(v) for v in row] for row in reader])
    root = hemisphere(folder) ** (1 / 3)
    found = []
    for column, head in enumerate(heads):
        match = re.match(r"([0-9.]+) m\.overpressure", head)
        if not match:
            continue
        over, impulse = data[:, column], data[:, column + 1]
        top = int(np.argmax(over))
        if not 0 < top < len(over) - 1:  # the wave has not passed it
            continue
        arrived = int(np.argmax(over > 0.1 * over[top]))
        negative = np.nonzero(over[top:] < 0)[0]
        end = top + negative[0] if len(negative) else len(over) - 1
        found.append((float(match.group(1)) / root, over[top] / 1e3, impulse[end] / root, data[arrived, 0] * 1e3 / root))
    return np.array(found)


def table(folder, found):
    """Prints the points of one run beside the curves, as a table in Markdown."""
    print(f"{folder}\n")
    print("| Z [m/kg^(1/3)] | peak overpressure [kPa] | curve | | impulse [kPa ms/kg^(1/3)] | curve | "
          "| arrival [ms/kg^(1/3)] | curve | |")
    print("|" + "---|" * 10)
    for row in found:
        cells = [f"{row[0]:.3g}"]
        for quantity, value in zip(QUANTITIES, row[1:]):
            reference = curve(quantity, row[0])
            cells += [f"{value:.4g}", f"{reference:.4g}", f"{100 * (value / reference - 1):+.1f} %"]
        print("| " + " | ".join(cells) + " |")
    print()


def picture(runs):
    """Curves, and the points of all runs."""
    z = np.logspace(np.log10(0.3), np.log10(40), 400)
    figure, panels = plt.subplots(1, 3, figsize=(11, 3.6), constrained_layout=True)
    for panel, quantity, column in zip(panels, QUANTITIES, (1, 2, 3)):
        panel.loglog(z, [curve(quantity, v) for v in z], color="#6b6b6b", label="Kingery & Bulmash")
        for i, (folder, found) in enumerate(runs):
            panel.loglog(found[:, 0], found[:, column], "osv^D"[i % 5], ms=4.5 - 0.5 * min(i, 4), color=LINES[i % len(LINES)],
                         label=folder.name)
        panel.set_title(QUANTITIES[quantity][0])
        panel.set_xlabel("Z [m/kg$^{1/3}$]")
        panel.set_ylabel(f"[{QUANTITIES[quantity][1]}]")
        panel.grid(True, which="both", alpha=0.15)
    panels[0].legend()
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    save(figure, PICTURE)


def measure_all(folders):
    """Tables of all runs, and one picture of them."""
    runs = [(folder, points(folder)) for folder in folders]
    for folder, found in runs:
        table(folder, found)
    picture(runs)
    print(f"picture: {PICTURE}")
