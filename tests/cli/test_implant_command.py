#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet implant: a scenario with a plan to seeds at rest, their errors, and the dose."""
import contextlib
import importlib.util
import io
import unittest
from pathlib import Path

from program import InFolder

SCENARIO = """
name = "two needles"
[patient]
source = "phantom"
[fixed]
outer = "sides"
[mesh]
nodes = 800
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


HDR = """# source: ir192_mhdr_v2
# implant: temporary
# strength_U: 40000
# prescription_Gy: 15
x_mm,y_mm,z_mm,needle,dwell_s
-10,0,30,1,20
-10,0,25,1,30
-10,0,20,1,20
10,0,30,2,20
10,0,25,2,30
10,0,20,2,0
"""


class TemporaryImplant(InFolder):
    def case(self, plan=HDR):
        self.write("case.toml", SCENARIO)
        self.write("plan.csv", plan)

    def test_dwell_positions_move_between_planning_and_delivery_and_keep_their_times(self):
        self.case()
        done = self.succeed("implant", "case.toml", "-o", "out", "--set", "tissue.creep_s=600", "--json", "json")
        self.assertIn("2 catheters, 6 dwell positions", done.stdout)
        self.assertIn("planning to delivery", done.stdout)
        self.assertNotIn("seed", done.stdout)
        result = self.read("out/summary.json")
        self.assertEqual(result, self.read("json"))
        implant = result["implant"]
        self.assertNotIn("seeds", implant)
        self.assertEqual([catheter["name"] for catheter in implant["catheters"]], ["1", "2"])
        self.assertEqual(implant["planning_to_delivery_s"], 3600)
        moved = 0.0
        for dwell in implant["dwell_positions"]:
            self.assertTrue(dwell["in_tissue"])
            for axis in range(3):
                error = dwell["delivery_mm"][axis] - dwell["planned_mm"][axis]
                self.assertAlmostEqual(error, sum(part[axis] for part in dwell["why"].values()), places=9)
                wait = dwell["delivery_mm"][axis] - dwell["planning_mm"][axis]
                self.assertAlmostEqual(wait, dwell["why"]["planning to delivery"][axis], places=9)
                moved = max(moved, abs(wait))
        self.assertGreater(moved, 0.05)
        for dvh in (implant["delivered_dvh"], implant["at_planning"]["delivered_dvh"]):
            self.assertEqual([row["structure"] for row in dvh], [row["structure"] for row in implant["planned_dvh"]])
        self.assertEqual(implant["goals"], [])
        rows = self.rows("out/seeds.csv")
        self.assertEqual([float(row["dwell_s"]) for row in rows], [20, 30, 20, 20, 30, 0])
        self.assertAlmostEqual(float(rows[1]["delivery_z_mm"]), implant["dwell_positions"][1]["delivery_mm"][2], places=3)
        report = (self.folder / "out/report.html").read_text()
        self.assertIn("Simulation of a temporary implant", report)
        self.assertIn("Errors of the dwell positions", report)
        # The delivered plan is a temporary plan; positions without a time are no places of its source.
        again = self.json_of("dose", "out/delivered/plan.dcm", "-o", "again")
        self.assertEqual((again["implant"], again["seeds"]), ("temporary", 5))
        for dwell, position in zip(implant["dwell_positions"], again["seed_list"]):
            self.assertAlmostEqual(position["dwell_s"], dwell["dwell_s"], places=6)
            for axis in range(3):
                self.assertAlmostEqual(position["position_mm"][axis], dwell["delivery_mm"][axis], places=4)
        for row, other in zip(again["dvh"], implant["delivered_dvh"]):
            self.assertEqual(row["structure"], other["structure"])

    def test_what_only_permanent_implants_have_is_refused_before_anything_is_computed(self):
        self.case()
        for key, value in (("seed.stranded", "true"), ("seed.release_mm", "1"), ("seed.release_sd_mm", "1"),
                           ("seed.loss_percent", "1"), ("oedema.swelling_percent", "[10, 10, 10]"),
                           ("procedure.technique", '"pushed"')):
            self.refuse("implant", "case.toml", "-o", "out", "--set", f"{key}={value}",
                        says=["case.toml", "temporary implant", key])
        self.refuse("implant", "case.toml", "-o", "out", "--compensate", "1", says=["plan.csv", "compensation"])
        self.refuse("implant", "case.toml", "-o", "out", "--found", "found.csv", says=["found.csv", "temporary"])
        self.refuse("implant", "case.toml", "-o", "out", "--set", "procedure.planning_to_delivery_s=-1",
                    says=["planning_to_delivery_s"])
        self.case(HDR.replace(",20\n", ",0\n").replace(",30\n", ",0\n"))
        self.refuse("implant", "case.toml", "-o", "out", says=["plan.csv", "above 0 s"])


class Implant(InFolder):
    def case(self, scenario=SCENARIO, plan=PLAN):
        self.write("case.toml", scenario)
        self.write("plan.csv", plan)

    def test_seeds_have_reasons_that_add_up_to_their_errors_and_are_matched_with_those_found_on_imaging(self):
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
        self.assertEqual(result, self.read("out/summary.json"))
        rows = self.rows("out/seeds.csv")
        self.assertEqual([row["needle"] for row in rows], [seed["needle"] for seed in implant["seeds"]])
        self.assertAlmostEqual(float(rows[1]["rest_z_mm"]), implant["seeds"][1]["rest_mm"][2], places=3)
        self.assertIn("two needles", (self.folder / "out/report.html").read_text())
        self.look_at_record(implant)
        # The delivered plan is a plan: stylet dose reads it and finds the same dose.
        again = self.json_of("dose", "out/delivered/plan.dcm", "-o", "again")
        self.assertEqual(again["seeds"], 5)
        for seed, position in zip(implant["seeds"], again["seed_list"]):
            for axis in range(3):
                self.assertAlmostEqual(position["position_mm"][axis], seed["rest_mm"][axis], places=4)
        self.match_found_seeds(implant)

    def look_at_record(self, implant):
        """run.h5 of the implant in the folder out is described, and refused as a recording."""
        info = self.json_of("info", "out/run.h5")
        self.assertEqual(info["kind"], "implant")
        self.assertEqual([needle["name"] for needle in info["needles"]], [needle["name"] for needle in implant["needles"]])
        self.assertEqual([needle["steps"] for needle in info["needles"]], [needle["steps"] for needle in implant["needles"]])
        # One shape at full depth and one for each seed.
        self.assertEqual([needle["shapes"] for needle in info["needles"]], [4, 3])
        self.assertEqual([seed["error_mm"] for seed in info["seeds"]], [seed["error_mm"] for seed in implant["seeds"]])
        self.assertEqual(info["error"]["mean_mm"], implant["error"]["mean_mm"])
        text = self.succeed("info", "out/run.h5").stdout
        self.assertIn("an implant of seeds", text)
        self.assertIn("distance from plan", text)
        self.refuse("insert", "out/run.h5", "-o", "again", says=["record of an implant"])
        self.refuse("serve", "out/run.h5", says=["record of an implant"])
        self.run_the_example_of_the_documents(implant)
        whole = (self.folder / "out/run.h5").read_bytes()
        self.write("part.h5", whole[:len(whole) // 2])
        self.refuse("info", "part.h5", says=["run.h5 that stylet wrote"])

    def run_the_example_of_the_documents(self, implant):
        """Python reads run.h5 as docs/results/implant.md shows it; only where h5py is installed."""
        if importlib.util.find_spec("h5py") is None:
            return
        page = (Path(__file__).parents[2] / "docs/results/implant.md").read_text(encoding="utf-8")
        code = page.split("## run.h5 of an implant")[1].split("```python\n")[1].split("```")[0]
        code = code.replace("OUT/run.h5", str(self.folder / "out/run.h5"))
        said = io.StringIO()
        names = {}
        with contextlib.redirect_stdout(said):
            exec(code, names)  # noqa: S102: the document's own text
        for name in ("C4", "E4"):
            self.assertIn(name, said.getvalue())
        for seed, error in zip(implant["seeds"], names["error"]):
            self.assertEqual(list(error), seed["error_xyz_mm"])
        self.assertEqual(names["dose"].ndim, 3)
        names["run"].close()

    def match_found_seeds(self, first):
        """Implants again, with seeds found near those that the first run has in the folder out."""
        self.assertIsNone(first["found"])
        self.assertIsNone(first["found_dvh"])
        self.assertFalse((self.folder / "out/found.csv").exists())
        # In another order, with a common shift, without the second seed, and with one that was never dropped.
        shift = (0.5, -0.3, -1.5)
        places = [[x + dx for x, dx in zip(seed["rest_mm"], shift)] for seed in first["seeds"]]
        away = [places[0][0], places[0][1] + 70.0, places[0][2]]
        rows = [places[4], places[2], away, places[0], places[3]]
        self.write("found_seeds.csv", "x_mm,y_mm,z_mm\n" + "".join("{},{},{}\n".format(*row) for row in rows))
        done = self.succeed("implant", "case.toml", "-o", "out", "--found", "found_seeds.csv", "--json", "json")
        self.assertIn("Found on imaging", done.stdout)
        self.assertIn("(no. 2 of the plan)", done.stdout)
        self.assertIn("found_seeds.csv, line 4", done.stdout)
        result = self.read("out/summary.json")
        self.assertEqual(result, self.read("json"))
        implant, found = result["implant"], result["implant"]["found"]
        self.assertEqual((found["found"], found["matched"], found["not_found"]), (5, 4, [2]))
        self.assertEqual([seed["found_number"] for seed in found["not_dropped"]], [3])
        self.assertEqual([(seed["number"], seed["found_number"]) for seed in found["seeds"]],
                         [(1, 4), (3, 2), (4, 5), (5, 1)])
        self.assertTrue(found["common_shift_beyond_chance"])
        for axis in range(3):
            self.assertAlmostEqual(found["common_shift_mm"][axis], shift[axis], places=9)
            for seed in found["seeds"]:
                parts = sum(part[axis] for part in seed["why"].values()) + seed["remainder_xyz_mm"][axis]
                self.assertAlmostEqual(parts, seed["error_xyz_mm"][axis], places=9)
                self.assertAlmostEqual(seed["remainder_without_shift_xyz_mm"][axis], 0.0, places=9)
        self.assertAlmostEqual(found["agreement"]["all"]["correlation"], 1.0, places=9)
        self.assertAlmostEqual(found["agreement"]["all"]["explained_percent"], 100.0, places=6)
        for errors in (found["as_found"], found["without_shift"]):
            self.assertAlmostEqual(sum(part["mm2"] for part in errors["parts"]), errors["mean_square_mm2"], places=9)
        # The dose is that of five seeds where they were found; without the shift and one seed it would be the delivered.
        self.assertEqual([row["structure"] for row in implant["found_dvh"]],
                         [row["structure"] for row in implant["delivered_dvh"]])
        self.assertIn("found_value", implant["goals"][0])
        self.assertAlmostEqual(implant["goals"][0]["value"], first["goals"][0]["value"], places=6)
        dose = self.read("out/found/dose.json")
        self.assertEqual(dose["dvh"], implant["found_dvh"])
        self.assertEqual(dose["seeds"], 5)
        table = self.rows("out/found.csv")
        self.assertEqual([row["found"] for row in table], ["4", "", "2", "5", "1", "3"])
        self.assertAlmostEqual(float(table[5]["found_y_mm"]), away[1], places=3)
        self.assertIn('id="found"', (self.folder / "out/report.html").read_text())

    def test_found_seeds_that_cannot_be_right_are_refused_before_anything_is_computed(self):
        self.case()
        head = "x_mm,y_mm,z_mm\n"
        implant = ("implant", "case.toml", "-o")
        self.refuse(*implant, "out", "--found", "none.csv", says=["none.csv", "no such file"])
        self.refuse(*implant, "out", "--found", "case.toml", says=["case.toml"])
        for text, *says in ((head + "1,2,3\n1,nan,3\n", "line 3", "y_mm", "'nan'"),
                            ("x_mm,y_mm,z_cm\n1,2,3\n", "line 1", "z_cm", "Did you mean 'z_mm'?"),
                            (head + "0,90,20\n0,95,20\n5,0,20\n", "line 2", "2 of 3 seeds", "30 mm", "register")):
            self.refuse(*implant, "out", "--found", self.write("found.csv", text), says=["found.csv", *says])
        self.write("found.csv", head + "0,0,20\n")
        self.refuse(*implant, "out", "--compensate", "1", "--found", "found.csv", says=["compensation"])
        self.refuse(*implant, ".", "--found", "found.csv", says=["found.csv", "replace this file"])

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
        self.refuse("implant", "case.toml", "-o", "out", says=["plan.csv", "away from the target", "other patient"])
        self.case()
        self.refuse("implant", "case.toml", "-o", "out", "--span", "--set", "tissue.preset=soft", says=["preset"])
        self.refuse("insert", "case.toml", "-o", "out", says=["stylet implant"])


if __name__ == "__main__":
    unittest.main()
