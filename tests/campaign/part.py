# SPDX-License-Identifier: GPL-3.0-or-later
"""Common to all parts of the campaign."""
import json

import bases


class AnyPart:
    """A part of the campaign: `count` attempts, each of which depends on its number and a random.Random only. Parts
    with the same `inputs` share a folder of input files."""
    count = 0
    inputs = "files"

    def __init__(self, folder):
        self.folder = folder

    @staticmethod
    def prepare(folder):
        """Writes the input files into an empty folder."""
        bases.write(folder)

    def attempt(self, number, random, folder):
        """Makes an attempt in an empty folder. Returns an Attempt."""
        raise NotImplementedError

    def measured(self, table, key, measure):
        """What measure() gives, kept beside the input files for the next time."""
        path = self.folder / f"{table}.json"
        known = json.loads(path.read_text(encoding="ascii")) if path.exists() else {}
        if key not in known:
            known[key] = measure()
            path.write_text(json.dumps(known), encoding="ascii")
        return known[key]

    def close(self):
        """Ends what the part has started."""
