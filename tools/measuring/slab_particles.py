"""The slab under an explosion computed by particles alone (pure MPM) beside the same slab coupled to the flow solver: pressure at the
same times in the plane y = 0, and what the slab has got by then.

The first run has the flow solver; in the others explosive and air are bodies named 'charge' and 'air'."""
import numpy as np
from matplotlib.colors import LogNorm

from flow_pictures import draw_outline
from slab_pictures import damage, deflections
from snapshot_files import by_time, open_snapshot
from solid_pictures import paint, view_frame
from style import COLOURS, colour_bar, plt, save

TIMES = (0.08e-3, 0.18e-3)  # s, those of Ni et al. 2022
RANGE = (0.05, 20.0)  # MPa
AMBIENT = 0.101325  # MPa
NEAR = 0.06  # m from the axis, and from the front face: the air before the slab
FLUIDS = ("air", "charge")


class State:
    """Fluid and slab of a run at a time: places, pressures [MPa] and volumes of the fluid, and the particles of the slab."""

    def __init__(self, folder, time):
        self.name = folder.name
        solids = by_time(folder, "solid")
        if round(1e6 * time) not in solids:
            raise SystemExit(f"error: {folder} has no snapshot of the solid at {1e3 * time:g} ms")
        self.solid = open_snapshot(solids[round(1e6 * time)])
        bodies = [name.strip() for name in self.solid.bodies]
        self.is_fluid = np.isin(self.solid.field("body"), [i + 1 for i, name in enumerate(bodies) if name in FLUIDS])
        flows = by_time(folder, "flow")
        self.flow = open_snapshot(flows[round(1e6 * time)]) if flows else None
        if self.flow is not None:
            plane, _ = self.flow.layer("pressure", 1, 0.0)
            closed, _ = self.flow.layer("cell_type", 1, 0.0)
            x, z = (self.flow.lower[d] + (np.arange(self.flow.cells[d]) + 0.5) * self.flow.spacing[d] for d in (0, 2))
            self.plane = 1e-6 * plane
            x, z = np.meshgrid(x, z)
            gas = closed < 0.5
            self.r, self.z, self.pressure = x[gas], z[gas], self.plane[gas]
            self.weight = self.r  # of a ring about the axis
        else:
            place = self.solid.position[self.is_fluid]
            self.r, self.z = np.hypot(place[:, 0], place[:, 1]), place[:, 2]
            self.pressure = 1e-6 * self.solid.field("pressure")[self.is_fluid]
            self.weight = np.abs(self.solid.field("volume")[self.is_fluid])

    def slab(self, name):
        """A field of the particles of the slab."""
        return self.solid.field(name)[~self.is_fluid]

    def draw(self, axes, norm):
        """Pressure in the plane y = 0, with the slab in grey."""
        colours = plt.get_cmap(COLOURS["pressure"])
        if self.flow is not None:
            box = (self.flow.lower[0], self.flow.upper[0], self.flow.lower[2], self.flow.upper[2])
            axes.imshow(np.maximum(self.plane, norm.vmin), extent=box, origin="lower", norm=norm, cmap=colours)
            draw_outline(axes, self.solid, 1, 0.0, 0, 2, {}, self.flow.spacing[0])
        else:
            frame = view_frame(np.array([0.0, -1.0, 0.0]))
            box = (self.solid.lower[0], self.solid.upper[0], self.solid.lower[2], self.solid.upper[2])
            for chosen, edge in ((self.is_fluid, self.fluid_size()), (~self.is_fluid, self.slab_size())):
                place = self.solid.position[chosen].copy()
                values = np.maximum(1e-6 * self.solid.field("pressure")[chosen], norm.vmin)
                near = place[:, 1] < 2 * edge
                picture, _, extent, _ = paint(place[near], values[near], 1.15 * edge, frame, box)
                image = colours(norm(np.nan_to_num(picture, nan=norm.vmin)))
                if chosen is not self.is_fluid:
                    image[..., :3] = 0.72
                image[..., 3] = np.isfinite(picture)
                axes.imshow(image, extent=extent, origin="lower")
        axes.set_xlim(box[0], box[1])
        axes.set_ylim(box[2], box[3])
        axes.set_aspect("equal")

    def fluid_size(self):
        """Edge of a particle of air."""
        return float(np.median(np.abs(self.solid.field("volume")[self.is_fluid])) ** (1 / 3))

    def slab_size(self):
        """Edge of a particle of the slab."""
        return float(np.median(np.abs(self.slab("volume"))) ** (1 / 3))

    def figures(self):
        """Place of the shock on the axis [mm], mean pressure [MPa] before the slab and its scatter, momentum [N s] and kinetic energy [J]
        of the slab, largest speed in it [m/s], failed part."""
        on_axis = (self.r < 0.15 * self.z) & (self.z < 0.40)
        struck = on_axis & (self.pressure > 2 * AMBIENT)
        before = (self.r < NEAR) & (self.z > 0.40 - NEAR) & (self.z < 0.40)
        mean = np.average(self.pressure[before], weights=self.weight[before]) if before.any() else np.nan
        scatter = np.sqrt(np.average((self.pressure[before] - mean) ** 2, weights=self.weight[before])) if before.any() else np.nan
        mass = self.slab("density") * np.abs(self.slab("volume"))
        speed = self.slab("speed")
        return [1e3 * self.z[struck].max(), mean, scatter / mean, (mass * self.slab("velocity_z")).sum(), 0.5 * (mass * speed ** 2).sum(),
                speed.max(), (self.slab("damage") >= 1).mean()]


