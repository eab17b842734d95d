#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet insert: every result file, the same every time; bad scenarios leave nothing behind."""
import csv
import json
import unittest

import samples
from program import InFolder

SCENARIO = """
[patient]
source = "gland.json"
[mesh]
preset = "paper"
[[insertion]]
entry_mm = [5, 3, -60]
target_mm = [5, 3, 5]
speed_mm_per_s = 50
retract_speed_mm_per_s = 50
"""

FAST = ("--set", "output.pictures=false", "--set", "output.max_frames=3")  # nothing of it touches the physics

SUMMARY_KEYS = {"version", "scenario", "mesh", "steps", "peak_force_N", "events", "tip_deflection_mm", "target_shift_mm",
                "residual", "step_us", "contacts_max"}
FORCES_COLUMNS = ["time_s", "base_depth_mm", "force_axial_N", "force_sagittal_N", "force_lateral_N", "torque_x_Nmm",
                  "torque_y_Nmm", "torque_z_Nmm", "tip_x_mm", "tip_y_mm", "tip_z_mm", "tip_state", "contacts",
                  "sticking", "iterations", "step_us"]


class Insert(InFolder):
    def setUp(self):
        super().setUp()
        samples.contour_json(self.folder / "gland.json")
        (self.folder / "case.toml").write_text(SCENARIO)

    def forces(self, folder):
        with open(self.folder / folder / "forces.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_writes_every_result_and_the_same_every_time(self):
        printed = self.json_of("insert", "case.toml", "-o", "one")
        self.succeed("insert", "case.toml", "-o", "two", "--quiet", *FAST)

        names = {p.name for p in (self.folder / "one").iterdir()}
        self.assertTrue({"summary.json", "forces.csv", "tissue.pvd", "needle.vtp", "run.h5", "report.html"} <= names)
        summary = json.loads((self.folder / "one/summary.json").read_text())
        self.assertTrue(SUMMARY_KEYS <= set(summary))
        self.assertEqual(printed, summary, "--json prints summary.json")

        one, two = self.forces("one"), self.forces("two")
        self.assertEqual(list(one[0]), FORCES_COLUMNS)
        self.assertEqual(len(one), summary["steps"])
        for row in one + two:
            del row["step_us"]
        self.assertEqual(one, two)

        kinds = [event["kind"] for event in summary["events"]]
        for kind in ("skin_contact", "puncture", "region_entered", "retraction_start", "slip_start", "withdrawn"):
            self.assertIn(kind, kinds)
        self.assertEqual(kinds.index("skin_contact"), 0)
        self.assertEqual(kinds[-1], "withdrawn")
        last = one[-1]
        self.assertLess(abs(float(last["force_axial_N"])), 1e-9, "out of the patient nothing holds the needle")

        run_file = self.json_of("info", "one/run.h5")
        self.assertTrue(run_file["finished"])
        self.assertEqual(run_file["steps"], summary["steps"])
        self.assertEqual(run_file["events"], summary["events"])

    def test_setting_on_the_command_line_replaces_the_files(self):
        short = self.json_of("insert", "case.toml", "-o", "a", *FAST, "--set", "insertion.speed_mm_per_s=100", "--set",
                            "insertion.retract=false", "--set", "insertion.depth_mm=30")
        kinds = [event["kind"] for event in short["events"]]
        self.assertNotIn("retraction_start", kinds)
        self.assertLess(max(float(row["base_depth_mm"]) for row in self.forces("a")), 30.2)

    def test_schema_is_a_scenario_file_with_every_table(self):
        text = self.succeed("insert", "--print-schema").stdout
        for table in ("[patient]", "[mesh]", "[needle]", "[coupling]", "[[insertion]]", "[output]"):
            self.assertIn(table, text)

    def bad(self, *says, replace=None, add="", options=()):
        text = SCENARIO
        if replace:
            self.assertIn(replace[0], text)
            text = text.replace(*replace)
        (self.folder / "bad.toml").write_text(text + add)
        self.refuse("insert", "bad.toml", "-o", "out/bad", *options, says=says)

    def test_bad_scenarios_are_refused_with_their_place(self):
        self.refuse("insert", says=["no scenario"])
        self.refuse("insert", "nowhere.toml", "-o", "out", says=["nowhere.toml"])
        self.refuse("insert", "gland.json", "-o", "out", says=["gland.json"])
        self.bad("bad.toml", "speed_mm_per_sec", "Did you mean insertion[0].speed_mm_per_s?",
                 replace=("\nspeed_mm_per_s", "\nspeed_mm_per_sec"))
        self.bad("nose.json", "no such file", replace=("gland.json", "nose.json"))
        self.bad("bad.toml", "poisson", "0.5", add="[tissue.prostate]\npoisson = 0.5\n")
        self.bad("bad.toml", "young_kPa", "-3", add="[tissue.prostate]\nyoung_kPa = -3\n")
        self.bad("bad.toml", "line", replace=("[mesh]", "[mesh"))
        self.bad("preset", "papr", replace=('"paper"', '"papr"'))
        self.bad("mesh.nods", "Did you mean mesh.nodes?", options=("--set", "mesh.nods=5"))

    def test_needle_that_misses_the_patient_is_refused(self):
        self.bad("bad.toml", replace=("entry_mm = [5, 3, -60]\ntarget_mm = [5, 3, 5]",
                                      "entry_mm = [500, 3, -60]\ntarget_mm = [500, 3, 5]"))

    def test_folder_that_cannot_be_is_refused(self):
        self.refuse("insert", "case.toml", "-o", "gland.json", says=["gland.json", "not a folder"])


if __name__ == "__main__":
    unittest.main()
