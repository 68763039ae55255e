"""The scenes of the trade-off: what is run, what is measured, and what counts as true."""
import itertools
from dataclasses import dataclass

from tradeoff_measures import bar, blast, bubble, burst, largest, last, slab_deflection, slab_spall


@dataclass(frozen=True)
class Scene:
    name: str
    against: str  # what the errors are against, in words
    measures: object  # {name: function of a folder}, or the names of flow_bench's measures
    picture: str  # scenes of one picture share it, a panel each
    deck: str = ""
    runs: tuple = ()  # (series, mesh, settings)
    reference: object = None  # (mesh, settings) of the run that is taken as true, or {measure: number}
    settings: tuple = ()  # of all runs
    quick: tuple = ()  # meshes that --quick keeps
    problem: str = ""  # of flow_bench, in place of a deck
    schemes: object = None  # {series: scheme of flow_bench}
    calls: int = 1  # of flow_bench, for the least time


def meshes(*counts):
    return [("", "x".join(map(str, count)), [f"mesh%cells={','.join(map(str, count))}"]) for count in counts]


def finest(*count, settings=()):
    """The run of a mesh that is taken as true."""
    return meshes(count)[0][1], [*meshes(count)[0][2], *settings]


def cubes(*counts):
    return meshes(*((n, n, n) for n in counts))


def series(choices):
    return [(name, "", list(settings)) for name, settings in choices.items()]


def runs(*groups):
    """All combinations of one run of each group: names and meshes joined, settings in a row."""
    return tuple((", ".join(name for name, _, _ in group if name), " ".join(mesh for _, mesh, _ in group if mesh),
                  sum((settings for _, _, settings in group), [])) for group in itertools.product(*groups))


BENCH_SCHEMES = {"paper": "paper", "MUSCL": "muscl+third_order+sensor", "fifth order": "fifth_order+sensor",
                 "THINC": "fifth_order+thinc+sensor"}
UNSHARPENED = {name: scheme for name, scheme in BENCH_SCHEMES.items() if name != "THINC"}
PAPER = ["flow%reconstruction=muscl", "flow%limiter=venkatakrishnan", "flow%interface=diffuse", "flow%shocks=plain"]
FIFTH = ["flow%reconstruction=fifth_order", "flow%interface=diffuse", "flow%shocks=sensor"]
MUSCL = ["flow%reconstruction=muscl", "flow%limiter=third_order", "flow%interface=diffuse", "flow%shocks=sensor"]
SCHEMES = {"paper": PAPER, "MUSCL": MUSCL, "fifth order": FIFTH}
THINC = FIFTH[:1] + ["flow%interface=thinc", "flow%shocks=sensor"]
METHODS = {method: [f"coupling%method={method}"] for method in ("lg_cfibm", "moving_wall")}
EXACT = "the exact solution, relative L1"


def exact(name, problem, schemes=BENCH_SCHEMES, calls=3):
    return Scene(name, EXACT, ("density", "velocity", "pressure"), "tubes", problem=problem, schemes=schemes, calls=calls)


def gauges(places, names):
    """All four gauges of a deck at these places along x, under these names."""
    return tuple(itertools.chain.from_iterable((f"gauge({i})%position={place},0,0", f"gauge({i})%name='{name}'")
                                               for i, (place, name) in enumerate(zip(places, names), 1)))


def free_air(z, end):
    """1 kg of TNT, an eighth of it in a cube of 1.2 times the distance that counts; all until the positive phase is over there."""
    side = 1.2 * z
    half = ["charge%start=spherical", f"charge%start_stop={0.5 * z}"]
    return Scene(f"free_air_{z:g}", "2400 cells along the radius", blast("place"), "blasts", "free_air_blast",
                 runs(series({"paper": PAPER}), cubes(48)) + runs(series({"fifth order": [], "start to Z/2": half}), cubes(24, 48))
                 + runs(series({"start to the faces": ["charge%start=spherical"]}), cubes(24)),
                 finest(2400, 1, 1, settings=["mesh%geometry=spherical"]),
                 (f"mesh%upper={side:g},{side:g},{side:g}", f"run%end_time={end}", "output%snapshot_interval=0", "output%peak_maps=.false.",
                  *gauges([z] * 4, ["place", "b", "c", "d"])), quick=("24x24x24",))


DISTANCES = (0.5, 1, 2, 5)
BURST_MEASURES, BURST_CURVES = burst(DISTANCES)

