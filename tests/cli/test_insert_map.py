#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet insert --map: the map of all holes of the template before the insertion."""
import csv
import json
import unittest

from insert_case import BLOCK, PHANTOM, SMALL, block_mesh
from program import InFolder

# Two columns and two rows of the template, around hole e3.5.
FEW_HOLES = """\
[template]
columns = ["E", "e"]
rows = ["3.5", "4"]
centre_mm = [12.5, 2.5]
"""


class Map(InFolder):
    def setUp(self):
        super().setUp()
        self.write("case.toml", PHANTOM + FEW_HOLES)

    def insert(self, *options):
        done = self.succeed("insert", "case.toml", *SMALL, *options)
        return done.stdout

    def test_each_row_is_what_an_insertion_through_that_hole_comes_to(self):
        printed = self.insert("--map", "-o", "out", "--json", "out.json")
        result = self.read("out.json")
        summary = json.loads((self.folder / "out" / "summary.json").read_text())
        holes = {row["hole"]: row for row in result["map"]["holes"]}
        self.assertEqual(list(holes), ["E4", "e4", "E3.5", "e3.5"])
        self.assertEqual(result["map"]["planned"], "e3.5")
        self.same(holes["e3.5"], summary)
        self.insert("-o", "other", "--set", 'insertion.hole="E4"')
        self.same(holes["E4"], json.loads((self.folder / "other" / "summary.json").read_text()))

        # The report has the same map.
        with open(self.folder / "out" / "map.csv", newline="", encoding="utf-8") as file:
            lines = {line["hole"]: line for line in csv.DictReader(file)}
        self.assertEqual(list(lines), list(holes))
        for name, line in lines.items():
            row = holes[name]
            for structure, clearance in row["clearance_mm"].items():
                self.assertAlmostEqual(float(line[f"clearance_{structure}_mm"]), clearance, delta=1e-6)
            self.assertAlmostEqual(float(line["shift_max_mm"]), row["shift_max_mm"]["norm"], delta=1e-6)
            self.assertAlmostEqual(float(line["tip_error_mm"]), row["tip_error_mm"]["norm"], delta=1e-6)
            printed_row = next(words for words in map(str.split, printed.splitlines()) if words[:1] == [name])
            self.assertEqual(printed_row[-1], f"{row['tip_error_mm']['norm']:.2f}")
        self.assertIn("e3.5 *", printed)
        self.assertIn("4 of 4 holes lead into the gland", printed)
        self.assertIn("Not a medical device", printed)

    def same(self, row, summary):
        gland = summary["gland"]
        for mapped, inserted in ((row["shift_at_break_mm"], gland["shift_at_break_mm"]),
                                 (row["shift_max_mm"], gland["shift_max_mm"]), (row["tip_error_mm"], summary["tip_error_mm"])):
            self.assertEqual(mapped is None, inserted is None)
            for part, value in (mapped or {}).items():
                self.assertAlmostEqual(value, inserted[part], delta=1e-9)

    def test_a_later_run_without_a_map_leaves_none_behind(self):
        self.insert("--map", "-o", "out", "--set", 'template.columns=["e"]', "--set", 'template.rows=["3.5"]',
                    "--set", "template.centre_mm=[15, 5]")
        self.assertTrue((self.folder / "out" / "map.csv").is_file())
        self.insert("-o", "out")
        self.assertFalse((self.folder / "out" / "map.csv").exists())
        self.refuse("insert", "out/run.h5", "--map", "-o", "again", says=["out/run.h5", "recording", "--map"])

    def test_what_no_map_can_be_made_of(self):
        self.write("two.toml", PHANTOM + '[[insertion]]\nhole = "c3.5"\n')
        self.refuse("insert", "two.toml", "--map", "-o", "no", *SMALL,
                    says=["two.toml, [[insertion]]", "2 insertions", "Keep only the"])
        block_mesh(self.folder / "block.msh")
        self.write("block.toml", BLOCK)
        self.refuse("insert", "block.toml", "--map", "-o", "no",
                    says=["block.toml, insertion[0].entry_mm", "does not go through a hole", 'hole = "D4"'])
        self.write("held.toml", BLOCK.replace("entry_mm = [31, 32, -10]", 'hole = "D4"'))
        self.refuse("insert", "held.toml", "--map", "-o", "no",
                    says=["held.toml", "no target", "tissue, lump", "patient.regions"])
        self.assertFalse((self.folder / "no").exists())


if __name__ == "__main__":
    unittest.main()
