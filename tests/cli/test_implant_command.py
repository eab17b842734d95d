#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet implant: a scenario with a plan to seeds at rest, their errors, and the dose."""
import csv
import json
import unittest

from program import InFolder

SCENARIO = """
name = "two needles"
[patient]
source = "phantom"
[fixed]
outer = "sides"
[mesh]
nodes = 1500
[plan]
file = "plan.csv"
[procedure]
speed_mm_per_s = 60
pause_s = 0.5
drop_speed_mm_per_s = 20
retract_speed_mm_per_s = 60
[run]
dt_ms = 8
"""

PLAN = """# source: i125_6711
# strength_U: 0.5
# prescription_Gy: 145
# template_origin_mm: 0.0 0.2 20.0
hole,retraction_mm,train
C4,5,S-1-S-1-S
E4,10,S-1-S
"""


class Implant(InFolder):
    def case(self, scenario=SCENARIO, plan=PLAN):
        (self.folder / "case.toml").write_text(scenario)
        (self.folder / "plan.csv").write_text(plan)

    def test_every_seed_has_a_place_of_rest_and_reasons_that_add_up_to_its_error(self):
        self.case()
        result = self.json_of("implant", "case.toml", "-o", "out")
        implant = result["implant"]
        self.assertEqual(len(implant["seeds"]), 5)
        for seed in implant["seeds"]:
            self.assertTrue(seed["in_tissue"])
            for axis in range(3):
                error = seed["rest_mm"][axis] - seed["planned_mm"][axis]
                self.assertAlmostEqual(error, seed["error_xyz_mm"][axis], places=9)
                self.assertAlmostEqual(error, sum(part[axis] for part in seed["why"].values()), places=9)
        self.assertGreater(implant["error"]["mean_mm"], 0.1)
        self.assertEqual(implant["error"]["seeds"], 5)
        self.assertEqual({row["name"] for row in implant["error_by_needle"]}, {"C4", "E4"})
        self.assertEqual(len(implant["planned_dvh"]), len(implant["delivered_dvh"]))
        self.assertEqual(len(implant["goals"]), 8)
        # The files say the same.
        self.assertEqual(result, json.loads((self.folder / "out/summary.json").read_text()))
        with (self.folder / "out/seeds.csv").open(newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["needle"] for row in rows], [seed["needle"] for seed in implant["seeds"]])
        self.assertAlmostEqual(float(rows[1]["rest_z_mm"]), implant["seeds"][1]["rest_mm"][2], places=3)
        self.assertIn("two needles", (self.folder / "out/report.html").read_text())
        # The delivered plan is a plan: stylet dose reads it and finds the same dose.
        again = self.json_of("dose", "out/delivered/plan.dcm", "-o", "again")
        self.assertEqual(again["seeds"], 5)
        for seed, position in zip(implant["seeds"], again["seed_list"]):
            for axis in range(3):
                self.assertAlmostEqual(position["position_mm"][axis], seed["rest_mm"][axis], places=4)

    def test_what_cannot_be_implanted_is_refused_before_anything_is_computed(self):
        self.case(scenario=SCENARIO.replace('[plan]\nfile = "plan.csv"', '[[insertion]]\nhole = "D4"'))
        self.refuse("implant", "case.toml", "-o", "out", says=["case.toml", "no plan", "[plan]"])
        self.case(scenario=SCENARIO.replace("plan.csv", "other.csv"))
        self.refuse("implant", "case.toml", "-o", "out", says=["other.csv"])
        self.case(plan=PLAN.replace("# source: i125_6711\n", ""))
        self.refuse("implant", "case.toml", "-o", "out", says=["source"])
        self.case(plan="# source: i125_6711\n# strength_U: 0.5\nx_mm,y_mm,z_mm,needle\n0,0,0,D4\n0,0,1,D4\n")
        self.refuse("implant", "case.toml", "-o", "out", says=["needle D4", "1.00 mm apart"])
        self.case(plan=PLAN.replace("0.0 0.2 20.0", "0.0 900 20.0"))
        self.refuse("implant", "case.toml", "-o", "out", says=["plan.csv", "away from all structures"])
        self.case()
        self.refuse("implant", "case.toml", "-o", "out", "--span", "--set", "tissue.preset=soft", says=["preset"])
        self.refuse("insert", "case.toml", "-o", "out", says=["stylet implant"])


if __name__ == "__main__":
    unittest.main()
