#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A scenario of ten lines is enough for a real patient or a mesh of another program."""
from insert_case import FAST, check_results, forces, kinds
from program import InFolder
from shared_data import SHARED, run_tests_with



class RealPatients(InFolder):
    def insert(self, source, lines, *options):
        scenario = f'[patient]\nsource = "{SHARED / source}"\n' + lines
        self.assertLessEqual(len(scenario.splitlines()), 10)
        self.write("case.toml", scenario)
        done = self.succeed("insert", "case.toml", "-o", "out", *FAST, *options)
        summary = check_results(self, self.folder / "out")
        return summary, done

    def check_in_and_out(self, summary, regions):
        """Checks that the needle goes through the skin into every region of `regions`, in this order, and out again."""
        entered = [e["region"] for e in summary["events"] if e["kind"] == "region_entered"]
        self.assertEqual([region for region in entered if region in regions][:len(regions)], regions)
        for kind in ("skin_contact", "puncture", "retraction_start", "slip_start", "withdrawn"):
            self.assertIn(kind, kinds(summary))
        self.assertEqual(kinds(summary)[-1], "withdrawn")
        peak = summary["peak_force_N"]["axial"]
        self.assertTrue(0.3 < peak < 20, peak)
        self.assertTrue(0 < summary["target_shift_mm"]["max"] < 30, summary["target_shift_mm"])
        last = forces(self.folder / "out")[-1]
        self.assertEqual((last["tip_state"], last["contacts"], last["force_axial_N"]), ("air", 0, 0))

    def test_a_mask_with_two_zones(self):
        summary, _ = self.insert("msd_prostate_masks/prostate_41.nii.gz", """\
regions = { "1" = "peripheral_zone", "2" = "transition_zone" }
[[insertion]]
hole = "e3.5"
speed_mm_per_s = 40
""")
        self.check_in_and_out(summary, ["body"])
        entered = {e["region"] for e in summary["events"] if e["kind"] == "region_entered"}
        self.assertTrue(entered & {"peripheral_zone", "transition_zone"}, entered)
        self.assertAlmostEqual(summary["mesh"]["nodes"], 3000, delta=90)

    def test_a_mask_whose_labels_nobody_named(self):
        summary, _ = self.insert("msd_prostate_masks/prostate_00.nii.gz", '[[insertion]]\nhole = "D4"\n',
                                 "--set", "mesh.nodes=1500")
        self.check_in_and_out(summary, ["body"])

    def test_a_structure_set_with_a_planning_volume(self):
        summary, done = self.insert("slicerrt_rando_rtstruct", '[[insertion]]\nhole = "e3.5"\nspeed_mm_per_s = 40\n')
        self.check_in_and_out(summary, ["body", "prostate"])
        self.assertIn("structure 'PTV' (type PTV) is taken as the gland", done.stderr)

    def test_a_structure_set_of_an_ultrasound_phantom(self):
        summary, _ = self.insert("robustbrachy_hdr_phantom/SS001.dcm", '[[insertion]]\nhole = "e3.5"\n',
                                 "--set", "mesh.nodes=1500")
        self.check_in_and_out(summary, ["body", "prostate"])

    def test_a_livers_mesh_in_units_of_its_own(self):
        summary, _ = self.insert("tetmesh_thirdparty/liver.msh", """\
scale = 25
[[insertion]]
entry_mm = [-36, 67, -60]
direction = [0, 0, 1]
depth_mm = 40
""")
        self.assertEqual(summary["mesh"], {"nodes": 181, "tets": 596})
        for kind in ("skin_contact", "puncture", "retraction_start", "withdrawn"):
            self.assertIn(kind, kinds(summary))

    def test_a_sphere_in_a_box_in_metres(self):
        summary, done = self.insert("sphere_in_box/sphere_in_box_573.msh", """\
scale = 1000
[[insertion]]
entry_mm = [5, 3, -60]
depth_mm = 50
""")
        self.assertEqual(summary["mesh"], {"nodes": 573, "tets": 2510})
        for kind in ("skin_contact", "puncture", "retraction_start", "slip_start", "withdrawn"):
            self.assertIn(kind, kinds(summary), done.stdout)

    def test_the_paper_sized_mesh_of_a_real_gland(self):
        summary, _ = self.insert("msd_prostate_masks/prostate_14.nii.gz",
                                 '[mesh]\npreset = "paper"\n[[insertion]]\nhole = "D4"\n')
        self.assertAlmostEqual(summary["mesh"]["nodes"], 570, delta=15)
        self.assertIn("withdrawn", kinds(summary))


if __name__ == "__main__":
    run_tests_with(SHARED)
