#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The flat end of a rod that presses on tissue, by finite elements that know nothing of Stylet: axisymmetric, in CalculiX.

    python3 tests/reference/rod_end.py            prints the stiffness at all distances of rod_end.inc, some minutes
    python3 tests/reference/rod_end.py --check    computes three of them and compares: the test of that table
    python3 tests/reference/rod_end.py --alone    stiffness in gland alone over E R, for two of Poisson's ratios
    python3 tests/reference/rod_end.py --shallow  the same at other depths below the free surface, for the first of them

A rod of radius 0.635 mm stands in a hole of its own radius, open to a free surface 40 mm above its end; the hole's wall bears
nothing. Fat of 2 kPa lies above gland of 30 kPa, with Poisson's ratio 0.45, bonded at a plane square to the rod. The end is
bonded to the tissue below it and pushed down; the force that this takes per millimetre is the stiffness. The block is held at
its side and bottom, 200 mm away, and once more at 400 mm: what the distance takes off the compliance falls as its inverse.
Quadratic elements (CAX8R), the smallest 0.3 µm, at the edge of the rod's end, where stress is singular: 0.01 mm there is 2 % too stiff."""

import argparse
import pathlib
import re
import subprocess
import sys
import tempfile

RADIUS_MM = 0.635
DEPTH_MM = 40.0  # of the rod's end below the free surface
FAT_MPA, GLAND_MPA, POISSON = 2e-3, 30e-3, 0.45
NO_FAT_MM = -1000.0  # the end is so far below the gland's surface that there is no fat
SMALLEST_MM, GROWTH = 3e-4, 0.2
TABLE = pathlib.Path(__file__).parent.parent / "coupling" / "near_field" / "rod_end.inc"


def away(start, end, stops=()):
    """Points from start to end, further apart the further from start; all of stops are among them."""
    points = [start]
    direction = 1.0 if end > start else -1.0
    for stop in sorted([*stops, end], key=lambda s: direction * s):
        here = points[-1]
        pieces = [0.0]
        while pieces[-1] < abs(stop - here):
            pieces.append(pieces[-1] + SMALLEST_MM + GROWTH * (abs(here - start) + pieces[-1]))
        if len(pieces) > 2 and pieces[-1] - abs(stop - here) > 0.5 * (pieces[-1] - pieces[-2]):
            pieces.pop()
        scale = abs(stop - here) / pieces[-1]
        points += [here + direction * scale * p for p in pieces[1:]]
    return points


def grid(above_mm, far_mm, depth_mm):
    """Radii and heights of a grid with lines along the rod's wall, its end at height 0 and the interface."""
    radii = sorted({*away(RADIUS_MM, 0.0), *away(RADIUS_MM, far_mm)})
    interface = -above_mm
    stops = [interface] if interface < 0.0 else []
    down = away(0.0, -far_mm, stops)
    up = away(0.0, depth_mm, [interface] if 0.0 < interface < depth_mm else [])
    return radii, sorted({*down, *up})


