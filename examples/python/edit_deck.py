"""A deck of Abaqus or CalculiX loaded, looked at, edited and run.

    python edit_deck.py [case.toml]
"""

import sys
import tempfile
from pathlib import Path

import signorini as sg

case = sg.load(Path(__file__).with_name("blocks.inp"))
print(case)
print(case.check())

# everything in the deck is an attribute: a softer rubber, friction, a larger load in ten increments
case.materials["RUBBER"].E = 4.0
case.contacts[0].friction = 0.3
step = case.steps[0]
step.loads[0].pressure = 0.2
step.increments = {"fixed": 10}

result = case.run(save=False)
top = result[-1]["displacement"][:, 2].min()
closed_form = -0.2 * (5.0 / 4.0 + 10.0 / 210e3)  # both blocks in uniaxial stress
print(f"top {top:.6f} mm, closed form {closed_form:.6f} mm")
assert abs(top / closed_form - 1.0) < 1e-9 and result.history.nrow == 10

# the same as a case file, which runs to the same numbers
file = sys.argv[1] if sys.argv[1:] else tempfile.mkdtemp() + "/blocks.toml"
case.to_toml(file)
again = sg.load(file).run(save=False)
assert (again[-1]["displacement"] == result[-1]["displacement"]).all()
