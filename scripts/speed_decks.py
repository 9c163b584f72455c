#!/usr/bin/env python3
"""Write a CalculiX deck with contact, of one of ten families.

    python scripts/speed_decks.py FAMILY OUT.inp --dof N --seed S

The seed chooses sizes, meshes, materials, friction and loads; the same seed gives the same bodies at every size and the
same file on every machine. The unknowns come as close to N as the steps of the meshes allow. --list names the families.
`ccx` and `signorini run` both solve the decks as they are; compare_speed.py runs them through both.

Needs: numpy. Exit code: 0 written, 2 wrong command line.
"""

import argparse
import pathlib

import numpy as np

from decks import blocks, curved, joints

# how a family draws its bodies from random numbers, and how it builds its deck from them and a size of elements
FAMILIES = {
    "assemblies": (blocks.draw_assembly, blocks.build_assembly),
    "joints": (joints.draw_joint, joints.build_joint),
    "slabs": (blocks.draw_slabs, blocks.build_slabs),
    "plates": (blocks.draw_plates, blocks.build_plates),
    "rubber": (curved.draw_rubber, curved.build_rubber),
    "gears": (curved.draw_gears, curved.build_gears),
    "tet10": (curved.draw_tet10, curved.build_tet10),
    "plane": (curved.draw_plane, curved.build_plane),
    "plasticity": (curved.draw_plasticity, curved.build_plasticity),
    "increments": (blocks.draw_increments, blocks.build_increments),
}
# attempts at a size of elements that gives the unknowns asked for
ATTEMPTS = 12


def make(family, dof, seed):
    """The deck of a family whose unknowns are closest to those asked for."""
    draw, build = FAMILIES[family]
    shape = draw(np.random.default_rng([list(FAMILIES).index(family), seed]))
    best, size, coarse, fine = None, 2.0, None, None
    for _ in range(ATTEMPTS):
        deck = build(shape, size)
        if best is None or abs(deck.dof - dof) < abs(best.dof - dof):
            best = deck
        if deck.dof == dof:
            break
        coarse, fine = (size, fine) if deck.dof < dof else (coarse, size)
        if coarse and fine:
            size = np.sqrt(coarse * fine)
        else:
            size *= np.clip((deck.dof / dof) ** 0.4, 0.5, 2.0)
    best.heading = f"{family}, seed {seed}: {best.heading}"
    return best


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("family", nargs="?", choices=FAMILIES, help="which family")
    parser.add_argument("out", nargs="?", type=pathlib.Path, metavar="OUT.inp", help="the deck to write")
    parser.add_argument("--dof", type=int, default=5000, metavar="N", help="unknowns, about")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="of the random numbers")
    parser.add_argument("--list", action="store_true", help="list the families, and stop")
    args = parser.parse_args()
    if args.list:
        print("\n".join(FAMILIES))
        return
    if args.out is None:
        parser.error("give a family and the deck to write")
    deck = make(args.family, args.dof, args.seed)
    args.out.write_text(deck.text(), encoding="ascii")
    print(f"{args.out}: {deck.dof} unknowns")


if __name__ == "__main__":
    main()
