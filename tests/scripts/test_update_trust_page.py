#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/update_trust_page sees figures that are no longer true, rows that are not there, and misses without a name."""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "update_trust_page"
PAGE = ("Off by <!-- bar -->0.06 %, <!-- bar to -->2 % accepted; <!-- gap from -->-1 to <!-- gap to -->1.\n"
        "## All rows that miss\n`gap` does.\n")
ROWS = [{"id": "bar", "value": 0.0612, "accepted_from": None, "accepted_to": 2.0, "pass": True},
        {"id": "gap", "value": 3.0, "accepted_from": -1.0, "accepted_to": 1.0, "pass": False}]


class TrustPage(unittest.TestCase):
    def run_on(self, page, *options, rows=None):
        """Exit status, complaints, and the page afterwards, of a copy of the script beside a page of its own."""
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "scripts").mkdir()
            (folder / "docs").mkdir()
            (folder / "scripts/update_trust_page").write_text(SCRIPT.read_text(encoding="utf-8"), encoding="utf-8")
            (folder / "docs/trust.md").write_text(page, encoding="utf-8")
            (folder / "v.json").write_text(json.dumps({"rows": rows or ROWS}), encoding="utf-8")
            done = subprocess.run([sys.executable, folder / "scripts/update_trust_page", *options, folder / "v.json"],
                                  capture_output=True, text=True, check=False)
            return done.returncode, done.stderr, (folder / "docs/trust.md").read_text(encoding="utf-8")

    def test_a_true_page_passes_and_stays(self):
        self.assertEqual(self.run_on(PAGE, "--check"), (0, "", PAGE))
        self.assertEqual(self.run_on(PAGE), (0, "", PAGE))

    def test_a_figure_that_is_not_true_is_named_and_corrected(self):
        stale = PAGE.replace("0.06 %", "0.21 %")
        status, said, _ = self.run_on(stale, "--check")
        self.assertEqual(status, 1)
        self.assertIn("line 1: bar is 0.061, and the page says 0.21", said)
        self.assertEqual(self.run_on(stale)[2], PAGE)

    def test_a_row_that_is_not_there_is_named(self):
        status, said, _ = self.run_on(PAGE.replace("<!-- bar -->", "<!-- beam -->"))
        self.assertEqual(status, 1)
        self.assertIn("no row beam", said)

    def test_of_a_part_the_rows_that_are_there_are_checked(self):
        self.assertEqual(self.run_on(PAGE, "--check", "--part", rows=ROWS[1:])[0], 0)
        self.assertEqual(self.run_on(PAGE, "--check", rows=ROWS[1:])[0], 1)
        stale = PAGE.replace("0.06 %", "0.21 %")
        self.assertEqual(self.run_on(stale, "--check", "--part", rows=ROWS[:1])[0], 1)
        skipped = {"id": "gap", "value": None, "pass": None, "skipped": True}
        self.assertEqual(self.run_on(PAGE, "--check", "--part", rows=[ROWS[0], skipped])[0], 0)

    def test_a_row_that_misses_and_is_not_named_is_named(self):
        status, said, _ = self.run_on(PAGE.replace("`gap` does", "None does"))
        self.assertEqual(status, 1)
        self.assertIn("these rows miss: ['gap']", said)


if __name__ == "__main__":
    unittest.main()
