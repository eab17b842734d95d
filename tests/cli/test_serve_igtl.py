#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""stylet serve with OpenIGTLink over the loopback interface: a tracker moves the needle and a display shows it; both
disconnect and reconnect."""
import math
import signal
import socket
import struct
import unittest

from igtl_client import Client, message
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

    def test_says_what_it_does_not_use(self):
        server, port = self.link("--hand", "igtl")
        whole = message("TRANSFORM", HANDLE, struct.pack(">12f", *(1, 0, 0, 0, 1, 0, 0, 0, 1, 10, 20, -30)))
        client = self.client(port)
        # Checksum 0, header version 3, types and names that are not used, no message at all.
        for sent, says in ((whole[:50] + bytes(8) + whole[58:], ["checksum is 0", HANDLE, "--igtl-no-checksum"]),
                           (b"\0\3" + whole[2:], ["header has version 3, which is not read", "version 1 or 2"]),
                           (message("SENSOR", "Tracker", whole[58:]), ["SENSOR 'Tracker' from 127.0.0.1:", "not used"]),
                           (message("TRANSFORM", "StylusToTracker", whole[58:]), ["'StylusToTracker'", HANDLE]),
                           (b"GET / HTTP/1.1\r\n" + bytes(58), ["is closed", "no header of OpenIGTLink"])):
            client.connection.sendall(sent)
            self.await_said(server, says)
        with self.assertRaises(ConnectionError):
            while True:
                client.receive()

    def test_starts_again_and_chooses_a_hole_by_a_string(self):
        _, port = self.link("--hand", "igtl")
        client = self.client(port)
        start = client.transform(BASE)

        def answer(text):
            client.connection.sendall(message("STRING", "Stylet", struct.pack(">HH", 3, len(text)) + text.encode()))
            return client.next("STRING", "Stylet")[4:].decode()

        self.lead(client, client, start, 5.0)
        self.assertEqual(answer("start again"), "done: start again")
        while apart(client.transform(BASE), start) > 0.01:
            pass
        said = answer('{"do": "hole", "hole": "Z99"}')
        self.assertTrue(said.startswith("refused: ") and "Z99" in said, said)
        self.assertIn("hole HOLE", answer("dance"))

    def await_said(self, server, texts):
        """Reads lines of the terminal until one has all texts."""
        while True:
            line = server.stderr.readline()
            self.assertTrue(line, "the server has ended")
            if all(text in line for text in texts):
                return

    def test_takes_messages_without_checksums_if_told_to_and_positions(self):
        _, port = self.link("--hand", "igtl", "--igtl-no-checksum")
        display, tracker = self.client(port), self.client(port)
        start = display.transform(BASE)
        x, y, z = start[:3]
        # The quaternion of a needle that goes superior in RAS, with its x axis to the patient's left.
        self.assertLess(abs(z[2] - 1.0), 1e-6)
        half = math.atan2(x[1], x[0]) / 2.0
        for step in range(1, 6):
            at = along(start, 1.0 * step)[3]
            body = struct.pack(">7f", *at, 0.0, 0.0, math.sin(half), math.cos(half))
            position = message("POSITION", HANDLE, body)
            tracker.connection.sendall(position[:50] + bytes(8) + position[58:])
            while apart(display.transform(BASE), along(start, 1.0 * step)) > 0.01:
                tracker.connection.sendall(position[:50] + bytes(8) + position[58:])

    def test_is_not_ready_while_a_recording_is_replayed(self):
        server, _ = self.start("case.toml", *SMALL)
        self.until(lambda: self.steps() > 100)
        server.send_signal(signal.SIGTERM)
        self.assertEqual(server.wait(PATIENCE_S), 0)
        self.start(str(self.recordings()[-1]), "--igtl", "0")
        client = self.client(self.said["igtl"]["port"])
        for _ in range(2):
            self.assertEqual(client.status(), NOT_READY)

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
