#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet bench step, loop, viewers, pictures, supply, probe and display: the contents of their rows on the coarsest mesh. Times
are not checked."""
import unittest

from program import InFolder


class StepBench(InFolder):
    def test_divides_a_step_among_its_phases(self):
        rows = self.json_of("bench", "step", "--nodes", "570")["rows"]
        self.assertEqual([r["contacts"] for r in rows], [20, 40, 60])
        for row in rows:
            self.assertLess(abs(row["nodes"] - 570), 0.03 * 570)
            self.assertGreater(row["steps"], 1000)
            times = row["step_cpu_us"]
            self.assertTrue(0 < times["p50"] <= times["p99"] <= times["p999"] <= times["max"])
            for phases in (row["phase_us"], row["slow_phase_us"]):
                self.assertEqual(len(phases), 10)
                self.assertTrue(all(us >= 0 for us in phases.values()))
                self.assertGreater(phases["solve"], 0)
                self.assertGreater(phases["contacts"], 0)
            self.assertGreater(sum(row["slow_phase_us"].values()), sum(row["phase_us"].values()))
        self.refuse("bench", "step", "--nodes", "499", says=["--nodes", "499", "500"])


class LoopBench(InFolder):
    def test_counts_every_step_of_the_loop(self):
        loop = self.json_of("bench", "loop", "--nodes", "570", "--contacts", "20", "--seconds", "3")
        self.assertGreaterEqual(loop["seconds"], 3)
        self.assertGreater(loop["steps"], 100)  # even on a busy machine
        self.assertGreater(loop["simulated_s"], 0.1)
        for key in ("step_cpu_us", "step_wall_us"):
            times = loop[key]
            self.assertEqual(times["count"], loop["steps"])
            self.assertTrue(0 < times["p50"] <= times["p99"] <= times["p999"] <= times["max"])
            counts = list(times["up_to_us"].values())
            self.assertEqual(counts, sorted(counts))
            self.assertLessEqual(counts[-1], times["count"])
        self.assertGreater(loop["device_wall_us"]["count"], 100)
        self.assertTrue(loop["rights"])
        self.refuse("bench", "loop", "--nodes", "499", says=["--nodes", "499", "500"])
        self.refuse("bench", "loop", "--seconds", "0", says=["--seconds", "0"])


class ViewersBench(InFolder):
    def test_compares_the_steps_with_viewers_to_those_without(self):
        found = self.json_of("bench", "viewers", "--nodes", "570", "--contacts", "20", "--seconds", "1")
        self.assertEqual(found["viewers"], 2)
        self.assertGreater(found["pictures_per_s"], 1)  # even on a busy machine
        self.assertGreater(found["megabytes_per_s"], 0)
        for key in ("without_us", "with_us"):
            times = found[key]
            self.assertGreater(times["count"], 1000)
            self.assertTrue(0 < times["p50"] <= times["p99"] <= times["p999"] <= times["max"])
            self.assertEqual(len(times["p99_of_turns"]), 1)
        self.assertAlmostEqual(found["p99_ratio"], found["with_us"]["p99"] / found["without_us"]["p99"])
        self.refuse("bench", "viewers", "--nodes", "499", says=["--nodes", "499", "500"])

    def test_compares_the_steps_beside_pictures_to_those_without(self):
        found = self.json_of("bench", "pictures", "--nodes", "570", "--contacts", "20", "--seconds", "1")
        self.assertEqual(found["viewers"], 0)
        self.assertGreater(found["ultrasound_per_s"], 1)  # even on a busy machine
        for key in ("without_us", "with_us"):
            self.assertGreater(found[key]["count"], 1000)
            self.assertEqual(len(found[key]["p99_of_turns"]), 1)
        self.assertAlmostEqual(found["p99_ratio"], found["with_us"]["p99"] / found["without_us"]["p99"])
        self.refuse("bench", "pictures", "--nodes", "499", says=["pictures", "--nodes", "499", "500"])


class SupplyBench(InFolder):
    def test_leads_a_needle_where_nothing_was_prepared(self):
        (row,) = self.json_of("bench", "supply", "--nodes", "570", "--speed", "20")["rows"]
        self.assertEqual(row["speed_mm_per_s"], 20)
        self.assertGreater(row["rows"], 0)
        self.assertGreater(row["steps"], 1000)
        self.assertLessEqual(row["flagged"], row["steps"])
        self.assertGreater(row["force_peak_N"], 0.3)
        self.assertLess(row["force_off_N"], row["force_peak_N"])
        self.refuse("bench", "supply", "--nodes", "569", says=["--nodes", "569", "570"])
        self.refuse("bench", "supply", "--speed", "0", says=["--speed", "0"])


class ProbeBench(InFolder):
    def test_a_moving_probe_never_goes_into_the_wall(self):
        (row,) = self.json_of("bench", "probe", "--nodes", "3000")["rows"]
        self.assertTrue(120 <= row["points"] <= 150)
        self.assertGreater(row["poses"], 400)
        self.assertTrue(0 < row["pose_cpu_ms"]["p50"] <= row["pose_cpu_ms"]["p99"] <= row["pose_cpu_ms"]["max"])
        self.assertGreater(row["megabytes"], 1)
        self.assertGreater(row["force_N"], 1)
        self.assertLessEqual(row["penetration_mm"], 0.05)
        self.refuse("bench", "probe", "--nodes", "2999", says=["--nodes", "2999", "3000"])


class DisplayBench(InFolder):
    def test_pictures_are_as_right_as_is_stated(self):
        rows = self.json_of("bench", "display", "--nodes", "5000")["rows"]
        self.assertEqual(len(rows), 2)
        for row in rows:
            self.assertGreater(row["frames"], 50)
            self.assertGreater(row["surface_nodes"], 100)
            self.assertGreater(row["slice_triangles"], 100)
            self.assertGreater(row["surface_us"]["p50"], 0)
            self.assertGreater(row["slice_us"]["p50"], 0)
            self.assertGreater(row["both_us"]["p50"], 0)
            self.assertGreater(row["near_us"]["p50"], 0)
            self.assertGreater(row["fine_points"], row["surface_nodes"])
            self.assertGreater(row["largest_mm"], 0.1)
            self.assertLess(row["error_mm"], row["stated_error_mm"] + 1e-4 * row["largest_mm"])
            self.assertLessEqual(row["columns"], row["zone_dofs"])
            self.assertEqual(row["left_out_N"], 0)
        self.assertIsNone(rows[0]["coarse_error_mm"])
        self.assertGreater(rows[1]["coarse_error_mm"], rows[1]["error_mm"])
        self.refuse("bench", "display", "--nodes", "569", says=["--nodes", "569", "570"])


if __name__ == "__main__":
    unittest.main()
