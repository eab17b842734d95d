#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""No control character of a file, of its name or of an argument reaches the terminal, whatever the format: with one, a
file could change what the terminal shows. What is wrong with a file is said in the program's own words, not in those of
a library. Meshes with several arrays of whole numbers say how to choose."""
import json
import re
import struct
import subprocess
import unittest

import samples
from program import HANGS_AFTER_S, STYLET, InFolder

ESCAPE = "\x1b]0;title\x07\x1b[31mred\x7f\u009b2J\r\u202eder\u2066\u200f\u061c\u2028"
JSON_ESCAPE = json.dumps(ESCAPE)[1:-1]

TETS = """1 2 3 7
1 3 4 7
1 4 8 7
1 8 5 7
1 5 6 7
1 6 2 7"""
CORNERS = [(x, y, z) for z in (0, 40) for x, y in ((0, 0), (40, 0), (40, 40), (0, 40))]

# Words of libraries that read files and of the C++ runtime.
FOREIGN = ("json.exception", "[json", "parse_error", "type_error", "while parsing", "saw '", "H5", "unable to",
           "HDF5 gave", "vtk", ".cxx", "ERROR:", "No data to", "Error reading", "std::", "bad_alloc", "basic_string",
           "what()", "terminate", "core dumped", "Segmentation", "Aborted", "last words", "Dcm", "OFCondition",
           "escaped_list", "boost", "exception", "error_code", "invalid escape", "Invalid stream", "I/O suspension")
QUOTED = re.compile(r"(?<![^ (\[{=,:\n])(['\"])((?:(?!\1[ )\]},.:;\n]).)*)\1")


def is_harmful(c):
    """Whether a character steers a terminal, ends a line or turns the direction of writing."""
    return ((c < " " and c not in "\n\t") or "\x7f" <= c < "\xa0" or c in "\u061c\u200e\u200f" or
            "\u2028" <= c <= "\u202e" or "\u2066" <= c <= "\u2069")


def texts_of(value):
    """All texts in a JSON value."""
    if isinstance(value, dict):
        return [t for key, part in value.items() for t in [key, *texts_of(part)]]
    if isinstance(value, list):
        return [t for part in value for t in texts_of(part)]
    return [value] if isinstance(value, str) else []


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


class Clean(InFolder):
    def check(self, *arguments, status=None):
        """Runs the program and checks that its output has no control characters. Returns the output."""
        done = subprocess.run([STYLET, *arguments], cwd=self.folder, capture_output=True, check=False,
                              timeout=HANGS_AFTER_S, stdin=subprocess.DEVNULL)
        text = (done.stdout + done.stderr).decode()
        self.assertEqual([c for c in text if is_harmful(c)], [], f"{arguments}: {text!r}")
        said = done.stderr.decode()
        for argument in arguments:
            said = said.replace(str(argument), "…")
        self.assertEqual([word for word in FOREIGN if word in said], [], f"{arguments}: {text!r}")
        for _, quoted in QUOTED.findall(said):
            self.assertLessEqual(len(quoted), 4096 if "/" in quoted else 300, f"{arguments}: {text!r}")
        self.assertIn(done.returncode, (0, 1, 2), f"{arguments}: {text!r}")
        if "-" in arguments and done.returncode == 0:
            for part in texts_of(json.loads(done.stdout)):
                self.assertEqual([c for c in part if is_harmful(c)], [], f"{arguments}: {part!r}")
        if status is not None:
            self.assertEqual(done.returncode, status, text)
        return text


class Names(Clean):
    def test_of_no_format_bring_control_characters_to_the_terminal(self):
        gland = {**samples.ball(15), "name": ESCAPE}
        for file in (self.write("c.json", samples.structure_set(gland, label=ESCAPE)), self.write("s.glb", glb(ESCAPE))):
            text = self.check("info", file, status=0)
            self.assertIn("red", text, file)
            self.check("info", file, "--json", "-", status=0)
            self.check("info", file, "--scenario", status=None)
            self.check("mesh", file, "-o", "out.vtu", "--region", "nothing=prostate", status=2)
        file = self.write("m.vtk", vtk({"a\x1b[31m": "1 1 1 2 2 2", "b\x07": "1 1 3 3 3 3"}))
        self.assertIn("a [31m", self.check("info", file, status=0))
        self.check("info", file, "--regions-from", "c", status=2)

    def test_of_plans_sources_scenarios_and_tables_bring_none(self):
        seeds = [{"position_mm": [0, 0, z], "needle": ESCAPE} for z in (0, 10, 20)]
        plan = {"format": "stylet-plan", "version": 1, "units": "mm", "frame": "LPS", "label": ESCAPE,
                "source": "i125_6711", "strength_U": 0.5, "prescription_Gy": 145, "seeds": seeds}
        self.assertIn("red", self.check("info", self.write("plan.json", json.dumps(plan)), status=0))
        plan["source"] = ESCAPE
        self.check("info", self.write("other.json", json.dumps(plan)))
        self.check("dose", "other.json", "-o", "out", status=2)
        self.check("info", self.write("plan.csv", f"# label: {ESCAPE}\n# strength_U: 0.5\n# source: i125_6711\n"
                                                  f"x_mm,y_mm,z_mm,needle\n0,0,0,{ESCAPE}\n"))
        self.check("dose", self.write("bad.csv", f"x_mm,{ESCAPE}\n0,0\n"), "-o", "out", status=2)
        source = {"format": "stylet-source", "version": 1, "name": ESCAPE, "title": ESCAPE, "citation": ESCAPE}
        self.check("info", self.write("source.json", json.dumps(source)), status=2)
        text = f'name = "{JSON_ESCAPE}"\n[patient]\nsource = "phantom"\n[tissue."{JSON_ESCAPE}"]\nyoung_kPa = 1\n'
        self.check("insert", self.write("s.toml", text), "-o", "out", status=2)
        self.check("info", self.write(f"{ESCAPE}.json", "{"), status=2)

    def test_of_settings_and_unknown_words_bring_none(self):
        for arguments in (["insert", "--set", f"name={ESCAPE}"], ["insert", f"--{ESCAPE}"], [ESCAPE], ["info", ESCAPE],
                          ["implant", f"{ESCAPE}.toml"], ["dose", ESCAPE, "--region", ESCAPE], ["serve", ESCAPE],
                          ["mesh", "a.nii", "-o", f"{ESCAPE}/{ESCAPE}/m.vtu"], ["insert", "--map", ESCAPE],
                          ["info", b"caf\xe9.json"], ["info", "a", "--volume", ESCAPE], ["info", "x" * 3000],
                          ["insert", "--set", "needle." + "x" * 3000 + "=1"], ["serve", "a", "--port", "x" * 3000]):
            self.check(*arguments, status=2)

    def test_that_are_not_utf8_or_very_long_are_shown_all_the_same(self):
        gland = {**samples.ball(15), "name": "NAME"}
        text = json.dumps(samples.structure_set(gland, {**samples.ball(10), "name": "x" * 5000}))
        self.check("info", self.write("long.json", text))
        self.check("mesh", "long.json", "-o", "m.vtu", "--region", "y" * 5000 + "=prostate", status=2)
        self.check("info", self.write("latin.json", text.encode().replace(b"NAME", b"Harnr\xf6hre \x9b31m")))
        self.check("info", self.write("nul.json", text.replace("NAME", "a\\u0000b")), "--json", "-")
        self.check("info", self.write("nul.csv", b"x_mm,y_mm,z_mm,needle\n0,0,0,a\0b\n"))
        latin = b'name = "caf\xe9"\n'
        self.check("implant", self.write("latin.toml", latin), "-o", "out", status=2)


class Damage(Clean):
    """Files of every format that are broken in some way."""

    FILES = {
        "object.json": "{", "list.json": '{"format": "stylet-contours", "version": 1, "structures": [1, {"name": 2}]}',
        "plan.json": '{"format": "stylet-plan", "version": "one", "seeds": {}}',
        "kinds.json": '{"format": "stylet-plan", "version": 1, "units": "mm", "frame": "LPS", '
                      '"seeds": [{"position_mm": "a"}]}',
        "source.json": '{"format": "stylet-source", "version": 1, "name": ["a"], "radial": "much"}',
        "number.json": '{"format": "stylet-contours", "version": 1e999}', "words.json": '{"a": nul}',
        "quotes.csv": 'x_mm,y_mm,z_mm\n"0,0\\,0\n', "backslash.csv": "x_mm,y_mm,z_mm\n0,\\q,0\n",
        "legacy.vtk": "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n0 0",
        "binary.vtk": "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n0 0",
        "polygons.vtk": "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n",
        "mesh.vtu": '<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="0.1"><UnstructuredGrid><Piece '
                    'NumberOfPoints="3" NumberOfCells="1"></UnstructuredGrid>',
        "surface.vtp": '<?xml version="1.0"?><VTKFile type="PolyData" version="0.1"><PolyData><Piece '
                       'NumberOfPoints="3">',
        "text.stl": "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0\nendloop\nendfacet\nendsolid x\n",
        "surface.ply": "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nend_header\n0\n",
        "face.ply": "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
                    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n3 0 1 9\n",
        "surface.obj": "v 0 0 0\nf 1 2 3\n", "name.obj": "v a b c\n",
        "scene.glb": b"glTF" + struct.pack("<II", 2, 40) + struct.pack("<I", 8) + b"JSON{\"a\": 1}",
        "image.nii": b"\\\x01\0\0" + b"\0" * 340 + b"n+1\0", "image.nii.gz": b"\x1f\x8b\x08\0garbage",
        "image.nrrd": "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 4 4 4\nencoding: gzip\n\ngarbage",
        "image.mha": "ObjectType = Image\nNDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\n"
                     "ElementDataFile = LOCAL\nab",
        "mesh.msh": "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 8 1 8\n3 1 0 8\n1\n",
        "old.msh": "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0\n$EndNodes\n",
        "mesh.mesh": "MeshVersionFormatted 2\nDimension 3\nVertices\n2\n0 0\n", "mesh.node": "4 3 0 0\n1 0 0\n",
        "image.dcm": b"\0" * 128 + b"DICM" + b"\x02\0\0\0UL\x04\0\xff\xff\0\0\x08\0\x60\0CS\xff\xffMR",
        "run.h5": b"\x89HDF\r\n\x1a\n" + b"\x02\x08\x08\0" + b"\xff" * 200,
        "model.stylet": b"\x89HDF\r\n\x1a\n" + b"\0" * 200,
        "sealed.stylet": b"\x89HDF\r\n\x1a\n" + b"\0" * 50 + b"{}\nstylet seal 1\n" + b"0" * 15 + b"2" + b"0" * 64,
    }
    TOML = ("a", "a =", "a = b", "a = 1,5", "a = [1, 2", "a = {b = 1,}", "a = 'x", 'a = "\\q"', "a = 1\na = 2",
            "[t\na = 1", "[[t]\n", "a = 01", "a = 1__0", "a = 99999999999999999999", "a = 2024-13-01",
            "a = 1\n[a]\nb = 1", "= 1", 'a = """x', "a = \x01", "a.b = 1\na = 2", "a = [1 2]", "a = +", "a = nan1",
            "[a.]\n", "a = 1 b = 2", "a = " + "[" * 300)

    def test_of_a_file_is_said_without_the_words_of_a_library(self):
        for name, content in self.FILES.items():
            self.write(name, content)
            for command in (["info", name], ["mesh", name, "-o", "m.vtu"], ["dose", name, "-o", "out"],
                            ["implant", name]):
                text = self.check(*command)
                self.assertIn(name, text)

    def test_of_a_scenario_is_said_with_line_and_column(self):
        for line in self.TOML:
            text = self.check("insert", self.write("s.toml", f"name = \"a\"\n{line}\n"), "-o", "out", status=2)
            self.assertRegex(text, r"s\.toml, line \d+", line)


