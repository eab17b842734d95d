# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the built program as a user does. The environment variable STYLET names it."""
import csv
import html
import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

STYLET = os.environ["STYLET"]
# Models are cached here instead of in the user's cache.
CACHE = tempfile.TemporaryDirectory(prefix="stylet-cache-")
os.environ["XDG_CACHE_HOME"] = CACHE.name

# Much longer than the longest command on a busy machine: it detects a program that never ends and limits no speed.
HANGS_AFTER_S = 900


def run(*arguments, cwd=None):
    """Runs the program. Returns the finished process with the texts of standard output and standard error."""
    return subprocess.run([STYLET, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, check=False,
                          timeout=HANGS_AFTER_S, stdin=subprocess.DEVNULL)


def commands():
    """The names of all commands, as listed by --help."""
    listed = run("--help").stdout.split("Subcommands:")[1]
    return re.findall(r"^  ([a-z]+) ", listed, re.MULTILINE)


def files_under(folder):
    """All files and folders below `folder` with their sizes, to check that nothing was written."""
    return {str(p.relative_to(folder)): p.stat().st_size for p in Path(folder).rglob("*")}


class InFolder(unittest.TestCase):
    """A test that runs in an empty folder of its own, self.folder."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="stylet-cli-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def write(self, name, content):
        """Writes a file: bytes, a text, or anything else as JSON. Returns its name."""
        if not isinstance(content, bytes):
            content = (content if isinstance(content, str) else json.dumps(content)).encode()
        (self.folder / name).write_bytes(content)
        return name

    def read(self, name):
        """The JSON in a file."""
        return json.loads((self.folder / name).read_text(encoding="utf-8"))

    def rows(self, name):
        """The rows of a CSV file with a header."""
        with (self.folder / name).open(newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def succeed(self, *arguments):
        """Runs the program in the folder and checks that it succeeds."""
        done = run(*arguments, cwd=self.folder)
        self.assertEqual(done.returncode, 0, f"{arguments}: {done.stderr}")
        return done

    def json_of(self, *arguments):
        """The JSON that the command prints with --json -."""
        return json.loads(self.succeed(*arguments, "--json", "-").stdout)

    def refuse(self, *arguments, says):
        """Runs the program with bad input. Checks that the exit status is 2, that standard error has one error (after
        warnings and lines of progress, if any) with every text of `says`, that standard output is empty and that no file is
        written."""
        before = files_under(self.folder)
        done = run(*arguments, cwd=self.folder)
        self.assertEqual(done.returncode, 2, f"{arguments}: {done.stderr}")
        self.assertEqual(done.stdout, "")
        self.assertRegex(done.stderr, r"\A([^\n]+( \.\.\.|: \d+ %|by a rough estimate\.)\n|stylet: warning: [^\n]+\n)*stylet: error: [^\n]+\n\Z")
        for text in says:
            self.assertIn(text, done.stderr)
        self.assertEqual(files_under(self.folder), before)
        return done


def as_on_terminal(text):
    """A text of a page as the terminal says it, where minus signs are hyphens and all spaces are plain."""
    return html.unescape(text).replace("\xa0", " ").replace("−", "-")


def page_text(path):
    return as_on_terminal(Path(path).read_text(encoding="utf-8"))
