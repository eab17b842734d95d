#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A rod pressed millimetres deep into hyperelastic tissue, computed by finite elements independently of Stylet.

    hyperelastic_punch.py           prints all curves and the fits to them; takes 15 minutes
    hyperelastic_punch.py --write   also writes the table hyperelastic_punch.inc
    hyperelastic_punch.py --check   compares the first millimetre and a half of one curve with that table: its test

The flat end of a rod of radius 0.635 mm is bonded to tissue of 30 kPa and pushed on. *Inside*, it stands in a hole of
the same radius in a medium that is held 60 mm away on all sides; the hole's wall slides along the rod without friction.
*On the surface* there is no hole: the end presses on the face of a half space. The held sides reduce the far field by a
linear displacement, which is found with two linear models and added again. The tissue is neo-Hookean, or Yeoh's solid
with C20 = C10; both have C10 = μ/2 and D1 = 2/K. CalculiX continues until an element at the edge of the end collapses,
or to 6 mm.

Output: the force at some depths z; k1/(E R), k2/E and misfit (root mean square / largest force) of F = k1 z + k2 z²;
the same for the dent s in place of z; and once more for s with k1 taken from the linear model on the same grid. The
dent s is z minus the displacement of linear tissue under the same force spread over 10 mm, F (5−6ν)/(16πμ(1−ν) 10 mm)
(Kelvinlet, de Goes & James 2017), or twice that on a surface. The division of z is Stylet's; the curves are not.

