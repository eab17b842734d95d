#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line itself: help, version, mistakes, and the stream to which each output goes."""
import json
import os
import subprocess
import unittest
from pathlib import Path

import samples
from program import STYLET, InFolder, commands


class CommandLine(InFolder):
    def test_version_is_one_line_and_names_the_commit_of_a_clone(self):
        commit = r"\+[0-9a-f]{8,}(\.modified)?" if (Path(__file__).parents[2] / ".git").exists() else ""
        self.assertRegex(self.succeed("--version").stdout, rf"\Astylet \d+\.\d+\.\d+{commit}\n\Z")

    def test_every_command_has_help_and_the_common_options(self):
        self.assertTrue({"phantom", "mesh", "info"} <= set(commands()))
        for command in commands():
            done = self.succeed(command, "--help")
            self.assertEqual(done.stderr, "")
            for option in ("--json", "--quiet", "--verbose", "--threads"):
                self.assertIn(option, done.stdout, command)

    def test_no_command_names_them_all(self):
        self.refuse(says=["no command given", *commands()])

    def test_unknown_command_suggests_the_nearest(self):
        self.refuse("mehs", "case.dcm", says=["'mehs'", "did you mean 'mesh'"])

    def test_unknown_option_suggests_the_nearest(self):
        self.refuse("mesh", "case.dcm", "--nods", "600", "-o", "m.vtu", says=["'--nods'", "did you mean '--nodes'"])
        self.refuse("mesh", "--nods=600", says=["'--nods'", "did you mean '--nodes'"])
        for command in commands():
            self.refuse(command, "--qiet", says=["'--qiet'", "did you mean '--quiet'"])

    def test_option_like_none_gets_no_suggestion(self):
        done = self.refuse("info", "case.dcm", "--xylophone", says=["unknown option '--xylophone'", "info --help"])
        self.assertNotIn("did you mean", done.stderr)

    def test_missing_and_surplus_arguments(self):
        self.refuse("info", says=["FILE is required"])
        self.refuse("info", "a", "b", says=["'b' is one argument too many"])
        self.refuse("mesh", "a", says=["--output is required"])

    def test_values_out_of_range_are_named_with_the_range(self):
        for value in ("0", "-4", "many", "1e3", "99999999999999999999", "1000000000"):
            self.refuse("mesh", "a", "-o", "m.vtu", f"--nodes={value}", says=["--nodes", f"'{value}'", "100 to 1000000"])
        self.refuse("mesh", "a", "-o", "m.vtu", "--preset", "papr", says=["'papr'", "did you mean 'paper'"])
        self.refuse("mesh", "a", "-o", "m.vtu", "--cull", "-1", says=["--cull", "0 to 5 mm"])
        self.refuse("mesh", "a", "-o", "m.vtu", "--scale", "nan", says=["--scale", "'nan'"])
        self.refuse("info", "a", "--threads", "0", says=["--threads", "1 to 1024"])
        self.refuse("phantom", "-o", "case", "--spacing", "50", says=["--spacing", "1 to 10 mm"])
        self.refuse("phantom", "-o", "case", "--seed", "-1", says=["--seed"])


class Streams(InFolder):
    def setUp(self):
        super().setUp()
        samples.contour_json(self.folder / "gland.json")

    def test_json_on_standard_output_comes_alone(self):
        done = self.succeed("info", "gland.json", "--json", "-")
        self.assertEqual(json.loads(done.stdout)["kind"], "contours")
        self.assertIn("Prostate", done.stderr, "the table moves to standard error")

    def test_json_to_a_file_leaves_the_table_on_standard_output(self):
        done = self.succeed("info", "gland.json", "--json", "deep/down/info.json")
        self.assertIn("Prostate", done.stdout)
        self.assertEqual(self.read("deep/down/info.json")["file"], "gland.json")
        self.assertEqual([p.name for p in (self.folder / "deep/down").iterdir()], ["info.json"], "no temporary is left")

    def test_json_may_go_to_a_device(self):
        self.succeed("info", "gland.json", "--json", "/dev/null")
        self.assertTrue(os.path.exists("/dev/null") and not os.path.isfile("/dev/null"))

    def test_json_nowhere_to_go_is_refused(self):
        self.refuse("info", "gland.json", "--json", "gland.json/info.json", says=["gland.json/info.json", "not a folder"])
        self.refuse("info", "gland.json", "--json", ".", says=["folder"])

    def test_quiet_says_nothing_and_still_writes_json(self):
        done = self.succeed("info", "gland.json", "--quiet")
        self.assertEqual(done.stdout + done.stderr, "")
        done = self.succeed("--quiet", "info", "gland.json", "--json", "-")
        self.assertEqual(done.stderr, "")
        json.loads(done.stdout)

    def test_full_standard_output_is_a_failed_run(self):
        with open("/dev/full", "w", encoding="ascii") as full:
            done = subprocess.run([STYLET, "info", "gland.json", "--json", "-"], cwd=self.folder, stdout=full,
                                  stderr=subprocess.PIPE, text=True, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("stylet: error: ", done.stderr)


if __name__ == "__main__":
    unittest.main()
