"""Internal blast in the flat box of four rooms: arrival and peaks at the side wall of the blast room, named by the paths that their
waves may have taken; largest overpressure in each room; mean overpressure of the rooms against what the explosive's energy makes in a
closed volume; displacement of the roof; damage by room. Pictures: histories of all runs, and of each run the pressure in the middle
of the height and the damage.

A path is a straight line from an image of the charge in the walls. A peak belongs to a path if the mean speed along it is between
SPEEDS: shocks are faster than sound, 340 m/s, and in the products of the explosive much faster."""
import itertools
import re

import numpy as np

from run_tables import read_columns
from snapshot_files import open_snapshot
from solid_pictures import draw_section, draw_view
from style import COLOURS, LINES, LogNorm, Normalize, colour_bar, plt, save, time_text

HALF, HEIGHT, WALL = 1.35, 0.8, 0.1  # m: half the width of a room, clear height, thickness of walls and roof
ROOMS = {"blast room": (0, 0), "side room": (1, 0), "other side room": (0, 1), "diagonal room": (1, 1)}
WAVES = (
    ("side wall: free wave, with roof and floor once", HALF),
    ("roof and floor, twice", np.hypot(HALF, 2 * HEIGHT)),
    ("neighbouring walls", np.hypot(HALF, 2 * HALF)),
    ("neighbouring walls, with roof and floor twice", np.sqrt(HALF ** 2 + (2 * HALF) ** 2 + (2 * HEIGHT) ** 2)),
    ("opposite wall", 3 * HALF),
)
SPEEDS = (450.0, 1100.0)  # m/s
FIRST = {"test": 0.987, "Ni et al. 2022": 0.938}  # MPa, the first peak
AMBIENT = 101325.0  # Pa
GAMMA = 1.4  # of the air
FELT = 5e3  # Pa: overpressure that counts as an arrival
STEP = 1e-5  # s, of the histories looked at


def number(deck, group, key):
    """A key of the first group of that name with it, in the effective deck; nought if there is none."""
    for text in re.findall(rf"&{group}\b(.*?)^\s*/", deck, re.DOTALL | re.MULTILINE):
        found = re.search(rf"\b{key}\s*=\s*([0-9.eE+-]+)", text)
        if found and float(found.group(1)) != 0:
            return float(found.group(1))
    return 0.0


def peaks(times, pressure):
    """Local maxima over 0.1 ms that stand out by 5 % of the largest: times and values."""
    grid = np.arange(times[0], times[-1], STEP)
    curve = np.interp(grid, times, pressure)
    near, before, found = 10, 40, []
    for i in range(near, len(curve) - near):
        if curve[i] >= curve[i - near:i + near + 1].max() and curve[i] - curve[max(i - before, 0):i].min() > 0.05 * curve.max():
            found.append((grid[i], curve[i]))
    return found


def named_peaks(found):
    """Each path with the first peak that is left and can have come by it, or none."""
    left = list(found)
    for name, way in WAVES:
        fitting = [k for k, (time, _) in enumerate(left) if SPEEDS[0] <= way / time <= SPEEDS[1]]
        if fitting:
            yield name, way, left[fitting[0]]
            left = left[fitting[0] + 1:]
        else:
            yield name, way, None


def print_side_wall(times, columns):
    """Arrival and peaks at the centre of the side wall."""
    pressure = columns["side wall.overpressure"]
    felt = np.nonzero(pressure > FELT)[0]
    if not len(felt):
        return
    print(f"  side wall: the wave arrives at {1e3 * times[felt[0]]:.2f} ms")
    first = True
    for name, way, peak in named_peaks(peaks(times, pressure)):
        line = f"    {name:48s} {way:.2f} m: "
        if peak is None:
            print(line + "none")
            continue
        line += f"{peak[1] / 1e6:.3f} MPa at {1e3 * peak[0]:.2f} ms, {way / peak[0]:.0f} m/s"
        if first:
            line += "".join(f", {100 * (peak[1] / 1e6 / value - 1):+.1f} % of {source}" for source, value in FIRST.items())
        print(line)
        first = False


def print_rooms(times, columns):
    """Largest overpressure of each room and its ratio to that at the side wall."""
    top = np.nanmax(columns["side wall.overpressure"])
    for name, pressure in columns.items():
        if name.endswith(".overpressure") and " room " in name:
            k = np.nanargmax(pressure)
            felt = np.nonzero(pressure > FELT)[0]
            came = f", arrival at {1e3 * times[felt[0]]:.2f} ms" if len(felt) else ""
            print(f"  {name.split('.')[0]:26s} {pressure[k] / 1e6:.4f} MPa at {1e3 * times[k]:.2f} ms, "
                  f"{pressure[k] / top:.3f} of the side wall's{came}")


