# SPDX-License-Identifier: GPL-3.0-or-later
"""Small input files for tests."""
import gzip
import json
import math
import struct

TETS = """1 2 3 7
1 3 4 7
1 4 8 7
1 8 5 7
1 5 6 7
1 6 2 7"""
CORNERS = [(x, y, z) for z in (0, 40) for x, y in ((0, 0), (40, 0), (40, 40), (0, 40))]


def ellipse(z, a, b, points=24):
    """A closed polygon in the plane z [mm], inscribed in an ellipse with half axes a and b [mm]."""
    angles = [2 * math.pi * k / points for k in range(points)]
    return [[a * math.cos(t), b * math.sin(t), z] for t in angles]


def structure_set(*structures, **more):
    """Contours as JSON."""
    return {"format": "stylet-contours", "version": 1, "units": "mm", "frame": "LPS", **more, "structures": list(structures)}


def ellipsoid(name, centre, half, gap, kind=""):
    """A structure with these half axes and contours `gap` apart [mm]."""
    count = int(2 * half[2] / gap)
    contours = []
    for k in range(count):
        z = (k - (count - 1) / 2) * gap
        scale = math.sqrt(1 - (z / half[2]) ** 2)
        contours.append([[centre[0] + x, centre[1] + y, centre[2] + z]
                         for x, y, _ in ellipse(z, half[0] * scale, half[1] * scale, points=48)])
    return {"name": name, "type": kind, "contours": contours}


def ball(radius, name="Prostate", at=(0, 0, 0), gap=1.0):
    return ellipsoid(name, at, (radius,) * 3, gap)


def contour_json(path, names=("Prostate",)):
    """Ellipsoidal glands of 40 × 30 × 35 mm side by side, one for each name, with contours every 5 mm."""
    structures = []
    for number, name in enumerate(names, start=1):
        contours = []
        for k in range(-3, 4):
            scale = math.sqrt(1 - (5 * k / 20) ** 2)
            contour = ellipse(5.0 * k, 20 * scale, 15 * scale)
            contours.append([[x + 60 * (number - 1), y, z] for x, y, z in contour])
        structures.append({"name": name, "number": number, "type": "ORGAN", "colour": [255, 0, 0], "contours": contours})
    path.write_text(json.dumps(structure_set(*structures, label="sample", frame_of_reference="")))


def nifti_mask(path):
    """A .nii.gz mask of two boxes, labels 1 (10 × 10 × 5 voxels) and 2 (5 × 5 × 5), with a spacing of 1 × 1 × 2 mm."""
    size = (30, 30, 12)
    voxels = bytearray(size[0] * size[1] * size[2])
    for label, (lo, hi) in {1: ((5, 5, 3), (15, 15, 8)), 2: ((20, 20, 3), (25, 25, 8))}.items():
        for k in range(lo[2], hi[2]):
            for j in range(lo[1], hi[1]):
                for i in range(lo[0], hi[0]):
                    voxels[i + size[0] * (j + size[1] * k)] = label
    header = bytearray(352)
    struct.pack_into("<i", header, 0, 348)
    struct.pack_into("<8h", header, 40, 3, *size, 1, 1, 1, 1)
    struct.pack_into("<2h", header, 70, 2, 8)  # unsigned char, 8 bits
    struct.pack_into("<8f", header, 76, 1, 1, 1, 2, 1, 1, 1, 1)
    struct.pack_into("<f", header, 108, 352)
    header[123] = 2  # millimetres
    struct.pack_into("<2h", header, 252, 0, 1)  # sform only
    struct.pack_into("<12f", header, 280, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2, 0)
    header[344:348] = b"n+1\0"
    path.write_bytes(gzip.compress(bytes(header) + bytes(voxels)))


def gmsh(path, names, nodes, tets):
    """A gmsh MSH 2.2 file. names: of the physical groups; tets: (number of the group, four indices of nodes)."""
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
    lines += [f'3 {k} "{name}"' for k, name in enumerate(names, start=1)]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [f"{k} {x} {y} {z}" for k, (x, y, z) in enumerate(nodes, start=1)]
    lines += ["$EndNodes", "$Elements", str(len(tets))]
    lines += [f"{k} 4 2 {group} {group} " + " ".join(str(n + 1) for n in tet)
              for k, (group, tet) in enumerate(tets, start=1)]
    path.write_text("\n".join(lines + ["$EndElements", ""]))


def tet_mesh(path, unit=1.0, last_tet=(1, 2, 3, 4), names=("upper", "lower")):
    """A gmsh MSH 2.2 file with two tetrahedra that share a face, edges of 10 mm in units of `unit` mm, and physical
    groups 1 and 2."""
    s = 10 / unit
    nodes = [(0, 0, -s), (0, 0, 0), (s, 0, 0), (0, s, 0), (0, 0, s)]
    tets = [(1, tuple(last_tet)), (2, (1, 3, 2, 0))]
    gmsh(path, names, nodes, tets)


def stl_surface(path):
    """An ASCII STL file of a closed tetrahedron with three perpendicular edges of 10 mm; its volume is 166.7 mm³."""
    p = [(0, 0, 0), (10, 0, 0), (0, 10, 0), (0, 0, 10)]
    lines = ["solid corner"]
    for triangle in ((0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)):
        lines += ["facet normal 0 0 0", "outer loop"]
        lines += ["vertex {} {} {}".format(*p[k]) for k in triangle]
        lines += ["endloop", "endfacet"]
    path.write_text("\n".join(lines + ["endsolid corner", ""]))


def vtk(arrays):
    """A legacy VTK file of six tetrahedra with these cell arrays: name to values."""
    tets = "\n".join("4 " + " ".join(str(int(n) - 1) for n in tet.split()) for tet in TETS.splitlines())
    text = ("# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n" +
            "\n".join(f"{x} {y} {z}" for x, y, z in CORNERS) + f"\nCELLS 6 30\n{tets}\nCELL_TYPES 6\n10 10 10 10 10 10\n"
            f"CELL_DATA 6\nFIELD FieldData {len(arrays)}\n")
    return text + "".join(f"{name} 1 6 int\n{values}\n" for name, values in arrays.items())


def glb(name):
    points = struct.pack("<9f", 0, 0, 0, 0.1, 0, 0, 0, 0.1, 0) + struct.pack("<3I", 0, 1, 2)
    scene = json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"name": name, "mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": len(points)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 12}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                       "max": [0.1, 0.1, 0]}, {"bufferView": 1, "componentType": 5125, "count": 3, "type": "SCALAR"}]
    }).encode()
    scene += b" " * (-len(scene) % 4)
    return (b"glTF" + struct.pack("<II", 2, 28 + len(scene) + len(points)) + struct.pack("<I", len(scene)) + b"JSON" +
            scene + struct.pack("<I", len(points)) + b"BIN\0" + points)
