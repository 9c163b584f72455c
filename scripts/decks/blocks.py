"""Families of flat bodies that press on one another: assemblies, slabs, plates, and a block that slides."""

from types import SimpleNamespace

import numpy as np

from decks.deck import ALUMINIUM, BRONZE, STEEL, Deck, Step
from decks.mesh import box, broken, grid

METALS = {"STEEL": STEEL, "ALUMINIUM": ALUMINIUM, "BRONZE": BRONZE}
# steepness of sticking, relative to the contact stiffness
STICK = 0.1


def near(axis, value):
    """The condition that a coordinate has a value."""
    return lambda *at: abs(at[axis] - value) < 1e-6


def metal(rng):
    return list(METALS)[rng.integers(len(METALS))]


def use(deck, names):
    """Defines these metals."""
    for name in sorted(set(names)):
        deck.elastic(name, METALS[name])


def softest(names):
    return min(METALS[name][0] for name in names)


def draw_assembly(rng):
    """Columns of blocks between a base and a lid."""
    columns, rows = int(rng.integers(2, 4)), int(rng.integers(1, 3))
    count = columns * rows
    levels = int(rng.integers(1, 3))
    height = rng.uniform(12.0, 20.0)
    parts = rng.dirichlet(np.full(levels, 8.0), size=count) * height
    return SimpleNamespace(
        columns=columns,
        rows=rows,
        levels=levels,
        height=height,
        parts=parts,
        pitch=rng.uniform(18.0, 26.0),
        thick=rng.uniform(5.0, 9.0, 2),
        half=rng.uniform(4.5, 7.5, (count, levels, 2)),
        metals=[[metal(rng) for _ in range(levels)] for _ in range(count)],
        ends=[metal(rng), metal(rng)],
        fineness=rng.uniform(0.8, 1.2, (count, levels)),
        friction=rng.uniform(0.1, 0.4),
        stiffness=rng.uniform(20.0, 50.0),
        press=rng.uniform(1e-3, 2e-3),
        shift=rng.uniform(-3e-4, 3e-4, 2),
    )


def build_assembly(shape, size):
    deck = Deck("columns of blocks between a base and a lid, pressed and sheared")
    names = [*shape.ends, *(name for column in shape.metals for name in column)]
    use(deck, names)
    contact = shape.stiffness * softest(names)
    law = deck.interaction(contact, shape.friction, STICK * contact)
    wide, deep = shape.columns * shape.pitch, shape.rows * shape.pitch
    top = shape.height + shape.thick[1]
    base = deck.add("BASE", box("C3D8", (0, 0, -shape.thick[0]), (wide, deep, 0), 1.1 * size), shape.ends[0])
    lid = deck.add("LID", box("C3D8", (0, 0, shape.height), (wide, deep, top), 1.2 * size), shape.ends[1])
    for column, heights in enumerate(shape.parts):
        x, y = (np.array(divmod(column, shape.rows)) + 0.5) * shape.pitch
        below, z = base, 0.0
        for level, height in enumerate(heights):
            a, b = shape.half[column, level]
            end = shape.height if level + 1 == shape.levels else z + height
            mesh = box("C3D8", (x - a, y - b, z), (x + a, y + b, end), size * shape.fineness[column, level])
            part = deck.add(f"B{column}L{level}", mesh, shape.metals[column][level])
            deck.pair(part.sides(near(2, z)), below.sides(near(2, z)), law)
            below, z = part, end
        deck.pair(below.sides(near(2, z)), lid.sides(near(2, z)), law)
    deck.set("HELD", base.nodes(near(2, -shape.thick[0])))
    deck.set("LOADED", lid.nodes(near(2, top)))
    deck.supports = [("HELD", 1, 3)]
    moves = [("LOADED", 1, shape.shift[0]), ("LOADED", 2, shape.shift[1]), ("LOADED", 3, -shape.press * top)]
    deck.steps = [Step(moves, increment=0.5)]
    return deck


def draw_slabs(rng):
    """A stack of slabs, pressed by a pad."""
    count = int(rng.integers(4, 8))
    return SimpleNamespace(
        count=count,
        plan=rng.uniform(35.0, 50.0, 2),
        thick=rng.uniform(2.0, 4.0, count),
        inset=np.cumsum(rng.uniform(0.2, 1.2, count)),
        metals=[metal(rng) for _ in range(count)],
        fineness=rng.uniform(0.85, 1.2, (count, 2)),
        pad=rng.uniform(0.5, 0.75, 2),
        friction=rng.uniform(0.15, 0.4),
        stiffness=rng.uniform(20.0, 50.0),
        press=rng.uniform(1.5e-3, 3e-3),
    )


def build_slabs(shape, size):
    deck = Deck(f"stack of {shape.count} slabs, two elements thick, pressed by a pad")
    use(deck, shape.metals)
    contact = shape.stiffness * softest(shape.metals)
    law = deck.interaction(contact, shape.friction, STICK * contact)
    z, below = 0.0, None
    for number, thick in enumerate(shape.thick):
        # the last one is the pad
        pad = number + 1 == shape.count
        low = 0.5 * (1.0 - shape.pad) * shape.plan if pad else np.full(2, shape.inset[number])
        high = shape.plan - low
        sizes = (*(size * shape.fineness[number]), 0.5 * thick)
        part = deck.add(f"L{number}", box("C3D8", (*low, z), (*high, z + thick), sizes), shape.metals[number])
        if below is None:
            deck.set("HELD", part.nodes(near(2, 0.0)))
        else:
            deck.pair(part.sides(near(2, z)), below.sides(near(2, z)), law)
        below, z = part, z + thick
    deck.set("LOADED", below.nodes(near(2, z)))
    deck.supports = [("HELD", 1, 3), ("LOADED", 1, 2)]
    deck.steps = [Step([("LOADED", 3, -shape.press * z)], increment=0.5)]
    return deck


