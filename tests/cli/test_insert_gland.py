#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo: the motion of the gland agrees with published motions of patients' glands."""
import json
import unittest
from pathlib import Path

from program import InFolder

SCENARIO = Path(__file__).resolve().parents[2] / "scenarios" / "demo.toml"


class MovingGland(InFolder):
    def run_at(self, speed):
        folder = f"out_{speed}"
        self.succeed("insert", str(SCENARIO), "-o", folder, "--set", f"insertion.speed_mm_per_s={speed}",
                     "--set", "output.pictures=false", "--set", "insertion.retract=false")
        return json.loads((self.folder / folder / "summary.json").read_text())

    def test_the_gland_is_carried_and_turned_and_a_fast_needle_moves_it_less(self):
        slow, fast = self.run_at(20), self.run_at(150)
        for summary in (slow, fast):
            skin, capsule = [e for e in summary["events"] if e["kind"] == "puncture"]
            self.assertEqual((skin["region"], capsule["region"]), ("subcutaneous_fat", "prostate"))
            self.assertLess(skin["depth_mm"], 12, "the skin tents by no more than reported")
            self.assertAlmostEqual(skin["force_N"], 2.8, delta=0.1)
            entered = [e["region"] for e in summary["events"] if e["kind"] == "region_entered"]
            self.assertEqual(entered, ["subcutaneous_fat", "body", "levator", "periprostatic_fat", "prostate"])
            self.assertTrue(4 < summary["peak_force_N"]["axial"] < 10)
            self.assertFalse(any("pressed the surface" in w for w in summary["warnings"]))
        gland = slow["gland"]
        shift = gland["shift_at_break_mm"]
        self.assertTrue(2 < shift["norm"] < 12, "published for a needle that is pushed: 5.6 mm, 0.3 to 21.6")
        self.assertGreater(shift["SI"], 2 * max(abs(shift["LR"]), abs(shift["AP"])))
        self.assertTrue(2 < abs(gland["rotation_deg"]["coronal"]) < 15, "15 mm beside the axis")
        self.assertLess(fast["gland"]["shift_at_break_mm"]["norm"], 0.7 * shift["norm"])


if __name__ == "__main__":
    unittest.main()
