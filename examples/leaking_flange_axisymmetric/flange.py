#!/usr/bin/env python3
"""Writes flange.inp: the section of a ring, 50 to 100 mm in radius and 20 mm high."""

from pathlib import Path

NR, NZ = 40, 6
R, Z = (50.0, 100.0), (0.0, 20.0)


def at(ends, k, n):
    return ends[0] + (ends[1] - ends[0]) * k / n


def node(i, j):
    return 1 + i + (NR + 1) * j


with open(Path(__file__).with_name("flange.inp"), "w", encoding="utf-8") as out:
    print("*NODE, NSET=ALL", file=out)
    for j in range(NZ + 1):
        for i in range(NR + 1):
            print(f"{node(i, j)}, {at(R, i, NR):.6g}, {at(Z, j, NZ):.6g}", file=out)
    print("*ELEMENT, TYPE=CAX4, ELSET=flange", file=out)
    for j in range(NZ):
        for i in range(NR):
            nodes = node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)
            print(f"{1 + i + NR * j}, " + ", ".join(map(str, nodes)), file=out)
