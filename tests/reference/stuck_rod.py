#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A rigid rod that sticks to the tissue along its shaft and is moved along its axis, computed by finite elements
independently of Stylet: axisymmetric, in CalculiX.

    stuck_rod.py            prints the stiffness of all rods of stuck_rod.inc and compares it with that table
    stuck_rod.py --check    computes the rods of one length and compares them: the test of that table
    stuck_rod.py --finer    does the same with elements that are ten times smaller at the edges

A rod of radius 0.635 mm stands in a hole of the same radius in a cylinder of tissue of 30 kPa, 100 mm wide and 100 mm
high, whose side and bottom are held and whose top is free. There are four models of each rod. The tissue is bonded to
the shaft up to the rod's end, or only up to three radii behind it and slides without friction beyond that; the rod's
flat end is bonded to the tissue, or does not touch it. Force / displacement along the axis is the stiffness. Elements
are quadratic (CAX8R), the smallest at the ends of bonded parts, where stress is singular."""

import pathlib
import re
import sys

from axisymmetric import RADIUS_MM, Mesh, arguments, away, pushed, radii

YOUNG_MPA = 30e-3
SIDE_MM, HEIGHT_MM = 50.0, 100.0
SLIDES_MM = 3.0 * RADIUS_MM
GROWTH = 0.3
WAY_MM = 1e-6
TABLE = pathlib.Path(__file__).parent.parent / "coupling" / "near_field" / "stuck_rod.inc"


def heights(length_mm, smallest):
    """Heights of grid lines, fine at the rod's end, where the bonded shaft begins, and at the top of the tissue."""
    places = [0.0, SLIDES_MM, length_mm]
    points = {*away(0.0, length_mm - HEIGHT_MM, smallest, GROWTH)}
    for low, high in zip(places, places[1:]):
        middle = 0.5 * (low + high)
        points |= {*away(low, middle, smallest, GROWTH), *away(high, middle, smallest, GROWTH)}
    return sorted(points)


def stiffness(poisson, length_mm, bonded_from_mm, end_bonded, smallest):
    """Stiffness [N/mm]. bonded_from_mm: height above the rod's end from which the shaft is bonded."""
    mesh = Mesh(radii(SIDE_MM, smallest, GROWTH), heights(length_mm, smallest), lambda height: "TISSUE")
    at_wall, at_end, from_here = 2 * mesh.radii.index(RADIUS_MM), 2 * mesh.heights.index(0.0), 2 * mesh.heights.index(bonded_from_mm)
    wall = {n for (i, j), n in mesh.number.items() if i == at_wall and j >= at_end}
    shaft = {n for (i, j), n in mesh.number.items() if i == at_wall and j >= from_here}
    moved = sorted({*shaft, *(mesh.end if end_bonded else [])})
    mesh.end = moved
    across = sorted({*mesh.axis, *wall, *moved})
    lines = mesh.deck({"TISSUE": ["*ELASTIC", f"{YOUNG_MPA}, {poisson}"]})
    lines += ["*BOUNDARY"] + [f"{n}, 1, 2" for n in mesh.rim] + [f"{n}, 1, 1" for n in across]
    return pushed(lines, WAY_MM, ["*STEP", "*STATIC, SOLVER=SPOOLES"])[-1][1] / WAY_MM


def main():
    given = arguments(__doc__, "--check", "--finer")
    rows = re.findall(r"\{([\d.]+), ([\d.]+), ([\d.]+), ([\d.]+), ([\d.]+), ([\d.]+)\}", TABLE.read_text(encoding="utf-8"))
    failed = False
    for row in rows:
        poisson, length, *expected = map(float, row)
        if given.check and length != 40.0:
            continue
        found = [stiffness(poisson, length, bonded_from, end, 1e-3 if given.finer else 1e-2)
                 for bonded_from in (0.0, SLIDES_MM) for end in (True, False)]
        off = max(abs(f / e - 1.0) for f, e in zip(found, expected))
        failed = failed or off > 0.003
        numbers = ", ".join(f"{f:.4f}" for f in found)
        print(f"{{{poisson:g}, {length:g}, {numbers}}} N/mm, at most {100 * off:.2f} % from the table", flush=True)
    sys.exit(1 if given.check and failed else 0)


if __name__ == "__main__":
    main()
