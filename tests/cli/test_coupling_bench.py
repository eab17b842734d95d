#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet bench coupling: one insertion with several spacings of contacts and time steps, on the coarsest mesh."""
import unittest

from program import InFolder


class CouplingBench(InFolder):
    def test_has_every_study_with_its_curves_and_hardly_hangs_on_spacing_and_time_step(self):
        result = self.json_of("bench", "coupling", "--nodes", "500")
        for row in result["rows"]:
            self.assertGreater(row["peak_N"], 0)
            self.assertGreater(row["target_shift_mm"], 0)
            self.assertEqual(len(row["curve_force_axial_N"]), 760)
        self.assertEqual({r["study"] for r in result["rows"]}, {"mesh", "geometry", "spacing", "dt"})
        self.assertEqual({r["method"] for r in result["rows"]}, {"near-field", "node-addition"})
        for study, percent in (("spacing", 3), ("dt", 1)):
            of_study = [r for r in result["rows"] if (r["study"], r["method"]) == (study, "near-field")]
            self.assertEqual(of_study[0]["rms_vs_finest_percent"], 0)
            self.assertTrue(all(0 < r["rms_vs_finest_percent"] < percent for r in of_study[1:]))
        self.refuse("bench", "coupling", "--nodes", "499", says=["--nodes", "499", "500"])


if __name__ == "__main__":
    unittest.main()
