#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet insert: from a scenario to its results."""
import json
import unittest

from insert_case import (BLOCK, FAST, FORCES_HEADER, FULL_INSERTION, SMALL, Cases, block_mesh, check_results, forces, kinds,
                         without_step_times)

# Makes the block's inner region the gland; otherwise there is no target.
GLAND = ("--set", 'patient.regions.lump="prostate"')


class Insert(Cases):
    def test_the_demo_patient_gives_every_file_and_every_event(self):
        summary = self.json_of("insert", "phantom.toml", "-o", "out", *SMALL)
        check_results(self, self.folder / "out", summary)
        self.assertAlmostEqual(summary["mesh"]["nodes"], 800, delta=0.03 * 800)
        happened = [(event["kind"], event["region"]) for event in summary["events"]]
        for earlier, later in zip(FULL_INSERTION, FULL_INSERTION[1:]):
            self.assertLess(kinds(summary).index(earlier), kinds(summary).index(later))
        self.assertIn(("puncture", "subcutaneous_fat"), happened)
        self.assertIn(("puncture", "prostate"), happened)
        self.assertIn(("region_entered", "prostate"), happened)
        self.assertEqual(kinds(summary)[-1], "withdrawn")
        self.assertGreater(summary["target_shift_mm"]["max"], 0)
        last = forces(self.folder / "out")[-1]
        self.assertEqual((last["tip_state"], last["contacts"], last["force_axial_N"]), ("air", 0, 0))

    def test_two_runs_are_byte_identical_but_for_step_times_on_any_number_of_threads(self):
        self.succeed("insert", "phantom.toml", "-o", "one", *SMALL)
        self.succeed("insert", "phantom.toml", "-o", "two", "--threads", "1", *SMALL)
        self.assertEqual(without_step_times(self.folder / "one"), without_step_times(self.folder / "two"))
        header = (self.folder / "one/forces.csv").read_text().splitlines()[0]
        self.assertEqual(header, ",".join(FORCES_HEADER))

    def test_nearly_flat_tetrahedra_are_warned_of(self):
        block_mesh(self.folder / "block.msh", last_layer=0.5)
        done = self.succeed("insert", "block.toml", "-o", "out", *FAST)
        self.assertRegex(done.stderr, r"stylet: warning: \d+ of 384 tetrahedra are nearly flat[^\n]*'tissue'")
        summary = check_results(self, self.folder / "out")
        self.assertEqual(sum("nearly flat" in warning for warning in summary["warnings"]), 1)
        self.assertIn("of 384 tetrahedra are nearly flat", (self.folder / "out/report.html").read_text(encoding="utf-8"))

    def test_a_mesh_of_somebody_else_is_taken_as_it_is_and_events_and_peaks_are_printed(self):
        done = self.succeed("insert", "block.toml", "-o", "out", *FAST, *GLAND)
        summary = check_results(self, self.folder / "out")
        for text in ("touched the tissue", "entered the tissue", "entered the prostate", "began to be drawn back",
                     "began to slip back", "came out of the patient", "peak force", "target moved", "balance", "step"):
            self.assertIn(text, done.stdout)
        lines = forces(self.folder / "out")
        self.assertEqual([line["time_s"] for line in lines], [(4 * (k + 1)) / 1000 for k in range(len(lines))])
        self.assertEqual(summary["mesh"], {"nodes": 125, "tets": 384})
        self.assertEqual([e["region"] for e in summary["events"] if e["kind"] == "region_entered"], ["tissue", "prostate"])
        self.assertIn("125 nodes, 384 tetrahedra", done.stdout)
        self.assertIn("Report: out/report.html", done.stdout)
        self.assertIn("far half, seen along the needle", (self.folder / "out/report.html").read_text(encoding="utf-8"))

    def test_the_methods_of_the_2005_paper_are_one_word_away_and_agree_with_ours(self):
        # With steps of 4 ms, the two solvers differ when the capsule breaks suddenly.
        addition = ("--method", "node-addition", "--rule", "paper", *FAST, "--set", "run.dt_ms=2")
        ours = self.json_of("insert", "block.toml", "-o", "ours", *addition)
        for words in (("--engine", "woodbury"), ("--engine", "bcs"), ("--solver", "staggered")):
            with self.subTest(words=words):
                theirs = self.json_of("insert", "block.toml", "-o", "theirs", *addition, *words)
                self.assertAlmostEqual(theirs["peak_force_N"]["axial"] / ours["peak_force_N"]["axial"], 1, delta=1e-6)
                self.assertEqual([(m["kind"], m["dimension"]) for m in theirs["mesh_changes"]],
                                 [(m["kind"], m["dimension"]) for m in ours["mesh_changes"]])
        self.assertTrue({m["dimension"] for m in ours["mesh_changes"]} <= {15, 18})

        done = self.succeed("insert", "phantom.toml", "-o", "moved", "--engine", "bcs", "--method", "node-repositioning",
                            *SMALL)
        self.assertIn("moved (ΔK of order", done.stdout)
        changes = check_results(self, self.folder / "moved")["mesh_changes"]
        moved = [m for m in changes if m["kind"] == "repositioned"]
        self.assertTrue(moved)
        for change in changes:
            self.assertEqual(change["not_moved_because"] == "", change["kind"] == "repositioned")
            self.assertEqual(change["moved_mm"] > 0, change["kind"] == "repositioned")

    def test_json_alone_is_on_standard_output(self):
        done = self.succeed("insert", "block.toml", "-o", "out", "--json", "-", *FAST)
        self.assertTrue(done.stdout.startswith("{"))
        self.assertEqual(json.loads(done.stdout), self.read("out/summary.json"))

    def test_json_goes_to_a_file_and_results_to_a_folder_named_after_the_scenario_quietly(self):
        done = self.succeed("insert", "block.toml", "--json", "here/s.json", "--quiet", *FAST, *GLAND)
        self.assertEqual((done.stdout, done.stderr), ("", ""))
        check_results(self, self.folder / "out/block", self.read("here/s.json"))

    def test_settings_replace_what_the_scenario_says(self):
        fast = self.json_of("insert", "block.toml", "-o", "fast", *FAST)
        slow = self.json_of("insert", "block.toml", "-o", "slow", *FAST, "--set", "insertion.speed_mm_per_s=20",
                            "--set", "insertion[0].depth_mm=15", "--set", "name=slow and shallow")
        self.assertEqual(slow["scenario"], "slow and shallow")
        self.assertLess(slow["peak_force_N"]["axial"], fast["peak_force_N"]["axial"])
        deepest = max(line["base_depth_mm"] for line in forces(self.folder / "slow"))
        self.assertAlmostEqual(deepest, 15, places=6)

    def test_a_needle_can_be_left_in(self):
        summary = self.json_of("insert", "block.toml", "-o", "out", *FAST, "--set", "insertion.retract=false")
        check_results(self, self.folder / "out", summary)
        self.assertNotIn("withdrawn", kinds(summary))
        self.assertGreater(forces(self.folder / "out")[-1]["contacts"], 3)

    def test_a_recorded_motion_moves_the_base(self):
        # The motion: 40 mm along z in one second and out again. The base is one needle length behind the tip.
        rows = ["time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz"]
        rows += [f"{t},31,32,{z - 100},1,0,0,0" for t, z in ((0, -3), (1.075, 40), (1.2, 40), (2.275, -3))]
        self.write("motion.csv", "\n".join(rows) + "\n")
        self.write("recorded.toml", BLOCK.split("[[insertion]]")[0] + '[[insertion]]\nmotion = "motion.csv"\n')
        summary = self.json_of("insert", "recorded.toml", "-o", "out", *FAST)
        check_results(self, self.folder / "out", summary)
        self.assertEqual(kinds(summary)[-1], "withdrawn")
        planned = self.json_of("insert", "block.toml", "-o", "plan", *FAST, "--set", "insertion.dwell_s=0.125")
        self.assertAlmostEqual(summary["peak_force_N"]["axial"], planned["peak_force_N"]["axial"], places=6)

    def test_the_results_open_again_with_info(self):
        self.succeed("insert", "block.toml", "-o", "out", "--quiet", *FAST)
        info = self.json_of("info", "out/run.h5")
        self.assertEqual(info["kind"], "recording")
        # The mesh of a saved model exists already, so keys that would change it are refused.
        self.refuse("insert", "out/run.h5", "-o", "again", "--set", 'patient.skip=["lump"]',
                    says=["patient.skip", "out/run.h5 already has the finished mesh"])

    def test_a_parameter_beyond_what_is_plausible_is_warned_of(self):
        done = self.succeed("insert", "block.toml", "-o", "out", "--quiet", *FAST, "--set", "tissue.lump.puncture_N=30")
        self.assertIn("warning", done.stderr)
        self.assertIn("tissue.lump: puncture_N = 30", done.stderr)
        self.assertIn("tenting", done.stderr)
        summary = check_results(self, self.folder / "out")
        self.assertTrue(any("tissue.lump" in warning for warning in summary["warnings"]))

    def test_tenting_and_lag_of_tissues_are_those_of_the_scenario_and_less_where_tissue_stiffens(self):
        def body(*settings):
            options = [word for s in ('tissue.preset="linear"', *settings) for word in ("--set", s)]
            text = self.succeed("insert", "block.toml", "--print-tissues", *options).stdout
            lines = [line.split() for line in text.splitlines()]
            names = next(line for line in lines if line[:1] == ["region"])
            self.assertEqual([name for name in names if name[0] != "["],
                             ["region", "E", "nu", "stiffening", "cutting", "puncture", "tenting", "cutting", "lag"])
            return [float(number) for number in next(line for line in lines if line[:1] == ["body"])[1:]]

        *linear, tenting, lag = body()
        *stiff, less_tenting, less_lag = body("tissue.body.stiffening=2")
        self.assertEqual(stiff, [*linear[:2], 2.0, *linear[3:]])
        # The stiffness of a flat punch is 2 R E / (1 - nu^2); the part of the displacement that is wider than 10 mm
        # does not stiffen.
        young, poisson, _, cutting, puncture = linear
        self.assertAlmostEqual(tenting, puncture * (1 - poisson**2) / (1.27 * 1e-3 * young), delta=0.06)
        self.assertLess(less_tenting, 0.5 * tenting)
        self.assertLess(less_lag, 0.8 * lag)
        self.assertGreater(less_lag, 0.2 * lag)
        self.assertAlmostEqual(body("needle.diameter_mm=0.635")[-1], 2 * lag, delta=0.11)


if __name__ == "__main__":
    unittest.main()
