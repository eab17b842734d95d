#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet mesh: from each kind of input to a model and its report."""
import math
import os
import pty
import subprocess
import time
import unittest

import samples
from insert_case import block_mesh
from program import STYLET, InFolder


class Mesh(InFolder):
    def check_report(self, report):
        """Checks that every documented key exists and that sums are correct."""
        self.assertTrue({"nodes", "tets", "regions", "dihedral_deg", "edge_mm", "radius_ratio_min",
                         "surface_distance_mm", "seconds"} <= set(report))
        for region in report["regions"].values():
            self.assertTrue({"tets", "volume_cc", "input_volume_cc"} <= set(region))
        self.assertEqual(sum(r["tets"] for r in report["regions"].values()), report["tets"])
        self.assertLess(report["dihedral_deg"]["min"], report["dihedral_deg"]["max"])
        self.assertLess(0, report["edge_mm"]["min"])
        self.assertTrue(0 < report["radius_ratio_min"] <= 1)
        self.assertLessEqual(report["surface_distance_mm"]["mean"], report["surface_distance_mm"]["max"])

    def test_contours_become_the_number_of_nodes_asked_for(self):
        samples.contour_json(self.folder / "gland.json")
        report = self.json_of("mesh", "gland.json", "-o", "out/model.vtu", "--nodes", "800")
        self.check_report(report)
        self.assertAlmostEqual(report["nodes"], 800, delta=0.03 * 800)
        prostate = report["regions"]["prostate"]
        self.assertAlmostEqual(prostate["volume_cc"] / prostate["input_volume_cc"], 1, delta=0.08)
        self.assertEqual(os.listdir(self.folder / "out"), ["model.vtu"], "no temporary is left")
        model = self.json_of("info", "out/model.vtu")
        self.assertEqual((model["nodes"], model["tets"]), (report["nodes"], report["tets"]))
        self.assertEqual(set(model["regions"]), set(report["regions"]))

    def test_what_is_passed_over_in_a_mesh_is_noted(self):
        block_mesh(self.folder / "block.msh")
        text = (self.folder / "block.msh").read_text()
        text = text.replace("$Elements\n384\n", "$Elements\n385\n").replace("$EndElements", "385 2 2 3 3 1 2 7\n$EndElements")
        self.write("more.msh", text)
        notes = self.json_of("mesh", "more.msh", "-o", "more.vtu")["notes"]
        self.assertTrue(any("ignored, because only tetrahedra are used" in note for note in notes), notes)

    def test_nearly_flat_tetrahedra_are_warned_of(self):
        block_mesh(self.folder / "flat.msh", last_layer=0.5)
        warning, = self.json_of("mesh", "flat.msh", "-o", "flat.vtu")["warnings"]
        self.assertIn("of 384 tetrahedra are nearly flat", warning)
        self.assertIn(f"stylet: warning: flat.vtu: {warning}\n", self.succeed("mesh", "flat.msh", "-o", "flat.vtu").stderr)
        block_mesh(self.folder / "good.msh")
        self.assertEqual(self.json_of("mesh", "good.msh", "-o", "good.vtu")["warnings"], [])

    def test_structure_of_any_name_can_be_the_target_in_a_mesh_of_the_papers_size(self):
        samples.contour_json(self.folder / "gland.json", ("Boost 1=2",))
        report = self.json_of("mesh", "gland.json", "-o", "model.vtu", "--preset", "paper", "--region",
                              "Boost 1=2=prostate")
        self.assertIn("prostate", report["regions"])
        self.assertAlmostEqual(report["nodes"], 570, delta=15)

    def test_tetrahedra_of_others_are_checked_and_converted(self):
        samples.tet_mesh(self.folder / "metres.msh", unit=1000)
        report = self.json_of("mesh", "metres.msh", "-o", "model.vtu", "--scale", "1000", "--region", "upper=prostate")
        self.check_report(report)
        self.assertEqual((report["nodes"], report["tets"]), (5, 2))
        self.assertEqual(set(report["regions"]), {"prostate", "lower"})
        self.assertAlmostEqual(report["regions"]["prostate"]["volume_cc"], 1 / 6)
        self.assertAlmostEqual(report["edge_mm"]["max"], 10 * math.sqrt(2))
        self.assertEqual(self.json_of("info", "model.vtu")["regions"], {
            name: {"tets": region["tets"], "volume_cc": region["volume_cc"]} for name, region in report["regions"].items()})

    def test_table_is_for_people(self):
        samples.tet_mesh(self.folder / "two.msh")
        text = self.succeed("mesh", "two.msh", "-o", "model.vtu").stdout
        for part in ("two.msh → model.vtu", "dihedral angles", "upper", "lower", "0.17"):
            self.assertIn(part, text)

    def test_surface_is_refused_with_what_can_be_meshed(self):
        samples.stl_surface(self.folder / "corner.stl")
        self.refuse("mesh", "corner.stl", "-o", "model.vtu",
                    says=["corner.stl", "surfaces are not meshed", "RTSTRUCT", "NIfTI", "tetrahedral mesh"])

    def test_region_that_is_not_there_is_refused(self):
        samples.tet_mesh(self.folder / "two.msh")
        self.refuse("mesh", "two.msh", "-o", "m.vtu", "--region", "uper=prostate",
                    says=["two.msh", "'uper'", "Did you mean 'upper'"])
        self.refuse("mesh", "two.msh", "-o", "m.vtu", "--region", "upper=lower", says=["two.msh", "'lower'"])
        for bad in ("upper", "=prostate", "upper="):
            self.refuse("mesh", "two.msh", "-o", "m.vtu", "--region", bad, says=[bad, "NAME=CANONICAL"])

    def test_option_without_meaning_for_the_input_is_refused(self):
        samples.tet_mesh(self.folder / "two.msh")
        for option in (("--nodes", "500"), ("--preset", "paper"), ("--cull", "1"), ("--no-band",)):
            self.refuse("mesh", "two.msh", "-o", "m.vtu", *option, says=["two.msh", option[0], "no meaning"])
        samples.contour_json(self.folder / "gland.json")
        self.refuse("mesh", "gland.json", "-o", "m.vtu", "--scale", "10", says=["gland.json", "--scale"])

    def test_output_that_cannot_be_is_refused(self):
        samples.tet_mesh(self.folder / "two.msh")
        (self.folder / "folder.vtu").mkdir()
        self.refuse("mesh", "two.msh", "-o", "model.stl", says=["model.stl", ".vtu"])
        self.refuse("mesh", "two.msh", "-o", "two.msh/model.vtu", says=["two.msh/model.vtu", "not a folder"])
        self.refuse("mesh", "two.msh", "-o", "folder.vtu", says=["folder.vtu", "folder"])

    @unittest.skipIf(os.geteuid() == 0, "root may write anywhere")
    def test_folder_without_permission_is_refused(self):
        samples.tet_mesh(self.folder / "two.msh")
        (self.folder / "locked").mkdir(mode=0o555)
        self.refuse("mesh", "two.msh", "-o", "locked/model.vtu", says=["locked/model.vtu", "not writable"])

    def test_long_work_shows_a_bar_on_a_terminal_and_lines_elsewhere(self):
        samples.contour_json(self.folder / "gland.json")
        command = [STYLET, "mesh", "gland.json", "-o", "model.vtu", "--nodes", "6000"]
        terminal, theirs = pty.openpty()
        start = time.monotonic()
        with subprocess.Popen(command, cwd=self.folder, stdout=subprocess.DEVNULL, stderr=theirs,
                              env={**os.environ, "TERM": "xterm"}) as process:
            os.close(theirs)
            shown = b""
            try:
                while part := os.read(terminal, 65536):
                    shown += part
            except OSError:  # the terminal is closed when the program ends
                pass
        os.close(terminal)
        self.assertEqual(process.returncode, 0)
        if time.monotonic() - start > 2:
            self.assertRegex(shown, rb"\r.*\[#*\.*\] +\d+ %")
        self.assertTrue(shown == b"" or shown.endswith(b"\r\x1b[K"), "the bar leaves nothing behind")

        start = time.monotonic()
        lines = self.succeed(*command[1:]).stderr
        self.assertNotIn("\r", lines)
        if time.monotonic() - start > 2:
            self.assertRegex(lines, r"\A\w[^\n]* \.\.\.\n")


if __name__ == "__main__":
    unittest.main()
