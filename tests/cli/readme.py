# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the README's statements about `stylet validate`."""
import re
from pathlib import Path

README = Path(__file__).resolve().parents[2] / "README.md"


def not_to_trust():
    """The ids of the rows in the section "Not to be trusted yet", in their order."""
    section = README.read_text(encoding="utf-8").split("\n## Not to be trusted yet\n")[1].split("\n## ")[0]
    return re.findall(r"^- `([a-z0-9_]+)`: ", section, re.MULTILINE)
