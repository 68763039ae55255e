"""Chooses what is measured from the files of a run."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "plotting"))

import building  # noqa: E402
import clamped_plate  # noqa: E402
import contact_column  # noqa: E402
import facade  # noqa: E402
import flat_box  # noqa: E402
import fragments  # noqa: E402
import particle_blast  # noqa: E402
import perforation  # noqa: E402
import shock_helium  # noqa: E402
import shock_panel  # noqa: E402
import slab  # noqa: E402
import slab_particles  # noqa: E402
import slab_pictures  # noqa: E402
import surface_burst  # noqa: E402
import taylor  # noqa: E402
from taylor_reference import measure_reference  # noqa: E402

MEASURES = {"slab": slab.measure}
# all runs side by side
TOGETHER = {"building": building.measure_all, "clamped-plate": clamped_plate.measure_all, "contact-column": contact_column.measure_all,
            "facade": facade.measure_all, "flat-box": flat_box.measure_all, "fragments": fragments.measure_all,
            "particle-blast": particle_blast.measure_all, "perforation": perforation.measure_all,
            "shock-helium": shock_helium.measure_all, "shock-panel": shock_panel.measure_all,
            "slab-particles": slab_particles.measure_all, "slab-pictures": slab_pictures.draw,
            "surface-burst": surface_burst.measure_all, "taylor": taylor.measure_all}

if len(sys.argv) > 2 and sys.argv[1] == "taylor-reference":
    measure_reference(sys.argv[2:])
    sys.exit()
if len(sys.argv) < 3 or sys.argv[1] not in {**MEASURES, **TOGETHER}:
    sys.exit(f"usage: tools/measure {'|'.join(sorted({**MEASURES, **TOGETHER}))} RUN_FOLDER...\n"
             "       tools/measure taylor-reference VELOCITY [ELEMENTS [jc_a=157e6 ...]]")
folders = [pathlib.Path(folder) for folder in sys.argv[2:]]
if sys.argv[1] in TOGETHER:
    TOGETHER[sys.argv[1]](folders)
else:
    for folder in folders:
        MEASURES[sys.argv[1]](folder)
