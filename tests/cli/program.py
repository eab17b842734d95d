# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the built program the way a user does. STYLET in the environment names it."""
import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

STYLET = os.environ["STYLET"]
# Models are kept here instead of in the user's cache.
CACHE = tempfile.TemporaryDirectory(prefix="stylet-cache-")
os.environ["XDG_CACHE_HOME"] = CACHE.name

# Long past the longest command on a busy machine: a guard against a program that never ends, no limit on its speed.
HANGS_AFTER_S = 900


def run(*arguments, cwd=None):
    """The finished process, with text of standard output and standard error."""
    return subprocess.run([STYLET, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, check=False,
                          timeout=HANGS_AFTER_S, stdin=subprocess.DEVNULL)


def commands():
    """Names of all commands, as --help lists them."""
    listed = run("--help").stdout.split("Subcommands:")[1]
    return re.findall(r"^  ([a-z]+) ", listed, re.MULTILINE)


def files_under(folder):
    """Every file and folder below `folder`, with sizes: equal before and after means that nothing was written."""
    return {str(p.relative_to(folder)): p.stat().st_size for p in Path(folder).rglob("*")}


class InFolder(unittest.TestCase):
    """A test that works in an empty folder of its own, self.folder."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="stylet-cli-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def succeed(self, *arguments):
        """Runs the program in the folder; it must succeed."""
        done = run(*arguments, cwd=self.folder)
        self.assertEqual(done.returncode, 0, f"{arguments}: {done.stderr}")
        return done

    def json_of(self, *arguments):
        """What the command prints with --json -."""
        return json.loads(self.succeed(*arguments, "--json", "-").stdout)

    def refuse(self, *arguments, says):
        """Runs the program on bad input: exit status 2, one message (behind lines of progress, if any) that holds every
        text of `says`, nothing on standard output, nothing written."""
        before = files_under(self.folder)
        done = run(*arguments, cwd=self.folder)
        self.assertEqual(done.returncode, 2, f"{arguments}: {done.stderr}")
        self.assertEqual(done.stdout, "")
        self.assertRegex(done.stderr, r"\A([^\n]+( \.\.\.|: \d+ %)\n)*stylet: error: [^\n]+\n\Z")
        for text in says:
            self.assertIn(text, done.stderr)
        self.assertEqual(files_under(self.folder), before)
        return done
