#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Standard streams that are closed, full or not read by any program do not stop the program and are not reported as an
error of a file."""
import itertools
import os
import subprocess
import unittest

import samples
from insert_case import FAST, Cases, check_results
from program import STYLET


class StandardStreams(Cases):
    def setUp(self):
        super().setUp()
        samples.contour_json(self.folder / "gland.json")

    def with_closed(self, closed, *arguments):
        """The exit status of the program when it is started with these standard streams closed."""
        command = [STYLET, *map(str, arguments)]
        child = os.fork()
        if child == 0:
            os.chdir(self.folder)
            null = os.open("/dev/null", os.O_RDWR)
            for stream in range(3):
                os.dup2(null, stream)
            for stream in closed:
                os.close(stream)
            os.closerange(3, 64)
            try:
                os.execv(command[0], command)
            finally:
                os._exit(127)
        return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])

    def test_any_of_them_may_be_closed(self):
        self.succeed("insert", "block.toml", "-o", "whole", "--quiet", *FAST)
        expected = {name: self.json_of("info", name) for name in ("gland.json", "block.msh", "whole/run.h5")}
        for number in range(4):
            for closed in itertools.combinations(range(3), number):
                with self.subTest(closed=closed):
                    for name, info in expected.items():
                        self.assertEqual(self.with_closed(closed, "info", name, "--json", "info.json"), 0, name)
                        self.assertEqual(self.read("info.json"), info)
                    if number == 2:  # a mesh and an insertion take longer
                        continue
                    self.assertEqual(self.with_closed(closed, "mesh", "gland.json", "--preset", "paper", "-o", "out.vtu"), 0)
                    self.assertEqual(self.json_of("info", "out.vtu")["kind"], "mesh")
                    self.assertEqual(self.with_closed(closed, "insert", "block.toml", "-o", "out", *FAST), 0)
                    check_results(self, self.folder / "out")

    def test_json_that_cannot_be_printed_is_a_failure(self):
        self.assertEqual(self.with_closed((1,), "info", "gland.json", "--json", "-"), 1)

    def with_full(self, full, *arguments):
        with open("/dev/full", "w", encoding="ascii") as file:
            streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE} | {name: file for name in full}
            return subprocess.run([STYLET, *map(str, arguments)], cwd=self.folder, check=False, text=True,
                                  stdin=subprocess.DEVNULL, timeout=300, **streams)

    def test_a_run_goes_on_when_what_it_prints_has_no_place(self):
        for full in (("stdout",), ("stderr",), ("stdout", "stderr")):
            with self.subTest(full=full):
                done = self.with_full(full, "insert", "block.toml", "-o", "out", *FAST)
                self.assertEqual(done.returncode, 0, done.stderr)
                check_results(self, self.folder / "out")
                if full == ("stdout",):
                    self.assertEqual(done.stderr.count("No space left on device"), 1)

    def test_what_was_asked_for_and_has_no_place_is_a_failure(self):
        for arguments in (("info", "gland.json"), ("insert", "--print-schema"), ("--help",),
                          ("insert", "block.toml", "-o", "out", "--json", "-", *FAST)):
            with self.subTest(arguments=arguments):
                self.assertEqual(self.with_full(("stdout",), *arguments).returncode, 1)

    def test_a_reader_who_goes_away_does_not_end_a_run(self):
        read, write = os.pipe()
        os.close(read)
        done = subprocess.run([STYLET, "insert", "block.toml", "-o", "out", *FAST], cwd=self.folder, check=False,
                              stdin=subprocess.DEVNULL, stdout=write, stderr=subprocess.PIPE, text=True, timeout=300)
        os.close(write)
        self.assertEqual(done.returncode, 0, done.stderr)
        check_results(self, self.folder / "out")


if __name__ == "__main__":
    unittest.main()