def room_means(flow):
    """Mean overpressure of the gas in each room."""
    total = {name: [0.0, 0.0] for name in ROOMS}
    for row, box in enumerate(flow.box):
        part = slice(flow.offset[row], flow.offset[row + 1])
        size = (box[1::2] - box[::2] + 1)[::-1]
        pressure = np.asarray(flow.data["pressure"][part], dtype=float).reshape(size)
        kind = np.asarray(flow.data["cell_type"][part]).reshape(size)
        z, y, x = (flow.lower[d] + (np.arange(box[2 * d], box[2 * d + 1] + 1) + 0.5) * flow.spacing[d] for d in (2, 1, 0))
        for name, (i, j) in ROOMS.items():
            low_x, low_y = i * (2 * HALF + WALL), j * (2 * HALF + WALL)
            inside = (kind == 0) & (z < HEIGHT)[:, None, None] & ((y > low_y) & (y < low_y + 2 * HALF))[None, :, None] \
                & ((x > low_x) & (x < low_x + 2 * HALF))[None, None, :]
            total[name][0] += (pressure[inside] - AMBIENT).sum()
            total[name][1] += inside.sum()
    return {name: value / max(count, 1) for name, (value, count) in total.items()}


def print_means(folder):
    """Mean overpressure of the rooms at the times of the snapshots, and (gamma - 1) E/V."""
    deck = (folder / "deck.nml").read_text()
    mass = number(deck, "charge", "mass")
    detonation = mass * number(deck, "material", "energy_per_volume") / 1630.0
    extra = mass * number(deck, "material", "afterburn_energy")
    volume = (2 * HALF) ** 2 * HEIGHT
    for name, size in (("the blast room", volume), ("all rooms", 4 * volume)):
        print(f"  (gamma - 1) E/V in {name}: {(GAMMA - 1) * detonation / size / 1e3:.1f} kPa"
              + (f", with afterburn {(GAMMA - 1) * (detonation + extra) / size / 1e3:.1f} kPa" if extra else ""))
    for path in sorted(folder.glob("snapshot_flow_*.vtkhdf")):
        flow = open_snapshot(path)
        means = room_means(flow)
        rooms = ", ".join(f"{name} {value / 1e3:.1f}" for name, value in means.items())
        print(f"  {1e3 * flow.time:6.2f} ms, mean overpressure [kPa]: {rooms}, all rooms {np.mean(list(means.values())) / 1e3:.1f}")
        flow.close()


def print_solid(folder, times, columns):
    """Largest displacements, and the failed part of roof and walls of each room."""
    for name, curve in columns.items():
        if ".displacement_" not in name or not np.isfinite(curve).any():
            continue
        k = np.nanargmax(np.abs(curve))
        if abs(curve[k]) > 1e-4:
            print(f"  {name:44s} largest {1e3 * curve[k]:.2f} mm at {1e3 * times[k]:.2f} ms, last {1e3 * curve[-1]:.2f} mm")
    files = sorted(folder.glob("snapshot_solid_*.vtkhdf"))
    if not files:
        return
    start, last = open_snapshot(files[0]), open_snapshot(files[-1])
    if "concrete" not in last.materials:  # rigid walls
        return
    order = np.argsort(start.field("id"))
    place = start.position[order][np.searchsorted(start.field("id")[order], last.field("id"))]
    damage, concrete = last.field("damage"), last.field("material") == last.materials.index("concrete") + 1
    roof = place[:, 2] > HEIGHT
    of_blast_room = np.all(place[:, :2] < 2 * HALF + WALL, axis=1)  # with its walls
    for name, room in ROOMS.items():
        low = np.array(room) * (2 * HALF + WALL) - WALL
        here = concrete & np.all((place[:, :2] > low) & (place[:, :2] < low + 2 * HALF + 2 * WALL), axis=1)
        here &= of_blast_room if name == "blast room" else ~of_blast_room
        print(f"  {name}, failed concrete at {1e3 * last.time:.2f} ms: roof {100 * np.mean(damage[here & roof] >= 1):.2f} %, "
              f"walls {100 * np.mean(damage[here & ~roof] >= 1):.2f} %")
    centre = np.hypot(place[:, 0] - HALF, place[:, 1] - HALF) < HALF / 2
    for name, part in (("over a disc of half its width in the middle", centre), ("elsewhere", of_blast_room & ~centre)):
        whole, cracked = broken_share(place, damage >= 1, concrete & roof & part)
        print(f"  roof of the blast room, {name}: failed through its thickness {100 * whole:.1f} %, in some depth {100 * cracked:.1f} %")
    joint = concrete & (np.abs(place[:, 0]) < WALL) & (place[:, 2] > HEIGHT - WALL) & (place[:, 1] > 0) & (place[:, 1] < 2 * HALF)
    along = np.floor(place[joint, 1] / WALL).astype(int)
    share = np.bincount(along, weights=damage[joint] >= 1) > 0
    print(f"  inner corner of roof and outer wall: failed somewhere across over {100 * share.mean():.0f} % of its length, "
          f"{100 * np.mean(damage[joint] >= 1):.0f} % of the concrete there")


