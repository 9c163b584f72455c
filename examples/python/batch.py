"""Case files and decks run on all cores, and a table of how they ended.

    python batch.py [case.toml ...]
"""

import sys
from pathlib import Path

import signorini as sg

EXAMPLES = Path(__file__).resolve().parents[1]
QUICK = ["cook_membrane_2d", "hertz_cylinder_2d_mortar", "paper_wedge_3d", "press_fit_2d_gauss_point", "two_blocks_2d"]

paths = [Path(path) for path in sys.argv[1:]] or [EXAMPLES / name / "case.toml" for name in QUICK]
runs = sg.run_many([sg.load(path) for path in paths])  # a run that fails keeps the others going
for path, run in zip(paths, runs):
    met = sum(one["ok"] for one in run.expectations)
    expected = f"{met} of {len(run.expectations)} expectations met"
    print(f"{path.parent.name:28} {run.status:10} {run.history.nrow:3} increments, {expected}")
    if run.error is not None:
        print(run.error)
assert all(run.ok for run in runs)
