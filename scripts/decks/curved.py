"""Families of curved bodies: rubber seals, gear teeth, balls of quadratic tetrahedra, plane models, and indentation."""

from types import SimpleNamespace

import numpy as np

from decks.blocks import METALS, STICK, metal, near, softest, use
from decks.deck import STEEL, Deck, Step
from decks.mesh import box, dense_in_the_middle, graded, grid, spaced


def draw_rubber(rng):
    """A seal with a round back between a groove and a lid."""
    height = rng.uniform(6.0, 9.0)
    return SimpleNamespace(
        height=height,
        width=height * rng.uniform(1.0, 1.5),
        length=rng.uniform(4.0, 8.0),
        round=height * rng.uniform(0.1, 0.25),
        shear=rng.uniform(0.6, 2.0),
        poisson=rng.uniform(0.48, 0.49),
        friction=rng.choice([0.0, rng.uniform(0.1, 0.3)]),
        stiffness=rng.uniform(20.0, 50.0),
        press=rng.uniform(0.1, 0.16),
        lid=rng.uniform(1.5, 2.5),
        fineness=rng.uniform(0.8, 1.2),
    )


def build_rubber(shape, size):
    deck = Deck("rubber seal with a round back, pressed by a lid", nlgeom=True)
    bulk = 2.0 * shape.shear * (1.0 + shape.poisson) / (3.0 * (1.0 - 2.0 * shape.poisson))
    deck.materials["RUBBER"] = ["*HYPERELASTIC,NEO HOOKE", f"{0.5 * shape.shear:.9g},{2.0 / bulk:.9g}"]
    deck.elastic("STEEL", STEEL)
    contact = shape.stiffness * 3.0 * shape.shear
    law = deck.interaction(contact, shape.friction, STICK * contact)
    h, w, length = shape.height, 0.5 * shape.width, shape.length
    axes = [spaced(-w, w, size), spaced(0.0, length, 1.5 * size), spaced(0.0, h, size)]

    def rounded(at):
        x, y, z = at.T
        return np.stack([x, y, z - shape.round * (x / w) ** 2 * z / h], axis=1)

    seal = deck.add("SEAL", grid("C3D8", axes, rounded), "RUBBER")
    wide, coarse = 1.2 * w, size * shape.fineness
    sizes = (coarse, 1.7 * coarse, 0.5 * shape.lid)
    lid = deck.add("LID", box("C3D8", (-wide, -0.1 * length, h), (wide, 1.1 * length, h + shape.lid), sizes), "STEEL")
    deck.pair(seal.sides(near(2, h)), lid.sides(near(2, h)), law)
    deck.set("HELD", seal.nodes(near(2, 0.0)))
    deck.set("LOADED", lid.nodes(near(2, h + shape.lid)))
    deck.supports = [("HELD", 1, 3), ("LOADED", 1, 2)]
    deck.steps = [Step([("LOADED", 3, -shape.press * h)], increment=0.1)]
    return deck


def draw_gears(rng):
    """Two teeth whose round flanks meet."""
    root, taper = rng.uniform(5.0, 6.5, 2), rng.uniform(2.5, 3.5)
    return SimpleNamespace(
        height=rng.uniform(9.0, 13.0),
        root=root,
        # nearly the same taper on both, so that the flanks meet away from the tips
        tip=root - taper + rng.uniform(-0.1, 0.1, 2),
        bulge=rng.uniform(0.1, 0.25, 2),
        overlap=rng.uniform(0.55, 0.8),
        face=rng.uniform(3.0, 6.0),
        fineness=rng.uniform(0.85, 1.2),
        metals=[metal(rng), metal(rng)],
        friction=rng.uniform(0.02, 0.12),
        stiffness=rng.uniform(20.0, 50.0),
        press=rng.uniform(0.02, 0.05),
    )


def half_width(shape, tooth, height):
    """Half the width of a tooth at a height, relative to its whole height."""
    straight = shape.root[tooth] + (shape.tip[tooth] - shape.root[tooth]) * height
    return straight + 4.0 * shape.bulge[tooth] * height * (1.0 - height)