def model(above_mm, far_mm, poisson, depth_mm):
    """The input of CalculiX: the rod's end goes down by a millionth of a millimetre."""
    radii, heights = grid(above_mm, far_mm, depth_mm)
    number = {}

    def node(i, j):  # twice the grid's indices: middle nodes are odd
        return number.setdefault((i, j), len(number) + 1)

    elements = {"FAT": [], "GLAND": []}
    for i in range(len(radii) - 1):
        for j in range(len(heights) - 1):
            middle = 0.5 * (heights[j] + heights[j + 1])
            if radii[i] < RADIUS_MM and middle > 0.0:
                continue  # the hole
            a, b = 2 * i, 2 * j
            corners = [(a, b), (a + 2, b), (a + 2, b + 2), (a, b + 2), (a + 1, b), (a + 2, b + 1), (a + 1, b + 2), (a, b + 1)]
            elements["GLAND" if middle < -above_mm else "FAT"].append([node(*at) for at in corners])

    def place(values, k):
        return values[k // 2] if k % 2 == 0 else 0.5 * (values[k // 2] + values[k // 2 + 1])

    lines = ["*NODE"]
    end, held, axis = [], [], []
    for (i, j), n in number.items():
        r, z = place(radii, i), place(heights, j)
        lines.append(f"{n}, {r:.12g}, {z:.12g}, 0")
        if i == 2 * (len(radii) - 1) or j == 0:
            held.append(n)
        elif j == 2 * heights.index(0.0) and r <= RADIUS_MM:
            end.append(n)
        elif i == 0:
            axis.append(n)
    count = 0
    for material, of_it in elements.items():
        if not of_it:
            continue
        lines.append(f"*ELEMENT, TYPE=CAX8R, ELSET={material}")
        for nodes in of_it:
            count += 1
            lines.append(", ".join(map(str, [count, *nodes])))
        young = FAT_MPA if material == "FAT" else GLAND_MPA
        lines += [f"*MATERIAL, NAME={material}", "*ELASTIC", f"{young}, {poisson}", f"*SOLID SECTION, ELSET={material}, MATERIAL={material}"]
    lines.append("*NSET, NSET=END")
    lines += [f"{n}," for n in end]
    lines += ["*STEP", "*STATIC, SOLVER=SPOOLES", "*BOUNDARY"]
    lines += [f"{n}, 1, 2" for n in held] + [f"{n}, 1, 1" for n in axis + end] + [f"{n}, 2, 2, -1e-6" for n in end]
    lines += ["*NODE PRINT, NSET=END, TOTALS=ONLY", "RF", "*END STEP"]
    return "\n".join(lines) + "\n"


def stiffness(above_mm, far_mm, poisson, depth_mm):
    """[N/mm] with the block held `far_mm` away."""
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "rod.inp").write_text(model(above_mm, far_mm, poisson, depth_mm), encoding="utf-8")
        done = subprocess.run(["ccx", "-i", "rod"], cwd=folder, capture_output=True, text=True, check=False)
        printed = pathlib.Path(folder, "rod.dat")
        if done.returncode != 0 or not printed.exists():
            sys.exit("CalculiX failed:\n" + done.stdout[-2000:] + done.stderr[-2000:])
        numbers = re.findall(r"[-+]?\d+\.\d+E[-+]\d+", printed.read_text(encoding="utf-8"))
        # CalculiX computes a wedge of two degrees.
        return abs(float(numbers[-2])) / 1e-6 * 180.0


def unbounded(above_mm, poisson=POISSON, depth_mm=DEPTH_MM):
    """[N/mm] with the block held infinitely far away."""
    near, far = (1.0 / stiffness(above_mm, far_mm, poisson, depth_mm) for far_mm in (200.0, 400.0))
    return 1.0 / (2.0 * far - near)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--alone", action="store_true")
    parser.add_argument("--shallow", action="store_true")
    arguments = parser.parse_args()
    if arguments.alone:
        for poisson in (0.45, 0.49):
            print(f"Poisson's ratio {poisson}: {unbounded(NO_FAT_MM, poisson) / (GLAND_MPA * RADIUS_MM):.3f} E R", flush=True)
        return
    if arguments.shallow:
        for depth in (1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0):
            over = unbounded(NO_FAT_MM, depth_mm=depth) / (GLAND_MPA * RADIUS_MM)
            print(f"{depth:5.1f} mm below the surface: {over:.3f} E R", flush=True)
        return
    table = [(float(a), float(k)) for a, k in re.findall(r"\{(-?[\d.]+), ([\d.]+)\}", TABLE.read_text(encoding="utf-8"))]
    failed = False
    for above, expected in table:
        if arguments.check and above not in (1.0, 0.0, -1.0):
            continue
        found = unbounded(above)
        off = abs(found / expected - 1.0)
        failed = failed or off > 0.01
        print(f"{above:6.1f} mm above the gland: {found:.6f} N/mm, table {expected:.6f}, {100 * off:.2f} % apart", flush=True)
    sys.exit(1 if arguments.check and failed else 0)


if __name__ == "__main__":
    main()
