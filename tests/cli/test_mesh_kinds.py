#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes with regions in an array of any name, and DICOM files without a header or with a Japanese name, as other
programs write them, have the right regions and volumes."""
from program import InFolder
from shared_data import FOUND, run_tests_with

ARRAYS = {"k15_labels.vtk": "labels", "k15_material.vtu": "material", "k15_elementdata_color.msh": "color"}


class MeshKinds(InFolder):
    def check_regions(self, info, file):
        volumes = {name: region["volume_cc"] for name, region in info["regions"].items()}
        self.assertEqual(set(volumes), {"region 1", "region 2"}, file)
        self.assertAlmostEqual(volumes["region 1"], 8.0, delta=0.001, msg=file)
        self.assertAlmostEqual(volumes["region 2"], 208.0, delta=0.001, msg=file)

    def test_regions_of_any_name_are_read_with_a_note(self):
        for file, array in ARRAYS.items():
            info = self.json_of("info", FOUND / file)
            self.check_regions(info, file)
            self.assertIn(f"'{array}'", " ".join(info["notes"]), file)

    def test_an_array_can_be_chosen_and_a_wrong_name_is_an_error_with_the_right_ones(self):
        for file, array in ARRAYS.items():
            self.check_regions(self.json_of("info", FOUND / file, "--regions-from", array), file)
            for command in (("info", FOUND / file), ("mesh", FOUND / file, "-o", "out.vtu")):
                self.refuse(*command, "--regions-from", array + "s", says=[f"'{array}s'", f"Did you mean '{array}'?"])
                self.refuse(*command, "--regions-from", "xyz", says=["'xyz'", f'"{array}"', "Name one of these"])

    def test_several_regions_become_one_if_the_user_says_so(self):
        for words in (("region 1=prostate", "region 2=prostate"), ("1=prostate", "2=prostate")):
            mesh = self.json_of("mesh", FOUND / "k15_material.vtu", "-o", "out.vtu", "--region", words[0], "--region",
                                words[1])
            self.assertEqual(list(mesh["regions"]), ["prostate"])
            self.assertAlmostEqual(mesh["regions"]["prostate"]["volume_cc"], 216.0, delta=0.001)
            self.assertIn("'region 1', 'region 2' of the file are one region, 'prostate'", " ".join(mesh["notes"]))

    def test_a_scenario_chooses_the_array_too(self):
        self.succeed("info", FOUND / "k15_material.vtu", "--regions-from", "material", "--scenario", "-o", "s.toml")
        self.assertIn('regions_from = "material"', (self.folder / "s.toml").read_text())
        self.refuse("prepare", "s.toml", "-o", "m.stylet", "--set", 'patient.regions_from="materials"',
                    says=["'materials'", "Did you mean 'material'?"])

    def test_bare_dicom_and_japanese_names_are_read(self):
        for file in ("k12_bare_implicit_date_first", "k12_bare_implicit_group_length", "k17_name_iso2022_japanese.dcm"):
            structures = self.json_of("info", FOUND / file)["structures"]
            gland = [s for s in structures if s["taken_as"] == "prostate"]
            self.assertEqual(len(gland), 1, file)
            self.assertAlmostEqual(gland[0]["volume_cc"], 32.40, delta=0.05, msg=file)
        self.assertIn("前立腺", [s["name"] for s in structures])


if __name__ == "__main__":
    run_tests_with(FOUND)
