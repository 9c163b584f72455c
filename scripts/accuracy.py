"""How far the results of a deck are from its exact solution: that of Hertz, or Coulomb's.

A deck whose heading has a radius, as in `R=100.`, is a quarter of a ball with the axis z, pressed on a block. Any
other one is a block that is pressed along z and slides along x.
"""

import functools
import math
import pathlib
import re

import numpy as np

from jobs import cards, fields, keywords, parameter

# a pressure below this part of p0 is none
NO_PRESSURE = 1e-6
# the part of the radius of contact within which pressures make up p0: at the edge they tell where that is
INNER = 0.8
# quarters of the ball, of which the deck has one
QUARTERS = 4
# first nodes of a side are its corners
HEX = [(0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)]
TET = [(0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0)]
TET10 = [(0, 1, 2, 4, 5, 6), (0, 3, 1, 7, 8, 4), (1, 3, 2, 8, 9, 5), (2, 3, 0, 9, 7, 6)]
# nodes of an element, and of its sides
SIDES = {"C3D8": (8, HEX), "C3D8I": (8, HEX), "C3D8R": (8, HEX), "C3D4": (4, TET), "C3D10": (10, TET10)}


class Deck:
    """What a deck says about its exact solution, and where its results are."""

    def __init__(self, text):
        self.cards = [(keywords(card)[0], card, lines) for card, lines in cards(text)]
        # a line has the number of a node and its coordinates
        self.dof = sum(line.count(",") for _, lines in self.all("NODE") for line in lines)
        self.heading = " ".join(line for _, lines in self.all("HEADING") for line in lines)

    def all(self, keyword):
        return [(card, lines) for key, card, lines in self.cards if key == keyword]

    def first(self, keyword, name):
        """A parameter of the first card of a keyword."""
        return next((parameter(card, name) for card, _ in self.all(keyword)), None)

    @property
    def radius(self):
        """That of the ball; none where there is no ball."""
        found = re.search(r"\bR=([0-9.]+)", self.heading)
        return float(found.group(1)) if found else None

    @property
    def applied(self):
        """The sum of all external loads, where the heading has it."""
        found = re.search(r"\bapplied=([-+.\deE ]+)", self.heading)
        return np.array([float(word) for word in found.group(1).split()]) if found else np.zeros(3)

    @property
    def friction(self):
        """The coefficient of friction."""
        return float(fields(self.all("FRICTION")[0][1])[0])

    def modulus(self):
        """E* of both bodies together: 1/E* is the sum of (1 - nu^2)/E over the sections."""
        constants, name = {}, None
        for key, card, lines in self.cards:
            if key == "MATERIAL":
                name = parameter(card, "NAME")
            elif key == "ELASTIC":
                constants[name] = [float(one) for one in fields(lines)[:2]]
        sections = [constants[parameter(card, "MATERIAL")] for card, _ in self.all("SOLIDSECTION")]
        return 1.0 / sum((1.0 - nu**2) / e for e, nu in sections)

    @functools.cached_property
    def slave(self):
        """Coordinates of the nodes of the slave surface, by their numbers."""
        nodes, found = {node for side in self.slave_sides for node in side}, {}
        for _, lines in self.all("NODE"):
            for line in lines:
                number, *at = line.split(",")
                if int(number) in nodes:
                    found[int(number)] = [float(x) for x in at]
        return found

    @functools.cached_property
    def slave_sides(self):
        """The nodes of each side of the slave surface; all turn alike as seen from outside."""
        name = fields(self.all("CONTACTPAIR")[0][1])[0].upper()
        lines = next(lines for card, lines in self.all("SURFACE") if parameter(card, "NAME") == name)
        sides = {}
        for element, side in (line.split(",")[:2] for line in lines):
            sides.setdefault(int(element), []).append(int(side.strip().lstrip("S")) - 1)
        found = []
        for card, lines in self.all("ELEMENT"):
            count, corners = SIDES[parameter(card, "TYPE")]
            numbers = fields(lines)
            for first in range(0, len(numbers), count + 1):
                for side in sides.get(int(numbers[first]), ()):
                    found.append([int(numbers[first + 1 + k]) for k in corners[side]])
        return found


def reaction(path, name):
    """The last total force of a set of nodes in a .dat file."""
    found, caption = None, False
    for line in pathlib.Path(path).read_text(encoding="ascii", errors="replace").splitlines():
        if "total force (fx,fy,fz)" in line:
            caption = line.upper().split(" SET ")[1].split()[0] == name
        elif caption and line.strip():
            found, caption = np.array([float(word) for word in line.split()]), False
    if found is None:
        raise ValueError(f"{path} has no total force of {name}")
    return found


