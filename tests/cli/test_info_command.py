#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet info: correct numbers for every kind of file."""
import json
import math
import unittest

import samples
from insert_case import block_mesh
from program import InFolder


class Info(InFolder):
    def test_contours(self):
        samples.contour_json(self.folder / "gland.json", ("Prostate", "Nose"))
        info = self.json_of("info", "gland.json")
        self.assertEqual(info["kind"], "contours")
        prostate, nose = info["structures"]
        self.assertEqual((prostate["taken_as"], nose["taken_as"]), ("prostate", ""))
        self.assertEqual((prostate["slices"], prostate["points"]), (7, 7 * 24))
        self.assertAlmostEqual(prostate["slice_spacing_mm"], 5)
        # The volume of 24-gons with half axes 20 s and 15 s, s² = 1 − (z/20)², each 5 mm thick.
        polygon = 24 / 2 * math.sin(2 * math.pi / 24)
        volume = sum(5 * polygon * 20 * 15 * (1 - (5 * k / 20) ** 2) for k in range(-3, 4)) / 1000
        self.assertAlmostEqual(prostate["volume_cc"], volume, places=6)
        self.assertAlmostEqual(nose["volume_cc"], volume, places=6)
        self.assertEqual(prostate["extent_mm"]["min"][2], -15)

    def test_contour_inside_another_is_a_hole(self):
        samples.contour_json(self.folder / "gland.json")
        data = self.read("gland.json")
        solid = self.json_of("info", "gland.json")["structures"][0]["volume_cc"]
        contours = data["structures"][0]["contours"]
        contours += [[[x / 2, y / 2, z] for x, y, z in contour] for contour in contours]
        self.write("hollow.json", json.dumps(data))
        hollow = self.json_of("info", "hollow.json")["structures"][0]["volume_cc"]
        self.assertAlmostEqual(hollow, 0.75 * solid, places=6)

    def test_mask(self):
        samples.nifti_mask(self.folder / "mask.nii.gz")
        info = self.json_of("info", "mask.nii.gz")
        self.assertEqual((info["kind"], info["size"], info["left_handed"]), ("mask", [30, 30, 12], False))
        self.assertEqual(info["spacing_mm"], [1, 1, 2])
        one, two = info["labels"]
        self.assertEqual((one["label"], one["voxels"]), (1, 500))
        self.assertAlmostEqual(one["volume_cc"], 1.0)
        self.assertAlmostEqual(two["volume_cc"], 0.25)

    def test_tetrahedra(self):
        samples.tet_mesh(self.folder / "two.msh")
        info = self.json_of("info", "two.msh")
        self.assertEqual((info["kind"], info["nodes"], info["tets"]), ("mesh", 5, 2))
        self.assertAlmostEqual(info["edge_mm"]["max"], 10 * math.sqrt(2))
        volumes = {name: region["volume_cc"] for name, region in info["regions"].items()}
        self.assertEqual(set(volumes), {"upper", "lower"})
        for volume in volumes.values():
            self.assertAlmostEqual(volume, 1 / 6)

    def test_nearly_flat_tetrahedra_are_warned_of(self):
        block_mesh(self.folder / "good.msh")
        self.assertEqual(self.json_of("info", "good.msh")["warnings"], [])
        self.assertEqual(self.succeed("info", "good.msh").stderr, "")
        block_mesh(self.folder / "flat.msh", last_layer=0.5)
        warning, = self.json_of("info", "flat.msh")["warnings"]
        for part in ("of 384 tetrahedra are nearly flat", "5°", "tetrahedron ", "'tissue'", "optimiser"):
            self.assertIn(part, warning)
        self.assertIn(f"stylet: warning: flat.msh: {warning}\n", self.succeed("info", "flat.msh").stderr)

    def test_unit_of_a_mesh(self):
        samples.tet_mesh(self.folder / "metres.msh", unit=1000)
        info = self.json_of("info", "metres.msh", "--scale", "1000")
        self.assertAlmostEqual(info["regions"]["upper"]["volume_cc"], 1 / 6)
        self.refuse("info", "metres.msh", says=["metres.msh"])

    def test_surface(self):
        samples.stl_surface(self.folder / "corner.stl")
        info = self.json_of("info", "corner.stl")
        surface = info["surfaces"][0]
        self.assertEqual((info["kind"], surface["triangles"], surface["open_edges"]), ("surfaces", 4, 0))
        self.assertAlmostEqual(surface["volume_cc"], 1 / 6)

    def test_table_shows_what_json_holds(self):
        samples.nifti_mask(self.folder / "mask.nii.gz")
        text = self.succeed("info", "mask.nii.gz").stdout
        for part in ("mask.nii.gz", "30 × 30 × 12", "1 × 1 × 2 mm", "right-handed", "500"):
            self.assertIn(part, text)


if __name__ == "__main__":
    unittest.main()
