#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of real patients and of other programs are read with the values that are published with them, or correctly
refused."""

from program import InFolder
from shared_data import SHARED, run_tests_with



class RealData(InFolder):
    def info(self, file, *options):
        return self.json_of("info", SHARED / file, *options)

    def test_a_mask_has_the_glands_volume_and_tilt(self):
        info = self.info("msd_prostate_masks/prostate_00.nii.gz")
        self.assertEqual([label["label"] for label in info["labels"]], [1, 2])
        self.assertAlmostEqual(sum(label["volume_cc"] for label in info["labels"]), 47.3, delta=0.051)
        self.assertAlmostEqual(info["slice_tilt_deg"], 16.8, delta=0.051)

    def check_structures(self, file, expected):
        found = {s["name"]: s for s in self.info(file)["structures"]}
        self.assertEqual(set(found), set(expected))
        for name, (taken_as, slices, volume_cc) in expected.items():
            self.assertEqual((found[name]["taken_as"], found[name]["slices"]), (taken_as, slices), name)
            self.assertAlmostEqual(found[name]["volume_cc"], volume_cc, delta=0.051, msg=name)

    def test_structure_sets_have_the_organs_volumes(self):
        self.check_structures("slicerrt_rando_rtstruct", {
            "BODY": ("body", 92, 10697.2), "Bladder": ("bladder", 21, 117.5), "PTV": ("prostate", 20, 49.2),
            "Femoral Head Lt": ("femur_left", 19, 49.4), "Femoral Head RT": ("femur_right", 18, 50.3),
            "Rectum": ("rectum", 40, 30.7)})
        self.check_structures("robustbrachy_hdr_phantom/SS001.dcm", {
            "Prostate": ("prostate", 61, 49.7), "Urethra": ("urethra", 69, 1.4), "Rectum": ("rectum", 69, 6.3)})

    def test_plan_and_dose_are_described_and_refused_as_patients(self):
        for file, modality in (("PL001.dcm", "RTPLAN"), ("DO001.dcm", "RTDOSE")):
            path = SHARED / "robustbrachy_hdr_phantom" / file
            self.assertEqual(self.json_of("info", path)["kind"], {"RTPLAN": "plan", "RTDOSE": "dose"}[modality])
            self.refuse("mesh", path, "-o", "model.vtu", says=[file, modality, "RTSTRUCT"])


if __name__ == "__main__":
    run_tests_with(SHARED)
