#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet validate: the table of claims as a page, JSON and curves."""
import csv
import json
import os
import re
import unittest
from pathlib import Path

from program import InFolder
from readme import not_to_trust

KEYS = {"id", "claim", "reference", "value", "unit", "tolerance", "pass", "note", "group", "verdict", "skipped",
        "seconds", "curves", "csv"}
SOME = ["patch_test", "needle_large_beam", "step_time"]


class Validate(InFolder):
    def setUp(self):
        super().setUp()
        self.shared = os.environ.get("STYLET_SHARED_DATA")
        os.environ["STYLET_SHARED_DATA"] = str(self.folder)  # a folder without data

    def tearDown(self):
        if self.shared is None:
            del os.environ["STYLET_SHARED_DATA"]
        else:
            os.environ["STYLET_SHARED_DATA"] = self.shared
        super().tearDown()

    def test_quick_writes_page_numbers_and_curves(self):
        result = self.json_of("validate", "-o", "out", "--quick")
        out = self.folder / "out"
        self.assertEqual(result, json.loads((out / "validate.json").read_text(encoding="utf-8")))
        rows = {row["id"]: row for row in result["rows"]}
        for row in rows.values():
            self.assertEqual(KEYS - set(row), set(), row["id"])
            self.assertNotEqual(row["verdict"], "crashed", row["note"])
            if row["csv"]:
                with open(out / row["csv"], encoding="utf-8", newline="") as file:
                    lines = list(csv.reader(file))
                self.assertEqual(len(lines[0]), 3)
                self.assertEqual({line[0] for line in lines[1:]}, set(row["curves"]))
        self.assertEqual(result["missed"], sum(row["pass"] is False for row in rows.values()))
        self.assertIs(rows["patch_test"]["pass"], True)
        self.assertIs(rows["contact_changes"]["pass"], True)
        self.assertIn("does not exist", rows["step_time"]["note"])
        self.assertIs(rows["step_time"]["skipped"], True)
        page = (out / "validate.html").read_text(encoding="utf-8")
        for row in rows.values():
            self.assertIn(f'<tr id="{row["id"]}">', page)
        missed = [row["id"] for row in rows.values() if row["pass"] is False]
        for name in missed:
            self.assertIn(f'<a href="#{name}">', page)
        self.assertEqual(missed, [name for name in rows if name in not_to_trust()],
                         "README.md, Not to be trusted yet: it names the rows that miss and no other")

    def test_the_readme_and_the_trust_page_name_rows_that_there_are(self):
        rows = {row["id"] for row in self.json_of("validate", "--list")["rows"]}
        named = not_to_trust()
        self.assertEqual(len(named), len(set(named)))
        self.assertLessEqual(set(named), rows)
        page = (Path(__file__).resolve().parents[2] / "docs/trust.md").read_text(encoding="utf-8")
        self.assertLessEqual(set(re.findall(r"<!-- (\w+)(?: from| to)? -->\s*-?\d", page)), rows)

    def test_only_measures_the_rows_named_and_says_what_was_skipped(self):
        done = self.succeed("validate", "-o", "out", "--only", *SOME)
        self.assertIn("2 of 2 judged claims pass, 0 MISSED, 1 skipped", done.stdout)
        self.assertIn("skipped step_time", done.stdout)

    def test_list_names_every_row_and_writes_nothing(self):
        listed = self.json_of("validate", "--list")
        self.assertGreater(len(listed["rows"]), 20)
        self.assertLessEqual(set(SOME), {row["id"] for row in listed["rows"]})
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_wrong_use_is_refused(self):
        self.refuse("validate", says=["-o"])
        self.refuse("validate", "-o", "out", "--only", "pach_test", says=["pach_test", "patch_test"])
        self.refuse("validate", "-o", "out", "--data", "nowhere", says=["nowhere", "not a folder"])
        self.assertFalse((self.folder / "out").exists())


if __name__ == "__main__":
    unittest.main()
