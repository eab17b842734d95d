#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet serve with OpenIGTLink over the loopback interface: a tracker moves the needle and a display shows it; both
disconnect and reconnect."""
import math
import os
import signal
import socket
import subprocess
import unittest

from igtl_client import Client
from igtl_server import BASE, HANDLE, LinkedServe, along, apart
from insert_case import SMALL
from live_server import PATIENCE_S

OK, NOT_READY = 1, 13


class ServeIgtl(LinkedServe):
    def test_a_tracker_moves_the_needle_and_a_display_sees_it(self):
        server, port = self.link("--hand", "igtl")
        self.assertTrue(self.said["igtl"]["hand"])
        display, tracker = self.client(port), self.client(port)
        start = display.transform(BASE)
        self.assertEqual(display.status(), OK)
        watcher = self.client(port)
        at_rest, triangles = watcher.surface()
        self.assertGreater(triangles, 100)

        self.assertGreater(self.lead(tracker, display, start, 60.0), 0.1)
        tip = display.transform("NeedleTipToReference")
        self.assertGreater(apart(tip, start), 200.0, "200 mm of needle and what it went")
        while watcher.surface()[0] == at_rest:
            pass

        tracker.close()
        while any(display.force()["force_N"]):
            pass
        there = display.transform(BASE)
        self.assertLess(apart(there, along(start, 60.0)), 0.01, "the needle stays")
        tracker = self.client(port)
        self.lead(tracker, display, start, 50.0)

        # The needle does not follow a handle that is far away from it.
        for _ in range(30):
            tracker.send_transform(HANDLE, along(start, 0.0))
            there = display.transform(BASE)
        self.assertLess(apart(there, along(start, 50.0)), 0.01)

        server.send_signal(signal.SIGTERM)
        self.assertEqual(server.wait(PATIENCE_S), 0)
        self.assertIn("to the last bit", self.succeed("insert", str(self.recordings()[-1]), "-o", "again").stdout)

    def test_connects_to_a_tracker_and_again_when_it_returns(self):
        with socket.create_server(("127.0.0.1", 0)) as listening:
            listening.settimeout(PATIENCE_S)
            port = listening.getsockname()[1]
            self.start("case.toml", "--igtl-connect", f"127.0.0.1:{port}", "--hand", "igtl", *SMALL)
            self.assertEqual(self.said["igtl"], {"role": "client", "host": "127.0.0.1", "port": port, "hand": True})
            start = None
            for mm in (10.0, 5.0):
                tracker = Client(listening.accept()[0])
                start = start or tracker.transform(BASE)
                self.lead(tracker, tracker, start, mm)
                tracker.close()

    def test_only_shows_unless_it_has_the_hand(self):
        _, port = self.link()
        self.assertFalse(self.said["igtl"]["hand"])
        client = self.client(port)
        start = client.transform(BASE)
        for _ in range(30):
            client.send_transform(HANDLE, along(start, 5.0))
            self.assertLess(apart(client.transform(BASE), start), 1e-3)

    def test_is_not_ready_while_a_recording_is_replayed(self):
        server, _ = self.start("case.toml", *SMALL)
        self.until(lambda: self.steps() > 100)
        server.send_signal(signal.SIGTERM)
        self.assertEqual(server.wait(PATIENCE_S), 0)
        self.start(str(self.recordings()[-1]), "--igtl", "0")
        client = self.client(self.said["igtl"]["port"])
        for _ in range(2):
            self.assertEqual(client.status(), NOT_READY)

    def test_a_port_that_is_taken(self):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            port = str(taken.getsockname()[1])
            done = subprocess.run([os.environ["STYLET"], "serve", "case.toml", "--port", "0", "--igtl", port], cwd=self.folder,
                                  capture_output=True, text=True, timeout=PATIENCE_S, check=False)
        self.assertEqual(done.returncode, 1)
        self.assertIn("OpenIGTLink, 127.0.0.1 port " + port, done.stderr)
        self.assertIn("another port", done.stderr)

    def test_refuses_what_is_wrong(self):
        def refuse(*arguments, says):
            self.refuse("serve", "case.toml", *arguments, says=says)

        refuse("--igtl", "70000", says=["70000", "65535"])
        refuse("--igtl", "here", says=["here", "port"])
        refuse("--igtl", "::1:18944", says=["brackets"])
        refuse("--igtl", "127.0.0.1:", says=["colon"])
        refuse("--igtl", "no host:18944", says=["no host"])
        refuse("--igtl-connect", "18944", says=["host"])
        refuse("--igtl-connect", "127.0.0.1:0", says=["no port from 1"])
        refuse("--igtl-connect", "127.0.0.1", "--igtl", "0", says=["--igtl"])
        refuse("--hand", "igtl", says=["--igtl PORT", "--igtl-connect"])
        refuse("--hand", "foot", says=["foot", "page"])


if __name__ == "__main__":
    unittest.main()