def broken_share(place, failed, roof):
    """Part of the columns of particles of a piece of the roof that have all failed, and part of those in which some have."""
    layers = np.unique(np.round(place[roof, 2], 6))
    pitch = np.diff(layers).max()
    column = np.floor(place[roof, :2] / pitch + 1e-6).astype(int)
    _, number_of = np.unique(column, axis=0, return_inverse=True)
    sound = np.bincount(number_of.ravel(), weights=~failed[roof])
    broken = np.bincount(number_of.ravel(), weights=failed[roof])
    return np.mean(sound == 0), np.mean(broken > 0)


def picture_histories(folders):
    """Overpressure of the rooms over time, all runs in one picture."""
    panels = ("side wall", "side room middle", "side room wall", "diagonal room wall")
    figure, axes = plt.subplots(2, 2, figsize=(9, 5.4), sharex=True, constrained_layout=True)
    for panel, gauge in zip(axes.flat, panels):
        for colour, folder in zip(itertools.cycle(LINES), folders):
            columns = read_columns(folder / "gauges.csv")
            times = columns["time"]
            if gauge + ".overpressure" in columns:
                curve = columns[gauge + ".overpressure"] / 1e3
                panel.plot(1e3 * times, curve, color=colour, lw=1, label=folder.name.replace("_", " "))
        panel.set_title(gauge)
        panel.set_ylabel("overpressure [kPa]")
        panel.grid(alpha=0.2)
    for panel in axes[1]:
        panel.set_xlabel("time [ms]")
    axes[0, 0].legend()
    axes[0, 0].axhline(1e3 * FIRST["test"], color="#6b6b6b", lw=0.8, ls=":")
    print("picture:", save(figure, folders[0] / "pictures" / "histories.png"))


def picture_flow(folder):
    """Pressure and speed in the middle of the height at the times of the snapshots; white: edge of the products."""
    flows = [open_snapshot(path) for path in sorted(folder.glob("snapshot_flow_*.vtkhdf"))]
    flows = [flow for flow in flows if flow.time > 0.5e-3][:6]
    if len(flows) < 2:
        return
    for name, factor, unit, norm in (("pressure", 1e-3, "kPa", LogNorm(70, 500)), ("speed", 1, "m/s", Normalize(0, 250))):
        figure, axes = plt.subplots(2, 3, figsize=(9.5, 6.2), constrained_layout=True, sharex=True, sharey=True)
        for panel, flow in zip(axes.flat, flows):
            values, _ = flow.layer(name, 2, HEIGHT / 2)
            solid = flow.layer("cell_type", 2, HEIGHT / 2)[0] > 0.5
            products, _ = flow.layer("volume_fraction_tnt", 2, HEIGHT / 2)
            box = (flow.lower[0], flow.upper[0], flow.lower[1], flow.upper[1])
            shown = np.ma.masked_where(solid, np.maximum(factor * values, norm.vmin))
            image = panel.imshow(shown, extent=box, norm=norm, cmap=COLOURS[name])
            panel.set_facecolor("#8a8a8a")
            panel.contour(np.where(solid, 0, products), levels=[0.5], extent=box, colors="white", linewidths=0.7)
            panel.set_title(time_text(flow.time, flow.time_unit), loc="left")
        for panel in axes.flat[len(flows):]:
            panel.set_axis_off()
        figure.colorbar(image, ax=axes, shrink=0.7, label=f"{name} [{unit}]")
        figure.supxlabel("x [m]")
        figure.supylabel("y [m]")
        print("picture:", save(figure, folder / "pictures" / f"{name}.png"))


def picture_damage(folder):
    """Damage at the end: roof from above and from below, sections through the blast room."""
    files = sorted(folder.glob("snapshot_solid_*.vtkhdf"))
    if not files or "concrete" not in open_snapshot(files[-1]).materials:
        return
    solid = open_snapshot(files[-1])
    figure, axes = plt.subplots(2, 2, figsize=(9, 6.2), constrained_layout=True, height_ratios=(4, 1))
    for panel, direction, title in ((axes[0, 0], (0, 0, 1), "from above"), (axes[0, 1], (0, 0, -1), "from below")):
        mappable, label = draw_view(panel, solid, "damage", np.array(direction, dtype=float), wanted=(0, 1))
        panel.set_title(f"{title}, {time_text(solid.time, solid.time_unit)}", loc="left")
    colour_bar(figure, mappable, axes[0, 1], label)
    for panel, axis in ((axes[1, 0], 1), (axes[1, 1], 0)):
        draw_section(panel, solid, "damage", axis, HALF, wanted=(0, 1))
        panel.set_title(f"{'xyz'[axis]} = {HALF} m", loc="left")
    print("picture:", save(figure, folder / "pictures" / "damage.png"))


def measure_all(folders):
    """Figures of each run, and the histories of all."""
    for folder in folders:
        (folder / "pictures").mkdir(exist_ok=True)
        columns = read_columns(folder / "gauges.csv")
        times = columns["time"]
        print(f"{folder}: until {1e3 * times[-1]:.2f} ms")
        print_side_wall(times, columns)
        print_rooms(times, columns)
        print_means(folder)
        print_solid(folder, times, columns)
        picture_flow(folder)
        picture_damage(folder)
    picture_histories(folders)
