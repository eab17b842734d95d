#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How deep a needle that has cut its way through fat presses a capsule in before it breaks, computed by finite elements
independently of Stylet: axisymmetric, in CalculiX.

    capsule_behind_fat.py           prints curves and how they depend on grid and assumptions; takes 15 minutes
    capsule_behind_fat.py --write   writes the table capsule_behind_fat.inc; takes three minutes
    capsule_behind_fat.py --check   compares the linear stiffness and the first three millimetres of the curve with that
                                    table: its test

A layer of fat (2 kPa), 12 mm thick with a free surface, is bonded to gland (30 kPa); both have a Poisson's ratio of
0.45. A rod of radius 0.635 mm stands in a hole of the same radius through the fat. Its flat end is bonded to the
gland's face and pushed into it; the hole's wall slides along the rod without friction. A capsule of strength F breaks
when the end presses with F. Since its end met the fat's surface, the rod's base has then moved by 12 mm plus the depth
of the dent, because the rod is rigid and the hole exerts no axial force.

*The block* is a cylinder with the cross-section of a block 100 mm wide, and reaches 100 mm below the fat's surface; it
is held at its side and bottom. For *the half space*, the motion of linear tissue further away is added: the difference
of two linear compliances. The compliance of the half space is extrapolated from blocks held at 200 and 400 mm.

