#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet phantom: writes two files with the same contours, and another patient for another seed."""
import unittest

from program import InFolder


class Phantom(InFolder):
    def structures(self, file):
        return {s["name"]: s for s in self.json_of("info", file)["structures"]}

    def test_dicom_and_json_hold_the_same_patient(self):
        self.succeed("phantom", "-o", "new/case")
        case = self.folder / "new/case"
        self.assertEqual(sorted(p.name for p in case.iterdir()), ["phantom.dcm", "phantom.json"])
        dicom, contours = self.structures(case / "phantom.dcm"), self.structures(case / "phantom.json")
        self.assertEqual(list(dicom), list(contours))
        for name, structure in dicom.items():
            self.assertEqual(structure["points"], contours[name]["points"])
            self.assertAlmostEqual(structure["volume_cc"], contours[name]["volume_cc"], delta=0.01)

    def test_anatomy_is_complete_and_recognised(self):
        self.succeed("phantom", "-o", "case")
        names = {s["taken_as"] for s in self.json_of("info", "case/phantom.dcm")["structures"]}
        self.assertEqual(names, {"prostate", "urethra", "bladder", "rectum", "pubic_arch", "band", "body"})

    def test_prostate_has_a_usual_size_whatever_the_seed(self):
        volumes = set()
        for seed in (0, 1, 2, 7):
            report = self.json_of("phantom", "-o", f"case{seed}", "--seed", seed)
            prostate = next(s for s in report["structures"] if s["taken_as"] == "prostate")
            self.assertTrue(30 <= prostate["volume_cc"] <= 60, f"seed {seed}: {prostate['volume_cc']} cc")
            volumes.add(round(prostate["volume_cc"], 3))
        self.assertEqual(len(volumes), 4)

    def test_same_seed_gives_the_same_contours(self):
        self.succeed("phantom", "-o", "a", "--seed", "3")
        self.succeed("phantom", "-o", "b", "--seed", "3")
        self.assertEqual((self.folder / "a/phantom.json").read_bytes(), (self.folder / "b/phantom.json").read_bytes())

    def test_slices_are_as_far_apart_as_asked(self):
        self.succeed("phantom", "-o", "case", "--spacing", "3")
        for name, structure in self.structures("case/phantom.json").items():
            self.assertAlmostEqual(structure["slice_spacing_mm"], 3, places=6, msg=name)

    def test_folder_that_cannot_be_is_refused(self):
        (self.folder / "file").write_text("in the way")
        self.refuse("phantom", "-o", "file", says=["file", "not a folder"])
        self.refuse("phantom", "-o", "file/case", says=["file/case", "not a folder"])
        self.refuse("phantom", "-o", "", says=["empty"])
        self.refuse("phantom", says=["--output is required"])


if __name__ == "__main__":
    unittest.main()