SCENES = [
    exact("sod", "sod", UNSHARPENED),
    exact("two_gas_tube", "sod_two_gases"),
    exact("tnt_air_tube", "tnt_air", UNSHARPENED),
    exact("sedov_3d", "sedov_3", UNSHARPENED, calls=1),
    free_air(0.5, 1.0e-3), free_air(1, 2.0e-3), free_air(2, 5.0e-3), free_air(5, 14.0e-3),
    Scene("surface_blast", "the curves of Kingery & Bulmash", BURST_MEASURES, "blasts", "surface_blast_3d",
          runs(series({"direct": ["charge%start=none"]}), cubes(32, 48)) + runs(series({"start to 1 m": []}), cubes(48))
          + runs(series({"start to the faces": ["charge%start_stop=5.5"],
                         "the same, 25 cells in the charge": ["charge%start_stop=5.5", "charge%start_cells=25"]}), cubes(32)), BURST_CURVES,
          ("mesh%upper=6,6,6", "run%end_time=14e-3", *gauges(DISTANCES, [f"{z:.2f} m" for z in DISTANCES])), quick=("32x32x32",)),
    Scene("surface_blast_3d", "4800 cells along the radius", blast("2.0 m"), "surface_blast_3d", "surface_blast_3d",
          runs(series({"direct": ["charge%start=none"], "start to 1 m": [], "start to 2.1 m": ["charge%start_stop=2.1"]}),
               cubes(24, 32, 48))
          + runs(series({"direct, no sleep": ["charge%start=none", "flow%sleep=.false."]}), cubes(48)),
          finest(4800, 1, 1, settings=["charge%start=none", "mesh%geometry=spherical"]), quick=("24x24x24", "32x32x32")),
    Scene("shock_helium", "the finest run", bubble(["refracted shock in the bubble", "upstream interface, first", "head of the air jet",
                                                    "downstream interface, first", "vortex pair"]), "bodies", "shock_helium",
          runs(series({**SCHEMES, "THINC": THINC}), meshes((162, 22, 1), (325, 45, 1))),
          finest(650, 89, 1, settings=FIFTH), quick=("162x22x1",)),
    Scene("taylor_bar", "the finest run", {"length": bar("length"), "foot": bar("foot"), "at 0.2 L": bar("fifth")}, "bodies", "taylor_bar",
          runs(series({"linear": [], "quadratic": ["solid%shape=quadratic"]}), [
              ("", "cells of 1 mm, 8 particles", ["mesh%cells=10,10,28", "body%spacing=0.5"]),
              ("", "1 mm, 64", ["mesh%cells=10,10,28"]),
              ("", "0.5 mm, 1", ["body%spacing=0.5"]),
              ("", "0.5 mm, 8", [])]),
          ("0.333 mm, 8", ["solid%shape=quadratic", "mesh%cells=30,30,84", "body%spacing=0.1666666667"]),
          quick=("cells of 1 mm, 8 particles",)),
    Scene("piston", "the exact solution", {"pressure": last("gas.pressure")}, "bodies", "piston",
          runs(series(METHODS), meshes((50, 1, 1), (100, 1, 1), (200, 1, 1), (400, 1, 1))), {"pressure": 1.7603},
          quick=("100x1x1", "200x1x1")),
    Scene("lift_off", "cells of 1/1600 (docs/validation.md)",
          {"x": last("cylinder.center_x", "loads.csv"), "y": last("cylinder.center_y", "loads.csv")}, "bodies", "lift_off",
          runs(series({"paper": PAPER, "fifth order": []}), meshes((160, 32), (200, 40), (400, 80))), {"x": 0.630, "y": 0.141},
          quick=("160x32",)),
    Scene("slab", "the test (Wang et al. 2013)", {"deflection": slab_deflection, "spall radius": slab_spall}, "bodies", "rc_slab_coarse",
          runs(series({"all of the paper": ["stages%solid_start=at_once", "flow%sleep=.false."], "moving_wall": METHODS["moving_wall"],
                       "moving_wall, start": [*METHODS["moving_wall"], "charge%start=spherical"]}), [("", "16 mm, 64 particles", [])])
          + runs(series({"all of the paper": ["stages%solid_start=at_once", "flow%sleep=.false."],
                         "moving_wall, start": [*METHODS["moving_wall"], "charge%start=spherical"],
                         "moving_wall, start, faded": [*METHODS["moving_wall"], "charge%start=spherical", "stages%flow_end=faded",
                                                       "stages%faded_part=0.05"],
                         "moving_wall, start, fifth order": [*METHODS["moving_wall"], "charge%start=spherical", *FIFTH]}),
                 [("", "16 mm, 8", ["body%spacing=0.008"])])
          + runs(series({"moving_wall, start": [*METHODS["moving_wall"], "charge%start=spherical"]}),
                 [("", "24 mm, 27", ["mesh%cells=25,25,25", "body%spacing=0.008"])]),
          {"deflection": 0.035, "spall radius": 0.120},
          ("run%end_time=5e-3", "output%snapshot_interval=0", "output%flow_snapshots=.false.")),
    Scene("flat_box", "the finest run", blast("side wall"), "bodies", "flat_box_room",
          runs(series({"four rooms, rigid": ["deck=flat_box_rigid"]}), meshes((55, 55, 4), (110, 110, 8)))
          + runs(series({"four rooms, concrete": ["deck=flat_box_coarse"]}), meshes((120, 120, 22)))
          + runs(series({"an eighth of a room": [], "the same, direct": ["charge%start=none"]}), meshes((27, 27, 8), (54, 54, 16))),
          finest(81, 81, 24), ("run%end_time=2.2e-3", "output%flow_snapshots=.false.", "output%solid_snapshots=.false."),
          quick=("27x27x8", "55x55x4")),
]
