#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet reproduce and stylet bench: reproduced figures and numbers of the paper."""
import csv
import json
import unittest

from program import InFolder

FILES = ["figure2.json", "figure5.csv", "figure6_bcs_repositioning.csv", "figure6_default.csv",
         "figure6_woodbury_addition.csv", "report.html", "reproduce.json", "table.csv"]
EVENTS = ["skin_contact", "puncture", "region_entered", "retraction_start", "slip_start", "withdrawn"]


def rows(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


class Reproduce(InFolder):
    def test_quick_writes_everything_with_the_papers_features(self):
        result = self.json_of("reproduce", "-o", "out", "--quick")
        out = self.folder / "out"
        self.assertEqual(sorted(p.name for p in out.iterdir()), FILES)
        self.assertEqual(result, json.loads((out / "reproduce.json").read_text(encoding="utf-8")))

        # Figure 5. Times are not checked; counted operations are.
        for row in result["fig5"]:
            for method in ("inverse_s", "bcs_s", "woodbury_s"):
                self.assertGreater(row[method], 0)
            self.assertGreater(row["bcs_multiplications"], row["woodbury_multiplications"])
        self.assertLess(max(row["largest_error"] for row in result["fig5"]), 1e-8)

        # Figure 6: all variants have the same motion and all events, one row per iteration, and no change of the mesh
        # on the way out.
        self.assertAlmostEqual(result["fig6"]["mesh"]["nodes"], 570, delta=0.03 * 570)
        runs = {run["id"]: run for run in result["fig6"]["runs"]}
        self.assertEqual(set(runs), set(result["fig6"]["curves"]))
        for run in runs.values():
            kinds = [event["kind"] for event in run["events"]]
            for kind in EVENTS:
                self.assertIn(kind, kinds)
            self.assertIn("prostate", [e["region"] for e in run["events"] if e["kind"] == "puncture"])
            self.assertEqual(run["not_converged"], 0)
            lines = rows(out / run["csv"])
            self.assertEqual(len(lines), run["iterations"])
            turned = next(e["iteration"] for e in run["events"] if e["kind"] == "retraction_start")
            self.assertGreater(sum(int(line["remeshings"]) for line in lines[:turned]), 0)
            self.assertEqual(sum(int(line["remeshings"]) for line in lines[turned:]), 0)
        self.assertEqual(len({run["iterations"] for run in runs.values()}), 1)
        added = {r["dimension"] for r in runs["woodbury_addition"]["remeshings"][1:]}
        self.assertEqual(added, {18}, "a node on a face between two elements")
        self.assertEqual({r["dimension"] for r in runs["default"]["remeshings"]}, {15})
        moved = [r["dimension"] for r in runs["bcs_repositioning"]["remeshings"] if r["kind"] == "repositioned"]
        self.assertGreater(min(moved), 18, "all elements around a node")

        # The table.
        table = {row["quantity"]: row for row in result["table"]}
        for quantity in ("Woodbury over the default, same nodes", "Woodbury over a symmetric rank-k update by BLAS"):
            self.assertGreater(table[quantity]["reproduced"], 0)
        self.assertEqual(table["nodes"]["paper"], 570)
        self.assertLess(table["memory of the compliance"]["default"], table["memory of the compliance"]["reproduced"])
        self.assertEqual(table["memory of the compliance"]["reproduced"], runs["woodbury_addition"]["compliance_mb"])
        self.assertEqual([row["quantity"] for row in rows(out / "table.csv")], list(table))
        for row in result["table"]:
            self.assertEqual({"quantity", "paper", "reproduced", "default"} - set(row), set())
            if row["quantity"].startswith("multiplications"):
                self.assertAlmostEqual(row["paper"], row["reproduced"], delta=0.02 * row["paper"])

    def test_a_folder_is_needed_and_must_be_writable(self):
        self.refuse("reproduce", says=["--output"])
        self.write("file", "in the way")
        self.refuse("reproduce", "--quick", "-o", "file/out", says=["file", "not a folder"])


class Bench(InFolder):
    def test_remesh_gives_every_method_at_every_size(self):
        result = self.json_of("bench", "remesh", "--nodes", "216")
        found = {(row["nodes"], row["method"]) for row in result["rows"]}
        methods = ("shortcut", "bordered", "woodbury", "bcs", "inverse")
        self.assertEqual(found, {(nodes, method) for nodes in (125, 216) for method in methods})
        self.assertTrue(all(row["median_us"] > 0 for row in result["rows"]))
        self.assertEqual([event["rule"] for event in result["events"]], ["interior", "paper", "near-field"])
        for event in result["events"]:
            self.assertLess(abs(event["nodes"] - 570), 0.03 * 570)
            self.assertGreater(event["events"], event["points"])
            for times in (event["warm_us"], event["cold_us"]):
                self.assertTrue(0 < times["p5"] <= times["p50"] <= times["p95"] <= times["max"])
            ratios = result["event_ratios"][event["rule"]]
            self.assertIsNone(ratios["warm"]["finest_over_coarsest"])  # there is only one mesh
            self.assertGreater(ratios["warm"]["woodbury_over_event"], 1)
        self.assertEqual(result["event_woodbury"]["nodes"], result["events"][0]["nodes"])

    def test_pictures_times_every_kind_of_picture(self):
        rows = self.json_of("bench", "pictures", "--nodes", "3000")["rows"]
        self.assertEqual([row["picture"] for row in rows],
                         ["surfaces", "section", "ultrasound, transverse", "ultrasound, sagittal", "X-ray", "probe"])
        for row in rows:
            self.assertLess(abs(row["nodes"] - 3000), 0.03 * 3000)
            times = row["cpu_us"]
            self.assertTrue(0 < times["p50"] <= times["p99"] <= times["max"])
        self.refuse("bench", "pictures", "--nodes", "2999", says=["--nodes", "2999", "3000"])

    def test_an_unknown_subject_is_refused_with_those_there_are(self):
        self.refuse("bench", "remsh", says=["remsh", "remesh", "pictures"])

    def test_an_option_of_another_subject_is_refused_with_those_that_take_it(self):
        self.refuse("bench", "dose", "--contacts", "20", says=["--contacts", "dose", "scale"])
        self.refuse("bench", "dose", "--nodes", "600", says=["--nodes", "dose", "remesh, scale, pictures"])
        self.refuse("bench", "pictures", "--steps", "1000", says=["--steps", "pictures", "scale"])


if __name__ == "__main__":
    unittest.main()
