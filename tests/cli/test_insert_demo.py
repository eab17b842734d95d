#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo insertion that run.sh runs at its end, with all events and its report."""
import shutil
import unittest
from pathlib import Path

from insert_case import check_gland, check_results, forces, kinds
from program import InFolder

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"


class Demo(InFolder):
    def test_the_demo_shows_every_event_of_an_insertion(self):
        shutil.copy(SCENARIOS / "demo.toml", self.folder / "demo.toml")
        done = self.succeed("insert", "demo.toml", "-o", "out/demo")
        summary = check_results(self, self.folder / "out/demo", pictures=True)
        self.assertEqual([(e["kind"], e["region"]) for e in summary["events"]],
                         [("skin_contact", "subcutaneous_fat"), ("puncture", "subcutaneous_fat"),
                          ("region_entered", "subcutaneous_fat"), ("region_entered", "body"),
                          ("region_entered", "levator"), ("region_entered", "periprostatic_fat"),
                          ("puncture", "prostate"), ("region_entered", "prostate"), ("retraction_start", ""),
                          ("slip_start", ""), ("withdrawn", "")])
        self.assertEqual([w.split(":")[0] for w in summary["warnings"]],
                         ["Structure 'Pubic arch'", "Soft tissue that the input does not have was added"])
        force = {(e["kind"], e["region"]): e["force_N"] for e in summary["events"]}
        self.assertAlmostEqual(force["puncture", "subcutaneous_fat"], 2.8, delta=0.05)
        self.assertGreater(force["retraction_start", ""], 0, "still pushing when the retraction starts")
        self.assertLess(force["slip_start", ""], 0, "pulling the tissue along until it slips")

        # The force rises before each puncture and falls after it.
        lines = forces(self.folder / "out/demo")
        for event in summary["events"]:
            if event["kind"] == "puncture":
                after = [l["force_axial_N"] for l in lines if 0.05 < l["time_s"] - event["time_s"] < 0.06]
                self.assertLess(max(after), event["force_N"])
        # At the start of the retraction all contacts stick; at the start of the slip most of them slide.
        start = next(e["time_s"] for e in summary["events"] if e["kind"] == "retraction_start")
        slip = next(e["time_s"] for e in summary["events"] if e["kind"] == "slip_start")
        stuck = [l for l in lines if start < l["time_s"] < slip]
        self.assertTrue(any(l["sticking"] >= 0.8 * l["contacts"] > 3 for l in stuck))
        for text in ("touched the skin", "went through the skin", "entered the levator", "entered the prostate",
                     "came out of the patient", "Report: out/demo/report.html"):
            self.assertIn(text, done.stdout)
        self.assertGreater(summary["mesh"]["nodes"], 2900)
        self.assertLess(summary["target_shift_mm"]["max"], 20)
        gland = check_gland(self, self.folder / "out/demo", summary)
        self.assertEqual([gland["shift_in_place_mm"][axis] for axis in ("LR", "AP", "SI")],
                         summary["target_shift_mm"]["centroid"])
        self.assertGreater(gland["shift_at_break_mm"]["SI"], 0, "pushed to superior, the way the needle goes")
        residual = gland["shift_residual_mm"]["norm"]
        self.assertTrue(0 < residual < 0.1 * gland["shift_in_place_mm"]["norm"], "tissue that creeps is nearly back")
        for text in ("just before its surface broke", "base (superior third)", "gland turned", "sagittal"):
            self.assertIn(text, done.stdout)
        self.assertEqual(kinds(summary).count("puncture"), 2)


if __name__ == "__main__":
    unittest.main()
