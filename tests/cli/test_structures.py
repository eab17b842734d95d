#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Structures as used in clinics: the region that each becomes, those that are left out, and that every output reports
this."""
import math
import unittest

import samples
from insert_case import BLOCK, SMALL, FAST, block_mesh
from program import InFolder, as_on_terminal

INSERTION = '[[insertion]]\nhole = "d4"\nspeed_mm_per_s = 80\nretract = false\ndwell_s = 0\n'


def organ(name, kind, x, y, half, closed=True):
    """An ellipsoidal organ with contours every 5 mm. If it is not closed, its lower third in y is missing on every
    slice."""
    contours = []
    for k in range(-3, 4):
        scale = math.sqrt(1 - (5 * k / 20) ** 2)
        points = []
        for step in range(60):
            angle = 2 * math.pi * step / 60 + math.pi / 2
            if closed or 10 <= step <= 50:
                points.append([x + half * scale * math.cos(angle), y + half * scale * math.sin(angle), 5.0 * k])
        contours.append(points)
    return {"name": name, "type": kind, "contours": contours}


class Structures(InFolder):
    def case(self, *structures, lines=""):
        self.write("case.json", samples.structure_set(*structures))
        self.write("case.toml", f'[patient]\nsource = "case.json"\n{lines}\n{INSERTION}')

    def warnings_everywhere(self, done):
        """The warnings of an insertion, which terminal, summary, report and recording have alike."""
        summary = self.read("out/summary.json")
        start = "stylet: warning: "
        said = [line[len(start):] for line in done.stderr.splitlines() if line.startswith(start)]
        self.assertEqual(said, summary["warnings"])
        report = (self.folder / "out/report.html").read_text()
        listed = report.split('<ul class="warnings">')[1].split("</ul>")[0] if '<ul class="warnings">' in report else ""
        self.assertEqual([as_on_terminal(item) for item in listed.replace("</li>", "").split("<li>")[1:]], said)
        self.assertEqual(self.json_of("info", "out/run.h5")["warnings"], said)
        return said

    def test_how_structures_are_taken_is_said_everywhere(self):
        self.case(organ("PTV", "PTV", 0, 0, 20), organ("X 1", "AVOIDANCE", 0, 60, 12), {"name": "PROS", "contours": []},
                  organ("Rectum", "ORGAN", 0, 45, 18, closed=False))
        said = self.warnings_everywhere(self.succeed("insert", "case.toml", "-o", "out", *SMALL))
        self.assertTrue(any("structure 'PTV' (type PTV) is taken as the gland, since no structure is named prostate" in s
                            for s in said), said)
        self.assertIn("The structure is left out (name not recognised): 'X 1'.", said)
        self.assertIn("The structure is left out (empty): 'PROS'.", said)
        self.assertTrue(any("'Rectum': in 7 of 7 contours" in s and "straight side" in s for s in said), said)
        summary = self.read("out/summary.json")
        self.assertIn("prostate", [e["region"] for e in summary["events"]])
        self.assertGreater(summary["target_shift_mm"]["max"], 0)

    def test_a_broken_structure_is_refused_with_the_way_to_leave_it_out(self):
        broken = organ("Rectum", "ORGAN", 0, 45, 15)
        points = broken["contours"][3]
        points[10], points[30] = points[30], points[10]
        self.case(organ("Prostate", "ORGAN", 0, 0, 20), broken)
        self.refuse("insert", "case.toml", "-o", "out",
                    says=["ROI 'Rectum', contour 4", "crosses itself", 'skip = ["Rectum"] below [patient]'])
        meshed = self.json_of("mesh", "case.json", "-o", "m.vtu", "--nodes", "800", "--skip", "rectum")
        self.assertNotIn("rectum", meshed["regions"])
        self.assertIn("The structure is left out (named in [patient] skip): 'Rectum'.", meshed["notes"])
        self.case(organ("Prostate", "ORGAN", 0, 0, 20), broken, lines='skip = ["Rektum"]')
        self.refuse("insert", "case.toml", "-o", "out", says=["patient.skip", "'Rektum'", "Did you mean 'Rectum'?"])

    def test_labels_and_surfaces_are_skipped_as_well(self):
        samples.nifti_mask(self.folder / "mask.nii.gz")
        meshed = self.json_of("mesh", "mask.nii.gz", "-o", "m.vtu", "--nodes", "800", "--skip", "2")
        self.assertIn("The label is left out (named in [patient] skip): '2'.", meshed["notes"])
        self.refuse("mesh", "mask.nii.gz", "-o", "n.vtu", "--skip", "7", says=["there is no label '7'"])
        samples.stl_surface(self.folder / "corner.stl")
        self.refuse("mesh", "corner.stl", "-o", "n.vtu", "--skip", "cornr",
                    says=["there is no surface 'cornr'", "Did you mean 'corner'?"])
        samples.tet_mesh(self.folder / "two.msh")
        self.refuse("mesh", "two.msh", "-o", "n.vtu", "--skip", "upper", says=["--skip has no meaning"])

    def test_without_a_target_none_is_said_to_have_moved_and_warnings_of_the_run_are_everywhere_too(self):
        block_mesh(self.folder / "block.msh")
        self.write("case.toml", BLOCK)
        done = self.succeed("insert", "case.toml", "-o", "out", *FAST, "--set", "coupling.contacts=8")
        said = self.warnings_everywhere(done)
        self.assertTrue(any(s.startswith("In ") and "no room for another contact" in s for s in said), said)
        self.assertTrue(any("No region of the mesh (tissue, lump) is known as the target" in s for s in said), said)
        self.assertIsNone(self.read("out/summary.json")["target_shift_mm"])
        self.assertIsNone(self.read("out/summary.json")["gland"])
        self.assertFalse((self.folder / "out/gland.csv").exists())
        self.assertNotIn("target moved", done.stdout)
        self.assertNotIn("gland moved", done.stdout)
        story = (self.folder / "out/report.html").read_text().split("<details>")[0]
        for words in ("How the gland moved", "shift of the target", "motion in the target", "was at its initial place", "section through the target"):
            self.assertNotIn(words, story)


class DraftedScenarios(InFolder):
    def draft_and_insert(self, file, *options):
        """Runs info --scenario > patient.toml && insert patient.toml. Returns the scenario's text and the summary."""
        text = self.succeed("info", file, "--scenario", *options).stdout
        self.succeed("insert", self.write("patient.toml", text), "-o", "out", *SMALL)
        return text, self.read("out/summary.json")

    def finds_its_patient(self, scenario):
        """A misspelt region ends an insertion after the patient has been read, before the work."""
        self.refuse("insert", scenario, "-o", "out", "--set", "tissue.prostata.young_kPa=30", says=["no region 'prostata'"])

    def contours(self, *structures):
        return self.write("case.json", samples.structure_set(*structures))

    def test_contours(self):
        broken = organ('Rec"tum', "", 0, 45, 15)
        broken["name"] = "Rectum"
        points = broken["contours"][3]
        points[10], points[30] = points[30], points[10]
        text, summary = self.draft_and_insert(self.contours(
            organ("CTV", "CTV", 0, 0, 20), organ("PTV", "PTV", 0, 0, 23), organ('He said "X"\n', "", 70, 0, 9), broken,
            organ("Bladder", "", 0, -50, 14), {"name": "PROS", "contours": []}))
        for part in ('"CTV" = "prostate"', '"Bladder" = "bladder"', "taken as the gland", "'PTV'", "'PROS'",
                     'skip = ["Rectum"]', "crosses itself", '[[insertion]]\nhole = "E4"'):
            self.assertIn(part, text)
        self.assertIn("prostate", [e["region"] for e in summary["events"]])

    def test_structure_set(self):
        self.succeed("phantom", "-o", ".")
        text, summary = self.draft_and_insert("phantom.dcm")
        for part in ('= "prostate"', '= "urethra"', '= "body"'):
            self.assertIn(part, text)
        self.assertIn("prostate", [e["region"] for e in summary["events"]])

    def test_mask(self):
        samples.nifti_mask(self.folder / "mask.nii.gz")
        text, summary = self.draft_and_insert("mask.nii.gz")
        self.assertIn('#"2" = ', text)
        self.assertGreater(summary["target_shift_mm"]["max"], 0)

    def test_mesh_with_a_unit(self):
        block_mesh(self.folder / "block.msh", size=0.06, names=("Tissue", "Prostate"))
        text, summary = self.draft_and_insert("block.msh", "--scale", "1000")
        self.assertIn("scale = 1000", text)
        self.assertIn('"Prostate" = "prostate"', text)
        self.assertIsNotNone(summary["target_shift_mm"])

    def test_surface(self):
        samples.stl_surface(self.folder / "corner.stl")
        done = self.succeed("info", "corner.stl", "--scenario")
        self.assertIn("[[insertion]]", done.stdout)
        self.assertIn("corner", done.stdout)

    def test_a_file_names_its_patient_from_where_it_lies(self):
        samples.contour_json(self.folder / "case.json")
        self.assertEqual(self.succeed("info", "case.json", "--scenario", "-o", "here/there/p.toml").stdout.strip(),
                         "case.json → here/there/p.toml")
        text = (self.folder / "here/there/p.toml").read_text()
        self.assertIn('source = "../../case.json"', text)
        (self.folder / "here").rename(self.folder / "hither")
        self.finds_its_patient("hither/there/p.toml")

    def test_standard_output_names_the_patient_wherever_it_goes(self):
        samples.contour_json(self.folder / "case.json")
        (self.folder / "deep").mkdir()
        self.finds_its_patient(self.write("deep/p.toml", self.succeed("info", "case.json", "--scenario").stdout))

    def test_what_cannot_be_drafted_is_refused(self):
        samples.contour_json(self.folder / "case.json")
        self.refuse("info", "case.json", "-o", "p.toml", says=["--scenario"])
        self.refuse("info", "case.json", "--scenario", "-o", "case.json", says=["replace the patient's file"])
        self.refuse("info", "case.json", "--scenario", "-o", "case.json/p.toml", says=["not a folder"])

    def test_without_a_gland_the_scenario_says_how_to_name_it(self):
        done = self.succeed("info", self.contours(organ("Lesion 3", "", 0, 0, 20)), "--scenario")
        self.assertIn('#"Lesion 3" = "prostate"', done.stdout)
        self.assertIn("warning", done.stderr)


if __name__ == "__main__":
    unittest.main()
