"""Chooses what is measured from the files of a run."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "plotting"))

import shock_helium  # noqa: E402
import slab  # noqa: E402
import taylor  # noqa: E402

MEASURES = {"shock-helium": shock_helium.measure, "slab": slab.measure, "taylor": taylor.measure}

if len(sys.argv) < 3 or sys.argv[1] not in MEASURES:
    sys.exit("usage: tools/measure shock-helium|slab|taylor RUN_FOLDER...")
for folder in sys.argv[2:]:
    MEASURES[sys.argv[1]](pathlib.Path(folder))