The tissue is linear, or Yeoh's solid with C20 = C10 in both tissues (C10 = μ/2, D1 = 2/K), as in hyperelastic_punch.py.
With Yeoh's solid, the elements at the edge of the end are 0.38 mm wide. Elements half as wide collapse before the end
has gone down by 12 mm, but until then give the same force within 1 %."""

import math
import pathlib
import re
import sys

from axisymmetric import RADIUS_MM, Mesh, arguments, away, material, pushed, radii

FAT_MM = 12.0
FAT_MPA, GLAND_MPA, POISSON = 2e-3, 30e-3, 0.45
WIDE_MM, DEEP_MM = 100.0, 100.0  # size of the block
SIDE_MM = WIDE_MM / math.sqrt(math.pi)  # radius of the cylinder with the block's cross-section
BLOCK = (SIDE_MM, DEEP_MM - FAT_MM)  # held at this radius, and at this depth below the gland's face
FINE = (3e-4, 0.2)  # smallest element and growth with the distance, for linear tissue
COARSE = (0.6 * RADIUS_MM, 0.25)  # the same for Yeoh's solid
DEEPEST_MM = 14.4
CHECKED_MM = 3.0
INCREMENT_MM = 0.3  # largest increment of CalculiX
STRENGTHS_N = (1.0, 2.0, 3.0, 4.0, 4.5)
TABLE = pathlib.Path(__file__).parent.parent / "coupling" / "near_field" / "capsule_behind_fat.inc"


def forces(solid, way_mm, held=BLOCK, grid=None, fat=None, slides=True):
    """[(depth in mm, force in N)] on the way down. held: distances of side and bottom [mm]. grid: smallest element [mm]
    and growth. fat: solid of the fat if different. slides: whether the hole's wall slides along the rod; otherwise it
    is free."""
    smallest, growth = grid or (FINE if solid == "linear" else COARSE)
    side_mm, below_mm = held
    heights = sorted({*away(0.0, -below_mm, smallest, growth), *away(0.0, FAT_MM, smallest, growth)})
    mesh = Mesh(radii(side_mm, smallest, growth), heights, lambda height: "GLAND" if height < 0.0 else "FAT")
    lines = mesh.deck({"GLAND": material(solid, GLAND_MPA, POISSON), "FAT": material(fat or solid, FAT_MPA, POISSON)})
    lines += ["*BOUNDARY"] + [f"{n}, 1, 2" for n in mesh.rim]
    lines += [f"{n}, 1, 1" for n in mesh.axis + mesh.end + (mesh.wall if slides else [])]
    step = ["*STEP", "*STATIC, SOLVER=SPOOLES"]
    if solid != "linear":
        most = min(1.0, INCREMENT_MM / way_mm)
        # Allow many iterations before an increment is halved.
        step = ["*STEP, NLGEOM, INC=2000", "*STATIC, SOLVER=SPOOLES", f"{most}, 1, 1e-5, {most}",
                "*CONTROLS, PARAMETERS=TIME INCREMENTATION", "8, 12, 9, 30, 10, 4, , 20, ,", "0.25, 0.5, 0.75, 0.85, , , 1.5,"]
    return [(share * way_mm, force) for share, force in pushed(lines, way_mm, step)]


def compliance(held=BLOCK, **other):
    """Compliance of linear tissue [mm/N]."""
    depth, force = forces("linear", 1e-6, held, **other)[-1]
    return depth / force


def in_half_space():
    """Compliance [mm/N] of linear tissue held infinitely far away: the effect of the distance is inversely proportional
    to it."""
    near, far = (compliance((held, held)) for held in (200.0, 400.0))
    return 2.0 * far - near


def depth_at(points, force):
    """Depth [mm] at which a curve reaches a force, None beyond the end of the curve."""
    before = (0.0, 0.0)
    for z, f in points:
        if force <= f:
            return before[0] + (z - before[0]) * (force - before[1]) / (f - before[1])
        before = (z, f)
    return None


def told(name, points, more=0.0):
    """Prints base depths at the break of capsules. more: additional compliance [mm/N]."""
    depths = ((strength, depth_at(points, strength)) for strength in STRENGTHS_N)
    text = ", ".join(f"{FAT_MM + z + more * strength:.2f} mm at {strength} N" for strength, z in depths if z is not None)
    print(f"{name}: pressed in by {points[-1][0]:.2f} mm; breaks at {text}", flush=True)


def report():
    in_block, far = compliance(), in_half_space()
    for strength in (0.3, 0.6):
        print(f"linear: breaks at {FAT_MM + in_block * strength:.2f} mm in the block, {FAT_MM + far * strength:.2f} mm in the half space "
              f"at {strength} N", flush=True)
    points = forces("yeoh", DEEPEST_MM)
    told("Yeoh, block", points)
    told("Yeoh, half space", points, far - in_block)
    for name, side_mm in (("inside the block", 0.5 * WIDE_MM), ("around it", WIDE_MM / math.sqrt(2.0))):
        told(f"Yeoh, the largest cylinder {name}" if side_mm < SIDE_MM else f"Yeoh, the smallest cylinder {name}",
             forces("yeoh", DEEPEST_MM, (side_mm, BLOCK[1])))
    for part, growth in ((0.4, 0.3), (0.4, 0.2), (0.6, 0.3), (1.0, 0.3)):
        told(f"Yeoh, elements at the edge of {part * RADIUS_MM:.3f} mm, growth {growth}",
             forces("yeoh", DEEPEST_MM, grid=(part * RADIUS_MM, growth)))
    told("Yeoh, the hole's wall bears nothing", forces("yeoh", DEEPEST_MM, slides=False))
    for fat in ("neo-hooke", "linear"):
        told(f"Yeoh, fat {fat}", forces("yeoh", DEEPEST_MM, fat=fat))


def write():
    in_block, far = compliance(), in_half_space()
    rows = ["// Made by tests/reference/capsule_behind_fat.py --write. Linear tissue: mm/N in the block, mm/N in the half space.",
            f"constexpr double kLinearDent[] = {{{in_block:.5f}, {far:.5f}}};",
            "// Yeoh's solid, C20 = C10, in the block: mm, N.", "constexpr Dent kYeohDent[] = {"]
    rows += [f"    {{{z:.4f}, {force:.5f}}}," for z, force in forces("yeoh", DEEPEST_MM)]
    TABLE.write_text("\n".join([*rows, "};", ""]), encoding="utf-8")


def check():
    text = TABLE.read_text(encoding="utf-8")
    linear = float(re.search(r"kLinearDent\[\] = \{([\d.]+),", text).group(1))
    curve = [(float(z), float(force)) for z, force in re.findall(r"^ +\{([\d.]+), ([\d.]+)\}", text, re.MULTILINE)]
    found = compliance()
    failed = abs(found / linear - 1.0) > 0.01
    print(f"linear: {found:.4f} mm/N, table {linear:.4f}", flush=True)
    for z, force in forces("yeoh", CHECKED_MM):
        expected = depth_at(curve, force)
        failed = failed or abs(z / expected - 1.0) > 0.01
        print(f"{force:.5f} N: {z:.3f} mm, table {expected:.3f}", flush=True)
    sys.exit(1 if failed else 0)


def main():
    given = arguments(__doc__, "--check", "--write")
    if given.check:
        check()
    elif given.write:
        write()
    else:
        report()


if __name__ == "__main__":
    main()
