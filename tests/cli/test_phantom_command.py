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

    def test_slices_are_as_far_apart_as_asked_and_another_seed_is_another_patient(self):
        self.succeed("phantom", "-o", "case", "--spacing", "3", "--seed", "1")
        structures = self.structures("case/phantom.json")
        for name, structure in structures.items():
            self.assertAlmostEqual(structure["slice_spacing_mm"], 3, places=6, msg=name)
        self.succeed("phantom", "-o", "other", "--spacing", "3", "--seed", "2")
        self.assertNotEqual(self.structures("other/phantom.json")["Prostate"]["volume_cc"],
                            structures["Prostate"]["volume_cc"])

    def test_folder_that_cannot_be_is_refused(self):
        self.write("file", "in the way")
        self.refuse("phantom", "-o", "file", says=["file", "not a folder"])
        self.refuse("phantom", "-o", "file/case", says=["file/case", "not a folder"])
        self.refuse("phantom", "-o", "", says=["empty"])
        self.refuse("phantom", says=["--output is required"])


if __name__ == "__main__":
    unittest.main()
