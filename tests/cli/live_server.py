# SPDX-License-Identifier: GPL-3.0-or-later
"""A running stylet serve, for tests."""
import json
import os
import resource
import subprocess
import time
from urllib.parse import urlsplit, urlunsplit

from insert_case import PHANTOM
from live_viewer import LiveViewer
from program import InFolder

PATIENCE_S = 120


class Serve(InFolder):
    """A folder with case.toml, in which servers run until the end of the test."""

    def setUp(self):
        super().setUp()
        (self.folder / "case.toml").write_text(PHANTOM)

    def start(self, *arguments, space_GB=None):
        """Starts a server on a free port, with a limit of its address space if one is given. Returns it and its
        address."""
        def limit():
            if space_GB:
                resource.setrlimit(resource.RLIMIT_AS, (int(1e9 * space_GB),) * 2)
        server = subprocess.Popen([os.environ["STYLET"], "serve", *arguments, "--port", "0", "--json", "-"], cwd=self.folder,
                                  stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=limit)
        self.addCleanup(server.stdout.close)
        self.addCleanup(server.stderr.close)
        self.addCleanup(server.wait)
        self.addCleanup(server.kill)
        text = ""
        while not text.endswith("\n}\n"):
            line = server.stdout.readline()
            self.assertTrue(line, server.stderr.read() if server.poll() is not None else "no address")
            text += line
        self.said = json.loads(text)
        return server, self.said["url"]

    def end(self, server):
        """Ends the server and waits until it has ended. Its files do not change any more afterwards."""
        server.terminate()
        self.assertEqual(server.wait(PATIENCE_S), 0)

    def address(self, path):
        """The address of a path of the server, with its token."""
        at = urlsplit(self.said["url"])
        return urlunsplit(at._replace(path="/" + path))

    def viewer(self):
        """A viewer that holds the needle."""
        viewer = LiveViewer(self.said["url"])
        self.addCleanup(viewer.close)
        viewer.command(do="take")
        return viewer

    def until(self, true):
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            if true():
                return
            time.sleep(0.05)
        self.fail("waited in vain")

    def recordings(self):
        return sorted((self.folder / "out" / "live").glob("*/run.h5"))

    def push(self, viewer, depth_mm, speed_mm_per_s, steps):
        """Pushes with the viewer's hand until the recording has more than this number of steps. The target is sent
        again and again, as by a page, because the server ignores targets before the needle exists, and the recording
        exists earlier than the needle."""
        def pushed():
            viewer.hand(depth_mm, speed_mm_per_s)
            return self.steps() > steps
        self.until(pushed)

    def steps(self):
        """The number of steps in the recording."""
        try:
            return self.json_of("info", str(self.recordings()[-1]))["steps"]
        except (AssertionError, KeyError, IndexError):
            return 0
