"""Makes tables and pictures of what flow_bench wrote: COMMAND FOLDER."""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "plotting"))

import accuracy  # noqa: E402
import particles  # noqa: E402
import speed  # noqa: E402
import stability  # noqa: E402

REPORTS = {"accuracy": accuracy.report, "particles": particles.report, "speed": speed.report, "stability": stability.report}

if len(sys.argv) != 3 or sys.argv[1] not in REPORTS:
    sys.exit("usage: benching accuracy|particles|speed|stability FOLDER")
for path in REPORTS[sys.argv[1]](pathlib.Path(sys.argv[2])):
    print(path)
