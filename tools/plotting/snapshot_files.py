"""Reading snapshots: flow (or peak maps) on a uniform mesh of bricks, and particles of the solid."""
import numpy as np
import h5py

AXES = "xyz"


class SnapshotError(Exception):
    """A file that cannot be drawn; the message says why."""


def text(value):
    return (value.decode() if isinstance(value, bytes) else str(value)).strip()


def place_text(snapshot, axis, place):
    """'y = 0.008 m'."""
    return f"{AXES[axis]} = {place:.3g}" + ("" if snapshot.length_unit in ("-", "") else f" {snapshot.length_unit}")


def by_time(folder, kind):
    """Files of a kind by the time of their snapshot, in whole microseconds."""
    found = {}
    for path in sorted(folder.glob(f"snapshot_{kind}_*.vtkhdf")):
        snapshot = open_snapshot(path)
        found[round(1e6 * snapshot.time)] = path
        snapshot.close()
    return found


def open_snapshot(path):
    """A Flow or a Solid, by what the file says of itself."""
    try:
        file = h5py.File(path, "r")
    except OSError as error:
        raise SnapshotError(f"{path}: not a readable HDF5 file ({error})") from None
    if "brisance" not in file or "VTKHDF" not in file:
        file.close()
        raise SnapshotError(f"{path}: not a snapshot of brisance")
    content = text(file["brisance"].attrs["content"])
    return Solid(path, file) if content == "solid" else Flow(path, file)


class Snapshot:
    """What both kinds have: time, step, title, units, and the mesh of the run."""

    def __init__(self, path, file):
        self.path = path
        self.file = file
        head = file["brisance"].attrs
        self.content = text(head["content"])
        self.title = text(head["title"])
        self.time = float(head["time"][0])
        self.step = int(head["step"][0])
        self.length_unit = text(head["length_unit"])
        self.time_unit = text(head["time_unit"])
        self.cells = np.asarray(head["cells"], dtype=int)
        self.active = [d for d in range(3) if head["active"][d]]
        self.lower = np.asarray(head["lower"], dtype=float)
        self.upper = np.asarray(head["upper"], dtype=float)
        self.materials = text(head["materials"]).split(";") if "materials" in head else []

    def close(self):
        self.file.close()

    def unknown(self, name):
        return SnapshotError(f"{self.path}: there is no field '{name}'; there are: {', '.join(self.names())}")


