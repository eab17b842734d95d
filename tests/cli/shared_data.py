# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of real patients and of other programs. They are not part of the repository: their folder is $STYLET_SHARED_DATA,
by default ../shared/data beside it. Without them tests are skipped (exit status 77)."""
import os
import sys
import unittest
from pathlib import Path

SHARED = Path(os.environ.get("STYLET_SHARED_DATA") or Path(__file__).resolve().parents[3] / "shared" / "data")
FOUND = SHARED / "found3"  # files with one property each that people met with other programs


def run_tests_with(data):
    """Runs the tests of the program, or skips them if this folder is not there."""
    if not data.is_dir():
        print(f"Skipped: no data in {data}; name the folder of the shared data with STYLET_SHARED_DATA.")
        sys.exit(77)
    unittest.main()