O. H. Yeoh, Some forms of the strain energy function for rubber, Rubber Chem. Technol. 66 (1993) 754–771."""

import math
import pathlib
import re
import sys

from axisymmetric import RADIUS_MM, Mesh, arguments, away, material, pushed, radii

YOUNG_MPA = 30e-3
HELD_MM = 60.0
DEEPEST_MM = 6.0
CHECKED_MM = 1.44
SPREAD_MM = 10.0
SMALLEST_MM, GROWTH = 0.1 * RADIUS_MM, 0.3
INCREMENT_MM = 0.18  # largest increment of CalculiX
TABLE = pathlib.Path(__file__).parent.parent / "coupling" / "near_field" / "hyperelastic_punch.inc"
CASES = [(place, solid, poisson)
         for place, solid in (("inside", "yeoh"), ("surface", "yeoh"), ("inside", "neo-hooke")) for poisson in (0.45, 0.49)]


def forces(place, solid, poisson, way_mm, held_mm):
    """[(depth in mm, force in N)] on the way down."""
    inside = place == "inside"

    def along(start, end, stop):  # the grid within HELD_MM does not depend on held_mm
        return away(start, end, SMALLEST_MM, GROWTH, [stop] if held_mm > HELD_MM else [])

    heights = {*along(0.0, -held_mm, -HELD_MM), *(along(0.0, held_mm, HELD_MM) if inside else [0.0])}
    mesh = Mesh(radii(held_mm, SMALLEST_MM, GROWTH, [HELD_MM] if held_mm > HELD_MM else []), sorted(heights), lambda height: "TISSUE")
    held = mesh.rim + (mesh.top if inside else [])
    lines = mesh.deck({"TISSUE": material(solid, YOUNG_MPA, poisson)})
    lines += ["*BOUNDARY"] + [f"{n}, 1, 2" for n in held] + [f"{n}, 1, 1" for n in mesh.axis + mesh.end + mesh.wall]
    step = ["*STEP", "*STATIC"]
    if solid != "linear":
        most = min(1.0, INCREMENT_MM / way_mm)
        # Allow many iterations before an increment is halved.
        step = ["*STEP, NLGEOM, INC=2000", "*STATIC", f"{most}, 1, 1e-4, {most}",
                "*CONTROLS, PARAMETERS=TIME INCREMENTATION", "8, 12, 9, 30, 10, 4, , 20, ,", "0.25, 0.5, 0.75, 0.85, , , 1.5,"]
    return [(share * way_mm, force) for share, force in pushed(lines, way_mm, step)]


def curve(place, solid, poisson, way_mm=DEEPEST_MM):
    """[(depth in mm, force in N)] in tissue held infinitely far away, and its compliance [mm/N] for a small dent."""
    near, far = (forces(place, "linear", poisson, 1e-6, held)[-1] for held in (HELD_MM, 2.0 * HELD_MM))
    # [mm/N] effect of the held sides, which is inversely proportional to their distance.
    lacking = 2.0 * (far[0] / far[1] - near[0] / near[1])
    points = [(z + lacking * force, force) for z, force in forces(place, solid, poisson, way_mm, HELD_MM)]
    return points, near[0] / near[1] + lacking


def fitted(points, k1=None):
    """k1, k2 and relative misfit of F = k1 z + k2 z² by least squares. k1: keeps this value if given."""
    m2, m3, m4 = (sum(z**power for z, _ in points) for power in (2, 3, 4))
    f1, f2 = (sum(f * z**power for z, f in points) for power in (1, 2))
    if k1 is None:
        k1 = (f1 * m4 - f2 * m3) / (m2 * m4 - m3**2)
    k2 = (f2 - k1 * m3) / m4
    off = math.sqrt(sum((k1 * z + k2 * z * z - f) ** 2 for z, f in points) / len(points))
    return k1, k2, off / max(f for _, f in points)


def between(points, depth):
    """Force at a depth, None beyond the last point."""
    before = (0.0, 0.0)
    for z, force in points:
        if depth <= z:
            return before[1] + (force - before[1]) * (depth - before[0]) / (z - before[0])
        before = (z, force)
    return None


def report(place, solid, poisson, points, compliance):
    force = ", ".join(f"{f:.4f}" for depth in (0.5, 1, 2, 3, 4, 5, 6) if (f := between(points, depth)) is not None)
    print(f"{place}, {solid}, Poisson's ratio {poisson}: {points[-1][0]:.2f} mm reached; at 0.5, 1, 2 … mm {force} N")
    spread = (5.0 - 6.0 * poisson) * (1.0 + poisson) / (8.0 * math.pi * YOUNG_MPA * (1.0 - poisson) * SPREAD_MM)
    if place == "surface":
        spread *= 2.0
    dents = [(z - spread * force, force) for z, force in points]
    for name, (k1, k2, off) in (("z", fitted(points)), ("s", fitted(dents)), ("s, k1 that of small dents", fitted(dents, 1.0 / (compliance - spread)))):
        print(f"    over {name}: k1 = {k1 / (YOUNG_MPA * RADIUS_MM):.2f} E R, k2 = {k2 / YOUNG_MPA:.2f} E, misfit {100 * off:.1f} %", flush=True)


def check():
    """Computes the first curve of the table again and compares."""
    rows = re.findall(r"\{0.45, ([\d.]+), ([\d.]+)\}", TABLE.read_text(encoding="utf-8"))
    table = [(float(z), float(force)) for z, force in rows]
    failed = False
    for z, force in curve("inside", "yeoh", 0.45, CHECKED_MM)[0]:
        expected = between(table, z)
        off = force / expected - 1.0
        failed = failed or abs(off) > 0.01
        print(f"{z:.3f} mm: {force:.5f} N, table {expected:.5f}, {100 * off:.2f} % apart", flush=True)
    sys.exit(1 if failed else 0)


def main():
    given = arguments(__doc__, "--check", "--write")
    if given.check:
        check()
    rows = ["// Made by tests/reference/hyperelastic_punch.py --write: Yeoh's solid, C20 = C10, of 30 kPa; Poisson's ratio, mm, N."]
    for place, solid, poisson in CASES:
        points, compliance = curve(place, solid, poisson)
        report(place, solid, poisson, points, compliance)
        if given.write and (place, solid) == ("inside", "yeoh"):
            rows += [f"{{{poisson}, {z:.4f}, {force:.5f}}}," for z, force in points]
            TABLE.write_text("\n".join(rows) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
