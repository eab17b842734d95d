#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""DICOM that an archive takes: whose plan it is, references between the files, and attributes that must be there."""
import os
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

DEBIANS_PYTHON = "/usr/bin/python3"
try:
    import pydicom
    from pydicom.dataset import Dataset
except ImportError:  # Debian's package is for Debian's own Python
    if sys.executable != DEBIANS_PYTHON and os.path.exists(DEBIANS_PYTHON):
        os.execv(DEBIANS_PYTHON, [DEBIANS_PYTHON, "-B", *sys.argv])
    print("pydicom (Debian: python3-pydicom) is not there")
    sys.exit(77)

from program import InFolder

SCENARIOS = Path(__file__).resolve().parents[2] / "scenarios"
SHARED = Path(os.environ.get("STYLET_SHARED_DATA", Path(__file__).resolve().parents[3] / "shared/data"))
HDR_CASE = SHARED / "robustbrachy_hdr_phantom"
HEAD = "# source: i125_6711\n# strength_U: 0.5\n"
PLAN = "x_mm,y_mm,z_mm,ax,ay,az\n0,0,0,0,0,1\n5,0,0,0,0,1\n0,5,10,0,0,1\n"
NEEDLES = "# template_origin_mm: 0 0 30\n# label: needles\nhole,retraction_mm,train\nD4,5,S-1-S-2-S\nd3.5,0,S-S\n"
KEPT = ("PatientName", "PatientID", "IssuerOfPatientID", "PatientBirthDate", "PatientSex", "StudyInstanceUID",
        "StudyDate", "StudyTime", "StudyID", "StudyDescription", "AccessionNumber", "ReferringPhysicianName",
        "FrameOfReferenceUID", "PositionReferenceIndicator")
TYPE_2 = ("PatientName", "PatientID", "PatientBirthDate", "PatientSex", "StudyDate", "StudyTime", "StudyID",
          "AccessionNumber", "ReferringPhysicianName", "PositionReferenceIndicator", "RTPlanDate", "RTPlanTime")


def texts(data, names=KEPT):
    return {name: str(data.get(name) or "") for name in names}


def identity(charset, name, physician, **more):
    data = Dataset()
    data.SpecificCharacterSet = charset
    data.PatientName, data.ReferringPhysicianName = name, physician
    data.PatientID, data.IssuerOfPatientID, data.PatientBirthDate, data.PatientSex = "A-0815", "Clinic", "19501231", "M"
    data.StudyInstanceUID, data.StudyDate, data.StudyTime = "1.2.840.99.1", "20240131", "101530.25"
    data.StudyID, data.AccessionNumber = "S7", "ACC 9"
    data.FrameOfReferenceUID, data.PositionReferenceIndicator = "1.2.840.99.2", "XY"
    for key, value in more.items():
        setattr(data, key, value)
    return data


PATIENTS = [
    identity("ISO_IR 100", "Müller^Jürgen", "Größe^Änne", StudyDescription="Prostata, früh"),
    identity("ISO_IR 192", "Çelik^Ömer", "Łukasz^Żółć", StudyDescription="前立腺"),
    identity("ISO_IR 144", "Люкceмбypг", "Иванов^Пётр", PatientSex="O"),
    identity(["", "ISO 2022 IR 87"], "Yamada^Tarou=山田^太郎=やまだ^たろう", "Suzuki^Ichiro=鈴木^一郎"),
    identity(["ISO 2022 IR 13", "ISO 2022 IR 87"], "ﾔﾏﾀﾞ^ﾀﾛｳ=山田^太郎=やまだ^たろう", "ｽｽﾞｷ=鈴木"),
    identity(["", "ISO 2022 IR 149"], "Hong^Gildong=洪^吉洞=홍^길동", "Kim"),
    identity("GB18030", "Wang^XiaoDong=王^小东", "Li"),
    identity("ISO_IR 166", "พัชรี^สมชาย", "Doctor", PatientSex="F", PatientBirthDate=""),
    identity("ISO_IR 6", "Plain^Name", "", StudyTime="", StudyID="", AccessionNumber="", PositionReferenceIndicator=""),
    identity("ISO_IR 100", "", "", PatientID="only an ID", PatientSex=""),
]


