#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet fluoro: X-ray pictures of a patient at rest and of a recording, as PNG and as MetaImage."""
import json
import shutil
import struct
import tempfile
import unittest
import zlib
from pathlib import Path

from insert_case import BLOCK, FAST, block_mesh
from program import InFolder, run

# A gland with a bone beside it, in tissue of 60 mm.
TWO_REGIONS = ("tissue", "lump")
BODY = """\
[patient]
source = "block.msh"
regions = { tissue = "body", lump = "prostate" }
[fluoroscopy]
pixels = 128
field_mm = 80
[[insertion]]
entry_mm = [31, 32, -10]
depth_mm = 40
"""


def metaimage(path):
    """The header of a MetaImage as a dictionary, and its bytes."""
    data = Path(path).read_bytes()
    header = {}
    position = 0
    while True:
        end = data.index(b"\n", position)
        key, value = data[position:end].decode().split("=", 1)
        header[key.strip()] = value.strip()
        position = end + 1
        if key.strip() == "ElementDataFile":
            return header, zlib.decompress(data[position:])


def numbers(text):
    return [float(word) for word in text.split()]


def png(path):
    """Width, height and rows of a PNG of 8-bit grey values."""
    data = Path(path).read_bytes()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    width, height, depth, kind = struct.unpack(">IIBB", data[16:26])
    assert (depth, kind) == (8, 0)
    packed, texts, position = b"", b"", 8
    while position < len(data):
        size, name = struct.unpack(">I4s", data[position:position + 8])
        body = data[position + 8:position + 8 + size]
        if name == b"IDAT":
            packed += body
        if name == b"tEXt":
            texts += body
        position += size + 12
    raw = zlib.decompress(packed)
    rows, above = [], bytes(width)
    for k in range(height):
        filter_kind, line = raw[k * (width + 1)], bytearray(raw[k * (width + 1) + 1:(k + 1) * (width + 1)])
        for i in range(width):
            a, b, c = (line[i - 1] if i else 0), above[i], (above[i - 1] if i else 0)
            nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            line[i] = (line[i] + (0, a, b, (a + b) // 2, nearest)[filter_kind]) % 256
        rows.append(bytes(line))
        above = line
    return width, height, rows, texts


class Fluoro(InFolder):
    def setUp(self):
        super().setUp()
        block_mesh(self.folder / "block.msh", cells=6, names=TWO_REGIONS)
        self.write("case.toml", BODY)

    def test_a_patient_at_rest_becomes_a_picture_with_scale_and_notice(self):
        said = self.json_of("fluoro", "case.toml", "-o", "new/x.png", "--angle", 10, "--energy", 70)
        self.assertEqual((said["angle_deg"], said["energy_keV"], said["cranial_deg"], said["pixels"], said["time_s"]),
                         (10, 70, 0, 128, 0))
        self.assertEqual((said["needles"], said["seeds"], said["second_energy_keV"]), (0, 0, None))
        self.assertAlmostEqual(said["mm_per_pixel"], 80 / 128)
        self.assertGreater(said["cpu_ms"], 0)
        self.assertEqual(said["notice"], "simulated; not a medical device")
        width, height, rows, texts = png(self.folder / "new/x.png")
        self.assertGreaterEqual(width, 512, "a small picture is enlarged")
        self.assertGreater(height, 512, "with a strip below it")
        left, top = 8, 26  # a margin and the title
        self.assertEqual(rows[top + 4][left + 4], 255, "air")
        self.assertLess(rows[top + 256][left + 256], 200, "the patient is darker")
        self.assertIn(b"not a medical device", texts)
        # A bar of 20 mm, which is 128 of the enlarged pixels.
        longest = max(len(run_of) for row in rows[top + 512:] for run_of in bytes(row).split(b"\0") if set(run_of) == {200})
        self.assertEqual(longest, 128)

    def test_a_metaimage_has_the_place_of_its_pixels_in_the_patient(self):
        self.succeed("fluoro", "case.toml", "-o", "x.mha", "--angle", 90)
        header, values = metaimage(self.folder / "x.mha")
        self.assertEqual(header["DimSize"], "128 128 1")
        self.assertEqual(header["ElementType"], "MET_UCHAR")
        self.assertEqual(len(values), 128 * 128)
        self.assertIn("not a medical device", header["Comment"])
        spacing, origin, axes = (numbers(header[key]) for key in ("ElementSpacing", "Offset", "TransformMatrix"))
        self.assertAlmostEqual(spacing[0], 80 / 128)
        # The detector is at the patient's left: columns run to posterior, rows to inferior.
        for value, expected in zip(axes, (0, 1, 0, 0, 0, -1)):
            self.assertAlmostEqual(value, expected)
        middle = [o + 63.5 * spacing[0] * (a + b) for o, a, b in zip(origin, axes[:3], axes[3:6])]
        for value in middle:
            self.assertAlmostEqual(value, 30.0, places=4, msg="the centre of the gland")

    def test_short_options_and_set_hold_together(self):
        said = self.json_of("fluoro", "case.toml", "-o", "x.mha", "--angle", -20, "--cranial", 15, "--set",
                            "fluoroscopy.pixels=64", "--energy", 45, "--set", "fluoroscopy.photons=0")
        self.assertEqual([said[key] for key in ("angle_deg", "cranial_deg", "pixels", "energy_keV")],
                         [-20, 15, 64, 45])

    def test_two_energies_make_one_picture_without_soft_tissue(self):
        said = self.json_of("fluoro", "case.toml", "-o", "x.png", "--energy", 50, "--second-energy", 110)
        self.assertEqual((said["energy_keV"], said["second_energy_keV"]), (50, 110))
        self.refuse("fluoro", "case.toml", "-o", "y.png", "--energy", 80, "--second-energy", 60,
                    says=["60 keV", "80 keV", "higher"])

    def test_seeds_of_a_plan_are_shown(self):
        seeds = [{"position_mm": [x, 30, 30], "axis": [0, 0, 1]} for x in (5, 55)]
        plan = {"format": "stylet-plan", "version": 1, "units": "mm", "frame": "LPS", "strength_U": 0.5,
                "source": "i125_6711", "seeds": seeds}
        self.write("plan.json", json.dumps(plan))
        # Contrast in the middle of the block, so that the tissue at its sides is not the darkest.
        contrast = BODY.replace('"prostate"', '"bladder"').replace('"body"', '"prostate"')
        self.write("contrast.toml", contrast)
        said = self.json_of("fluoro", "contrast.toml", "-o", "x.mha", "--seeds", "plan.json", "--set",
                            "fluoroscopy.photons=0")
        self.assertEqual(said["seeds"], 2)
        values = metaimage(self.folder / "x.mha")[1]
        for x in (5, 55):
            column = round(63.5 + (x - 30) / (80 / 128))
            beside = values[64 * 128 + column + 3]
            self.assertLess(min(values[64 * 128 + column - 1:64 * 128 + column + 2]), beside - 50, f"the seed at {x} mm")
        self.refuse("fluoro", "case.toml", "-o", "new.mha", "--seeds", "case.toml", says=["case.toml"])

    def test_what_is_wrong_is_refused(self):
        def refuse(*arguments, says):
            self.refuse("fluoro", *arguments, says=says)

        refuse("case.toml", says=["no file", "-o picture.png"])
        refuse("case.toml", "-o", "x.jpg", says=["x.jpg", ".png or .mha"])
        refuse("none.toml", "-o", "x.png", says=["none.toml"])
        refuse("case.toml", "-o", "x.png", "--time", 1, says=["--time", "at rest", "run.h5"])
        refuse("case.toml", "-o", "x.png", "--angle", 200, says=["200", "-180", "180"])
        refuse("case.toml", "-o", "x.png", "--energy", 10, says=["10", "20", "150"])
        refuse("case.toml", "-o", "x.png", "--set", "fluoroscopy.angel_deg=3", says=["angel_deg", "angle_deg"])
        refuse("case.toml", "-o", "x.png", "--set", "fluoroscopy.detector_mm=50", says=["detector_mm", "in the patient"])
        refuse("block.msh", "-o", "x.png", says=["block.msh"])
        (self.folder / "folder.png").mkdir()
        refuse("case.toml", "-o", "folder.png", says=["folder.png"])


class FluoroOfRecording(InFolder):
    """A recording of a short insertion, made once."""

    @classmethod
    def setUpClass(cls):
        cls.made = tempfile.TemporaryDirectory(prefix="stylet-cli-")
        folder = Path(cls.made.name)
        block_mesh(folder / "block.msh")
        (folder / "case.toml").write_text(BLOCK)
        done = run("insert", "case.toml", "-o", "out", *FAST, "--set", "output.frames_per_s=10", cwd=folder)
        assert done.returncode == 0, done.stderr
        cls.recording = folder / "out/run.h5"

    @classmethod
    def tearDownClass(cls):
        cls.made.cleanup()

    def test_the_deepest_moment_is_shown_unless_another_is_asked_for(self):
        more = ("--set", "fluoroscopy.photons=0", "--set", "fluoroscopy.pixels=128", "--set", "fluoroscopy.field_mm=80")
        deepest = self.json_of("fluoro", self.recording, "-o", "deepest.mha", *more)
        self.assertEqual(deepest["needles"], 1)
        self.assertGreater(deepest["time_s"], 0.5)
        same = self.json_of("fluoro", self.recording, "-o", "same.mha", "--time", deepest["time_s"], *more)
        self.assertEqual(metaimage(self.folder / "deepest.mha"), metaimage(self.folder / "same.mha"))
        self.assertEqual(same["time_s"], deepest["time_s"])
        early = self.json_of("fluoro", self.recording, "-o", "early.mha", "--time", 0.2, *more)
        self.assertEqual(early["time_s"], 0.2)

        def shadow(name):
            """Rows of the column x = 31 mm, the needle's, that are clearly darker than the tissue beside it."""
            header, values = metaimage(self.folder / name)
            spacing, origin = numbers(header["ElementSpacing"])[0], numbers(header["Offset"])
            column = round((31.5 - origin[0]) / spacing)
            rows = [row for row in range(128)
                    if min(values[row * 128 + column + k] for k in (-1, 0, 1)) < values[row * 128 + column + 8] - 20]
            return [origin[2] - row * spacing for row in rows]

        self.assertGreater(max(shadow("deepest.mha")), max(shadow("early.mha")) + 15, "the needle has gone superior")

    def test_what_does_not_fit_a_recording_is_refused(self):
        def refuse(*arguments, says):
            self.refuse("fluoro", self.recording, "-o", "x.png", *arguments, says=says)

        refuse("--time", 1000, says=["--time", "1000 s", "ends at"])
        refuse("--time", -1, says=["-1 s"])
        refuse("--set", "mesh.nodes=900", says=["mesh.nodes"])
        shutil.copy(self.recording, self.folder / "cut.h5")
        with open(self.folder / "cut.h5", "r+b") as file:
            file.truncate(3000)
        self.refuse("fluoro", "cut.h5", "-o", "x.png", says=["cut.h5"])


if __name__ == "__main__":
    unittest.main()
