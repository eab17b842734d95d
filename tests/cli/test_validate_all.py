#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet validate, a part of its rows: the README names those that miss, and the figures of docs/trust.md are true.

Usage: test_validate_all.py PART   PART: 1 to 4; the parts together have every row
"""
import subprocess
import sys
import unittest
from pathlib import Path

from program import STYLET, InFolder
from readme import not_to_trust
from shared_data import SHARED

PART = int(sys.argv.pop(1)) if len(sys.argv) > 1 and sys.argv[1].isdigit() else 1


def part_of(row):
    """The part that measures a row. Rows that share runs are in one part."""
    if row["group"] in ("analysis", "independent code"):
        return 1
    if row["id"].startswith(("mask_", "probe_", "balloon_")):
        return 2
    if row["id"].startswith("implant_") or row["group"] == "mesh and step independence":
        return 3
    return 4


class ValidateAll(InFolder):
    def test_the_readme_names_every_row_that_misses_and_the_trust_page_has_true_figures(self):
        listed = self.json_of("validate", "--list")["rows"]
        mine = [row["id"] for row in listed if part_of(row) == PART and row["id"] != "sensitivity"]
        self.assertGreater(len(mine), 5)
        subprocess.run([STYLET, "validate", "-o", self.folder / "out", "--data", SHARED, "--only", *mine], check=True,
                       capture_output=True, timeout=3000)
        rows = self.read("out/validate.json")["rows"]
        judged = {row["id"]: row["pass"] for row in rows if row["pass"] is not None}
        self.assertEqual({name for name, passes in judged.items() if not passes}, set(not_to_trust()) & set(judged),
                         "README.md, Not to be trusted yet: it names the rows that miss and no other")
        script = Path(__file__).resolve().parents[2] / "scripts/update_trust_page"
        trusted = subprocess.run([sys.executable, script, "--check", "--part", self.folder / "out/validate.json"],
                                 capture_output=True, text=True, check=False)
        self.assertEqual(trusted.returncode, 0, trusted.stderr)


if __name__ == "__main__":
    unittest.main()