class Archive(InFolder):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.found_errors = shutil.which("dciodvfy")

    def phantom(self):
        if not (self.folder / "phantom.dcm").exists():
            self.succeed("phantom", "-o", ".")
        return self.folder / "phantom.dcm"

    def patient_file(self, record, name="patient.dcm"):
        """A structure set of a patient."""
        data = pydicom.dcmread(self.phantom())
        for key in KEPT:
            if key in data and key != "FrameOfReferenceUID":
                del data[key]
        data.update(record)
        for item in (*data.ReferencedFrameOfReferenceSequence, *data.StructureSetROISequence):
            tag = "FrameOfReferenceUID" if "FrameOfReferenceUID" in item else "ReferencedFrameOfReferenceUID"
            setattr(item, tag, data.FrameOfReferenceUID)
        data.SOPInstanceUID = data.file_meta.MediaStorageSOPInstanceUID = "1.2.840.99.3"
        data.save_as(self.folder / name)
        return pydicom.dcmread(self.folder / name)

    def dose(self, *arguments, plan=PLAN, out="out"):
        """Runs `stylet dose` on a file, or on the text of a CSV plan; returns plan, dose and what the terminal says."""
        if isinstance(plan, str):
            self.write("plan.csv", HEAD + plan)
            plan = "plan.csv"
        done = self.succeed("dose", plan, *arguments, "--grid", "8", "-o", out)
        files = [pydicom.dcmread(self.folder / out / name) for name in ("plan.dcm", "dose.dcm")]
        return *files, done.stdout + done.stderr

    def errors_of(self, path):
        """Errors that dciodvfy finds. It stops at doses of 32 bits, also in other programs' files, so it sees a copy
        with the upper half of each."""
        if not self.found_errors:
            self.skipTest("dciodvfy (Debian: dicom3tools) is not there")
        data = pydicom.dcmread(path)
        if data.get("BitsAllocated") == 32:
            data.BitsAllocated = data.BitsStored = 16
            data.HighBit = 15
            data.PixelData = b"".join(data.PixelData[k + 2:k + 4] for k in range(0, len(data.PixelData), 4))
            path = self.folder / "16_bits.dcm"
            data.save_as(path)
        done = subprocess.run(["dciodvfy", str(path)], capture_output=True, text=True, check=False, errors="replace")
        self.assertRegex(done.stderr, "RT(Plan|Dose|StructureSet)")
        return [line for line in done.stderr.splitlines() if line.startswith("Error")]

    def test_dciodvfy_finds_no_error_in_files_of_ldr_hdr_and_needle_plans(self):
        self.assertEqual(self.errors_of(self.phantom()), [])
        patient = self.patient_file(PATIENTS[0])
        for plan, options in ((SCENARIOS / "demo_plan.csv", []),
                              (SCENARIOS / "demo_plan.csv", ["--patient-from", "patient.dcm"]),
                              (SCENARIOS / "hdr_plan.csv", []), (NEEDLES, []), (PLAN, []),
                              (PLAN.replace("5,0,0,", "5,0,1e-7,").replace(",0,0,1\n", ",0.577,0.577,0.577\n"), [])):
            self.dose(*options, plan=plan)
            for name in ("plan.dcm", "dose.dcm"):
                self.assertEqual(self.errors_of(self.folder / "out" / name), [], f"{plan} {name}")
        self.assertEqual(patient.PatientID, "A-0815")

    def test_dciodvfy_finds_no_error_in_the_plan_of_a_real_hdr_case(self):
        if not HDR_CASE.exists():
            self.skipTest(f"{HDR_CASE} is not there")
        plan, dose, said = self.dose("--structures", HDR_CASE / "SS001.dcm", "--source", "ir192_mhdr_v2",
                                     plan=HDR_CASE / "PL001.dcm")
        for name in ("plan.dcm", "dose.dcm"):
            self.assertEqual(self.errors_of(self.folder / "out" / name), [])
        clinic = pydicom.dcmread(HDR_CASE / "PL001.dcm")
        structures = pydicom.dcmread(HDR_CASE / "SS001.dcm")
        for data in (plan, dose):
            self.assertEqual(texts(data), texts(clinic))
        self.assertEqual(plan.ReferencedStructureSetSequence[0].ReferencedSOPInstanceUID, structures.SOPInstanceUID)
        self.assertIn("cannot both be right", said)  # strengths of 2016 in a plan of 1901

    def test_plan_and_dose_have_patient_study_and_frame_of_the_file(self):
        by_structures = ["--structures", "patient.dcm", "--step", "5"]
        for k, record in enumerate(PATIENTS):
            for options in (["--patient-from", "patient.dcm"], by_structures)[:2 if k % 4 == 0 else 1]:
                source = self.patient_file(record)
                plan, dose, _ = self.dose(*options)
                for data in (plan, dose):
                    self.assertEqual(data.SpecificCharacterSet, "ISO_IR 192")
                    self.assertEqual(texts(data), texts(source), record.PatientName)
                self.assertEqual(plan.ReferencedStructureSetSequence[0].ReferencedSOPInstanceUID, source.SOPInstanceUID)
                self.assertEqual(plan.RTPlanGeometry, "PATIENT")

    def test_a_dose_refers_to_its_plan_in_the_same_study_and_frame(self):
        plan, dose, _ = self.dose()
        self.assertEqual(dose.ReferencedRTPlanSequence[0].ReferencedSOPInstanceUID, plan.SOPInstanceUID)
        self.assertEqual(dose.StudyInstanceUID, plan.StudyInstanceUID)
        self.assertEqual(dose.FrameOfReferenceUID, plan.FrameOfReferenceUID)
        self.assertNotEqual(dose.SeriesInstanceUID, plan.SeriesInstanceUID)
        again, _, _ = self.dose(out="again")
        self.assertEqual(again.SOPInstanceUID, plan.SOPInstanceUID)
        self.patient_file(PATIENTS[0])
        other, _, _ = self.dose("--patient-from", "patient.dcm", out="other")
        self.assertNotEqual(other.SOPInstanceUID, plan.SOPInstanceUID)

    def test_nothing_is_made_up_where_no_input_names_the_patient(self):
        plan, dose, said = self.dose()
        for data in (plan, dose):
            for name in TYPE_2:
                if name in data:
                    self.assertEqual(str(data.get(name) or ""), "", name)
            self.assertNotIn("IssuerOfPatientID", data)
        self.assertEqual(plan.RTPlanGeometry, "TREATMENT_DEVICE")
        self.assertIn("No input says which patient this is", said)

    def test_files_of_different_patients_are_refused_unless_the_user_decides(self):
        self.patient_file(PATIENTS[0], "a.dcm")
        self.dose("--patient-from", "a.dcm", out="a")
        self.patient_file(identity("ISO_IR 100", "Müller^Jürgen", "", PatientID="B-1"), "b.dcm")
        plan = ("a/plan.dcm", "--source", "i125_6711", "--step", "5", "--grid", "8")
        self.refuse("dose", *plan, "--structures", "b.dcm", "-o", "out", says=["different patients", "A-0815", "B-1",
                                                                            "--patient-from"])
        done = self.succeed("dose", *plan, "--structures", "b.dcm", "--patient-from", "b.dcm", "-o", "out")
        self.assertIn("a/plan.dcm is of patient 'A-0815'", done.stderr)
        self.assertEqual(pydicom.dcmread(self.folder / "out/dose.dcm").PatientID, "B-1")
        # Without an ID, the name decides.
        self.patient_file(identity("ISO_IR 100", "Meier", "", PatientID=""), "c.dcm")
        self.refuse("dose", *plan, "--structures", "c.dcm", "-o", "out", says=["different patients", "Meier"])
        self.patient_file(identity("ISO_IR 100", "MüLLER^JüRGEN^^", "", PatientID="", PatientBirthDate=""), "d.dcm")
        self.succeed("dose", *plan, "--structures", "d.dcm", "-o", "out")
        self.assertEqual(pydicom.dcmread(self.folder / "out/dose.dcm").PatientID, "A-0815")
        # The same ID with other data is the same patient, with a note.
        self.patient_file(identity("ISO_IR 100", "Müller^Jürgen", "", PatientBirthDate="19501230"), "e.dcm")
        done = self.succeed("dose", *plan, "--structures", "e.dcm", "-o", "out")
        self.assertIn("The birth date is '19501231' in a/plan.dcm and '19501230' in e.dcm", done.stderr)

    def test_another_frame_of_reference_is_refused(self):
        self.patient_file(PATIENTS[0])
        self.write("framed.csv", HEAD + "# frame_of_reference: 1.2.3\n" + PLAN)
        arguments = ("dose", "framed.csv", "--patient-from", "patient.dcm", "--grid", "8", "-o", "out")
        self.refuse(*arguments, says=["1.2.840.99.2", "1.2.3"])
        done = self.succeed(*arguments, "--ignore-frame-of-reference")
        self.assertIn("1.2.3", done.stderr)
        self.assertEqual(pydicom.dcmread(self.folder / "out/plan.dcm").FrameOfReferenceUID, "1.2.840.99.2")

    def test_a_file_that_is_not_dicom_names_no_patient(self):
        self.refuse("dose", SCENARIOS / "demo_plan.csv", "--patient-from", SCENARIOS / "demo_plan.csv", "-o", "out",
                    says=["--patient-from takes a DICOM file"])

    def test_values_that_dicom_does_not_allow_are_left_out_with_a_note(self):
        data = self.patient_file(PATIENTS[8])
        pydicom.config.settings.writing_validation_mode = 0
        data.PatientSex = "W"
        data.StudyDate = "20241399"
        data.PatientBirthDate = "1950.12.31"
        data.save_as(self.folder / "patient.dcm")
        plan, _, said = self.dose("--patient-from", "patient.dcm")
        self.assertEqual((plan.PatientSex or "", plan.StudyDate or "", plan.PatientBirthDate), ("", "", "19501231"))
        self.assertIn("the patient's sex is 'W'", said)
        self.assertIn("the study date is '20241399'", said)

    def test_a_name_outside_its_character_set_is_said(self):
        self.patient_file(identity("ISO_IR 100", "Müller", ""))
        data = (self.folder / "patient.dcm").read_bytes().replace(b"ISO_IR 100", b"ISO_IR 6  ")
        self.write("patient.dcm", data)
        plan, _, said = self.dose("--patient-from", "patient.dcm")
        self.assertEqual(str(plan.PatientName), "Müller")
        self.assertIn("not in the file's character set", said)

    def test_long_names_are_cut_at_characters_and_dates_of_strengths_kept(self):
        label = "Prüfplan für Öl, Süß\\sauer & vieles mehr"
        dates = "# strength_date: 2024-01-02 10:15\n# plan_date: 2024-01-09\n"
        plan, _, said = self.dose(plan=f"# label: {label}\n{dates}{PLAN}")
        self.assertEqual(plan.RTPlanLabel, "Prüfplan für Öl,")
        self.assertEqual(plan.RTPlanName, label.replace("\\", "_"))
        source = plan.SourceSequence[0]
        self.assertEqual(source.SourceStrengthReferenceDate, "20240102")
        self.assertEqual(source.SourceStrengthReferenceTime, "101500")
        self.assertEqual(plan.RTPlanDate, "20240109")
        self.assertIn("decay factor between them is 0.9216", said)
        self.assertTrue(re.search("without decay", said))
        self.write("bad.csv", HEAD + "# strength_date: 31.1.2024\n" + PLAN)
        self.refuse("dose", "bad.csv", "-o", "bad", says=["strength_date", "31.1.2024", "2024-01-31"])

    def test_dwell_positions_stand_at_their_distance_from_the_tip(self):
        rows = "x_mm,y_mm,z_mm,ax,ay,az,dwell_s,needle\n" + "".join(f"0,0,{z},0,0,1,3,Ä1\n" for z in (-20, -15, -5, 0))
        head = "# source: ir192_mhdr_v2\n# implant: temporary\n# strength_U: 40000\n"
        self.write("hdr.csv", head + rows)
        plan, _, _ = self.dose(plan=self.folder / "hdr.csv")
        channel = plan.ApplicationSetupSequence[0].ChannelSequence[0]
        points = channel.BrachyControlPointSequence
        self.assertEqual([float(p.ControlPointRelativePosition) for p in points[::2]], [20, 15, 5, 0])
        self.assertEqual((channel.SourceMovementType, float(channel.SourceApplicatorStepSize)), ("STEPWISE", 5))
        self.assertEqual(channel.SourceApplicatorName, "Ä1")


if __name__ == "__main__":
    unittest.main()
