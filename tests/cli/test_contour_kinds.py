#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Contours that are drawn or written in an unusual way have the same, right volume in `stylet info`, `mesh` and `dose`,
and what is unusual about them is said."""
import json

from program import InFolder
from shared_data import FOUND, run_tests_with

# File, volume of the gland [cc], its tolerance [%], and words of the note.
KINDS = (("k01_twice_one_slice.dcm", 32.40, 0.2, "occurs twice"),
         ("k01_twice_other_points.dcm", 32.40, 0.5, "occurs twice"),
         ("k01_twice_reversed.dcm", 32.40, 0.2, "occurs twice"),
         ("k01_twice_same_order.dcm", 32.40, 0.2, "occurs twice"),
         ("k02_two_lobes_overlap.dcm", 46.64, 0.2, "united"),
         ("k03_two_parts_z_0.03.dcm", 22.79, 0.2, "slightly different heights"),
         ("k03_two_parts_z_0.08.dcm", 22.79, 0.2, "slightly different heights"),
         ("k04_four_missing.dcm", 31.17, 0.2, "z = -6.00 to z = 9.00"),
         ("k04_spacing_1_then_3.dcm", 32.24, 0.2, "unevenly spaced"),
         ("k04_spacing_3_then_9.dcm", 31.61, 0.2, "unevenly spaced"),
         ("k04_two_missing.dcm", 32.15, 0.2, "z = -3.00 to z = 6.00"),
         ("k10_empty_item.dcm", 32.40, 0.2, "no points"),
         ("k10_one_point.dcm", 32.40, 0.2, "1 point"),
         ("k10_small_loop.dcm", 32.40, 0.2, "contour 8"),
         ("k10_three_on_a_line.dcm", 32.40, 0.2, "points on a line"),
         ("k10_two_points.dcm", 32.40, 0.2, "2 points"),
         ("k11_item_for_no_roi.dcm", 32.40, 0.2, "ROI number 77"),
         ("k11_rectum_in_other_frame.dcm", 32.40, 0.2, "'Rectum' is left out"),
         ("k13_two_items.dcm", 32.40, 0.2, "several items"))


class ContourKinds(InFolder):
    def test_have_one_volume_in_all_commands_and_a_note(self):
        plan = self.folder / "one_needle.csv"
        plan.write_text("# source: i125_6711\n# strength_U: 0.44\n# prescription_Gy: 145\n"
                        "# template_origin_mm: 0 0.2 20\nhole,retraction_mm,train\nB4,0,S-1-S-1-S-1-S\n", encoding="utf-8")
        for file, volume, tolerance, words in KINDS:
            with self.subTest(file=file):
                info = self.json_of("info", FOUND / file)
                glands = [s for s in info["structures"] if s["taken_as"] == "prostate"]
                self.assertEqual(len(glands), 1)
                self.near(glands[0]["volume_cc"], volume, tolerance)
                self.assertIn(words, " ".join(info["notes"]))
                # The gland alone is meshed and sampled; the other structures would take most of the time.
                skipped = [w for s in info["structures"] if s["taken_as"] != "prostate" for w in ("--skip", s["name"])]
                mesh = self.json_of("mesh", FOUND / file, "-o", "m.vtu", "--nodes", "300", "--quiet", *skipped)
                self.near(mesh["regions"]["prostate"]["structure_volume_cc"], volume, tolerance)
                self.assertIn(words, " ".join(mesh["notes"]))
                done = self.succeed("dose", plan, "--structures", FOUND / file, "--grid", "10",
                                    "--ignore-frame-of-reference", "-o", "dose", *skipped)
                self.assertIn(words, done.stderr)
                dose = json.loads((self.folder / "dose" / "dose.json").read_text())
                glands = [s for s in dose["dvh"] if s["region"] == "prostate"]
                self.assertEqual(len(glands), 1)
                self.near(glands[0]["volume_cc"], volume, 1)  # the samples of the dose are half a millimetre apart

    def near(self, value, right, percent):
        self.assertAlmostEqual(value, right, delta=right * percent / 100)


if __name__ == "__main__":
    run_tests_with(FOUND)
