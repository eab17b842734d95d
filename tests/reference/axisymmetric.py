# SPDX-License-Identifier: GPL-3.0-or-later
"""Axisymmetric finite elements in CalculiX around a rod in tissue: common part of the models in this folder.
Lengths are in mm, forces in N, moduli in MPa. The rod's axis is r = 0 and its end is at height 0."""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

RADIUS_MM = 0.635  # radius of the rod
SKIPPED = 77  # exit status that ctest takes for a skipped test


def arguments(description, *flags):
    """The arguments of a program that has these flags and no other arguments."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    for flag in flags:
        parser.add_argument(flag, action="store_true")
    return parser.parse_args()


def away(start, end, smallest, growth, stops=()):
    """Points from start to end with spacings that grow with the distance from start. They include all of `stops`."""
    points = [start]
    direction = 1.0 if end > start else -1.0
    for stop in sorted([*stops, end], key=lambda s: direction * s):
        here = points[-1]
        pieces = [0.0]
        while pieces[-1] < abs(stop - here):
            pieces.append(pieces[-1] + smallest + growth * (abs(here - start) + pieces[-1]))
        if len(pieces) > 2 and pieces[-1] - abs(stop - here) > 0.5 * (pieces[-1] - pieces[-2]):
            pieces.pop()
        scale = abs(stop - here) / pieces[-1]
        points += [here + direction * scale * p for p in pieces[1:]]
    return points


def radii(far_mm, smallest, growth, stops=()):
    """Radii of grid lines, one of which runs along the rod's wall."""
    return sorted({*away(RADIUS_MM, 0.0, smallest, growth), *away(RADIUS_MM, far_mm, smallest, growth, stops)})


class Mesh:
    """A grid of quadratic elements (CAX8R) without the rod and its hole above height 0."""

    def __init__(self, radii, heights, material_at):
        """material_at: name of the material at a height."""
        self.radii, self.heights = radii, heights
        self.number = {}  # node number by twice the grid indices; odd indices are middle nodes
        self.elements = {}  # material → nodes of each element
        for i in range(len(radii) - 1):
            for j in range(len(heights) - 1):
                middle = 0.5 * (heights[j] + heights[j + 1])
                if radii[i] < RADIUS_MM and middle > 0.0:
                    continue
                a, b = 2 * i, 2 * j
                corners = [(a, b), (a + 2, b), (a + 2, b + 2), (a, b + 2), (a + 1, b), (a + 2, b + 1), (a + 1, b + 2), (a, b + 1)]
                nodes = [self.number.setdefault(at, len(self.number) + 1) for at in corners]
                self.elements.setdefault(material_at(middle), []).append(nodes)
        self.end, self.wall, self.axis, self.rim, self.top = [], [], [], [], []  # rim: outer side and bottom
        at_end, at_wall = 2 * heights.index(0.0), 2 * radii.index(RADIUS_MM)
        for (i, j), n in self.number.items():
            if i == 2 * (len(radii) - 1) or j == 0:
                self.rim.append(n)
            elif j == at_end and i <= at_wall:
                self.end.append(n)
            elif j == 2 * (len(heights) - 1):
                self.top.append(n)
            elif i == 0:
                self.axis.append(n)
            elif j > at_end and i == at_wall:
                self.wall.append(n)

    def deck(self, materials):
        """Lines of CalculiX's input with nodes, elements and materials. materials: name → lines after the name."""

        def place(values, k):
            return values[k // 2] if k % 2 == 0 else 0.5 * (values[k // 2] + values[k // 2 + 1])

        lines = ["*NODE"]
        lines += [f"{n}, {place(self.radii, i):.12g}, {place(self.heights, j):.12g}, 0" for (i, j), n in self.number.items()]
        count = 0
        for name, of_it in self.elements.items():
            lines.append(f"*ELEMENT, TYPE=CAX8R, ELSET={name}")
            for nodes in of_it:
                count += 1
                lines.append(", ".join(map(str, [count, *nodes])))
            lines += [f"*MATERIAL, NAME={name}", *materials[name], f"*SOLID SECTION, ELSET={name}, MATERIAL={name}"]
        return lines + ["*NSET, NSET=END", *(f"{n}," for n in self.end)]


def pushed(lines, way_mm, step):
    """Moves the set END down by way_mm in a step whose first lines are given. Returns [(share of the step, force on END
    in N)], as far as CalculiX gets."""
    if shutil.which("ccx") is None:
        print("skipped: the program ccx (CalculiX) is not installed")
        sys.exit(SKIPPED)
    lines = [*lines, *step, "*BOUNDARY", f"END, 2, 2, {-way_mm!r}", "*NODE PRINT, NSET=END, TOTALS=ONLY", "RF", "*END STEP", ""]
    with tempfile.TemporaryDirectory() as folder:
        pathlib.Path(folder, "rod.inp").write_text("\n".join(lines), encoding="utf-8")
        done = subprocess.run(["ccx", "-i", "rod"], cwd=folder, capture_output=True, text=True, check=False,
                              env={**os.environ, "OMP_NUM_THREADS": "1"})
        printed = pathlib.Path(folder, "rod.dat")
        text = printed.read_text(encoding="utf-8") if printed.exists() else ""
    found = re.findall(r"for set END and time\s+(\S+)\s+\S+\s+(\S+)\s+\S+\s", text)
    if not found:
        sys.exit("CalculiX failed:\n" + done.stdout[-2000:] + done.stderr[-2000:])
    # CalculiX gives the force on a wedge of two degrees.
    return [(float(share), -180.0 * float(force)) for share, force in found]


def material(solid, young_MPa, poisson):
    """Lines of a material: linear, neo-Hookean, or Yeoh's solid with C20 = C10. The last two have C10 = μ/2 and
    D1 = 2/K."""
    c10 = 0.25 * young_MPa / (1.0 + poisson)
    d1 = 6.0 * (1.0 - 2.0 * poisson) / young_MPa
    none = 1e12  # switches off the higher volumetric terms
    return {"linear": ["*ELASTIC", f"{young_MPa}, {poisson}"],
            "neo-hooke": ["*HYPERELASTIC, NEO HOOKE", f"{c10}, {d1}"],
            "yeoh": ["*HYPERELASTIC, YEOH", f"{c10}, {c10}, 0, {d1}, {none}, {none}"]}[solid]