HEADS = [("outermost place on the axis at twice the ambient pressure [mm]", "{:.0f}"), ("mean pressure over 60 mm before the slab [MPa]", "{:.2f}"),
         ("its standard deviation over its mean", "{:.2f}"), ("momentum of the slab [N s]", "{:.2f}"), ("kinetic energy of the slab [J]", "{:.1f}"),
         ("largest speed in the slab [m/s]", "{:.0f}"), ("failed part of the slab", "{:.3f}")]


def measure_all(folders):
    """A table, and pictures of pressure, deflection and damage with a column or a row for each run, into the folder of the last run."""
    states = [[State(folder, time) for time in TIMES] for folder in folders]
    print("| | " + " | ".join(f"{row[0].name}, {1e3 * t:.2f} ms" for t in TIMES for row in states) + " |")
    print("|" + "---|" * (1 + len(TIMES) * len(states)))
    figures = [[state.figures() for state in row] for row in states]
    for k, (head, form) in enumerate(HEADS):
        print(f"| {head} | " + " | ".join(form.format(row[t][k]) for t in range(len(TIMES)) for row in figures) + " |")
    norm = LogNorm(*RANGE)
    figure, panels = plt.subplots(len(TIMES), len(folders), figsize=(0.8 + 2.9 * len(folders), 6.0), squeeze=False, layout="constrained")
    for column, row in enumerate(states):
        for axes, state, time in zip(panels[:, column], row, TIMES):
            state.draw(axes, norm)
            axes.set_title(f"{state.name.replace('_', ' ')}, {1e3 * time:.2f} ms", loc="left")
            axes.set_xlabel("x [m]")
            axes.set_ylabel("z [m]")
            axes.label_outer()
    colour_bar(figure, plt.cm.ScalarMappable(norm, COLOURS["pressure"]), list(panels.flat), "pressure [MPa]", fraction=0.03)
    pictures = folders[-1] / "pictures"
    pictures.mkdir(parents=True, exist_ok=True)
    print("\npictures:", save(figure, pictures / "slab_particles_pressure.png"), deflections(folders, pictures / "slab_particles_deflection.png"),
          damage(folders, pictures / "slab_particles_damage.png"))
