#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet validate with all rows: the README names the rows that are missed."""
import json
import subprocess
import unittest

from program import STYLET, InFolder
from readme import not_to_trust


class ValidateAll(InFolder):
    def test_the_readme_names_every_row_that_misses_and_none_that_passes(self):
        subprocess.run([STYLET, "validate", "-o", self.folder / "out"], check=True, capture_output=True, timeout=3000)
        rows = json.loads((self.folder / "out/validate.json").read_text(encoding="utf-8"))["rows"]
        judged = {row["id"]: row["pass"] for row in rows if row["pass"] is not None}
        self.assertGreater(len(judged), 30)
        self.assertEqual({name for name, passes in judged.items() if not passes}, set(not_to_trust()) & set(judged),
                         "README.md, What not to trust yet: it names the rows that miss and no other")


if __name__ == "__main__":
    unittest.main()
