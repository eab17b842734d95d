# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs scripts of the repository on small trees of files."""
import subprocess
import sys
import tempfile
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"


def run_script(name, files):
    """Exit status and output of a script for a tree with these files (path: text)."""
    with tempfile.TemporaryDirectory() as folder:
        for path, text in files.items():
            file = Path(folder) / path
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
        done = subprocess.run([sys.executable, SCRIPTS / name, folder], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout + done.stderr
