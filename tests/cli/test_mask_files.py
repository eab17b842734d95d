#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Masks as used in clinics: layers, named zones, one volume of several; and files that no program should open."""
import gzip
import os
import struct
import unittest

import samples
from program import InFolder


def ball(centre, radius, size=(40, 40, 24), spacing=(1.5, 1.5, 2.5)):
    """Voxels (0 or 1) of a ball, with i as the fastest index; centre and radius in mm, from the centre of the grid."""
    middle = [(n - 1) / 2 * h for n, h in zip(size, spacing)]
    return bytes(int(sum((c * h - m - o) ** 2 for c, h, m, o in zip((i, j, k), spacing, middle, centre)) < radius ** 2)
                 for k in range(size[2]) for j in range(size[1]) for i in range(size[0]))


def layered_nrrd(path, layers, keys, size=(40, 40, 24), spacing=(1.5, 1.5, 2.5)):
    """A .seg.nrrd file as 3D Slicer writes it for overlapping segments."""
    header = ["NRRD0004", "type: unsigned char", "dimension: 4", "space: left-posterior-superior",
              "sizes: {} {} {} {}".format(len(layers), *size),
              "space directions: none ({},0,0) (0,{},0) (0,0,{})".format(*spacing), "kinds: list domain domain domain",
              "encoding: gzip", "space origin: (-30,-30,-30)", *(f"{key}:={value}" for key, value in keys), "", ""]
    voxels = bytes(v for together in zip(*layers) for v in together)
    path.write_bytes("\n".join(header).encode() + gzip.compress(voxels))


class LayeredSegmentation(InFolder):
    def setUp(self):
        super().setUp()
        gland, inner = ball((0, 0, 0), 20), ball((0, 0, 0), 11)
        urethra = ball((0, 0, 0), 4)
        layered_nrrd(self.folder / "case.seg.nrrd", [gland, inner, urethra],
                     [("Segment0_Name", "PZ"), ("Segment0_LabelValue", 1), ("Segment0_Layer", 0),
                      ("Segment1_Name", "transition"), ("Segment1_LabelValue", 1), ("Segment1_Layer", 1),
                      ("Segment2_Name", "Urethra"), ("Segment2_LabelValue", 1), ("Segment2_Layer", 2)])

    def test_info_says_what_each_segment_is_and_who_has_the_overlap(self):
        info = self.json_of("info", "case.seg.nrrd")
        self.assertEqual([(label["name"], label["taken_as"]) for label in info["labels"]],
                         [("PZ", "peripheral_zone"), ("transition", "transition_zone"), ("Urethra", "urethra")])
        self.assertTrue(any("the smaller segment, 'Urethra'" in note for note in info["notes"]), info["notes"])
        self.assertIn("note: 3 segments in 3 layers", self.succeed("info", "case.seg.nrrd").stdout)

    def test_it_is_meshed_with_zones_in_place_of_the_gland(self):
        report = self.json_of("mesh", "case.seg.nrrd", "-o", "m.vtu", "--nodes", "1500")
        self.assertLessEqual({"peripheral_zone", "transition_zone", "urethra"}, set(report["regions"]))
        self.assertFalse(any("No label is named" in note for note in report["notes"]), report["notes"])
        self.assertTrue(any("the smaller segment" in note for note in report["notes"]), report["notes"])



class SeveralVolumes(InFolder):
    def setUp(self):
        super().setUp()
        samples.nifti_mask(self.folder / "one.nii.gz")
        raw = bytearray(gzip.decompress((self.folder / "one.nii.gz").read_bytes()))
        struct.pack_into("<h", raw, 40, 4)
        struct.pack_into("<h", raw, 48, 2)
        voxels = raw[352:]
        self.write("two.nii.gz", gzip.compress(bytes(raw[:352]) + bytes(len(voxels)) + bytes(voxels)))

    def test_one_is_chosen_by_an_option_or_in_a_scenario(self):
        self.refuse("info", "two.nii.gz", says=["two.nii.gz", "2 volumes", "volume = 1 below [patient]", "--volume 1"])
        info = self.json_of("info", "two.nii.gz", "--volume", "2")
        self.assertEqual(info["labels"], self.json_of("info", "one.nii.gz")["labels"])
        self.refuse("mesh", "two.nii.gz", "-o", "m.vtu", "--volume", "3", says=["two.nii.gz", "volume 3", "holds 2"])
        self.write("s.toml", '[patient]\nsource = "two.nii.gz"\n[patient.regions]\n1 = "prostate"\n[mesh]\nnodes = 1500\n'
                             '[[insertion]]\nentry_mm = [10, 10, -5]\ntarget_mm = [10, 10, 10]\n')
        # The first volume is empty; the error about it shows that the key is used.
        self.refuse("prepare", "s.toml", "-o", "m.stylet", "--set", "patient.volume=1", says=["every voxel is 0"])
        samples.contour_json(self.folder / "gland.json")
        self.refuse("mesh", "gland.json", "-o", "m.vtu", "--volume", "1", says=["gland.json", "only a mask has volumes", "--volume"])


class NoRegularFile(InFolder):
    """A named pipe must be refused. Opening it would wait for its other end, and `run` would time out."""

    def test_every_input_is_looked_at_before_it_is_opened(self):
        samples.contour_json(self.folder / "gland.json")
        for name in ("p.toml", "p.stylet", "p.h5", "p.nrrd", "p.mhd", "p.dcm", "p.msh", "p.csv", "p"):
            os.mkfifo(self.folder / name)
            self.refuse("info", name, says=[name, "named pipe"])
            self.refuse("insert", name, "-o", "out", says=[name, "named pipe"])
            self.refuse("serve", name, says=[name, "named pipe"])
            self.write("s.toml", f'[patient]\nsource = "{name}"\n[[insertion]]\nentry_mm = [0, 0, -30]\n'
                                                'target_mm = [0, 0, 0]\n')
            self.refuse("insert", "s.toml", "-o", "out", says=[name, "named pipe"])
        self.write("s.toml", '[patient]\nsource = "phantom"\n[[insertion]]\nmotion = "p.csv"\n')
        self.refuse("insert", "s.toml", "-o", "out", says=["p.csv", "named pipe"])


if __name__ == "__main__":
    unittest.main()
