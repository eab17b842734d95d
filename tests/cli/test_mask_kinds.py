#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks with one property each that people met with other programs have the right volumes, places and notes."""
from program import InFolder
from shared_data import FOUND, run_tests_with



class MaskKinds(InFolder):
    def check(self, file, labels, notes=()):
        """`labels`: for each label its voxels and volume [cc]; `notes`: words that must stand in one note each."""
        info = self.json_of("info", FOUND / file)
        self.assertEqual([(label["label"], label["voxels"]) for label in info["labels"]],
                         [(number, voxels) for number, (voxels, _) in labels.items()], file)
        for label in info["labels"]:
            self.assertAlmostEqual(label["volume_cc"], labels[label["label"]][1], delta=0.0006, msg=file)
        for words in notes:
            self.assertTrue(any(words in note for note in info["notes"]), f"{file}: {words} not in {info['notes']}")
        return info

    GLAND_AND_URETHRA = {1: (6218, 22.385), 2: (70, 0.252)}

    def test_slices_without_a_frame_are_empty_where_their_distance_is_stated(self):
        self.check("k05_dcmqi_sparse_labelmap_noppv.dcm", {1: (630, 0.772)}, ["1 of 3 slices of 2.5 mm"])
        self.check("k05_every_second_slice.dcm", {1: (2452, 13.241)}, ["6 of 13 slices of 3 mm"])
        self.check("k05_two_distant_frames.dcm", {1: (946, 5.108)}, ["slices 2 to 4"])

    def test_plates_of_one_slice_are_not_meshed(self):
        self.refuse("mesh", FOUND / "k05_two_distant_frames.dcm", "-o", "m.vtu", says=["thicker than a voxel", "slices"])

    def test_of_plates_of_one_slice_the_mesh_says_why_it_keeps_little(self):
        notes = " ".join(self.json_of("mesh", FOUND / "k05_every_second_slice.dcm", "-o", "m.vtu")["notes"])
        self.assertIn("7 slices, of which 7 are plates of one slice", notes)

    def test_each_volume_of_an_old_slicer_is_a_segment(self):
        info = self.check("k06_slicer_4.10.seg.nrrd", self.GLAND_AND_URETHRA, ["share 70 voxels"])
        self.assertEqual([label["name"] for label in info["labels"]], ["Prostate", "Urethra"])

    def test_odd_headers_of_nifti_and_nrrd_are_read(self):
        for file, notes in (("k07_vox_offset_0.nii", ["vox_offset"]), ("k19_long_content.nrrd", []),
                            ("k20_pixdim_negative_valid_sform.nii.gz", ["sform counts"])):
            info = self.check(file, self.GLAND_AND_URETHRA, notes)
            extent = info["labels"][0]["extent_mm"]
            for found, right in zip(extent["min"] + extent["max"], (-29.8, 5.75, 13.0, 9.8, 34.25, 47.0)):
                self.assertAlmostEqual(found, right, delta=0.001, msg=file)

    def test_odd_backgrounds_are_background(self):
        self.check("k14_background_-1.nii.gz", self.GLAND_AND_URETHRA, ["-1 of 42096 voxels is taken as background"])
        self.check("k14_nan_outside.nii.gz", self.GLAND_AND_URETHRA, ["5184 voxels are no number (NaN)"])

    def test_an_image_that_does_not_say_where_it_lies_is_refused(self):
        self.refuse("info", FOUND / "k18_no_offset_no_matrix.mha", says=["no Offset, no TransformMatrix", "orientation"])


if __name__ == "__main__":
    run_tests_with(FOUND)
