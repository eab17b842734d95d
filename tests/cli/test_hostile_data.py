#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that have crashed or hung programs are refused with one line and within little processor time, child processes
included."""
import resource

from program import InFolder
from shared_data import SHARED, run_tests_with

DATA = SHARED / "hostile"
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
    run_tests_with(DATA)