def draw_plates(rng):
    """A thin plate on another one, both clamped, under a pressure."""
    slender = np.clip(rng.uniform(50.0, 200.0) * rng.uniform(0.8, 1.25, 2), 50.0, 200.0)
    length = rng.uniform(80.0, 140.0)
    return SimpleNamespace(
        length=length,
        width=length * rng.uniform(0.5, 0.9),
        thick=length / slender,
        fineness=rng.uniform(0.9, 1.15),
        inset=rng.uniform(0.05, 0.15),
        patch=rng.uniform(0.2, 0.35, 2),
        metals=[metal(rng), metal(rng)],
        stiffness=rng.uniform(2e-4, 4e-4),
        sag=rng.uniform(0.2, 0.6),
    )


def build_plates(shape, size):
    deck = Deck("thin plates over one another under a pressure")
    use(deck, shape.metals)
    # soft, since a stiffer penalty on facets that do not match keeps thin plates from bending
    law = deck.interaction(shape.stiffness * softest(shape.metals))
    length, width, (lower, upper) = shape.length, shape.width, shape.thick
    inset = shape.inset * width
    middle, reach = np.array([0.5 * length, 0.5 * width]), shape.patch * (length, width)
    mesh = box("C3D8I", (0, 0, -lower), (length, width, 0), (size, size, 0.5 * lower))
    below = deck.add("LOWER", mesh, shape.metals[0])
    fine = size * shape.fineness
    ends = [(0.0, length), (inset, width - inset)]
    plan = [
        broken([start, at - half, at + half, end], fine) for (start, end), at, half in zip(ends, middle, reach)
    ]
    above = deck.add("UPPER", grid("C3D8I", [*plan, np.linspace(0.0, upper, 3)]), shape.metals[1])
    deck.pair(above.sides(near(2, 0.0)), below.sides(near(2, 0.0)), law)
    deck.set("LOWERENDS", below.nodes(lambda x, y, z: (x < 1e-6) | (x > length - 1e-6)))
    deck.set("UPPERENDS", above.nodes(lambda x, y, z: (x < 1e-6) | (x > length - 1e-6)))
    deck.supports = [("LOWERENDS", 1, 3), ("UPPERENDS", 1, 3)]

    def pressed(x, y, z):
        inside = (abs(x - middle[0]) < reach[0] + 1e-6) & (abs(y - middle[1]) < reach[1] + 1e-6)
        return near(2, upper)(x, y, z) & inside

    deck.surface("PRESSED", above.sides(pressed))
    # both bend as beams clamped at their ends, which sag by F l^3 / (192 E I) under a force in the middle
    stiff = sum(192.0 * METALS[name][0] * width * thick**3 / 12.0 for name, thick in zip(shape.metals, shape.thick))
    force = stiff / length**3 * shape.sag * min(shape.thick)
    deck.applied = np.array([0.0, 0.0, -force])
    deck.steps = [Step([], pressures=[("PRESSED", force / (4.0 * reach.prod()))], increment=0.5)]
    return deck


def draw_increments(rng):
    """A block that is pressed on another one and slides, in fifty increments."""
    return SimpleNamespace(
        plan=rng.uniform(8.0, 12.0, 2),
        height=rng.uniform(5.0, 8.0),
        margin=rng.uniform(4.0, 6.0),
        metals=[metal(rng), metal(rng)],
        fineness=rng.uniform(0.85, 1.15),
        friction=rng.uniform(0.1, 0.35),
        stiffness=rng.uniform(20.0, 50.0),
        press=rng.uniform(1e-3, 2e-3),
        path=rng.uniform(0.8, 2.0),
        angle=rng.uniform(-0.4, 0.4),
    )


def build_increments(shape, size):
    deck = Deck("a block slides on another one in fifty increments", nlgeom=True)
    use(deck, shape.metals)
    contact = shape.stiffness * softest(shape.metals)
    law = deck.interaction(contact, shape.friction, STICK * contact)
    (a, b), h, m = shape.plan, shape.height, shape.margin
    track = deck.add("TRACK", box("C3D8", (-m, -m, -h), (a + m, b + m, 0), 1.3 * size), shape.metals[0])
    mesh = box("C3D8", (0, 0, 0), (a, b, h), size * shape.fineness)
    slider = deck.add("SLIDER", mesh, shape.metals[1])
    deck.pair(slider.sides(near(2, 0.0)), track.sides(near(2, 0.0)), law)
    deck.set("HELD", track.nodes(near(2, -h)))
    deck.set("LOADED", slider.nodes(near(2, h)))
    deck.supports = [("HELD", 1, 3)]
    down = -shape.press * 2.0 * h
    along = shape.path * np.array([np.cos(shape.angle), np.sin(shape.angle)])
    deck.steps = [
        Step([("LOADED", 1, 0.0), ("LOADED", 2, 0.0), ("LOADED", 3, down)], increment=0.5),
        Step([("LOADED", 1, along[0]), ("LOADED", 2, along[1]), ("LOADED", 3, down)], increment=0.02, fixed=True),
    ]
    return deck
