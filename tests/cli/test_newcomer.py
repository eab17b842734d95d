#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Mistakes of somebody who is new to the program: each is told of in words that name the place and the cure, before
anything is computed."""
import os
import unittest
from pathlib import Path

from insert_case import BLOCK, Cases, block_mesh
from program import commands, run


class Mistakes(Cases):
    def warned(self, *settings, says, scenario="block.toml"):
        """Checks that an insertion is warned of before the work, which a misspelt region ends before it begins."""
        arguments = [word for setting in (*settings, "tissue.limp.young_kPa=30") for word in ("--set", setting)]
        done = run("insert", scenario, "-o", "out", *arguments, cwd=self.folder)
        self.assertEqual(done.returncode, 2, done.stderr)
        for text in says:
            self.assertRegex(done.stderr, text)
        lines = done.stderr.splitlines()
        self.assertEqual(len(lines), len(set(lines)), done.stderr)

    # Words of the command line.

    def test_help_and_version_as_words(self):
        self.assertEqual(run("help").stdout, run("--help").stdout)
        self.assertEqual(run("version").stdout, run("--version").stdout)
        for command in commands():
            self.assertEqual(run("help", command).stdout, run(command, "--help").stdout)
        self.refuse("help", "mehs", says=["unknown command 'mehs'", "did you mean 'mesh'"])

    def test_words_that_are_no_commands(self):
        self.refuse("insret", "block.toml", says=["did you mean 'insert'"])
        self.refuse("simulate", "block.toml", says=["unknown command 'simulate'", "insert", "fluoro"])
        self.refuse("block.toml", says=["'block.toml' is a file", "stylet info"])
        self.refuse("block.toml", "insert", says=["write stylet insert block.toml"])

    def test_options_that_are_keys_and_arguments_that_are_outputs(self):
        self.refuse("insert", "block.toml", "--nodes", "3000", says=["--set mesh.nodes=VALUE"])
        self.refuse("insert", "block.toml", "--depth", "60", says=["--set insertion[0].depth_mm=VALUE"])
        self.refuse("mesh", "block.msh", "m.vtu", says=["'m.vtu' is one argument too many", "-o m.vtu"])

    def test_files_for_another_command(self):
        self.refuse("mesh", "block.toml", "-o", "m.vtu", says=["this is a scenario", "stylet insert"])
        self.refuse("info", "block.toml", says=["this is a scenario", "stylet insert"])
        self.refuse("insert", "block.msh", says=["this is a gmsh mesh, a scenario (TOML) is expected"])
        self.refuse("info", "ir192_mhdr_v3", says=["did you mean 'ir192_"])

    def test_numbers_in_another_notation(self):
        self.refuse("insert", "block.toml", "--set", "needle.length_mm=20cm", says=["without a unit"])
        self.refuse("insert", "block.toml", "--set", "insertion.depth_mm=0,06", says=["decimal point"])
        self.refuse("insert", "block.toml", "--set", "needle.diameter_mm=18", says=["18 gauge is 1.27 mm"])
        self.refuse("insert", "block.toml", "--set", "run.dt_ms=0.001", says=["s has to be multiplied by 1000"])

    # Names of files.

    def test_misspelt_files_of_every_command(self):
        self.write("prostate.dcm", "x")
        for words in (["insert", "blok.toml"], ["prepare", "blok.toml", "-o", "m.stylet"], ["serve", "blok.toml"],
                      ["implant", "blok.toml"], ["image", "blok.toml", "-o", "p.png"],
                      ["fluoro", "blok.toml", "-o", "p.png"]):
            self.refuse(*words, says=["blok.toml: no such file; did you mean 'block.toml'"])
        for words in (["info", "prostat.dcm"], ["mesh", "prostat.dcm", "-o", "m.vtu"],
                      ["dose", "prostat.dcm", "-o", "out"]):
            self.refuse(*words, says=["prostat.dcm: no such file; did you mean 'prostate.dcm'"])

    def test_files_named_by_other_files(self):
        self.write("case.toml", BLOCK.replace("block.msh", "blok.msh"))
        self.refuse("insert", "case.toml", says=["blok.msh: no such file; did you mean", "block.msh'"])
        self.write("hand.csv", "x")
        self.refuse("insert", self.write("hand.toml", BLOCK.split("[[insertion]]")[0] +
                                         '[[insertion]]\nmotion = "hnad.csv"\n'),
                    says=["hnad.csv: no such file; did you mean", "hand.csv'"])

    def test_wrong_case_extension_and_folder(self):
        (self.folder / "cases").mkdir()
        self.write("cases/one.toml", BLOCK)
        self.refuse("info", "BLOCK.MSH", says=["did you mean 'block.msh'"])
        self.refuse("insert", "phantom", says=["did you mean 'phantom.toml'"])
        self.refuse("insert", "phantom.tom1", says=["did you mean 'phantom.toml'"])
        self.refuse("insert", "case/one.toml", says=["there is no folder 'case'", "did you mean 'cases/one.toml'"])
        self.refuse("insert", "block.toml/one.toml", says=["'block.toml' is a file, not a folder"])
        self.refuse("info", "nothing_like_it.dcm", says=["no such file. Check the name and the folder"])

    # Keys.

    def test_keys_without_their_unit(self):
        for setting, key in (("insertion.speed=5", "insertion[0].speed_mm_per_s"),
                             ("insertion.depth=5", "insertion[0].depth_mm"),
                             ("needle.diameter=1", "needle.diameter_mm"),
                             ("tissue.lump.friction=5", "tissue.lump.friction_static_N_per_m"),
                             ("tissue.lump.young=5", "tissue.lump.young_kPa"),
                             ("run.dt=1", "run.dt_ms")):
            self.refuse("insert", "block.toml", "--set", setting, says=[f"Did you mean {key}?"])

    def test_tissue_that_no_region_has_is_refused_before_meshing(self):
        done = self.refuse("insert", "phantom.toml", "-o", "out", "--set", "tissue.prostata.young_kPa=30",
                           says=["no region 'prostata'", "Did you mean 'prostate'?"])
        self.assertEqual(len(done.stderr.splitlines()), 1, "no stage of the work was begun")

    # Numbers in other units, told before the first stage of the work.

    def test_numbers_in_other_units(self):
        self.warned("tissue.lump.friction_static_N_per_m=0.06", "tissue.lump.friction_coulomb_N_per_m=0.045",
                    "insertion.speed_mm_per_s=0.4", "insertion.depth_mm=1", "insertion.retract=false",
                    "needle.bevel_deg=0.35",
                    says=["friction_static_N_per_m = 0.06 N/m is less than is plausible", "N/mm",
                          "speed_mm_per_s = 0.4 mm/s is less", "m/s has to be multiplied by 1000", "depth_mm = 1 mm",
                          "needle.bevel_deg = 0.35 degree is less", "radians"])
        self.refuse("insert", "block.toml", "--set", "insertion.speed_mm_per_s=20000", says=["0.01 … 1000"])

    def test_a_needle_from_the_head(self):
        # 20 mm through a block of 60 mm.
        self.warned("insertion.direction=[0,0,-1]", says=[r"insertion\[0\]: the needle goes from superior to inferior"])

    def test_a_run_that_would_take_hours(self):
        self.warned("insertion.speed_mm_per_s=0.01", "run.dt_ms=0.1", scenario="phantom.toml",
                    says=["This will take about .* hours: .* steps of 0.1 ms"])

    # Sizes.

    def test_a_wrong_scale_names_the_key_of_the_scenario(self):
        self.refuse("insert", "block.toml", "--set", "patient.scale=1000",
                    says=["with a unit of 1000 mm", "5 to 2000 mm is expected", "probably in millimetres",
                          "patient.scale = 1 in a scenario"])
        block_mesh(self.folder / "metres.msh", size=0.06)
        for words in (["insert", self.write("metres.toml", BLOCK.replace("block.msh", "metres.msh"))],
                      ["info", "metres.msh"], ["mesh", "metres.msh", "-o", "m.vtu"]):
            self.refuse(*words, says=["metres.msh", "probably in metres", "patient.scale = 1000", "--scale 1000"])

    # Outputs.

    def test_outputs_that_cannot_be_written_are_refused_before_the_work(self):
        self.write("taken", "")
        below = "taken/below"
        for words, name in ((["insert", "phantom.toml"], ""), (["implant", "phantom.toml"], ""),
                            (["serve", "phantom.toml"], ""), (["reproduce"], ""), (["validate"], ""), (["phantom"], ""),
                            (["mesh", "block.msh"], "/m.vtu"), (["prepare", "phantom.toml"], "/m.stylet"),
                            (["image", "phantom.toml"], "/p.png"), (["fluoro", "phantom.toml"], "/p.png")):
            done = self.refuse(*words, "-o", below + name, says=["taken"])
            self.assertEqual(len(done.stderr.splitlines()), 1, "no stage of the work was begun")
        # Nobody, not even the system's administrator, can make a file there.
        self.refuse("insert", "phantom.toml", "-o", "/proc/here", says=["/proc", "not writable"])
        self.refuse("insert", "phantom.toml", "-o", "n" * 300, says=["more than 255 bytes"])

    @unittest.skipIf(os.geteuid() == 0, "the administrator may write everywhere")
    def test_folder_without_permission(self):
        locked = self.folder / "locked"
        locked.mkdir(mode=0o500)
        self.refuse("insert", "phantom.toml", "-o", str(Path("locked") / "out"), says=["locked", "not writable"])


if __name__ == "__main__":
    unittest.main()
