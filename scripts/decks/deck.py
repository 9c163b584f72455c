"""A CalculiX deck: its parts, contact pairs, supports and steps, and how it is written."""

from dataclasses import dataclass, field

import numpy as np

PER_LINE = 12
STEEL, ALUMINIUM, BRONZE = (210000.0, 0.3), (70000.0, 0.33), (110000.0, 0.34)


@dataclass
class Step:
    """A static step: displacements of sets, pressures on surfaces, temperatures of parts."""

    moves: list[tuple[str, int, float]]
    pressures: list[tuple[str, float]] = field(default_factory=list)
    temperatures: list[tuple[str, float]] = field(default_factory=list)
    # the first increment; all of them with `fixed`
    increment: float = 0.25
    fixed: bool = False


class Part:
    """A mesh in a deck, with the numbers of its nodes and elements."""

    def __init__(self, name, mesh, material, first_node, first_element):
        self.name, self.mesh, self.material = name, mesh, material
        self.first_node, self.first_element = first_node, first_element

    def nodes(self, where):
        return [self.first_node + int(node) for node in self.mesh.nodes(where)]

    def sides(self, where):
        return [(self.first_element + cell, side + 1) for cell, side in self.mesh.sides(where)]


class Deck:
    """What a family fills in. All lengths are in mm, all forces in N."""

    def __init__(self, heading, nlgeom=False):
        self.heading, self.nlgeom = heading, nlgeom
        self.parts, self.materials, self.sets, self.surfaces = [], {}, {}, {}
        self.interactions, self.pairs, self.supports, self.steps = [], [], [], []
        # thickness of plane parts
        self.thickness = None
        # sets whose total reactions are printed; together they have all nodes with a prescribed displacement
        self.printed = []
        # sum of all external loads, which the printed reactions balance
        self.applied = np.zeros(3)

    @property
    def dof(self):
        return sum(part.mesh.dof for part in self.parts)

    def add(self, name, mesh, material):
        """Adds a part; the material is a name that `materials` has."""
        nodes = sum(len(part.mesh.points) for part in self.parts)
        elements = sum(len(part.mesh.cells) for part in self.parts)
        self.parts.append(Part(name, mesh, material, nodes + 1, elements + 1))
        return self.parts[-1]

    def elastic(self, name, constants):
        """An elastic material of Young's modulus and Poisson's ratio."""
        self.materials[name] = ["*ELASTIC", numbers(constants)]

    def set(self, name, nodes, printed=True):
        self.sets[name] = sorted(set(nodes))
        if printed:
            self.printed.append(name)

    def surface(self, name, sides):
        self.surfaces[name] = sides
        return name

    def interaction(self, stiffness, friction=0.0, stick=0.0):
        """A linear overclosure, with the coefficient of friction and the slope of sticking where there is friction."""
        name = f"I{len(self.interactions) + 1}"
        lines = [f"*SURFACE INTERACTION,NAME={name}", "*SURFACE BEHAVIOR,PRESSURE-OVERCLOSURE=LINEAR", numbers([stiffness])]
        self.interactions.append(lines + (["*FRICTION", numbers([friction, stick])] if friction else []))
        return name

    def pair(self, slave, master, interaction):
        """A contact pair of two surfaces, each given by its sides; their names come from the number of the pair."""
        number = len(self.pairs) + 1
        names = self.surface(f"S{number}", slave), self.surface(f"M{number}", master)
        self.pairs.append((interaction, *names))

    def text(self):
        applied = " ".join(f"{value:.6g}" for value in self.applied)
        lines = ["*HEADING", f"{self.heading}; applied={applied}"]
        for part in self.parts:
            lines += part_lines(part)
        for name, nodes in self.sets.items():
            lines += [f"*NSET,NSET={name}", *in_rows(nodes)]
        for name, sides in self.surfaces.items():
            lines += [f"*SURFACE,NAME={name},TYPE=ELEMENT", *(f"{element},S{side}" for element, side in sides)]
        for name, material in self.materials.items():
            lines += [f"*MATERIAL,NAME={name}", *material]
        for part in self.parts:
            lines.append(f"*SOLID SECTION,ELSET=E{part.name},MATERIAL={part.material}")
            lines += [numbers([self.thickness])] if self.thickness else []
        if any(step.temperatures for step in self.steps):
            lines += ["*INITIAL CONDITIONS,TYPE=TEMPERATURE", *(f"N{part.name},0." for part in self.parts)]
        for interaction in self.interactions:
            lines += interaction
        for interaction, slave, master in self.pairs:
            lines += [f"*CONTACT PAIR,INTERACTION={interaction},TYPE=SURFACE TO SURFACE", f"{slave},{master}"]
        lines += ["*BOUNDARY", *(f"{name},{first},{last}" for name, first, last in self.supports)]
        for step in self.steps:
            lines += self.step_lines(step)
        return "\n".join(lines) + "\n"

    def step_lines(self, step):
        lines = ["*STEP,INC=1000" + (",NLGEOM" if self.nlgeom else "")]
        lines += ["*STATIC" + (",DIRECT" if step.fixed else ""), numbers([step.increment, 1.0])]
        if step.moves:
            lines += ["*BOUNDARY", *(f"{name},{axis},{axis},{value:.9g}" for name, axis, value in step.moves)]
        if step.pressures:
            lines += ["*DSLOAD", *(f"{name},P,{value:.9g}" for name, value in step.pressures)]
        if step.temperatures:
            lines += ["*TEMPERATURE", *(f"N{name},{value:.9g}" for name, value in step.temperatures)]
        for name in self.printed:
            lines += [f"*NODE PRINT,NSET={name},TOTALS=ONLY", "RF"]
        return [*lines, "*NODE FILE", "U", "*EL FILE", "S", "*CONTACT FILE", "CDIS,CSTR", "*END STEP"]


def part_lines(part):
    """Nodes and elements of a part."""
    lines = [f"*NODE,NSET=N{part.name}"]
    for number, point in enumerate(part.mesh.points, part.first_node):
        lines.append(f"{number}," + ",".join(f"{x:.10g}" for x in point))
    lines.append(f"*ELEMENT,TYPE={part.mesh.kind},ELSET=E{part.name}")
    for number, cell in enumerate(part.mesh.cells + part.first_node, part.first_element):
        lines.append(f"{number}," + ",".join(map(str, cell)))
    return lines


def in_rows(values):
    rows = [values[first : first + PER_LINE] for first in range(0, len(values), PER_LINE)]
    return [",".join(map(str, row)) + "," for row in rows]


def numbers(values):
    return ",".join(f"{float(value):.9g}" for value in values)
