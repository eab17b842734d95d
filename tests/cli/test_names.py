#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""No control character of a file reaches the terminal, whatever its format: with one, a file could change what the
terminal shows. Meshes with several arrays of whole numbers say how to choose."""
import json
import struct
import subprocess
import unittest

import samples
from program import HANGS_AFTER_S, STYLET, InFolder

ESCAPE = "\x1b]0;title\x07\x1b[31mred\x7f\u009b2J\r"
JSON_ESCAPE = json.dumps(ESCAPE)[1:-1]

TETS = """1 2 3 7
1 3 4 7
1 4 8 7
1 8 5 7
1 5 6 7
1 6 2 7"""
CORNERS = [(x, y, z) for z in (0, 40) for x, y in ((0, 0), (40, 0), (40, 40), (0, 40))]


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


class Names(InFolder):
    def check(self, *arguments, status=None):
        """Runs the program and checks that its output has no control characters. Returns the output."""
        done = subprocess.run([STYLET, *arguments], cwd=self.folder, capture_output=True, check=False,
                              timeout=HANGS_AFTER_S, stdin=subprocess.DEVNULL)
        text = (done.stdout + done.stderr).decode()
        bad = [c for c in text if (c < " " and c not in "\n\t") or "\x7f" <= c < "\xa0"]
        self.assertEqual(bad, [], f"{arguments}: {text!r}")
        if status is not None:
            self.assertEqual(done.returncode, status, text)
        return text

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
