#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of real patients and of other programs are read with the values that are published with them, or correctly
refused.

They are not part of the repository: their folder is $STYLET_SHARED_DATA, by default ../shared/data beside it. Without
one the tests are skipped (exit status 77)."""
import os
import sys
import unittest
from pathlib import Path

from program import InFolder

DATA = Path(os.environ.get("STYLET_SHARED_DATA") or Path(__file__).resolve().parents[3] / "shared" / "data")


class RealData(InFolder):
    def info(self, file, *options):
        return self.json_of("info", DATA / file, *options)

    def test_masks_have_the_glands_volume_and_tilt(self):
        for number, volume_cc, tilt_deg in (("00", 47.3, 16.8), ("14", 48.4, 0), ("17", 34.3, 0), ("21", 54.2, 0),
                                            ("25", 67.2, 0), ("41", 47.8, 0.1), ("44", 43.4, 0), ("46", 35.1, 0)):
            info = self.info(f"msd_prostate_masks/prostate_{number}.nii.gz")
            self.assertEqual([label["label"] for label in info["labels"]], [1, 2], number)
            self.assertAlmostEqual(sum(label["volume_cc"] for label in info["labels"]), volume_cc, delta=0.051, msg=number)
            self.assertAlmostEqual(info["slice_tilt_deg"], tilt_deg, delta=0.051, msg=number)

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
            path = DATA / "robustbrachy_hdr_phantom" / file
            self.assertEqual(self.json_of("info", path)["kind"], {"RTPLAN": "plan", "RTDOSE": "dose"}[modality])
            self.refuse("mesh", path, "-o", "model.vtu", says=[file, modality, "RTSTRUCT"])

    def test_meshes_of_other_programs_load_once_their_unit_is_told(self):
        for file, scale, nodes, tets in (("tetmesh_thirdparty/liver.msh", 25, 181, 596),
                                         ("tetmesh_thirdparty/liver2.msh", 50, 507, 1493),
                                         ("tetmesh_thirdparty/shark_22_ascii_fTetWild.msh", 1000, 425, 1070),
                                         ("tetmesh_thirdparty/cube_41_ascii_vol_gmshApp.msh", 50, 14, 24),
                                         ("tetmesh_thirdparty/teddy.vtk", 1000, 410, 1207),
                                         ("sphere_in_box/sphere_in_box_573.msh", 1000, 573, 2510),
                                         ("sphere_in_box/sphere_in_box_5037.msh", 1000, 5037, 26507)):
            self.refuse("info", DATA / file, says=[Path(file).name, "--scale"])
            info = self.info(file, "--scale", scale)
            self.assertEqual((info["nodes"], info["tets"]), (nodes, tets), file)

    def test_surfaces_are_shown_but_not_meshed(self):
        for file, surfaces in (("tetmesh_thirdparty/liver-smooth.obj", 1), ("hubmap_vhm_pelvis/VH_M_Pelvis.glb", 14)):
            self.assertEqual(len(self.info(file)["surfaces"]), surfaces, file)
            self.refuse("mesh", DATA / file, "-o", "m.vtu", says=[Path(file).name, "surfaces are not meshed"])

    def test_tables_of_numbers_are_refused(self):
        for file in ("force_okamura_insertion/depth_force.csv", "force_okamura_insertion/Data0.json",
                     "msd_prostate_masks/dataset.json", "tg43_i125_6711/brachy_LDR.mat"):
            self.refuse("info", DATA / file, says=[Path(file).name])


if __name__ == "__main__":
    if not DATA.is_dir():
        print(f"Skipped: no real data in {DATA}; name its folder with STYLET_SHARED_DATA.")
        sys.exit(77)
    unittest.main()
