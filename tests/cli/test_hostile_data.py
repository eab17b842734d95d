#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that have crashed or hung programs are refused with one line and within little processor time, child processes
included.

They are not part of the repository: their folder is hostile/ in $STYLET_SHARED_DATA, by default ../shared/data beside
it. Without one the tests are skipped (exit status 77)."""
import os
import resource
import sys
import unittest
from pathlib import Path

from program import InFolder

DATA = Path(os.environ.get("STYLET_SHARED_DATA") or Path(__file__).resolve().parents[3] / "shared" / "data") / "hostile"
MOST_SECONDS = 10


def spent():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class HostileFiles(InFolder):
    def test_each_is_refused_in_one_line_and_little_processor_time(self):
        files = [f for f in sorted(DATA.iterdir()) if f.suffix in (".nrrd", ".mha", ".mhd", ".nii", ".vtk", ".vtu")]
        self.assertTrue(files)
        for file in files:
            for command in (["info", file], ["mesh", file, "-o", "m.vtu"]):
                before = spent()
                self.refuse(*command, says=[file.name])
                self.assertLess(spent() - before, MOST_SECONDS, f"{command[0]} {file.name}")


if __name__ == "__main__":
    if not DATA.is_dir():
        print(f"Skipped: no hostile files in {DATA}; name the folder above with STYLET_SHARED_DATA.")
        sys.exit(77)
    unittest.main()
