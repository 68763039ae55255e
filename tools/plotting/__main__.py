"""tools/plot: pictures from the files of a run."""
import argparse
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import numpy as np  # noqa: E402

from comparison_pictures import comparison_picture  # noqa: E402
from curve_pictures import curves_picture  # noqa: E402
from flow_pictures import lines_picture, slice_picture  # noqa: E402
from snapshot_files import AXES, SnapshotError, open_snapshot  # noqa: E402
from solid_pictures import solid_picture  # noqa: E402
from standard_set import draw_standard  # noqa: E402

EXAMPLES = """examples
  tools/plot --standard runs/rc_slab                        what tools/run draws at the end
  tools/plot runs/sod/snapshot_flow_*.vtkhdf                one dimension: all of them in one picture
  tools/plot runs/rc_slab/snapshot_flow_000800.vtkhdf --field pressure,schlieren --plane y=0 --mirror x
  tools/plot runs/rc_slab/snapshot_solid_000800.vtkhdf --field damage --view -z --mirror xy
  tools/plot runs/rc_slab/snapshot_solid_000800.vtkhdf --field pressure --plane y=0.002 --mirror x
  tools/plot runs/rc_slab/gauges.csv --columns '*.displacement_z'
  tools/plot runs/material_tests/hjc_*.csv --against compression --columns pressure,von_mises
"""


