#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet dose with plans that contradict themselves, made from plans of our own: each is refused, or warned of on the
terminal, in dose.json and on the page."""
import copy
import subprocess
import unittest

from program import InFolder, page_text, run
from samples import ball, structure_set


GRID = [(x, y, z) for x in (-11, 0, 11) for y in (-11, 0, 11) for z in (-10, 0, 10)]


def base(**more):
    return {"format": "stylet-plan", "version": 1, "units": "mm", "frame": "LPS", **more}


def ldr():
    return base(source="i125_6711", strength_U=0.6, prescription_Gy=145,
                seeds=[{"position_mm": list(p), "axis": [0, 0, 1]} for p in GRID])


def hdr():
    return base(source="ir192_mhdr_v2", implant="temporary", strength_U=40000, prescription_Gy=15,
                seeds=[{"position_mm": list(p), "axis": [0, 0, 1], "dwell_s": 14, "needle": f"n{k // 3}"}
                       for k, p in enumerate(GRID)])


def csv(strength="0.6", lines=(), columns="x_mm,y_mm,z_mm", extra=""):
    head = [f"# strength_U: {strength}", "# source: i125_6711", "# prescription_Gy: 145", *lines, columns]
    return "\n".join(head + [",".join(map(str, p)) + extra for p in GRID]) + "\n"


def seeds(change):
    """Changes each seed of a plan by change(seed, number)."""
    def changed(plan):
        for number, seed in enumerate(plan["seeds"]):
            change(seed, number)
    return changed


def scaled(factor):
    return seeds(lambda seed, _: seed.update(position_mm=[factor * x for x in seed["position_mm"]]))


def times(factor):
    return seeds(lambda seed, _: seed.update(dwell_s=factor * seed["dwell_s"]))


def one(number, **values):
    return seeds(lambda seed, k: seed.update(values) if k == number else None)


def put(**values):
    return lambda plan: plan.update(values)


SOURCE = "(300a,0210)[0]."
CHANNEL = "(300a,0230)[0].(300a,0280)[0]."

# (name, plan, change, arguments, what the message says: the rule's name, or words of another message)
JSON_CASES = [
    ("strength in MBq", ldr, put(strength_U=17.5), (), "seed strength"),
    ("strength in kBq", ldr, put(strength_U=17500), (), "seed strength"),
    ("strength in Bq", ldr, put(strength_U=1.75e7), (), "seed strength"),
    ("strength in GBq", ldr, put(strength_U=0.0175), (), "seed strength"),
    ("strength in Gy m²/h", ldr, put(strength_U=6e-7), (), "seed strength"),
    ("strength of 0", ldr, put(strength_U=0), (), "strength"),
    ("negative strength of one seed", ldr, one(3, strength_U=-0.6), (), "strength"),
    ("one seed a hundredfold", ldr, one(5, strength_U=60.0), (), "equal strengths"),
    ("one seed ten times weaker", ldr, one(5, strength_U=0.06), (), "equal strengths"),
    ("source in Ci", hdr, put(strength_U=9.8), (), "afterloader strength"),
    ("source in GBq", hdr, put(strength_U=363), (), "afterloader strength"),
    ("source in mCi", hdr, put(strength_U=9800), (), "dose to the target"),
    ("source in mGy/h", hdr, put(strength_U=40), (), "afterloader strength"),
    ("source of a seed in an afterloader", hdr, put(source="i125_6711"), (), "low-rate strength"),
    ("afterloader's source that stays", hdr, put(implant="permanent"), (), "dwell times of seeds"),
    ("seeds with dwell times", ldr, one(0, dwell_s=5), (), "dwell times of seeds"),
    ("temporary without dwell times", ldr, put(implant="temporary", source="ir192_mhdr_v2", strength_U=40000), (),
     "missing dwell time"),
    ("one dwell time missing", hdr, lambda plan: plan["seeds"][4].pop("dwell_s"), (), "missing dwell time"),
    ("all dwell times 0", hdr, times(0), (), "missing dwell time"),
    ("negative dwell time", hdr, one(2, dwell_s=-4), (), "dwell time"),
    ("times in ms", hdr, times(1000), (), "time of the implant"),
    ("times in min", hdr, times(1 / 60), (), "time of the implant"),
    ("times in h", hdr, times(1 / 3600), (), "time of the implant"),
    ("places in cm", ldr, scaled(0.1), (), "extent"),
    ("places in m", ldr, scaled(0.001), (), "overlapping seeds"),
    ("places ten times too far", ldr, scaled(10), (), "extent"),
    ("plan of another patient", ldr, seeds(lambda s, _: s["position_mm"].__setitem__(0, s["position_mm"][0] + 90)), (),
     "other patient"),
    ("one seed far away", ldr, one(7, position_mm=[60, 0, 0]), (), "distance from the target"),
    ("seeds beside the target", ldr, seeds(lambda s, _: s["position_mm"].__setitem__(1, s["position_mm"][1] + 28)), (),
     "distance from the target"),
    ("a seed twice", ldr, lambda plan: plan["seeds"].append(copy.deepcopy(plan["seeds"][0])), (), "same place"),
    ("two seeds in one another", ldr, one(1, position_mm=[-11.3, -11, -10]), (), "overlapping seeds"),
    ("a dwell position twice", hdr, lambda plan: plan["seeds"].append(copy.deepcopy(plan["seeds"][0])), (),
     "same place"),
    ("three seeds only", ldr, lambda plan: plan.update(seeds=plan["seeds"][:3]), (), "number of sources"),
    ("prescription in cGy", ldr, put(prescription_Gy=14500), (), "prescription"),
    ("prescription a hundredth", ldr, put(prescription_Gy=1.45), (), "prescription"),
    ("negative prescription", ldr, put(prescription_Gy=-145), (), "prescription"),
    ("no prescription", ldr, lambda plan: plan.pop("prescription_Gy"), (), "missing prescription"),
    ("prescription of seeds for an afterloader", hdr, put(prescription_Gy=145), (), "prescription"),
    ("prescription in cGy for an afterloader", hdr, put(prescription_Gy=1500), (), "prescription"),
    ("another prescription on the command line", ldr, put(), ("--prescription", 60), "one prescription"),
    ("units in cm", ldr, put(units="cm"), (), "mm"),
    ("unknown source", ldr, put(source="i125_9999"), (), "i125_9999"),
    ("strength not a number", ldr, put(strength_U="0.6 U"), (), "number"),
    ("date of the strength that is none", ldr, put(strength_date="next Tuesday"), (), "no date"),
    ("date of the strength in the future", ldr, put(strength_date="20990101"), (), "dates"),
    ("Cs-131 of the strength of I-125", ldr, put(source="cs131_cs1rev2"), (), "seed strength"),
]
CSV_CASES = [
    ("a line of strength in mCi", csv(lines=["# strength_mCi: 0.47"]), "not computed"),
    ("a line of activity", csv(lines=["# activity: 17.5 MBq"]), "not computed"),
    ("strength in MBq", csv("22.2"), "seed strength"),
    ("strength NaN", csv("nan"), "finite"),
    ("dwell times without implant: temporary", csv(columns="x_mm,y_mm,z_mm,dwell_s", extra=",10"),
     "dwell times of seeds"),
    ("temporary without a dwell time", csv("40000", ["# implant: temporary"]).replace("i125_6711", "ir192_mhdr_v2"),
     "missing dwell time"),
    ("prescription in cGy", csv().replace(": 145", ": 14500"), "prescription"),
    ("places in m", csv().replace("11,", "0.011,").replace(",10\n", ",0.010\n"), "not"),
]
DICOM_CASES = [
    ("half-life of another isotope", ldr, ["-m", SOURCE + "(300a,0228)=16.991"], (), "half-life"),
    ("half-life in hours", ldr, ["-m", SOURCE + "(300a,0228)=1425.6"], (), "half-life"),
    ("half-life of 60 days", ldr, ["-m", SOURCE + "(300a,0228)=60.2"], (), "half-life"),
    ("half-life not a number", ldr, ["-m", SOURCE + "(300a,0228)=long"], (), "half-life"),
    ("another isotope", ldr, ["-m", SOURCE + "(300a,0226)=Pd-103"], (), "isotope and model"),
    ("another isotope than the source", ldr, [], ("--source", "pd103_theraseed200"), "isotope and model"),
    ("unknown isotope", ldr, ["-m", SOURCE + "(300a,0226)=Xy-1", "-e", SOURCE + "(300a,0228)"], (), "isotope"),
    ("another length of the source", ldr, ["-m", SOURCE + "(300a,021a)=10"], (), "source length"),
    ("strength missing", ldr, ["-m", SOURCE + "(300a,022a)="], (), "300A,022A"),
    ("strength 0", ldr, ["-m", SOURCE + "(300a,022a)=0"], (), "300A,022A"),
    ("strength negative", ldr, ["-m", SOURCE + "(300a,022a)=-0.6"], (), "300A,022A"),
    ("strength in Bq", ldr, ["-m", SOURCE + "(300a,022a)=17500000"], (), "seed strength"),
    ("strength as a dose rate in water", ldr, ["-i", SOURCE + "(300a,0229)=DOSE_RATE_WATER"], (), "300A,0229"),
    ("permanent and HDR", hdr, ["-m", "(300a,0200)=PERMANENT"], (), "type and technique"),
    ("HDR of a seed's strength", hdr, ["-m", SOURCE + "(300a,022a)=0.6"], (), "afterloader strength"),
    ("LDR and interstitial", ldr, ["-m", "(300a,0200)=INTERSTITIAL"], (), "type and technique"),
    ("permanent for a week", ldr, ["-m", "(300a,0230)[0].(300a,0280)[*].(300a,0286)=604800"], (), "type and technique"),
    ("unknown type", hdr, ["-m", "(300a,0202)=FAST"], (), "300A,0202"),
    ("channel without its time", hdr, ["-e", CHANNEL + "(300a,0286)"], (), "channel time"),
    ("channel with an empty time", hdr, ["-m", CHANNEL + "(300a,0286)="], (), "channel time"),
    ("channel of 0 s", hdr, ["-m", CHANNEL + "(300a,0286)=0"], (), "channel time"),
    ("channel of negative time", hdr, ["-m", CHANNEL + "(300a,0286)=-30"], (), "channel"),
    ("weights above the final one", hdr, ["-m", CHANNEL + "(300a,02c8)=21"], (), "channel weights"),
    ("weights that decrease", hdr, ["-m", CHANNEL + "(300a,02d0)[3].(300a,02d6)=1"], (), "weight"),
    ("a weight that is no number", hdr, ["-m", CHANNEL + "(300a,02d0)[3].(300a,02d6)=x"], (), "weight"),
    ("fewer control points than announced", hdr, ["-m", CHANNEL + "(300a,0110)=12"], (), "control points"),
    ("a source that is not there", hdr, ["-m", CHANNEL + "(300c,000e)=7"], (), "source 7"),
    ("pulses of HDR", hdr, ["-i", CHANNEL + "(300a,028a)=5"], (), "pulses"),
    ("PDR without pulses", hdr, ["-m", "(300a,0202)=PDR"], (), "pulses"),
    ("total air kerma of another plan", hdr, ["-m", "(300a,0230)[0].(300a,0250)=900"], (), "total air kerma"),
    ("prescription in cGy", ldr, ["-m", "(300a,0010)[0].(300a,0026)=14500"], (), "prescription"),
    ("prescription missing", ldr, ["-e", "(300a,0010)", "-e", "(300a,0070)[0].(300c,000a)[0].(300a,00a4)"], (),
     "missing prescription"),
    ("prescriptions of target and setup", hdr, ["-m", "(300a,0070)[0].(300c,000a)[0].(300a,00a4)=9"], (),
     "one prescription"),
    ("fractions of a permanent implant", ldr, ["-m", "(300a,0070)[0].(300a,0078)=4"], (), "fractions"),
    ("no fraction", hdr, ["-m", "(300a,0070)[0].(300a,0078)=0"], (), "fractions"),
    ("strength of years before the plan", ldr,
     ["-m", SOURCE + "(300a,022c)=20180101", "-m", "(300a,0006)=20210601"], (), "dates"),
    ("strength of years after the plan", ldr,
     ["-m", SOURCE + "(300a,022c)=20210101", "-m", "(300a,0006)=20180601"], (), "dates"),
    ("plan of the future", ldr, ["-m", "(300a,0006)=20990601"], (), "dates"),
    ("a place that is missing", ldr, ["-e", CHANNEL + "(300a,02d0)[1].(300a,02d4)"], (), "300A,02D4"),
]
TARGET_CASES = [
    ("no target among the structures", structure_set(ball(15, "Rectum")), "target"),
    ("a target of a tenth of a cc", structure_set(ball(3), ball(15, "Urethra")), "target"),
    ("a target 25 mm away", structure_set(ball(15, at=(0, 0, 48))), "distance from the target"),
    ("a target without volume", structure_set({"name": "Prostate", "contours": ball(15)["contours"][:1]}), "volume"),
]
CONTROLS = [("seeds (JSON)", ldr), ("afterloader (JSON)", hdr)]


class ContradictoryPlans(InFolder):
    def setUp(self):
        super().setUp()
        self.write("rs.json", structure_set(ball(15)))
        self.number = 0

    def dose(self, plan, *arguments, rs="rs.json"):
        self.number += 1
        out = f"out{self.number}"
        return out, run("dose", plan, "--structures", rs, "--grid", 5, "--step", 2, "-o", out, *arguments,
                        cwd=self.folder)

    def judge(self, name, plan, says, *arguments, rs="rs.json"):
        """Checks that a plan is refused, or that its warnings are in all three places, and that they say `says`."""
        out, done = self.dose(plan, *arguments, rs=rs)
        with self.subTest(name):
            if done.returncode == 2:
                self.assertIn(says.lower(), done.stderr.lower())
                self.assertFalse((self.folder / out).exists())
                return
            self.assertEqual(done.returncode, 0, done.stderr)
            warnings = self.read(f"{out}/dose.json")["warnings"]
            page = page_text(self.folder / out / "report.html")
            self.assertTrue(any(says.lower() in w.lower() for w in warnings), f"silent; warnings are {warnings}")
            for warning in warnings:
                self.assertIn(warning, done.stderr)
                self.assertIn(warning, page)

    def no_warning(self, name, plan, *arguments):
        out, done = self.dose(plan, *arguments)
        with self.subTest(name):
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(self.read(f"{out}/dose.json")["warnings"], [])
            self.assertNotIn("warning", done.stderr)
        return out

    def test_the_rules_are_printed(self):
        printed = run("dose", "--print-rules").stdout
        for rule in ("half-life", "seed strength", "dose to the target"):
            self.assertIn(f"\n{rule}\n", printed)

    def test_plans_that_are_right_give_no_warning(self):
        for name, plan in CONTROLS:
            self.write("plan.json", plan())
            out = self.no_warning(name, "plan.json")
            self.no_warning(name.replace("JSON", "DICOM"), f"{out}/plan.dcm")
        self.write("plan.csv", csv())
        self.no_warning("seeds (CSV)", "plan.csv")

    def test_text_plans_that_contradict_themselves_are_refused_or_warned_of(self):
        for name, plan, change, arguments, says in JSON_CASES:
            content = plan()
            change(content)
            self.write("plan.json", content)
            self.judge(name, "plan.json", says, *arguments)
        for name, content, says in CSV_CASES:
            self.write("plan.csv", content)
            self.judge(name, "plan.csv", says)

    def test_dicom_plans_that_contradict_themselves_are_refused_or_warned_of(self):
        made = {}
        for plan in (ldr, hdr):
            self.write("plan.json", plan())
            out, done = self.dose("plan.json")
            self.assertEqual(done.returncode, 0, done.stderr)
            made[plan] = (self.folder / out / "plan.dcm").read_bytes()
        for name, plan, changes, arguments, says in DICOM_CASES:
            self.write("plan.dcm", made[plan])
            if changes:
                subprocess.run(["dcmodify", "-nb", *changes, "plan.dcm"], cwd=self.folder, check=True,
                               capture_output=True)
            self.judge(name, "plan.dcm", says, *arguments)

    def test_plans_without_their_target_are_refused_or_warned_of(self):
        self.write("plan.json", ldr())
        for name, content, says in TARGET_CASES:
            self.write("other.json", content)
            self.judge(name, "plan.json", says, rs="other.json")


if __name__ == "__main__":
    unittest.main()
