#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A dose grid in big endian and a plan without the time of a channel, as other programs write them.

They are not part of the repository: their folder is found3 in $STYLET_SHARED_DATA, by default ../shared/data beside it.
Without one the tests are skipped (exit status 77)."""
import os
import sys
import unittest
from pathlib import Path

from program import InFolder

DATA = Path(os.environ.get("STYLET_SHARED_DATA") or Path(__file__).resolve().parents[3] / "shared" / "data") / "found3"


class DoseKinds(InFolder):
    def test_a_dose_grid_of_32_bits_is_the_same_in_both_orders_of_bytes(self):
        for order in ("little", "big"):
            info = self.json_of("info", DATA / f"k08_dose_{order}_endian.dcm")
            self.assertAlmostEqual(info["highest_Gy"], 21.8818, delta=5e-5, msg=order)

    def test_a_channel_without_its_time_is_an_error_that_names_it(self):
        self.refuse("dose", DATA / "k09_channel_time_missing.dcm", "--structures", DATA / "k01_twice_one_slice.dcm",
                    "--source", "ir192_mhdr_v2", "--ignore-frame-of-reference", "-o", "out",
                    says=["channel 1", "ChannelTotalTime, 300A,0286"])


if __name__ == "__main__":
    if not DATA.is_dir():
        print(f"Skipped: no folder {DATA} (set STYLET_SHARED_DATA to the folder of the shared data).")
        sys.exit(77)
    unittest.main()
