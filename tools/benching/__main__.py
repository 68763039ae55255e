"""Makes tables and pictures of what flow_bench wrote: COMMAND FOLDER; or runs the scenes of the trade-off: tradeoff FOLDER
[--case A,B] [--quick]."""
import pathlib
import sys

for tools in ("plotting", "measuring"):
    sys.path.insert(1, str(pathlib.Path(__file__).resolve().parent.parent / tools))

import accuracy  # noqa: E402
import particles  # noqa: E402
import speed  # noqa: E402
import stability  # noqa: E402
import tradeoff  # noqa: E402

REPORTS = {"accuracy": accuracy.report, "particles": particles.report, "speed": speed.report, "stability": stability.report}

if len(sys.argv) > 2 and sys.argv[1] == "tradeoff":
    options = sys.argv[3:]
    cases = options[options.index("--case") + 1].split(",") if "--case" in options else []
    files = tradeoff.run(pathlib.Path(sys.argv[2]), cases, "--quick" in options)
elif len(sys.argv) == 3 and sys.argv[1] in REPORTS:
    files = REPORTS[sys.argv[1]](pathlib.Path(sys.argv[2]))
else:
    sys.exit("usage: benching accuracy|particles|speed|stability FOLDER, or benching tradeoff FOLDER [--case A,B] [--quick]")
for path in files:
    print(path)
