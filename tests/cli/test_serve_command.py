#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet serve: prints its address, serves the page, ends on a signal and refuses faulty input. stylet insert repeats
its recordings, even those of a killed server, with bit-identical forces."""
import os
import signal
import stat
import subprocess
import time
import unittest
import urllib.error
import urllib.request
from pathlib import Path
from urllib.parse import urlsplit

from insert_case import SMALL
from live_server import PATIENCE_S, Serve
from live_viewer import LiveViewer


class ServeCommand(Serve):
    def test_serves_the_page_and_ends_when_asked_to(self):
        for end in (signal.SIGINT, signal.SIGTERM):
            server, url = self.start("case.toml", *SMALL)
            with urllib.request.urlopen(url) as page:
                self.assertIn("text/html", page.headers["Content-Type"])
                self.assertIn('src="live.js"', page.read().decode())
            with urllib.request.urlopen(self.address("live.js")) as script:
                self.assertGreater(len(script.read()), 100_000)
            self.until(self.recordings)
            server.send_signal(end)
            self.assertEqual(server.wait(PATIENCE_S), 0)

    def test_ends_within_seconds_whatever_it_is_preparing_and_however_little_memory_it_has(self):
        for space_GB, after_s in ((None, 2.0), (3.0, 2.0), (3.0, 12.0)):
            server, _ = self.start("case.toml", "--models", "", "--set", "mesh.nodes=40000", space_GB=space_GB)
            time.sleep(after_s)
            asked = time.monotonic()
            server.send_signal(signal.SIGTERM)
            self.assertEqual(server.wait(PATIENCE_S), 0)
            self.assertLess(time.monotonic() - asked, 5.0, space_GB)

    def test_a_killed_server_leaves_a_recording_that_repeats(self):
        server, _ = self.start("case.toml", *SMALL)
        self.until(self.recordings)
        self.push(self.viewer(), 40.0, 20.0, steps=1000)
        server.kill()
        server.wait(PATIENCE_S)
        recording = str(self.recordings()[-1])
        said = self.succeed("insert", recording, "-o", "again").stdout
        self.assertIn("to the last bit", said)
        self.refuse("insert", recording, "-o", str(self.recordings()[-1].parent), says=["replaced", "-o"])

    def test_old_recordings_go_when_together_they_take_too_much(self):
        live = self.folder / "out" / "live"
        for name in ("2020-01-01-120000-old", "2020-01-02-120000-older-than-most", "kept"):
            (live / name).mkdir(parents=True)
            (live / name / "run.h5").write_bytes(bytes(2_000_000))
        server, _ = self.start("case.toml", *SMALL, "--keep", "0.0035")
        self.until(lambda: not (live / "2020-01-01-120000-old").exists())
        self.assertTrue((live / "kept" / "run.h5").exists())
        self.end(server)
        self.assertIn("2020-01-01-120000-old was removed", server.stderr.read())
        self.refuse("serve", "case.toml", "--keep", "-1", says=["--keep"])

    def opened(self, *arguments):
        """Starts a server, waits until the needle moves, and ends the server."""
        before = len(self.recordings())
        server, _ = self.start("case.toml", *SMALL, *arguments)
        self.until(lambda: len(self.recordings()) > before)
        self.end(server)
        return server

    def test_uses_a_model_that_was_prepared_in_the_folder_unless_it_is_damaged(self):
        self.succeed("prepare", "case.toml", *SMALL, "-o", "models/")
        kept, = (self.folder / "models").iterdir()
        made = kept.stat().st_ino
        self.opened("--models", "models")
        self.assertEqual(kept.stat().st_ino, made, "it was made again")
        kept.write_bytes(kept.read_bytes()[:-1000])
        self.opened("--models", "models")
        self.assertNotEqual(kept.stat().st_ino, made)
        self.assertEqual(list((self.folder / "models").iterdir()), [kept])

    def test_a_folder_for_models_that_refuses_keeps_nobody_from_opening(self):
        self.write("models", "a file")
        server = self.opened("--models", "models")
        self.assertIn("The model was not stored in the cache", server.stderr.read())
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
        port = str(urlsplit(url).port)
        done = subprocess.run([os.environ["STYLET"], "serve", "case.toml", "--port", port], cwd=self.folder, capture_output=True,
                              text=True, timeout=PATIENCE_S, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("another port", done.stderr)

    def test_nobody_comes_in_without_the_token(self):
        for address in ("127.0.0.1", "0.0.0.0"):
            _, url = self.start("case.toml", "--address", address, *SMALL)
            self.assertRegex(url, r"/\?token=[0-9a-f]{32}$")
            without = f"http://127.0.0.1:{urlsplit(url).port}/"
            with self.assertRaises(urllib.error.HTTPError) as refused:
                urllib.request.urlopen(without + "recordings")
            refused.exception.close()
            self.assertEqual(refused.exception.code, 401)
            for wrong in (without, without + "?token=0123"):
                with self.assertRaisesRegex(ConnectionError, " 401 "):
                    LiveViewer(wrong)
            LiveViewer(without + "?" + urlsplit(url).query).close()

    def test_each_start_has_a_new_token_unless_it_is_to_be_kept(self):
        def token(*options):
            return urlsplit(self.start("case.toml", *options, *SMALL)[1]).query
        token_file = Path(os.environ["XDG_CACHE_HOME"]) / "stylet" / "live_token"
        new = [token() for _ in range(2)]
        self.assertFalse(token_file.exists())
        kept = [token("--keep-token") for _ in range(2)]
        self.assertEqual(kept[0], kept[1])
        self.assertEqual(stat.S_IMODE(token_file.stat().st_mode), 0o600)
        self.assertEqual(len({*new, *kept}), 3)

    def test_a_token_of_ones_own_or_none(self):
        os.environ["STYLET_TOKEN"] = "from-the-environment"
        self.addCleanup(os.environ.pop, "STYLET_TOKEN")
        server, url = self.start("case.toml", *SMALL)
        self.assertTrue(url.endswith("/?token=from-the-environment"))
        self.end(server)
        os.environ["STYLET_TOKEN"] = ""
        server, url = self.start("case.toml", "--no-token", *SMALL)
        self.assertNotIn("token", url)
        LiveViewer(url).close()
        self.end(server)
        self.assertIn("Every user of this machine", server.stderr.read())
        self.refuse("serve", "case.toml", "--no-token", "--address", "0.0.0.0", says=["0.0.0.0", "move the needle"])
        self.refuse("serve", "case.toml", "--no-token", "--token", "mine", says=["--no-token"])
        self.refuse("serve", "case.toml", "--token", "a b", says=["a b"])


if __name__ == "__main__":
    unittest.main()
