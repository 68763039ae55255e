"""Centre column of the building: deflection of its middle, load on its front, damage along it, lift of the plate. Figures of each run
and one picture. Deflection: displacement of the middle less the mean of foot and head, along the blast; residual: mean over the last
third of the run. Test: 12.5 and 6.3 mm, as generally reported."""
import numpy as np

from run_tables import read_columns
from snapshot_files import open_snapshot
from style import LINES, plt, save

PEAK, RESIDUAL = 12.5, 6.3  # mm
FRONT = 0.0445 * 0.9345  # m2, of the half that is computed
WIDTH = 0.089  # m
PLATES = ("plate at the front", "plate behind the column", "plate inside")


def deflection(gauges):
    """Time [ms], deflection and displacement of the middle [mm]."""
    middle, foot, head = (gauges[f"column {place}.displacement_x"] for place in ("middle", "foot", "head"))
    return 1e3 * gauges["time"], 1e3 * (middle - 0.5 * (foot + head)), 1e3 * middle


def failed_parts(folder):
    """Time [ms] of the last snapshot and failed part [%] of the concrete at the foot, in the middle and at the head, each over one
    width, and of the plate within half a metre."""
    first, last = (open_snapshot(sorted(folder.glob("snapshot_solid_*.vtkhdf"))[i]) for i in (0, -1))
    order = np.argsort(first.field("id"))
    start, body, material = first.position[order], first.field("body")[order], first.field("material")[order]
    now = np.searchsorted(first.field("id")[order], last.field("id"))
    failed = np.zeros(len(start))
    failed[now] = last.field("damage") >= 1
    z, concrete = start[:, 2], material == 1
    column = concrete & (body == 1)
    height = z[column].max() + z[column].min()
    plate = concrete & (body == 2) & (z > height) & (z < height + WIDTH) & (np.hypot(start[:, 0], start[:, 1]) < 0.5)
    places = (column & (z < WIDTH), column & (np.abs(z - 0.5 * height) < 0.5 * WIDTH), column & (z > height - WIDTH), plate)
    return 1e3 * last.time, [100 * failed[place].mean() if place.any() else np.nan for place in places]


def measure(folder, panel, colour):
    """Prints the figures of one run and draws its curve."""
    gauges = read_columns(folder / "gauges.csv")
    time, bent, moved = deflection(gauges)
    k = int(np.nanargmax(bent))
    late = time > time[-1] * 2 / 3
    state = "still rising" if k == len(bent) - 1 else f"at {time[k]:.2f} ms"
    print(f"{folder}: {time[-1]:.2f} ms")
    print(f"  deflection of the middle: peak {bent[k]:.2f} mm {state} (test {PEAK}), residual {np.nanmean(bent[late]):.2f} mm "
          f"(mean from {time[late][0]:.1f} ms on, {np.nanmin(bent[late]):.2f} to {np.nanmax(bent[late]):.2f}; test {RESIDUAL})")
    print(f"  displacement of the middle: peak {np.nanmax(moved):.2f} mm, last {moved[-1]:.2f} mm; of foot and head "
          f"{1e3 * gauges['column foot.displacement_x'][-1]:.2f}, {1e3 * gauges['column head.displacement_x'][-1]:.2f} mm")
    for place in ("below", "middle", "above"):
        if f"front {place}.overpressure" not in gauges:  # a column alone has no flow and no plates
            continue
        over, impulse = gauges[f"front {place}.overpressure"], gauges[f"front {place}.impulse"]
        arrival = time[np.argmax(np.nan_to_num(over) > 1e4)]
        print(f"  front, {place}: arrival {arrival:.3f} ms, overpressure {1e-6 * np.nanmax(over):.2f} MPa, "
              f"impulse {np.nanmax(impulse):.0f} Pa s")
    loads = folder / "loads.csv"
    if loads.exists():
        impulse = read_columns(loads)["column.impulse_x"] / FRONT
        print(f"  impulse on the column over its front: {np.max(impulse):.0f} Pa s, at the end {impulse[-1]:.0f} Pa s")
    for name in PLATES:
        if f"{name}.displacement_z" not in gauges:
            continue
        lift = 1e3 * gauges[f"{name}.displacement_z"]
        print(f"  {name}: lifted by {np.nanmax(lift):.1f} mm at most, {lift[-1]:.1f} mm last")
    when, parts = failed_parts(folder)
    print(f"  failed concrete at {when:.1f} ms: foot {parts[0]:.0f} %, middle {parts[1]:.0f} %, head {parts[2]:.0f} %, "
          f"plate within 0.5 m {parts[3]:.0f} %")
    panel.plot(time, bent, color=colour, label=folder.name.replace("_", " "))


def measure_all(folders):
    """All runs; the picture goes to the first one."""
    figure, panel = plt.subplots(figsize=(5.4, 3.6), constrained_layout=True)
    panel.axhline(PEAK, color="#6b6b6b", lw=0.8, ls="--", label="test: peak")
    panel.axhline(RESIDUAL, color="#6b6b6b", lw=0.8, ls=":", label="test: residual")
    for i, folder in enumerate(folders):
        measure(folder, panel, LINES[i % len(LINES)])
    panel.set_xlabel("time [ms]")
    panel.set_ylabel("deflection of the column's middle [mm]")
    panel.legend()
    picture = folders[0] / "pictures" / "building.png"
    picture.parent.mkdir(parents=True, exist_ok=True)
    save(figure, picture)
    print(f"picture: {picture}")
