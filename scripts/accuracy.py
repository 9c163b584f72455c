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
        self.dof = 3 * sum(len(lines) for _, lines in self.all("NODE"))
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
        nodes, found = self.slave_nodes(), {}
        for _, lines in self.all("NODE"):
            for line in lines:
                number, *at = line.split(",")
                if int(number) in nodes:
                    found[int(number)] = [float(x) for x in at]
        return found

    def slave_nodes(self):
        name = fields(self.all("CONTACTPAIR")[0][1])[0].upper()
        lines = next(lines for card, lines in self.all("SURFACE") if parameter(card, "NAME") == name)
        sides = {}
        for element, side in (line.split(",")[:2] for line in lines):
            sides.setdefault(int(element), []).append(int(side.strip().lstrip("S")) - 1)
        nodes = set()
        for card, lines in self.all("ELEMENT"):
            count, corners = SIDES[parameter(card, "TYPE")]
            numbers = fields(lines)
            for first in range(0, len(numbers), count + 1):
                for side in sides.get(int(numbers[first]), ()):
                    nodes.update(int(numbers[first + 1 + k]) for k in corners[side])
        return nodes


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


def pressures(path):
    """Pressures at nodes, by their numbers, in the last CONTACT table of an .frd file."""
    found, column, inside = {}, None, False
    with open(path, encoding="ascii", errors="replace") as file:
        for line in file:
            if line.startswith(" -4"):
                inside = line.split()[1] == "CONTACT"
                if inside:
                    found, components = {}, []
            elif inside and line.startswith(" -5"):
                components.append(line.split()[1])
                column = components.index("CPRESS") if "CPRESS" in components else None
            elif inside and line.startswith(" -1") and column is not None:
                at = 13 + 12 * column
                found[int(line[3:13])] = float(line[at : at + 12])
    if not found:
        raise ValueError(f"{path} has no table CONTACT with CPRESS")
    return found


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


def errors(deck, results):
    """Errors of the results that begin with this path, by name."""
    along, _, down = (float(abs(one)) for one in reaction(f"{results}.dat", deck.first("NODEPRINT", "NSET")))
    if deck.radius is None:
        return {"force": down, "friction": along / down / deck.friction - 1.0}
    found = pressures(f"{results}.frd")
    at = np.array([math.hypot(x, y) for x, y, _ in deck.slave.values()])
    pressure = np.array([found.get(node, 0.0) for node in deck.slave])
    return beside_hertz(QUARTERS * down, deck.radius, deck.modulus(), at, pressure)
