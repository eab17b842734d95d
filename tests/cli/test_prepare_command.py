#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet prepare: a saved model runs like its scenario, can be described, and is refused if it is incomplete."""
import subprocess
import unittest
from pathlib import Path

from insert_case import FAST, SMALL, Cases, without_step_times
from program import STYLET


class Prepare(Cases):
    made = None  # the model that all tests share, and the JSON of the command that made it

    def prepare(self):
        """Makes case.stylet and returns the command's JSON. It is compiled once; the same case gives the same bytes."""
        if Prepare.made is None:
            told = self.json_of("prepare", "phantom.toml", "-o", "case.stylet", *SMALL)
            Prepare.made = told, (self.folder / "case.stylet").read_bytes()
        self.write("case.stylet", Prepare.made[1])
        return Prepare.made[0]

    def test_runs_like_its_scenario(self):
        made = self.prepare()
        self.assertLess(abs(made["nodes"] - 800), 80)
        self.assertEqual(made["element"], "nodal-pressure")
        self.assertGreater(made["corridor_nodes"], 20)
        self.assertGreater(made["peak_memory_mb"], 10)
        self.assertAlmostEqual(made["file_mb"], (self.folder / "case.stylet").stat().st_size / 2**20, places=6)
        info = self.json_of("info", "case.stylet")
        self.assertEqual((info["kind"], info["nodes"], info["corridor_nodes"]),
                         ("model", made["nodes"], made["corridor_nodes"]))
        self.assertIn("prostate", info["regions"])
        fresh = self.json_of("insert", "phantom.toml", "-o", "fresh", *SMALL)
        saved = self.json_of("insert", "case.stylet", "-o", "saved")
        self.assertEqual(without_step_times(self.folder / "fresh"), without_step_times(self.folder / "saved"))
        for key in ("mesh", "events", "peak_force_N", "target_shift_mm", "warnings"):
            self.assertEqual(fresh.get(key), saved.get(key), key)

    def test_a_stripped_program_finds_what_the_whole_one_has_kept(self):
        stripped = self.folder / "stylet"
        subprocess.run(["strip", "-o", stripped, STYLET], check=True)
        (self.folder / "stylet-reader").symlink_to(Path(STYLET).parent / "stylet-reader")
        names = []
        for number, program in enumerate((STYLET, stripped)):
            models = self.folder / f"models{number}"
            models.mkdir()
            said = subprocess.run([program, "prepare", "phantom.toml", "-o", f"{models}/", "--quiet", *SMALL],
                                  cwd=self.folder, check=True, capture_output=True)
            self.assertEqual(said.stdout, b"")
            names.append([file.name for file in models.iterdir()])
        self.assertEqual(len(names[0]), 1)
        self.assertEqual(names[0], names[1])

    def test_settings(self):
        self.prepare()
        self.succeed("insert", "case.stylet", "-o", "slow", "--set", "insertion.speed_mm_per_s=30", *FAST)
        self.refuse("insert", "case.stylet", "--set", "mesh.nodes=900", says=["mesh.nodes", "stylet prepare"])
        self.refuse("insert", "case.stylet", "--set", "tissue.prostate.young_kPa=50", says=["stylet prepare"])

    def test_files_cut_or_with_a_damaged_head(self):
        self.prepare()
        self.succeed("insert", "case.stylet", "-o", "out", *FAST)

        def damaged(file):
            whole = (self.folder / file).read_bytes()
            yield "cut", whole[:len(whole) // 2]
            # A recording has bytes that nobody reads; of a saved model every byte counts.
            for at in (12, 100) + ((len(whole) // 2,) if file.endswith(".stylet") else ()):
                bad = bytearray(whole)
                bad[at] ^= 64
                yield f"bad_{at}", bytes(bad)

        # refuse() checks that HDF5 itself prints nothing.
        for file, ending, cure in (("case.stylet", "stylet", "stylet prepare"),
                                   ("out/run.h5", "h5", "run.h5 that stylet wrote")):
            for name, content in damaged(file):
                self.write(f"{name}.{ending}", content)
                for command in ("insert", "info"):
                    with self.subTest(command=command, name=name, ending=ending):
                        self.refuse(command, f"{name}.{ending}", says=[f"{name}.{ending}", cure])
        self.write("bad_3.stylet", b"\x89HDf" + (self.folder / "case.stylet").read_bytes()[4:])
        self.refuse("insert", "bad_3.stylet", says=["not a saved model", "stylet prepare"])

    def test_what_cannot_be_prepared(self):
        self.refuse("prepare", "phantom.toml", "-o", "case.h5", says=["case.h5", ".stylet"])
        self.refuse("prepare", "none.toml", "-o", "case.stylet", says=["none.toml"])
        self.refuse("prepare", "phantom.toml", "-o", "case.stylet", "--set", "tissue.prostate.poisson=0.5", says=["poisson"])
        self.refuse("prepare", "phantom.toml", "-o", "case.stylet", "--set", 'coupling.engine="woodbury"', *SMALL,
                    says=["woodbury"])
        self.prepare()
        self.refuse("prepare", "case.stylet", "-o", "again.stylet", says=["scenario (TOML) is expected"])

    def test_a_recording_is_no_model_but_can_be_repeated(self):
        self.succeed("insert", "block.toml", "-o", "out", *FAST)
        again = self.succeed("insert", "out/run.h5", "-o", "again").stdout
        self.assertIn("to the last bit", again)
        self.assertEqual(without_step_times(self.folder / "out"), without_step_times(self.folder / "again"))
        slower = self.succeed("insert", "out/run.h5", "-o", "other", "--set", "tissue.lump.young_kPa=90").stdout
        self.assertIn("differ from the recording's", slower)


if __name__ == "__main__":
    unittest.main()
