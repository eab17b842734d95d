#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet insert with an ultrasound probe in the rectum: what terminal, summary and report say about it."""
import json
import math
import unittest

from insert_case import PHANTOM, SMALL
from program import InFolder, page_text

PROBE = ("--set", 'probe.kind="biplane"', "--set", "probe.lift_mm=8", "--set", "probe.depth_mm=20")


class ProbeInTheRectum(InFolder):
    def insert(self, *settings):
        self.write("probe.toml", PHANTOM)
        said = self.succeed("insert", "probe.toml", "-o", "out", *SMALL, *settings)
        out = self.folder / "out"
        return (said.stdout, json.loads((out / "summary.json").read_text()), page_text(out / "report.html"))

    def test_terminal_summary_and_report_say_where_it_is_and_what_it_does(self):
        text, summary, page = self.insert(*PROBE)
        self.assertFalse([w for w in summary["warnings"] if "rectal_lumen:" in w], "the soft lumen needs no warning")
        probe = summary["probe"]
        self.assertEqual(probe["kind"], "biplane")
        self.assertAlmostEqual(probe["array_mm"][2], 20.0)
        self.assertGreater(probe["force_N"][1], 1.0, "the tissue pushes the probe back, to posterior")
        lasting = math.dist(probe["lasting_force_N"], [0, 0, 0])
        self.assertAlmostEqual(lasting, math.dist(probe["force_N"], [0, 0, 0]) / 4, places=6)
        self.assertLessEqual(probe["penetration_mm"], 0.05)
        width, depth, length = probe["gland"]["change_percent"]
        self.assertLess(depth, -1.0, "the gland is flattened")
        self.assertGreater(width, 0.0)
        self.assertGreater(length, 0.0)
        self.assertLess(abs(probe["gland"]["volume_percent"]), 3.0)
        self.assertLess(probe["gland"]["shift_mm"][1], 0.0, "to anterior")
        for words in ("biplane probe, 20 mm across", f"{depth:+.1f} % anterior-posterior", f"{lasting:.1f} N"):
            self.assertIn(words, text)
            self.assertTrue(words in page, words)

    def test_a_probe_in_the_contours_moves_nothing(self):
        _, summary, page = self.insert(*PROBE, "--set", "probe.in_contours=true")
        self.assertLess(max(abs(x) for x in summary["probe"]["gland"]["change_percent"]), 0.01)
        self.assertTrue("the contours were drawn with it there" in page)

    def test_without_a_probe_nothing_is_said_about_one(self):
        text, summary, page = self.insert()
        self.assertNotIn("probe", summary)
        self.assertNotIn("probe", text)
        self.assertFalse("The ultrasound probe" in page)


if __name__ == "__main__":
    unittest.main()