class Regions(InFolder):
    def setUp(self):
        super().setUp()
        self.write("m.vtk", vtk({"tissue": "1 1 1 2 2 2", "part": "1 1 3 3 3 3"}))

    def test_of_several_arrays_are_listed_with_the_option_and_the_key_that_choose(self):
        info = self.json_of("info", "m.vtk")
        self.assertEqual(len(info["regions"]), 1)
        for words in ("'tissue'", "'part'", '--regions-from "tissue"', 'regions_from = "tissue"'):
            self.assertIn(words, " ".join(info["notes"]))
        mesh = self.json_of("mesh", "m.vtk", "-o", "out.vtu", "--regions-from", "tissue", "--region", "2=prostate")
        self.assertEqual(list(mesh["regions"]), ["region 1", "prostate"])
        self.refuse("info", "m.vtk", "--regions-from", "tisue", says=["Did you mean 'tissue'?"])

    def test_may_be_chosen_in_a_scenario(self):
        for source, array, says in (("m.vtk", "tisue", ["Did you mean 'tissue'?"]),
                                    ("phantom", "a", ["regions_from", "phantom"])):
            self.write("s.toml", f'[patient]\nsource = "{source}"\nregions_from = "{array}"\n[[insertion]]\nhole = "D4"\n')
            self.refuse("insert", "s.toml", "-o", "out", says=says)


if __name__ == "__main__":
    unittest.main()
