#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A file that is no patient for this program: refused by every simulation with the cure, told of by info."""
import json
import unittest

from program import InFolder
from samples import ellipsoid, structure_set

INSERTION = '[[insertion]]\nhole = "d4"\nretract = false\n'
INSISTS = "--region 'CTV=prostate'"


BREAST = [ellipsoid("Heart", (20, 0, 0), (50, 45, 55), 5), ellipsoid("Lung_L", (80, 20, 20), (50, 60, 100), 10),
          ellipsoid("Lung_R", (-80, 20, 20), (50, 60, 100), 10), ellipsoid("CTV", (70, -80, 10), (7, 6.5, 7), 1, "CTV")]
FLIPPED = [ellipsoid("Prostate", (0, 0, 0), (22, 17, 20), 4), ellipsoid("Bladder", (0, -10, -48), (35, 30, 26), 4)]


class PatientFit(InFolder):
    def case(self, structures, lines=""):
        self.write("case.json", structure_set(*structures))
        self.write("case.toml", f'[patient]\nsource = "case.json"\n{lines}\n[mesh]\nnodes = 800\n{INSERTION}')

    def test_a_breast_is_refused_by_every_simulation(self):
        self.case(BREAST)
        for command in (("mesh", "case.json", "-o", "m.vtu"), ("insert", "case.toml", "-o", "out"),
                        ("prepare", "case.toml", "-o", "m.stylet"), ("image", "case.toml", "-o", "out.png"),
                        ("fluoro", "case.toml", "-o", "out.png")):
            said = self.refuse(*command, says=("not a patient for this program",))
            for part in ("1.3 cc", "'Heart', 'Lung_L', 'Lung_R'", INSISTS):
                self.assertIn(part, said.stderr, command)
        self.assertFalse((self.folder / "m.vtu").exists())

    def test_info_tells_and_its_draft_does_not_insist(self):
        self.case(BREAST)
        warnings = self.json_of("info", "case.json")["warnings"]
        self.assertEqual(len([w for w in warnings if w.startswith("A simulation refuses this patient")]), 2, warnings)
        self.succeed("info", "case.json", "--scenario", "-o", "draft.toml")
        self.assertIn('#"CTV" = "prostate"', (self.folder / "draft.toml").read_text())
        self.refuse("insert", "draft.toml", "-o", "out", says=("not a patient for this program",))

    def test_the_user_may_insist(self):
        self.case(BREAST, '[patient.regions]\nCTV = "prostate"')
        warnings = self.json_of("mesh", "case.json", "-o", "m.vtu", "--nodes", "800", "--region",
                                "CTV=prostate")["warnings"]
        self.assertTrue(any("other_body_part" in w for w in warnings), warnings)
        self.assertIn("other_body_part", self.succeed("prepare", "case.toml", "-o", "m.stylet").stderr)

    def test_flipped_axes_are_a_warning(self):
        self.case(FLIPPED)
        self.assertTrue(any("axes may be flipped" in w for w in
                            self.json_of("mesh", "case.json", "-o", "m.vtu", "--nodes", "800")["warnings"]))

    def test_dose_warns_where_it_judges_the_goals_of_a_prostate(self):
        self.case(BREAST)
        self.write("plan.csv", "x_mm,y_mm,z_mm,strength_U\n70,-80,10,0.5\n71,-80,14,0.5\n")
        dose = ("dose", "plan.csv", "--structures", "case.json", "--source", "i125_6711", "-o", "out",
                "--prescription", "145", "--grid", "5")
        self.assertIn("other_body_part", self.succeed(*dose).stderr)
        self.assertIn("other_body_part", json.dumps(self.read("out/dose.json")["warnings"]))
        self.assertIn("other_body_part", (self.folder / "out/report.html").read_text())
        self.write("goals.csv", "structure,metric,bound,citation\nHeart,D2cc_Gy,>= 1,own\n")
        self.assertNotIn("other_body_part", self.succeed(*dose, "--goals", "goals.csv").stderr)


if __name__ == "__main__":
    unittest.main()
