#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A dose grid in big endian and a plan without the time of a channel, as other programs write them."""
from program import InFolder
from shared_data import FOUND, run_tests_with



class DoseKinds(InFolder):
    def test_a_dose_grid_of_32_bits_is_the_same_in_both_orders_of_bytes(self):
        for order in ("little", "big"):
            info = self.json_of("info", FOUND / f"k08_dose_{order}_endian.dcm")
            self.assertAlmostEqual(info["highest_Gy"], 21.8818, delta=5e-5, msg=order)

    def test_a_channel_without_its_time_is_an_error_that_names_it(self):
        self.refuse("dose", FOUND / "k09_channel_time_missing.dcm", "--structures", FOUND / "k01_twice_one_slice.dcm",
                    "--source", "ir192_mhdr_v2", "--ignore-frame-of-reference", "-o", "out",
                    says=["channel 1", "ChannelTotalTime, 300A,0286"])


if __name__ == "__main__":
    run_tests_with(FOUND)
