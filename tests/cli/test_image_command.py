#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet image: pictures of a patient at rest and of a recorded run, where they are in LPS, and what is refused."""
import re
import tempfile
import unittest
import zlib
from pathlib import Path

from program import InFolder, run

DEMO = Path(__file__).resolve().parents[2] / "scenarios/demo.toml"
COARSE = ("--set", "mesh.nodes=1500")
QUICK = ("--set", "output.pictures=false", "--set", "output.max_frames=10", "--set", "run.dt_ms=8")


class Image(InFolder):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="stylet-cli-run-")
        cls.addClassCleanup(folder.cleanup)
        done = run("insert", DEMO, *COARSE, *QUICK, "-o", folder.name)
        assert done.returncode == 0, done.stderr
        cls.recording = Path(folder.name) / "run.h5"

    def test_transverse_picture_of_the_patient_at_rest(self):
        report = self.json_of("image", DEMO, *COARSE, "--template", "-o", "new/us.png")
        self.assertEqual((self.folder / "new/us.png").read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual((report["array"], report["needles"], report["lines"], report["samples"]),
                         ("transverse", 0, 256, 560))
        self.assertIn("not a medical device", report["notice"])
        picture, = report["pictures"]
        across, down, normal, corner = zip(*picture["pixel_to_lps"][:3])
        mm = picture["mm_per_pixel"]
        for found, expected in zip(across + down + normal, (mm, 0, 0, 0, mm, 0, 0, 0, 1)):
            self.assertAlmostEqual(found, expected, msg="columns go to the left, rows to posterior")
        self.assertAlmostEqual(corner[2], picture["z_mm"])

    def test_z_moves_the_plane_and_the_same_seed_gives_the_same_picture(self):
        files = []
        for name, z in (("a.mha", "5"), ("b.mha", "5"), ("c.mha", "-5")):
            report = self.json_of("image", self.recording, "--z", z, "-o", name)
            self.assertAlmostEqual(report["pictures"][0]["pixel_to_lps"][2][3], float(z))
            self.assertIsNone(report["probe"])
            files.append((self.folder / name).read_bytes())
        self.assertEqual(files[0], files[1])
        self.assertNotEqual(files[0], files[2])

    def test_all_planes_as_numbered_pictures_and_as_one_volume(self):
        several = self.json_of("image", self.recording, "--all", "-o", "us.png")["pictures"]
        heights = [picture["z_mm"] for picture in several]
        self.assertGreater(len(several), 5)
        for below, above in zip(heights, heights[1:]):
            self.assertAlmostEqual(above - below, 5.0)
        self.assertEqual(sorted(p.name for p in self.folder.glob("*.png")),
                         [f"us_{k + 1:02}.png" for k in range(len(several))])
        one = self.json_of("image", self.recording, "--all", "-o", "us.mha")["pictures"]
        header = (self.folder / "us.mha").read_bytes().split(b"ElementDataFile")[0].decode()
        value = lambda key: [float(x) for x in re.search(key + r" = (.*)", header).group(1).split()]
        self.assertEqual(value("DimSize"), [one[0]["columns"], one[0]["rows"], len(several)])
        for found, expected in zip(value("ElementSpacing"), (0.2, 0.2, 5.0)):
            self.assertAlmostEqual(found, expected)
        for found, expected in zip(value("Offset"), [row[3] for row in one[0]["pixel_to_lps"][:3]]):
            self.assertAlmostEqual(found, expected, places=4)
        for found, expected in zip(value("TransformMatrix"), (1, 0, 0, 0, 1, 0, 0, 0, 1)):
            self.assertAlmostEqual(found, expected)

    def test_recorded_run_shows_its_needle(self):
        deepest = self.json_of("image", self.recording, "--array", "sagittal", "-o", "deepest.png")
        self.assertEqual((deepest["needles"], deepest["array"]), (1, "sagittal"))
        self.assertGreater(deepest["time_s"], 1.0)
        earlier = self.json_of("image", self.recording, "--time", "2", "--set", "ultrasound.lines=64", "-o", "earlier.png")
        self.assertEqual((earlier["time_s"], earlier["lines"]), (2.0, 64))
        self.refuse("image", self.recording, "--time", "1000", "-o", "late.png", says=["--time", "1000 s", "ends at"])

    def test_probe_presses_and_the_command_says_how(self):
        lifted = ("--set", 'probe.kind="biplane"', "--set", "probe.lift_mm=8")
        for command in ("image", "fluoro"):
            said = self.succeed(command, self.recording, *lifted, "-o", command + ".mha", "--json", "said.json").stdout
            self.assertIn("gland under the probe: ", said)
            self.assertIn("to anterior", said)
            probe = self.read("said.json")["probe"]
            self.assertEqual(probe["lift_mm"], 8)
            self.assertGreater(probe["force_N"][1], 1.0, "the tissue pushes the probe back, to posterior")
            self.assertLess(probe["gland"]["shift_mm"][1], -0.3, "the gland goes to anterior")
        drawn = self.json_of("image", self.recording, *lifted, "--set", "probe.in_contours=true", "-o", "drawn.mha")
        self.assertIsNone(drawn["probe"], "contours that were drawn with the probe there are not moved")
        self.assertNotEqual((self.folder / "drawn.mha").read_bytes(), (self.folder / "image.mha").read_bytes())

    def test_seeds_of_a_plan_are_bright(self):
        plan = DEMO.parent / "demo_plan.csv"
        without = self.json_of("image", self.recording, "-o", "without.mha")
        seeded = self.json_of("image", self.recording, "--seeds", plan, "-o", "seeded.mha")
        trains = [line.split(",")[2] for line in plan.read_text().splitlines() if re.match(r"[A-Za-z][\d.]+,", line)]
        self.assertEqual((without["seeds"], seeded["seeds"]), (0, sum(train.count("S") for train in trains)))
        grey = [zlib.decompress((self.folder / name).read_bytes().split(b"ElementDataFile = LOCAL\n", 1)[1])
                for name in ("without.mha", "seeded.mha")]
        brighter = sum(new > old + 60 for old, new in zip(*grey))
        darker = sum(new < old - 60 for old, new in zip(*grey))
        self.assertGreater(brighter, 20, "seeds are bright")
        self.assertGreater(brighter, 2 * darker)
        self.refuse("image", DEMO, "--seeds", "missing.csv", "-o", "us.png", says=["missing.csv"])

    def test_bad_input_is_refused(self):
        self.refuse("image", DEMO, "-o", "us.jpg", says=["us.jpg", ".png or .mha"])
        self.refuse("image", DEMO, "--time", "1", "-o", "us.png", says=["--time", "scenario"])
        self.refuse("image", DEMO, "--all", "--z", "3", "-o", "us.png", says=["--z", "--all"])
        self.refuse("image", DEMO, "--template", "-o", "us.mha", says=["--template"])
        self.refuse("image", self.recording, "--array", "sagittal", "--all", "-o", "us.png", says=["--all", "transverse"])
        self.refuse("image", DEMO, "--array", "coronal", "-o", "us.png", says=["coronal"])
        self.refuse("image", "missing.toml", "-o", "us.png", says=["missing.toml"])
        self.refuse("image", DEMO, "--set", "ultrasound.lines=4", "-o", "us.png", says=["ultrasound.lines"])
        self.refuse("image", DEMO, says=["--output is required"])


if __name__ == "__main__":
    unittest.main()
