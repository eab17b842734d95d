#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""For every kind of faulty scenario, stylet insert reports the place and the fault and writes nothing."""
import unittest

from insert_case import BLOCK, PHANTOM, block_mesh
from program import InFolder


class BadScenario(InFolder):
    def setUp(self):
        super().setUp()
        block_mesh(self.folder / "block.msh")
        self.write("block.toml", BLOCK)
        self.write("phantom.toml", PHANTOM)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def refuse_scenario(self, text, says):
        self.refuse("insert", self.write("bad.toml", text), "-o", "out", "--json", "out.json", says=["bad.toml", *says])

    def refuse_setting(self, setting, says, scenario="block.toml"):
        self.refuse("insert", scenario, "-o", "out", "--json", "-", "--set", setting, says=says)

    # Faults of the command line.

    def test_no_scenario(self):
        self.refuse("insert", says=["no scenario", "scenarios/demo.toml"])

    def test_settings_of_tissues_without_a_scenario(self):
        self.refuse("insert", "--print-tissues", "--set", "tissue.body.young_kPa=5",
                    says=["--set has no scenario to change", "scenarios/demo.toml"])

    def test_scenario_that_is_not_there(self):
        self.refuse("insert", "nowhere.toml", says=["nowhere.toml"])

    def test_folder_in_place_of_a_scenario(self):
        self.refuse("insert", ".", says=["."])

    def test_output_that_is_a_file(self):
        self.write("taken", "")
        self.refuse("insert", "block.toml", "-o", "taken", says=["taken", "not a folder"])
        self.refuse("insert", "block.toml", "-o", "taken/below", says=["taken", "not a folder"])

    def test_json_that_cannot_be_written(self):
        self.write("taken", "")
        self.refuse("insert", "block.toml", "-o", "out", "--json", "taken/s.json", says=["taken"])

    # Faults of the file.

    def test_no_toml(self):
        self.refuse_scenario("[patient\nsource = 1", ["line 1"])
        self.refuse_scenario(BLOCK + 'name = "open', [f"line {len(BLOCK.splitlines()) + 1}"])

    def test_unknown_key_with_its_line_and_the_nearest_name(self):
        self.refuse_scenario(BLOCK.replace("depth_mm", "dept_mm"), ["line 9", "dept_mm", "depth_mm"])
        self.refuse_scenario(BLOCK.replace("outer", "outr"), ["line 4", "outr", "fixed.outer"])

    def test_unknown_table(self):
        self.refuse_scenario(BLOCK + "[need1e]\nlength_mm = 1\n", ["need1e", "needle"])

    def test_no_patient(self):
        self.refuse_scenario(BLOCK.replace('source = "block.msh"', ""), ["patient.source", "phantom"])

    def test_patient_that_is_not_there(self):
        self.refuse("insert", self.write("bad.toml", BLOCK.replace("block.msh", "gone.msh")), "-o", "out",
                    says=["gone.msh"])

    def test_surface_in_place_of_a_patient(self):
        import samples
        samples.stl_surface(self.folder / "skin.stl")
        self.refuse("insert", self.write("bad.toml", BLOCK.replace("block.msh", "skin.stl")), "-o", "out",
                    says=["skin.stl", "cannot be meshed"])

    def test_no_needle(self):
        self.refuse_scenario(BLOCK.split("[[insertion]]")[0], ["[[insertion]]"])

    def test_values_of_the_wrong_kind_or_range(self):
        self.refuse_scenario(BLOCK.replace("depth_mm = 40", 'depth_mm = "deep"'), ["line 9", "depth_mm", "number"])
        self.refuse_scenario(BLOCK.replace("depth_mm = 40", "depth_mm = nan"), ["line 9", "depth_mm"])
        self.refuse_scenario(BLOCK.replace('"sides"', '"side"'), ["line 4", "sides"])

    def test_poisson_ratio_of_a_half(self):
        self.refuse_scenario(BLOCK + "[tissue.lump]\npoisson = 0.5\n", ["tissue.lump.poisson = 0.5", "0.4999"])

    def test_depth_beyond_the_needle(self):
        self.refuse_scenario(BLOCK.replace("depth_mm = 40", "depth_mm = 97"), ["depth_mm = 97", "needle.length_mm"])

    def test_hole_and_entry_at_once(self):
        self.refuse_scenario(BLOCK + 'hole = "D4"\n', ["hole", "entry_mm"])

    def test_hole_that_is_not_in_the_template(self):
        self.refuse_setting("insertion.hole=H9", ["H9", "columns are A … G"], "phantom.toml")

    def test_methods_there_are_not(self):
        self.refuse_setting("coupling.method=near-feild", ["did you mean", "near-field", "node-addition"])

    def test_what_does_not_go_together(self):
        self.refuse("insert", "block.toml", "-o", "out", "--method", "node-repositioning",
                    says=["node-repositioning", "condensed", "woodbury"])
        self.refuse_setting("coupling.projection=nearest-node", ["nearest-node", "staggered"])
        self.refuse("insert", "block.toml", "-o", "out", "--engine", "woodbery",
                    says=["coupling.engine", "did you mean", "woodbury"])

    # Faults of --set.

    def test_settings_out_of_range(self):
        for setting in ("insertion.speed_mm_per_s=-5", "insertion.depth_mm=-1", "needle.length_mm=-150",
                        "mesh.nodes=-3", "tissue.lump.young_kPa=-40", "run.dt_ms=0", "coupling.spacing_mm=1e9"):
            with self.subTest(setting=setting):
                key, value = setting.split("=")
                self.refuse_setting(setting, ["--set", key.split(".")[-1], value.lstrip("-")[:2], "…"])

    def test_settings_of_unknown_keys(self):
        self.refuse_setting("mesh.node=500", ["mesh.node", "mesh.nodes"])

    def test_settings_without_a_value(self):
        self.refuse_setting("mesh.nodes", ["mesh.nodes", "="])

    # Faults that appear only with the patient.

    def test_needle_that_misses_the_patient(self):
        self.refuse_scenario(BLOCK.replace("[31, 32, -10]", "[131, 32, -10]"),
                             ["insertion[0]", "misses the patient", "(131.0, 32.0, -10.0) mm", "(60.0, 60.0, 60.0) mm"])

    def test_tissue_of_a_region_that_is_not_there(self):
        self.refuse_scenario(BLOCK + "[tissue.limp]\nyoung_kPa = 20\n",
                             ["[tissue.limp]", "there are: tissue, lump", "Did you mean 'lump'?"])

    def test_held_region_that_is_not_there(self):
        self.refuse_scenario(BLOCK.replace("[needle]", 'regions = ["lunp"]\n[needle]'),
                             ["fixed.regions", "'lunp'", "'lump'"])

    def test_name_for_a_region_that_is_not_there(self):
        self.refuse("insert", self.write("bad.toml", BLOCK + '[patient.regions]\nlunp = "prostate"\n'), "-o", "out",
                    says=["lunp", "lump"])

    def test_tissue_that_nothing_holds(self):
        self.refuse_setting("fixed.outer=none", ["[fixed]", "nothing holds the tissue", "sides"])

    def test_target_deeper_than_the_needle(self):
        self.refuse_scenario(BLOCK.replace("length_mm = 100", "length_mm = 20").replace("depth_mm = 40\n", ""),
                             ["insertion[0]", "needle is 20 mm long", "needle.length_mm"])

    def test_mesh_in_other_units(self):
        block_mesh(self.folder / "block.msh", size=0.06)
        self.refuse("insert", "block.toml", "-o", "out", says=["block.msh", "scale"])

    def test_mesh_with_an_inverted_element(self):
        text = (self.folder / "block.msh").read_text().splitlines()
        last = text[-2].split()
        last[-1], last[-2] = last[-2], last[-1]
        text[-2] = " ".join(last)
        (self.folder / "block.msh").write_text("\n".join(text) + "\n")
        self.refuse("insert", "block.toml", "-o", "out", says=["block.msh"])

    # Faults of recorded motions.

    def test_recorded_motion_that_is_not_there_or_broken(self):
        recorded = BLOCK.split("[[insertion]]")[0] + '[[insertion]]\nmotion = "motion.csv"\n'
        self.refuse("insert", self.write("bad.toml", recorded), "-o", "out", says=["motion.csv"])
        self.write("motion.csv", "time,x\n0,1\n")
        self.refuse("insert", "bad.toml", "-o", "out", says=["motion.csv", "time_s"])

    def test_recorded_motion_that_starts_inside(self):
        rows = "time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz\n0,31,32,-80,1,0,0,0\n1,31,32,-70,1,0,0,0\n"
        self.write("motion.csv", rows)
        self.refuse_scenario(BLOCK.split("[[insertion]]")[0] + '[[insertion]]\nmotion = "motion.csv"\n',
                             ["insertion[0].motion", "inside the patient"])


if __name__ == "__main__":
    unittest.main()
