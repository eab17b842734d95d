#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""For each kind of faulty scenario, stylet insert reports the place and the fault and writes nothing. The faults of keys,
values and motions are in tests/io/scenario, those that appear with the patient in tests/sim/test_model.cpp."""
import unittest

import samples
from insert_case import BLOCK, Cases


class BadScenario(Cases):
    def refuse_scenario(self, text, says):
        self.refuse("insert", self.write("bad.toml", text), "-o", "out", "--json", "out.json", says=says)

    def refuse_setting(self, setting, says, scenario="block.toml"):
        self.refuse("insert", scenario, "-o", "out", "--json", "-", "--set", setting, says=says)

    def test_no_scenario(self):
        self.refuse("insert", says=["no scenario", "scenarios/demo.toml"])
        self.refuse("insert", "--print-tissues", "--set", "tissue.body.young_kPa=5",
                    says=["--set has no scenario to change", "scenarios/demo.toml"])

    def test_outputs_that_cannot_be_written(self):
        self.write("taken", "")
        self.refuse("insert", "block.toml", "-o", "taken", says=["taken", "not a folder"])
        self.refuse("insert", "block.toml", "-o", "taken/below", says=["taken", "not a folder"])
        self.refuse("insert", "block.toml", "-o", "out", "--json", "taken/s.json", says=["taken"])

    def test_faults_of_the_file_have_its_name_and_line(self):
        self.refuse_scenario(BLOCK + 'name = "open', ["bad.toml", f"line {len(BLOCK.splitlines()) + 1}"])
        self.refuse_scenario(BLOCK.replace("depth_mm", "dept_mm"), ["bad.toml", "line 9", "dept_mm", "depth_mm"])
        self.refuse_scenario(BLOCK.replace("depth_mm = 40", "depth_mm = 97"),
                             ["bad.toml", "depth_mm = 97", "needle.length_mm"])
        self.refuse_scenario(BLOCK.split("[[insertion]]")[0], ["bad.toml", "[[insertion]]"])

    def test_faults_of_settings_have_the_setting(self):
        self.refuse_setting("insertion.speed_mm_per_s=-5", ["--set", "speed_mm_per_s", "5", "…"])
        self.refuse_setting("insertion.hole=H9", ["H9", "columns are A … G"], "phantom.toml")
        self.refuse("insert", "block.toml", "-o", "out", "--engine", "woodbery",
                    says=["coupling.engine", "did you mean", "woodbury"])
        self.refuse("insert", "block.toml", "-o", "out", "--method", "node-repositioning",
                    says=["node-repositioning", "condensed", "woodbury"])

    def test_faults_of_the_files_that_it_names(self):
        self.refuse_scenario(BLOCK.replace("block.msh", "gone.msh"), ["gone.msh"])
        samples.stl_surface(self.folder / "skin.stl")
        self.refuse_scenario(BLOCK.replace("block.msh", "skin.stl"), ["skin.stl", "cannot be meshed"])
        self.write("motion.csv", "time,x\n0,1\n")
        self.refuse_scenario(BLOCK.split("[[insertion]]")[0] + '[[insertion]]\nmotion = "motion.csv"\n',
                             ["motion.csv", "time_s"])

    def test_faults_that_appear_with_the_patient(self):
        self.refuse_scenario(BLOCK.replace("[31, 32, -10]", "[131, 32, -10]"),
                             ["bad.toml", "insertion[0]", "misses the patient", "(131.0, 32.0, -10.0) mm",
                              "(60.0, 60.0, 60.0) mm"])
        self.refuse_scenario(BLOCK.replace("[needle]", 'regions = ["lunp"]\n[needle]'),
                             ["bad.toml", "fixed.regions", "'lunp'", "'lump'"])
        self.refuse_scenario(BLOCK + '[patient.regions]\nlunp = "prostate"\n', ["lunp", "lump"])


if __name__ == "__main__":
    unittest.main()