def arguments():
    parser = argparse.ArgumentParser(prog="tools/plot", description=__doc__, epilog=EXAMPLES,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", nargs="*", metavar="FILE", help="snapshot_*.vtkhdf, peaks.vtkhdf, gauges.csv, history.csv, or an output folder")
    parser.add_argument("--standard", metavar="FOLDER", action="append", default=[], help="the standard set of pictures of an output folder, into FOLDER/pictures")
    parser.add_argument("--field", metavar="NAME[,NAME]", help="fields to draw (default: pressure; damage for particles); also speed, velocity_x, mach, schlieren")
    parser.add_argument("--plane", metavar="AXIS[=PLACE]", help="slice of the flow, or cut through the particles (default of the flow: y, in the middle)")
    parser.add_argument("--view", metavar="SIDE", help="particles seen from this side: +x, -x, ... -z, or a direction as 1,-1,0.5 (default: +z)")
    parser.add_argument("--mirror", metavar="AXES", default="", help="add mirror images at the low faces of these directions: x, xy, ...")
    parser.add_argument("--range", metavar="LOW,HIGH", help="range of the colours, in the units of the colour bar")
    parser.add_argument("--log", action="store_true", default=None, help="logarithmic colours")
    parser.add_argument("--linear", dest="log", action="store_false", help="linear colours")
    parser.add_argument("--no-solid", action="store_true", help="do not draw the particles into slices of the flow")
    parser.add_argument("--columns", metavar="PATTERN", help="columns of a table, as '*.pressure'")
    parser.add_argument("--against", metavar="COLUMN", help="draw the --columns of all tables given over this one of their columns, in one picture; "
                        "-COLUMN (as --against=-strain_xx) changes the sign")
    parser.add_argument("--output", metavar="FOLDER", help="where the pictures go (default: beside each file)")
    parser.add_argument("--list", action="store_true", help="only tell what fields the files have")
    return parser


def parse_plane(word, snapshot):
    """(axis, place) of 'y' or 'y=0.1'."""
    axis_name, _, place = word.partition("=")
    if axis_name not in AXES or len(axis_name) != 1:
        raise SnapshotError(f"--plane {word}: the axis must be x, y or z")
    axis = AXES.index(axis_name)
    return axis, (float(place) if place else 0.5 * float(snapshot.lower[axis] + snapshot.upper[axis]))


def parse_view(word):
    """A direction from '+z' or '1,-1,0.5'."""
    if word.lstrip("+-") in AXES and len(word.lstrip("+-")) == 1:
        return np.eye(3)[AXES.index(word[-1])] * (-1 if word.startswith("-") else 1)
    try:
        direction = np.array([float(part) for part in word.split(",")])
    except ValueError:
        direction = np.zeros(0)
    if direction.shape != (3,) or not np.any(direction):
        raise SnapshotError(f"--view {word}: give +x, -x, ... -z or three numbers as 1,-1,0.5")
    return direction


def target(options, path, tail):
    folder = options.output or os.path.dirname(path) or "."
    os.makedirs(folder, exist_ok=True)
    stem = os.path.splitext(os.path.basename(path))[0]
    return os.path.join(folder, "_".join([stem] + [part for part in tail if part]) + ".png")


def draw_file(path, options):
    """The pictures of one file."""
    if path.endswith(".csv"):
        tail = [] if options.columns is None else ["".join(c if c.isalnum() else "_" for c in options.columns).strip("_")]
        yield curves_picture(path, target(options, path, tail), options.columns)
        return
    snapshot = open_snapshot(path)
    if options.list:
        print(f"{path}: {snapshot.content}, step {snapshot.step}, time {snapshot.time:g} {snapshot.time_unit}: {', '.join(snapshot.names())}")
        return
    mirror = {AXES.index(a): float(snapshot.lower[AXES.index(a)]) for a in options.mirror}
    wanted = tuple(float(part) for part in options.range.split(",")) if options.range else None
    plane = parse_plane(options.plane, snapshot) if options.plane else None
    if snapshot.content == "solid":
        for name in (options.field or "damage").split(","):
            if plane:
                yield solid_picture(snapshot, name, target(options, path, [name, "cut", AXES[plane[0]]]), None, *plane, mirror, wanted, options.log)
            else:
                side = options.view or "+z"
                yield solid_picture(snapshot, name, target(options, path, [name, side.replace(",", "_")]), parse_view(side), None, None, mirror,
                                    wanted, options.log)
        return
    default = "pressure" if snapshot.content == "flow" else "peak_overpressure"
    if len(snapshot.active) == 3 and plane is None:
        plane = parse_plane("y", snapshot)
    if len(snapshot.active) < 3:
        plane = None
    beside = path.replace("snapshot_flow_", "snapshot_solid_")
    solid = open_snapshot(beside) if not options.no_solid and beside != path and os.path.exists(beside) else None
    for name in (options.field or default).split(","):
        axis, place = plane or (None, 0.0)
        yield slice_picture(snapshot, name, target(options, path, [name, AXES[axis] if plane else ""]), axis, place, mirror, wanted, options.log, solid)


def draw_lines(paths, options):
    """Snapshots of one dimension go into one picture."""
    flows = sorted((open_snapshot(path) for path in paths), key=lambda flow: flow.time)
    velocity = f"velocity_{AXES[flows[0].active[0]]}"
    default = ["density", velocity, "pressure"] if flows[0].content == "flow" else list(flows[0].data)
    names = options.field.split(",") if options.field else default
    return lines_picture(flows, names, target(options, flows[-1].path, [options.field.replace(",", "_") if options.field else "lines"]))


def draw_comparison(paths, options):
    """Tables in one picture, one column over another."""
    if not options.columns or not all(path.endswith(".csv") for path in paths):
        raise SnapshotError("--against needs tables and --columns, as --columns pressure,von_mises")
    names = options.columns.split(",")
    tail = [name.lstrip("-") for name in names] + ["over", options.against.lstrip("-")]
    return comparison_picture(paths, options.against, names, target(options, paths[0], tail))


def is_line(path):
    """True for a flow snapshot of one dimension."""
    if path.endswith(".csv"):
        return False
    snapshot = open_snapshot(path)
    one = snapshot.content != "solid" and len(snapshot.active) == 1
    snapshot.close()
    return one


def main():
    parser = arguments()
    options = parser.parse_args(joined_view(sys.argv[1:]))
    if not options.files and not options.standard:
        parser.error("no file is given")
    if set(options.mirror) - set(AXES):
        parser.error(f"--mirror {options.mirror}: give some of x, y, z")
    failed = False
    try:
        for folder in options.standard + [path for path in options.files if os.path.isdir(path)]:
            paths, failures = draw_standard(folder)
            print("\n".join(paths))
            for failure in failures:
                failed = True
                print(f"error: {failure}", file=sys.stderr)
        files = [path for path in options.files if not os.path.isdir(path)]
        if options.against:
            print(draw_comparison(files, options))
            files = []
        lines = [path for path in files if not options.list and is_line(path)]
        if lines:
            print(draw_lines(lines, options))
        for path in files:
            if path not in lines:
                for picture in draw_file(path, options):
                    print(picture)
    except (SnapshotError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        failed = True
    return 1 if failed else 0


def joined_view(words):
    """'--view -z' as '--view=-z', which the parser would take for an option."""
    out = []
    for word in words:
        if out and out[-1] in ("--view", "--range"):
            out[-1] += "=" + word
        else:
            out.append(word)
    return out


if __name__ == "__main__":
    sys.exit(main())
