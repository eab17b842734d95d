#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The flat end of a rod that presses on tissue, computed by finite elements independently of Stylet: axisymmetric, in
CalculiX.

    rod_end.py            prints the stiffness at all distances of rod_end.inc; takes some minutes
    rod_end.py --check    computes three of them and compares them with that table: its test
    rod_end.py --alone    prints stiffness / (E R) in gland alone for two Poisson's ratios
    rod_end.py --shallow  prints the same at other depths below the free surface for the first ratio

A rod of radius 0.635 mm stands in a hole of the same radius, open to a free surface 40 mm above the rod's end; the
hole's wall carries no force. Fat of 2 kPa lies above gland of 30 kPa, both with a Poisson's ratio of 0.45, bonded at a
plane perpendicular to the rod. The end is bonded to the tissue below it and pushed down; force / displacement is the
stiffness. The block is held at its side and bottom, 200 mm away and in a second computation 400 mm away; the compliance
for infinity follows because the effect of the distance is inversely proportional to it. Elements are quadratic (CAX8R),
the smallest 0.3 µm at the edge of the rod's end, where stress is singular; with 0.01 mm there, the result is 2 % too
stiff."""

import pathlib
import re
import sys

from axisymmetric import RADIUS_MM, Mesh, arguments, away, pushed, radii

DEPTH_MM = 40.0  # depth of the rod's end below the free surface
FAT_MPA, GLAND_MPA, POISSON = 2e-3, 30e-3, 0.45
NO_FAT_MM = -1000.0  # places the end so far below the gland's surface that there is no fat
SMALLEST_MM, GROWTH = 3e-4, 0.2
TABLE = pathlib.Path(__file__).parent.parent / "coupling" / "near_field" / "rod_end.inc"


def heights(above_mm, far_mm, depth_mm):
    """Heights of grid lines, with lines along the rod's end, at height 0, and along the interface."""
    interface = -above_mm
    down = away(0.0, -far_mm, SMALLEST_MM, GROWTH, [interface] if interface < 0.0 else [])
    up = away(0.0, depth_mm, SMALLEST_MM, GROWTH, [interface] if 0.0 < interface < depth_mm else [])
    return sorted({*down, *up})


def stiffness(above_mm, far_mm, poisson, depth_mm):
    """Stiffness [N/mm] with the block held far_mm away, from a motion of the rod's end by 10⁻⁶ mm."""
    mesh = Mesh(radii(far_mm, SMALLEST_MM, GROWTH), heights(above_mm, far_mm, depth_mm),
                lambda height: "GLAND" if height < -above_mm else "FAT")
    materials = {"FAT": ["*ELASTIC", f"{FAT_MPA}, {poisson}"], "GLAND": ["*ELASTIC", f"{GLAND_MPA}, {poisson}"]}
    held = ["*BOUNDARY"] + [f"{n}, 1, 2" for n in mesh.rim] + [f"{n}, 1, 1" for n in mesh.axis + mesh.end]
    return pushed(mesh.deck(materials) + held, 1e-6, ["*STEP", "*STATIC, SOLVER=SPOOLES"])[-1][1] / 1e-6


def unbounded(above_mm, poisson=POISSON, depth_mm=DEPTH_MM):
    """Stiffness [N/mm] with the block held infinitely far away."""
    near, far = (1.0 / stiffness(above_mm, far_mm, poisson, depth_mm) for far_mm in (200.0, 400.0))
    return 1.0 / (2.0 * far - near)


def main():
    given = arguments(__doc__, "--check", "--alone", "--shallow")
    if given.alone:
        for poisson in (0.45, 0.49):
            print(f"Poisson's ratio {poisson}: {unbounded(NO_FAT_MM, poisson) / (GLAND_MPA * RADIUS_MM):.3f} E R", flush=True)
        return
    if given.shallow:
        for depth in (1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0):
            over = unbounded(NO_FAT_MM, depth_mm=depth) / (GLAND_MPA * RADIUS_MM)
            print(f"{depth:5.1f} mm below the surface: {over:.3f} E R", flush=True)
        return
    table = [(float(a), float(k)) for a, k in re.findall(r"\{(-?[\d.]+), ([\d.]+)\}", TABLE.read_text(encoding="utf-8"))]
    failed = False
    for above, expected in table:
        if given.check and above not in (1.0, 0.0, -1.0):
            continue
        found = unbounded(above)
        off = abs(found / expected - 1.0)
        failed = failed or off > 0.01
        print(f"{above:6.1f} mm above the gland: {found:.6f} N/mm, table {expected:.6f}, {100 * off:.2f} % apart", flush=True)
    sys.exit(1 if given.check and failed else 0)


if __name__ == "__main__":
    main()
