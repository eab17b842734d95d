#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Commands whose results do not fit on the disk end with exit status 1 and one line, and leave nothing that looks finished.
scripts/campaign_disk does the same with more commands and sizes."""
import os
import subprocess
import unittest

import full_disk
from insert_case import SMALL
from program import STYLET, InFolder

KIND = full_disk.small_disk()


class FullDisk(InFolder):
    def setUp(self):
        super().setUp()
        full_disk.write_inputs(self.folder)

    def test_every_quick_command_meets_it(self):
        for name in full_disk.QUICK:
            needed = full_disk.needed_kB(KIND, name, self.folder)
            failed = 0
            for size in {0, needed // 3, needed - full_disk.PAGE_KB}:
                with self.subTest(command=name, size_kB=size), KIND(size) as disk:
                    end = full_disk.run_on(disk, name, self.folder)
                    self.assertEqual(full_disk.faults(name, end), [], end.errors)
                    failed += end.status
            self.assertGreater(failed, 0, name)

    def test_a_full_cache_is_said_once_and_does_not_stop_a_run(self):
        if KIND is not full_disk.Mounted:
            self.skipTest("this machine mounts no file systems for tests")
        with KIND(0) as disk:
            done = subprocess.run([STYLET, "insert", "phantom.toml", *SMALL, "-o", "out"], cwd=self.folder, capture_output=True,
                                  text=True, check=False, env={**os.environ, "STYLET_CACHE": disk.folder})
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(done.stderr.count("no space is left on the disk"), 1, done.stderr)
            self.assertEqual(os.listdir(disk.folder), [full_disk.FILLER])

    def test_standard_output_that_takes_nothing_fails_with_one_line(self):
        for arguments in (("info", "gland.json"), ("info", "gland.json", "--quiet", "--json", "-"), ("--help",), ("insert", "--print-schema"),
                          ("validate", "--list"), ("dose", "--print-rules")):
            with self.subTest(arguments=arguments), open("/dev/full", "w", encoding="ascii") as full:
                done = subprocess.run([STYLET, *arguments], cwd=self.folder, stdout=full, stderr=subprocess.PIPE, text=True,
                                      check=False, timeout=full_disk.HANGS_AFTER_S)
                self.assertEqual(done.returncode, 1)
                self.assertRegex(done.stderr, r"\Astylet: error: [^\n]+\n\Z")


if __name__ == "__main__":
    unittest.main()
