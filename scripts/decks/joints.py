"""The family of bolted lap joints: plates with holes, bolts that are tightened by cooling, then a pull."""

from types import SimpleNamespace

import numpy as np

from decks.blocks import STICK, metal, near, softest, use
from decks.deck import Deck, Step
from decks.mesh import grid, join, spaced

EXPANSION = 1.2e-5


def draw_joint(rng):
    """One or two bolts through two plates."""
    radius = rng.uniform(3.5, 5.0)
    return SimpleNamespace(
        bolts=int(rng.integers(1, 3)),
        radius=radius,
        hole=radius + rng.uniform(0.4, 0.7),
        head=radius * rng.uniform(1.6, 1.8),
        head_height=radius * rng.uniform(0.7, 0.9),
        pitch=radius * rng.uniform(4.5, 5.5),
        thick=rng.uniform(5.0, 8.0, 2),
        free=rng.uniform(8.0, 16.0),
        metals=[metal(rng), metal(rng)],
        friction=rng.uniform(0.15, 0.35),
        stiffness=rng.uniform(20.0, 50.0),
        strain=rng.uniform(0.8e-3, 1.4e-3),
        pull=rng.uniform(0.004, 0.008),
    )


def ring(inner, outer, around, across, heights, middle):
    """Between two closed curves, which are given as functions of the angle."""

    def place(at):
        angle, s, z = at.T
        inside, outside = inner(angle), outer(angle)
        plan = inside + s[:, None] * (outside - inside)
        return np.column_stack([plan + middle, z])

    # the angle runs clockwise, for right-handed cells
    axes = [np.linspace(2.25 * np.pi, 0.25 * np.pi, 4 * around + 1), np.linspace(0.0, 1.0, across + 1), heights]
    return grid("C3D8", axes, place)


def circle(radius):
    return lambda angle: radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def square(half):
    """The boundary of a square, with even steps on its sides for even steps of the angle."""

    def at(angle):
        side, part = np.divmod(angle / (0.5 * np.pi) - 0.5 + 1e-9, 1.0)
        along = half * (2.0 * (part - 1e-9) - 1.0)
        turn = side.astype(int) % 4
        x = np.choose(turn, [-along, np.full_like(along, -half), along, np.full_like(along, half)])
        y = np.choose(turn, [np.full_like(along, half), -along, np.full_like(along, -half), along])
        return np.stack([x, y], axis=1)

    return at


def disk(radius, around, across, heights, middle):
    """A core and a ring around it."""
    core = 0.5 * radius
    axis = np.linspace(-core, core, around + 1)
    inside = grid("C3D8", [axis + middle[0], axis + middle[1], heights])
    return [inside, ring(square(core), circle(radius), around, across, heights, middle)]


def plate(shape, around, across, heights, toward):
    """A plate with a hole for each bolt and a free end along x."""
    half = 0.5 * shape.pitch
    parts = []
    for number in range(shape.bolts):
        middle = np.array([0.0, number * shape.pitch])
        parts.append(ring(circle(shape.hole), square(half), around, across, heights, middle))
    wide = [-half, (shape.bolts - 0.5) * shape.pitch]
    size = shape.pitch / around
    end = half + shape.free
    along = spaced(half, end, size) if toward > 0 else spaced(-end, -half, size)
    parts.append(grid("C3D8", [along, np.linspace(*wide, shape.bolts * around + 1), heights]))
    return join(parts)


def bolt(shape, around, low, high, size, middle):
    """A shank between two heads."""
    steps = max(1, round((shape.head - shape.radius) / size))
    across = max(2, round(0.5 * shape.radius / size))
    levels = [low - shape.head_height, low, high, high + shape.head_height]
    parts = []
    for number, (start, end) in enumerate(zip(levels, levels[1:])):
        heights = spaced(start, end, size)
        parts += disk(shape.radius, around, across, heights, middle)
        if number != 1:
            parts.append(ring(circle(shape.radius), circle(shape.head), around, steps, heights, middle))
    return join(parts)


def build_joint(shape, size):
    deck = Deck(f"lap joint with {shape.bolts} bolts, tightened by cooling and pulled")
    use(deck, [*shape.metals, "STEEL"])
    for name in deck.materials:
        deck.materials[name] += ["*EXPANSION", f"{EXPANSION:.9g}"]
    contact = shape.stiffness * softest([*shape.metals, "STEEL"])
    law = deck.interaction(contact, shape.friction, STICK * contact)
    lower, upper = shape.thick
    half = 0.5 * shape.pitch
    count = [max(2, round(shape.pitch / (size * factor))) for factor in (1.0, 1.15, 1.4)]
    across = [max(2, round((half - shape.hole) / (size * factor))) for factor in (1.0, 1.15)]
    meshes = [
        plate(shape, count[0], across[0], spaced(-lower, 0.0, size), -1),
        plate(shape, count[1], across[1], spaced(0.0, upper, 1.1 * size), 1),
    ]
    below = deck.add("LOWER", meshes[0], shape.metals[0])
    above = deck.add("UPPER", meshes[1], shape.metals[1])
    deck.pair(above.sides(near(2, 0.0)), below.sides(near(2, 0.0)), law)
    bolts = []
    for number in range(shape.bolts):
        middle = np.array([0.0, number * shape.pitch])
        mesh = bolt(shape, count[2], -lower, upper, size, middle)
        part = deck.add(f"BOLT{number}", mesh, "STEEL")
        deck.pair(part.sides(near(2, upper)), above.sides(near(2, upper)), law)
        deck.pair(part.sides(near(2, -lower)), below.sides(near(2, -lower)), law)
        bolts.append(part.name)
    end = half + shape.free
    deck.set("HELD", below.nodes(near(0, -end)))
    deck.set("PULLED", above.nodes(near(0, end)))
    deck.supports = [("HELD", 1, 3), ("PULLED", 2, 3)]
    cold = [(name, -shape.strain / EXPANSION) for name in bolts]
    deck.steps = [
        Step([("PULLED", 1, 0.0)], temperatures=cold, increment=0.25),
        Step([("PULLED", 1, shape.pull)], temperatures=cold, increment=0.25),
    ]
    return deck