def build_gears(shape, size):
    deck = Deck("two gear teeth pressed flank to flank")
    use(deck, shape.metals)
    contact = shape.stiffness * softest(shape.metals)
    law = deck.interaction(contact, shape.friction, STICK * contact)
    h = shape.height
    # the second tooth points down, its tip this far from the root of the first one
    start = (1.0 - shape.overlap) * h
    heights = np.linspace(start, h, 2001)
    reach = half_width(shape, 0, heights / h) + half_width(shape, 1, 1.0 - (heights - start) / h)
    apart, meeting = reach.max(), heights[reach.argmax()]

    def tooth(number, along, place):
        axes = [spaced(-1.0, 1.0, size / shape.root[number]), along, spaced(0.0, shape.face, 1.6 * size)]
        return grid("C3D8", axes, place)

    def up(at):
        s, t, z = at.T
        return np.stack([s * half_width(shape, 0, t / h), t, z], axis=1)

    def down(at):
        s, t, z = at.T
        return np.stack([apart - s * half_width(shape, 1, t / h), start + h - t, z], axis=1)

    fine = size * shape.fineness
    along = [two_sided(0.0, meeting, h, 0.6 * size), two_sided(0.0, start + h - meeting, h, 0.6 * fine)]
    first = deck.add("FIRST", tooth(0, along[0], up), shape.metals[0])
    second = deck.add("SECOND", tooth(1, along[1], down), shape.metals[1])
    # the first mesh may have a gap to the second one, where no nodes are at the point of contact
    deck.pair(second.sides(near(0, 1.0)), first.sides(near(0, 1.0)), law)
    deck.set("HELD", first.nodes(near(1, 0.0)))
    deck.set("LOADED", second.nodes(near(1, 0.0)))
    deck.supports = [("HELD", 1, 3), ("LOADED", 2, 3)]
    deck.steps = [Step([("LOADED", 1, -shape.press)], increment=0.25)]
    return deck


def two_sided(start, middle, end, size):
    """Steps that grow from the middle to both ends."""
    left, right = graded(middle, start, size, 2.0), graded(middle, end, size, 2.0)
    return np.concatenate([left[:0:-1], right])


def draw_tet10(rng):
    """A ball's cap on a block."""
    return SimpleNamespace(
        radius=rng.uniform(600.0, 1000.0),
        half=rng.uniform(6.0, 8.0),
        height=rng.uniform(8.0, 12.0),
        turned=rng.uniform(0.0, 0.5 * np.pi),
        fineness=rng.uniform(0.9, 1.15),
        metals=[metal(rng), metal(rng)],
        friction=rng.choice([0.0, rng.uniform(0.1, 0.3)]),
        stiffness=rng.uniform(20.0, 50.0),
        depth=rng.uniform(0.06, 0.09),
    )


def build_tet10(shape, size):
    deck = Deck("cap of a ball on a block, of quadratic tetrahedra")
    use(deck, shape.metals)
    contact = shape.stiffness * softest(shape.metals)
    law = deck.interaction(contact, shape.friction, STICK * contact)
    a, h = shape.half, shape.height
    c, s = np.cos(shape.turned), np.sin(shape.turned)

    def cap(at):
        x, y, z = at.T
        rise = (x**2 + y**2) / (2.0 * shape.radius)
        return np.stack([c * x - s * y, s * x + c * y, z + rise * (1.0 - z / h)], axis=1)

    plan = dense_in_the_middle(-a, a, size, 2.0)
    ball = deck.add("BALL", grid("C3D10", [plan, plan, graded(0.0, h, size, 2.0)], cap), shape.metals[0])
    wide, fine = 1.6 * a, size * shape.fineness
    plan = dense_in_the_middle(-wide, wide, fine, 3.0)
    block = deck.add("BLOCK", grid("C3D10", [plan, plan, graded(0.0, -h, fine, 2.5)[::-1]]), shape.metals[1])
    deck.pair(ball.sides(near(2, 0.0)), block.sides(near(2, 0.0)), law)
    deck.set("HELD", block.nodes(near(2, -h)))
    deck.set("LOADED", ball.nodes(near(2, h)))
    deck.supports = [("HELD", 1, 3), ("LOADED", 1, 2)]
    deck.steps = [Step([("LOADED", 3, -shape.depth)], increment=0.25)]
    return deck


def draw_plane(rng):
    """A punch with a round end on a layer on a block, in the plane."""
    return SimpleNamespace(
        kind=str(rng.choice(["CPS4", "CPE4", "CPE8"])),
        punch=rng.uniform(5.0, 8.0, 2),
        radius=rng.uniform(60.0, 150.0),
        layer=rng.uniform(3.0, 5.0),
        block=rng.uniform(12.0, 18.0),
        wide=rng.uniform(14.0, 20.0),
        thickness=rng.uniform(1.0, 3.0),
        fineness=rng.uniform(0.85, 1.2, 2),
        metals=[metal(rng), metal(rng), metal(rng)],
        friction=rng.uniform(0.1, 0.3),
        stiffness=rng.uniform(20.0, 50.0),
        press=rng.uniform(0.02, 0.05),
        shift=rng.uniform(-0.004, 0.004),
    )


