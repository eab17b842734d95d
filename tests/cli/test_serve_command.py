#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet serve: says where it listens, serves the page, ends when asked to, refuses what is wrong; its recordings, also of a killed
server, are repeated by stylet insert to the last bit."""
import os
import signal
import subprocess
import unittest
import urllib.error
import urllib.request

from insert_case import SMALL
from live_server import PATIENCE_S, Serve


class ServeCommand(Serve):
    def test_serves_the_page_and_ends_when_asked_to(self):
        for end in (signal.SIGINT, signal.SIGTERM):
            server, url = self.start("case.toml", *SMALL)
            with urllib.request.urlopen(url) as page:
                self.assertIn("text/html", page.headers["Content-Type"])
                self.assertIn('src="live.js"', page.read().decode())
            with urllib.request.urlopen(url + "live.js") as script:
                self.assertGreater(len(script.read()), 100_000)
            self.until(self.recordings)
            server.send_signal(end)
            self.assertEqual(server.wait(PATIENCE_S), 0)

    def test_a_killed_server_leaves_a_recording_that_repeats(self):
        server, _ = self.start("case.toml", *SMALL)
        self.until(lambda: self.steps() > 500)
        server.kill()
        server.wait(PATIENCE_S)
        recording = str(self.recordings()[-1])
        said = self.succeed("insert", recording, "-o", "again").stdout
        self.assertIn("to the last bit", said)
        self.refuse("insert", recording, "-o", str(self.recordings()[-1].parent), says=["replaced", "-o"])

    def opened(self, *arguments):
        """Starts a server, waits until the needle moves, and ends it."""
        before = len(self.recordings())
        server, _ = self.start("case.toml", *SMALL, *arguments)
        self.until(lambda: len(self.recordings()) > before)
        server.terminate()
        self.assertEqual(server.wait(PATIENCE_S), 0)
        return server

    def test_models_are_kept_for_the_next_time(self):
        models = self.folder / "models"
        self.opened("--models", "models")
        kept = list(models.iterdir())
        self.assertEqual([file.suffix for file in kept], [".stylet"])
        made = kept[0].stat().st_ino
        self.opened("--models", "models")
        self.assertEqual(kept[0].stat().st_ino, made, "it was made again")
        kept[0].write_bytes(kept[0].read_bytes()[:-1000])  # damaged: not used, and made again
        self.opened("--models", "models")
        self.assertNotEqual(kept[0].stat().st_ino, made)
        self.assertEqual(list(models.iterdir()), kept)

    def test_finds_a_model_that_was_prepared_in_the_folder(self):
        self.succeed("prepare", "case.toml", *SMALL, "-o", "models/")
        kept = list((self.folder / "models").iterdir())
        made = kept[0].stat().st_ino
        self.opened("--models", "models")
        self.assertEqual(list((self.folder / "models").iterdir()), kept)
        self.assertEqual(kept[0].stat().st_ino, made)

    def test_a_folder_for_models_that_refuses_keeps_nobody_from_opening(self):
        (self.folder / "models").write_text("a file")
        server = self.opened("--models", "models")
        self.assertIn("not kept for the next time", server.stderr.read())
        self.opened("--models", "")

    def test_refuses_what_is_wrong(self):
        self.refuse("serve", "nothing.toml", says=["nothing.toml"])
        self.refuse("serve", "case.toml", "--address", "nowhere", says=["nowhere", "IP address"])
        self.refuse("serve", "case.toml", "--port", "70000", says=["70000"])
        self.refuse("serve", "case.toml", "--set", "mesh.nods=1", says=["mesh.nods", "mesh.nodes"])
        (self.folder / "empty").mkdir()
        self.refuse("serve", "empty", says=["empty", "scenario"])

    def test_a_port_that_is_taken(self):
        _, url = self.start("case.toml", *SMALL)
        port = url.rstrip("/").rsplit(":", 1)[1]
        done = subprocess.run([os.environ["STYLET"], "serve", "case.toml", "--port", port], cwd=self.folder, capture_output=True,
                              text=True, timeout=PATIENCE_S, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("another port", done.stderr)

    def test_beyond_this_machine_there_is_a_token(self):
        _, url = self.start("case.toml", "--address", "0.0.0.0", *SMALL)
        self.assertRegex(url, r"/\?token=[0-9a-f]{32}$")
        port = url.split("/")[2].rsplit(":", 1)[1]
        with self.assertRaises(urllib.error.HTTPError) as refused:
            urllib.request.urlopen(f"http://127.0.0.1:{port}/recordings")
        refused.exception.close()
        self.assertEqual(refused.exception.code, 401)


if __name__ == "__main__":
    unittest.main()
