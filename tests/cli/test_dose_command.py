#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet dose: a plan and its structures to dose, figures and files."""
import math
import unittest

from program import InFolder
from samples import ball, structure_set


def plan(seeds, **more):
    return {"format": "stylet-plan", "version": 1, "units": "mm", "frame": "LPS", "strength_U": 0.5, **more,
            "seeds": [{"position_mm": list(seed), "axis": [0, 0, 1]} for seed in seeds]}


GRID = [(x, y, z) for x in (-8, 0, 8) for y in (-8, 0, 8) for z in (-9, 0, 9)]


class Dose(InFolder):
    def case(self):
        self.write("plan.json", plan(GRID, source="i125_6711", prescription_Gy=145))
        self.write("rs.json", structure_set(ball(14), ball(3, "Urethra")))

    def test_a_point_at_10_mm_from_a_seed_has_the_dose_that_one_computes_by_hand(self):
        self.write("plan.json", plan([(0, 0, 0)]))
        self.write("points.csv", "x_mm,y_mm,z_mm\n10,0,0\n0,-10,0\n")
        dose = self.json_of("dose", "plan.json", "--source", "i125_6711", "--points", "points.csv", "-o", "out")
        by_hand = 0.5 * 0.965 * 59.4 * 24 / math.log(2) / 100
        for point in dose["points"]:
            self.assertAlmostEqual(point["dose_Gy"] / by_hand, 1, places=12)
        self.assertEqual((dose["seeds"], dose["source"], dose["formalism"]), (1, "i125_6711", "line2d"))
        self.assertIsNone(dose["prescription_Gy"])

    def test_the_result_folder_is_complete_and_its_plan_and_dose_are_read_again(self):
        self.case()
        dose = self.json_of("dose", "plan.json", "--structures", "rs.json", "-o", "out")
        files = {p.name for p in (self.folder / "out").iterdir()}
        self.assertEqual(files, {"report.html", "dose.json", "dvh.csv", "dose.nrrd", "plan.dcm", "dose.dcm"})
        self.assertEqual(dose, self.read("out/dose.json"))
        again = self.json_of("dose", "out/plan.dcm", "--structures", "rs.json", "--source", "i125_6711", "--compare",
                             "out/dose.dcm", "-o", "again", "--ignore-frame-of-reference")
        self.assertEqual(again["seeds"], 27)
        self.assertAlmostEqual(again["compare"]["median_ratio"], 1, places=5)
        self.assertAlmostEqual(again["compare"]["p1"], 1, places=4)
        self.assertAlmostEqual(again["compare"]["p99"], 1, places=4)
        for a, b in zip(dose["dvh"], again["dvh"]):
            self.assertAlmostEqual(a["D90_Gy"] / b["D90_Gy"], 1, places=5)
        self.assertEqual(self.json_of("info", "out/plan.dcm")["seeds"], 27)
        self.assertEqual(self.json_of("info", "out/dose.dcm")["kind"], "dose")

    def test_figures_are_those_of_the_structures(self):
        self.case()
        dose = self.json_of("dose", "plan.json", "--structures", "rs.json", "-o", "out")
        prostate, urethra = dose["dvh"]
        self.assertEqual((prostate["region"], urethra["region"]), ("prostate", "urethra"))
        self.assertAlmostEqual(prostate["volume_cc"], 4 / 3 * math.pi * 1.4**3, delta=0.1)
        self.assertGreater(prostate["D10_Gy"], prostate["D30_Gy"])
        self.assertGreater(prostate["D30_Gy"], prostate["D90_Gy"])
        self.assertAlmostEqual(prostate["V100_cc"], prostate["V100_percent"] / 100 * prostate["volume_cc"], places=6)
        by_name = {(g["structure"], g["metric"]): g for g in dose["goals"]}
        d90 = by_name["prostate", "D90_percent"]
        self.assertAlmostEqual(d90["value"], prostate["D90_Gy"] / 1.45, places=6)
        self.assertEqual(d90["met"], d90["value"] >= 100)
        self.assertIsNone(by_name["rectum", "D2cc_percent"]["value"])

    def test_a_dose_within_days_a_rate_and_a_decay_follow_the_half_life(self):
        self.write("plan.json", plan([(0, 0, 0)], source="i125_6711"))
        self.write("points.csv", "x_mm,y_mm,z_mm\n10,0,0\n")

        def at(*more):
            return self.json_of("dose", "plan.json", "--points", "points.csv", "-o", "out", *more)["points"][0]["dose_Gy"]

        total = at()
        self.assertAlmostEqual(at("--days", 59.4) / total, 0.5, places=12)
        self.assertAlmostEqual(at("--decay-days", 59.4) / total, 0.5, places=12)
        self.assertAlmostEqual(at("--quantity", "rate") * 59.4 * 24 / math.log(2) / total, 1, places=12)
        self.assertFalse((self.folder / "out/dose.dcm").exists(), "DICOM has no unit of a dose rate")
        one = at("--formalism", "point", "--phi-an", 0.95)
        two = at("--formalism", "point", "--phi-an", 0.475 + 0.475 / 2)
        self.assertAlmostEqual(two / one, 0.75, places=12)

    def test_a_plan_without_a_source_model_is_told_which_fit(self):
        self.case()
        self.json_of("dose", "plan.json", "-o", "out")
        self.write("unnamed.json", plan(GRID))
        self.refuse("dose", "unnamed.json", "-o", "new", says=["does not name the model", "i125_6711", "i125_agx100"])
        self.refuse("dose", "out/plan.dcm", "--source", "pd103_theraseed200", "-o", "new", says=["I-125", "Pd-103"])
        self.refuse("dose", "out/plan.dcm", "--source", "i125_6712", "-o", "new", says=["i125_6711"])

    def test_what_does_not_belong_together_is_refused(self):
        self.case()
        self.write("far.json", plan([(300, 0, 0)], source="i125_6711"))
        self.refuse("dose", "far.json", "--structures", "rs.json", "-o", "new", says=["away from the target", "other patient"])
        self.write("a.json", plan(GRID, source="i125_6711", frame_of_reference="1.2.3"))
        self.write("b.json", structure_set(ball(14), frame_of_reference="1.2.4"))
        self.refuse("dose", "a.json", "--structures", "b.json", "-o", "new", says=["frame of reference", "1.2.3", "1.2.4"])
        self.succeed("dose", "a.json", "--structures", "b.json", "-o", "out", "--ignore-frame-of-reference")
        self.refuse("dose", "plan.json", "--phi-an", 0.9, "-o", "new", says=["line2d"])
        self.refuse("dose", "rs.json", "-o", "new", says=["stylet-plan"])
        self.refuse("dose", "plan.json", "--compare", "rs.json", "-o", "new", says=["RTDOSE"])

    def test_a_grid_that_does_not_hold_an_organ_is_warned_of(self):
        self.case()
        self.succeed("dose", "plan.json", "-o", "small", "--grid", 2)
        self.write("large.json", structure_set(ball(45, gap=3.0)))
        dose = self.json_of("dose", "plan.json", "--structures", "large.json", "--compare", "small/dose.dcm", "-o", "out",
                            "--ignore-frame-of-reference")
        self.assertLess(dose["dvh"][0]["covered_by_grid_percent"], 50)
        self.assertTrue(any("holds only" in w for w in dose["warnings"]), dose["warnings"])

    def test_all_source_models_are_listed(self):
        listed = self.json_of("info", "sources")
        self.assertEqual(len(listed["sources"]), 10)
        self.assertEqual(self.json_of("info", "i125_6711")["dose_rate_constant"], 0.965)


if __name__ == "__main__":
    unittest.main()
