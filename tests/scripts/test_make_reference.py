#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/make_reference has an entry for every command and every installed header, and Doxygen understands the comments
of all of them."""
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NOT_INSTALLED = {"evidence", "igtl", "measure", "serve"}


class Reference(unittest.TestCase):
    def test_every_command_and_every_header_has_an_entry(self):
        with tempfile.TemporaryDirectory() as name:
            subprocess.run([sys.executable, ROOT / "scripts/make_reference", PROGRAM, name], check=True)
            options = (Path(name) / "options.md").read_text(encoding="utf-8")
            library = (Path(name) / "library.md").read_text(encoding="utf-8")
            self.assertTrue((Path(name) / "html/index.html").is_file())
            self.assertIn("\nhalf-life\n", (Path(name) / "plan_rules.md").read_text(encoding="utf-8"))
        commands = {f.stem.removeprefix("command_") for f in (ROOT / "apps/cli").glob("command_*.cpp")}
        self.assertEqual(commands | {"stylet"}, set(re.findall(r"^## (\w+)$", options, re.M)))
        include = ROOT / "include"
        headers = {h.relative_to(include).as_posix() for h in include.rglob("*.hpp")}
        installed = {h for h in headers if h.split("/")[1] not in NOT_INSTALLED}
        self.assertEqual(installed, set(re.findall(r"^### (\S+)$", library, re.M)))


if __name__ == "__main__":
    PROGRAM = sys.argv.pop()
    unittest.main()
