#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet bench coupling: one insertion on two meshes, over the spacing of contacts and over the time step."""
import unittest

from program import InFolder


class CouplingBench(InFolder):
    def test_coupling_gives_the_same_force_on_two_meshes_and_what_makes_the_difference(self):
        result = self.json_of("bench", "coupling", "--nodes", "2000")
        mesh = {row["nodes"]: row for row in result["rows"] if (row["study"], row["method"]) == ("mesh", "near-field")}
        self.assertEqual(len(mesh), 2)
        for row in result["rows"]:
            self.assertGreater(row["peak_N"], 0)
            self.assertEqual(len(row["curve_force_axial_N"]), 660)
        coarse = mesh[min(mesh)]
        self.assertLess(coarse["rms_vs_finest_percent"], 8)
        self.assertGreater(coarse["rms_vs_finest_percent"], 0)
        for study, percent in (("spacing", 3), ("dt", 1)):
            of_study = [r for r in result["rows"] if (r["study"], r["method"]) == (study, "near-field")]
            self.assertEqual(of_study[0]["rms_vs_finest_percent"], 0)
            self.assertLess(max(r["rms_vs_finest_percent"] for r in of_study), percent)
        self.assertEqual({r["method"] for r in result["rows"]}, {"near-field", "node-addition"})
        self.refuse("bench", "coupling", "--nodes", "499", says=["--nodes", "499", "500"])


if __name__ == "__main__":
    unittest.main()