class Flow(Snapshot):
    """Cell data; a brick is read only if it is needed."""

    def __init__(self, path, file):
        super().__init__(path, file)
        level = file["VTKHDF/Level0"]
        self.box = np.asarray(level["AMRBox"], dtype=int)
        self.data = level["CellData"]
        size = (self.box[:, 1::2] - self.box[:, ::2] + 1).prod(axis=1)
        self.offset = np.concatenate([[0], np.cumsum(size)])
        self.spacing = (self.upper - self.lower) / self.cells

    def names(self):
        """The fields, with those that follow from them."""
        names = list(self.data)
        if "velocity" in self.data:
            names += ["speed"] + [f"velocity_{AXES[d]}" for d in self.active]
            if "sound_speed" in self.data:
                names.append("mach")
        if "density" in self.data and len(self.active) > 1:
            names.append("schlieren")
        return names

    def unit(self, name):
        if name == "speed" or name.startswith("velocity_"):
            name = "velocity"
        if name in ("mach", "schlieren"):
            return "-"
        return text(self.data[name].attrs["unit"])

    def _stored(self, name):
        """Stored field and component (None: scalar; -1: magnitude) that a name stands for."""
        if name == "speed":
            return "velocity", -1
        if name.startswith("velocity_") and name[-1] in AXES:
            return "velocity", AXES.index(name[-1])
        return name, None

    def layer(self, name, axis, position):
        """The cells of one layer as an array [second axis, first axis] of the two other directions, and the place of their centre.

        axis: direction 0..2 across the layer, or None for a scene of two dimensions or less."""
        if axis is None:
            axis = [d for d in range(3) if d not in self.active][-1]
            position = self.lower[axis]
        index = int(np.clip(np.floor((position - self.lower[axis]) / self.spacing[axis]), 0, self.cells[axis] - 1))
        centre = self.lower[axis] + (index + 0.5) * self.spacing[axis]
        if name == "mach":
            speed, _ = self.layer("speed", axis, position)
            sound, _ = self.layer("sound_speed", axis, position)
            return speed / np.maximum(sound, np.finfo(float).tiny), centre
        if name == "schlieren":
            return self._schlieren(axis, position), centre
        field, component = self._stored(name)
        if field not in self.data:
            raise self.unknown(name)
        first, second = [d for d in range(3) if d != axis]
        plane = np.empty((self.cells[second], self.cells[first]))
        for number, box in enumerate(self.box):
            low, high = box[::2], box[1::2] + 1
            if not low[axis] <= index < high[axis]:
                continue
            values = np.asarray(self.data[field][self.offset[number]:self.offset[number + 1]], dtype=float)
            size = high - low
            values = values.reshape((size[2], size[1], size[0]) + values.shape[1:])
            values = np.take(values, index - low[axis], axis=2 - axis)
            if component == -1:
                values = np.sqrt((values ** 2).sum(axis=-1))
            elif component is not None:
                values = values[..., component]
            elif values.ndim > 2:
                raise SnapshotError(f"{self.path}: '{name}' is a vector; draw 'speed' or '{name}_x'")
            plane[low[second]:high[second], low[first]:high[first]] = values
        return plane, centre

    def _schlieren(self, axis, position):
        """exp(-k |grad density| / largest): dark where the density changes, as in photographs of the light deflected."""
        density, _ = self.layer("density", axis, position)
        first, second = [d for d in range(3) if d != axis]
        steps = [self.spacing[second], self.spacing[first]]
        slope = np.zeros_like(density)
        for direction in (0, 1):
            if density.shape[direction] > 1:
                slope += np.gradient(density, steps[direction], axis=direction) ** 2
        slope = np.sqrt(slope)
        if "cell_type" in self.data:  # the gas frozen inside a solid has nothing to show
            slope[self.layer("cell_type", axis, position)[0] > 0.5] = 0.0
        largest = np.percentile(slope, 99.8)
        return np.exp(-8 * slope / largest) if largest > 0 else np.ones_like(slope)

    def line(self, name):
        """Cell centres and values along x of a scene of one dimension."""
        values, _ = self.layer(name, None, 0.0)
        d = self.active[0]
        return self.lower[d] + (np.arange(self.cells[d]) + 0.5) * self.spacing[d], values.ravel()


class Solid(Snapshot):
    """Particles."""

    def __init__(self, path, file):
        super().__init__(path, file)
        self.data = file["VTKHDF/PointData"]
        self.bodies = text(file["brisance"].attrs["bodies"]).split(";")
        self.position = np.asarray(file["VTKHDF/Points"], dtype=float).reshape(-1, 3)
        self.n = len(self.position)

    def names(self):
        return list(self.data) + ["speed"] + [f"velocity_{AXES[d]}" for d in self.active]

    def unit(self, name):
        if name == "speed" or name.startswith("velocity_"):
            name = "velocity"
        return text(self.data[name].attrs["unit"])

    def field(self, name):
        if name == "speed":
            return np.sqrt((np.asarray(self.data["velocity"], dtype=float) ** 2).sum(axis=1))
        if name.startswith("velocity_") and name[-1] in AXES:
            return np.asarray(self.data["velocity"], dtype=float)[:, AXES.index(name[-1])]
        if name not in self.data:
            raise self.unknown(name)
        values = np.asarray(self.data[name], dtype=float)
        if values.ndim > 1:
            raise SnapshotError(f"{self.path}: '{name}' is a vector; draw 'speed' or '{name}_x'")
        return values

    def size(self):
        """Edge of a particle, seen as a cube: the median over all."""
        if self.n == 0:
            return 0.0
        return float(np.median(np.abs(self.field("volume"))) ** (1 / max(len(self.active), 1)))

    def extent(self):
        """Low and high corner of the bulk of the particles (few that flew off are left out)."""
        edge = self.size() / 2
        low = np.percentile(self.position, 0.5, axis=0)
        high = np.percentile(self.position, 99.5, axis=0)
        return low - edge, high + edge
