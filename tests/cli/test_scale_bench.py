#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet bench scale: the contents of its rows on the coarsest mesh. Times are not checked."""
import unittest

from program import InFolder


class ScaleBench(InFolder):
    def test_measures_three_numbers_of_contacts_on_each_mesh(self):
        rows = self.json_of("bench", "scale", "--nodes", "570")["rows"]
        self.assertEqual([r["contacts"] for r in rows], [20, 40, 60])
        for row in rows:
            self.assertLess(abs(row["nodes"] - 570), 0.03 * 570)
            self.assertLess(abs(row["contacts_max"] - row["contacts"]), 0.1 * row["contacts"])
            self.assertGreater(row["steps"], 1000)
            self.assertGreater(row["events"], 0)
            self.assertEqual(row["step_cpu_p99_over_coarsest"], 1)
            for times in (row["step_cpu_us"], row["step_wall_us"]):
                self.assertTrue(0 < times["p50"] <= times["p99"] <= times["p999"] <= times["max"])
            self.assertTrue(all(seconds > 0 for seconds in row["offline_s"].values()))
            self.assertGreater(row["memory_mb"], 0)
            self.assertGreater(row["all_cpu_s"], 0)
            self.assertGreater(row["fixed_work_cpu_s"], 0)
            self.assertLessEqual(1e-3 * row["fixed_work_over_1ms"], row["fixed_work_cpu_s"])
            self.assertIsNone(row["over_1ms_median_us"])  # no step is repeated
        again = self.json_of("bench", "scale", "--nodes", "570", "--contacts", "20", "--steps", "25000")["rows"]
        self.assertEqual([r["contacts"] for r in again], [20])
        self.assertGreaterEqual(again[0]["all_steps"], 25000)
        self.assertLess(again[0]["steps"], again[0]["all_steps"])
        self.assertGreaterEqual(again[0]["all_longest_us"], again[0]["step_cpu_us"]["max"])
        # The layers of this coarse mesh are thinner than an element, so some steps that cut have no balance.
        self.assertLess(again[0]["flagged"], 0.01 * again[0]["steps"])
        self.assertIsNone(again[0]["all_longest_median_us"])  # too few repeats for a median
        self.refuse("bench", "scale", "--nodes", "570", "--contacts", "3", says=["--contacts", "'3'"])
        # At 93 mm depth, the spacing of this many contacts is just above the needle's diameter of 1.27 mm.
        densest = self.json_of("bench", "scale", "--nodes", "570", "--contacts", "74")["rows"]
        self.assertGreaterEqual(densest[0]["spacing_mm"], 1.27)
        self.refuse("bench", "scale", "--nodes", "570", "--contacts", "75", says=["--contacts", "'75'", "74"])
        self.refuse("bench", "scale", "--nodes", "569", says=["--nodes", "569", "570"])


if __name__ == "__main__":
    unittest.main()