def last(path, table, names):
    """These components at nodes, by their numbers, in the last such table of an .frd file."""
    found, inside = {}, False
    with open(path, encoding="ascii", errors="replace") as file:
        for line in file:
            if line.startswith(" -4"):
                inside = line.split()[1] == table
                if inside:
                    found, components, columns = {}, [], []
            elif inside and line.startswith(" -5"):
                components.append(line.split()[1])
                columns = [components.index(name) for name in names if name in components]
            elif inside and line.startswith(" -1") and len(columns) == len(names):
                found[int(line[3:13])] = [float(line[13 + 12 * k : 25 + 12 * k]) for k in columns]
    if not found:
        raise ValueError(f"{path} has no table {table} with {', '.join(names)}")
    return found


def pressures(path):
    """Pressures at nodes, by their numbers, in the last CONTACT table of an .frd file."""
    return {node: value for node, (value,) in last(path, "CONTACT", ["CPRESS"]).items()}


def mean_normal(deck, path):
    """The mean of the normals of the slave surface where an .frd file ends, weighted with the pressures there."""
    moved, pressure = last(path, "DISP", ["D1", "D2", "D3"]), pressures(path)
    total = np.zeros(3)
    for side in deck.slave_sides:
        first = side[: 4 if len(side) in (4, 8) else 3]
        x = np.array([np.add(deck.slave[node], moved[node]) for node in first])
        across = np.cross(x[2] - x[0], x[-1] - x[1])
        total += across * np.mean([pressure.get(node, 0.0) for node in first])
    return total / np.linalg.norm(total)


def hertz(force, radius, modulus):
    """The largest pressure under a ball that is pressed by a force, and the radius of the contact."""
    p0 = (6.0 * force * modulus**2 / (math.pi**3 * radius**2)) ** (1.0 / 3.0)
    return p0, (3.0 * force * radius / (4.0 * modulus)) ** (1.0 / 3.0)


def beside_hertz(force, radius, modulus, at, pressure):
    """Errors of pressures at distances `at` from the axis."""
    p0, a = hertz(force, radius, modulus)
    exact = p0 * np.sqrt(np.maximum(0.0, 1.0 - (at / a) ** 2))
    counts = (at < a) | (pressure > NO_PRESSURE * p0)
    inner = at < INNER * a
    shape, found = exact[inner], pressure[inner]
    return {
        "force": force,
        "fitted": float(found @ shape / (shape @ shape)) - 1.0 if inner.any() else None,
        "largest": float(pressure.max()) / p0 - 1.0,
        "centre": float(pressure[at.argmin()]) / p0 - 1.0,
        "rms": float(np.sqrt(np.mean((pressure[counts] - exact[counts]) ** 2))) / p0,
        "nodes": int(counts.sum()),
    }


def beside_coulomb(force, normal, friction):
    """Errors of a force on a surface that slips everywhere: as it is, along x and z, and across and along a normal."""
    along, _, down = np.abs(force)
    pressing = force @ normal
    across = np.linalg.norm(force - pressing * normal)
    return {
        "force": float(down),
        "friction": float(across / abs(pressing) / friction) - 1.0,
        "axes": float(along / down / friction) - 1.0,
    }


def errors(deck, results):
    """Errors of the results that begin with this path, by name."""
    force = reaction(f"{results}.dat", deck.first("NODEPRINT", "NSET"))
    if deck.radius is None:
        return beside_coulomb(force, mean_normal(deck, f"{results}.frd"), deck.friction)
    found = pressures(f"{results}.frd")
    at = np.array([math.hypot(x, y) for x, y, _ in deck.slave.values()])
    pressure = np.array([found.get(node, 0.0) for node in deck.slave])
    return beside_hertz(QUARTERS * abs(float(force[2])), deck.radius, deck.modulus(), at, pressure)


def printed_sets(deck):
    """The sets of nodes whose total reactions a deck of generated families prints; none of other decks."""
    names = [parameter(card, "NSET") for card, _ in deck.all("NODEPRINT")]
    return list(dict.fromkeys(names)) if "applied=" in deck.heading else []


def forces(deck, results):
    """The last total reactions of all printed sets, in results that begin with this path."""
    return {name: [float(value) for value in reaction(f"{results}.dat", name)] for name in printed_sets(deck)}


def largest(found):
    return max(abs(value) for force in found.values() for value in force)


def difference(found, wanted):
    """The largest difference of a component of the forces, relative to the largest component of those wanted."""
    off = [abs(a - b) for name in wanted for a, b in zip(found[name], wanted[name])]
    return max(off) / largest(wanted)


def imbalance(found, applied):
    """The largest component of the sum of reactions and loads, relative to the largest component of a reaction."""
    total = np.sum(list(found.values()), axis=0) + applied
    return float(np.abs(total).max()) / largest(found)