def build_plane(shape, size):
    deck = Deck(f"round punch on a layer on a block, of {shape.kind}")
    use(deck, shape.metals)
    deck.thickness = shape.thickness
    contact = shape.stiffness * softest(shape.metals)
    law = deck.interaction(contact, shape.friction, STICK * contact)
    (half, high), layer, wide = shape.punch, shape.layer, shape.wide

    def rounded(at):
        x, y = at.T
        return np.stack([x, y + x**2 / (2.0 * shape.radius) * (1.0 - y / high)], axis=1)

    axes = [spaced(-half, half, size), spaced(0.0, high, 1.2 * size)]
    punch = deck.add("PUNCH", grid(shape.kind, axes, rounded), shape.metals[0])
    sizes = size * shape.fineness
    middle = deck.add("LAYER", box(shape.kind, (-wide, -layer), (wide, 0.0), sizes[0]), shape.metals[1])
    low = -layer - shape.block
    plan = [spaced(-1.2 * wide, 1.2 * wide, sizes[1]), graded(-layer, low, sizes[1], 2.0)[::-1]]
    block = deck.add("BLOCK", grid(shape.kind, plan), shape.metals[2])
    deck.pair(punch.sides(near(1, 0.0)), middle.sides(near(1, 0.0)), law)
    deck.pair(middle.sides(near(1, -layer)), block.sides(near(1, -layer)), law)
    deck.set("HELD", block.nodes(near(1, low)))
    deck.set("LOADED", punch.nodes(near(1, high)))
    deck.supports = [("HELD", 1, 2)]
    deck.steps = [Step([("LOADED", 1, shape.shift), ("LOADED", 2, -shape.press)], increment=0.25)]
    return deck


def draw_plasticity(rng):
    """A stiff round punch that indents an elastic-plastic block."""
    return SimpleNamespace(
        radius=rng.uniform(120.0, 250.0),
        half=rng.uniform(3.0, 4.0, 2),
        high=rng.uniform(3.0, 5.0),
        block=rng.uniform(10.0, 14.0, 3),
        fineness=rng.uniform(0.9, 1.2),
        metal=metal(rng),
        strength=rng.uniform(1.2e-3, 2.5e-3),
        hardening=rng.uniform(0.01, 0.05),
        friction=rng.choice([0.0, rng.uniform(0.1, 0.2)]),
        stiffness=rng.uniform(20.0, 50.0),
        depth=rng.uniform(0.06, 0.12),
    )


def build_plasticity(shape, size):
    deck = Deck("a round punch indents an elastic-plastic block")
    young, poisson = METALS[shape.metal]
    strength = shape.strength * young
    curve = [(strength, 0.0), (strength * 1.2, 0.01), (strength * 1.2 + shape.hardening * young * 0.2, 0.21)]
    table = [f"{stress:.9g},{strain:.9g}" for stress, strain in curve]
    deck.materials["SOFT"] = ["*ELASTIC", f"{young:.9g},{poisson:.9g}", "*PLASTIC", *table]
    deck.elastic("HARD", (3.0 * STEEL[0], STEEL[1]))
    contact = shape.stiffness * young
    law = deck.interaction(contact, shape.friction, STICK * contact)
    (a, b), high = shape.half, shape.high

    def rounded(at):
        x, y, z = at.T
        rise = (x**2 + y**2) / (2.0 * shape.radius)
        return np.stack([x, y, z + rise * (1.0 - z / high)], axis=1)

    axes = [spaced(-a, a, size), spaced(-b, b, size), spaced(0.0, high, 1.5 * size)]
    punch = deck.add("PUNCH", grid("C3D8", axes, rounded), "HARD")
    long, wide, deep = shape.block
    fine = 0.9 * size * shape.fineness
    plan = [dense_in_the_middle(-0.5 * one, 0.5 * one, fine, 2.5) for one in (long, wide)]
    block = deck.add("BLOCK", grid("C3D8", [*plan, graded(0.0, -deep, fine, 3.0)[::-1]]), "SOFT")
    deck.pair(punch.sides(near(2, 0.0)), block.sides(near(2, 0.0)), law)
    deck.set("HELD", block.nodes(near(2, -deep)))
    deck.set("LOADED", punch.nodes(near(2, high)))
    deck.supports = [("HELD", 1, 3), ("LOADED", 1, 2)]
    deck.steps = [Step([("LOADED", 3, -shape.depth)], increment=0.1)]
    return deck
