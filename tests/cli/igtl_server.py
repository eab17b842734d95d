# SPDX-License-Identifier: GPL-3.0-or-later
"""A running stylet serve with OpenIGTLink, for tests."""
import math

from igtl_client import Client
from insert_case import SMALL
from live_server import Serve

BASE = "NeedleBaseToReferenc"  # an OpenIGTLink name has 20 bytes
HANDLE = "HandleToReference"


def along(pose, mm):
    """The pose, moved by this distance along its z axis."""
    return [*pose[:3], tuple(o + mm * z for o, z in zip(pose[3], pose[2]))]


def apart(a, b):
    return math.dist(a[3], b[3])


class LinkedServe(Serve):
    def link(self, *arguments):
        """Starts a server with a link on a free port. Returns it and the port."""
        server, _ = self.start("case.toml", "--igtl", "0", *arguments, *SMALL)
        return server, self.said["igtl"]["port"]

    def client(self, port):
        client = Client.to(port)
        self.addCleanup(client.close)
        return client

    def lead(self, tracker, display, start, mm):
        """Moves the base in small steps until it is this far from its start. Returns the largest force on the way."""
        most = 0.0
        handle = 0.0
        while True:
            base = display.transform(BASE)
            at = math.dist(base[3], start[3])
            if abs(at - mm) < 0.01:
                return most
            handle = at + max(-1.0, min(1.0, mm - at))
            tracker.send_transform(HANDLE, along(start, handle))
            most = max(most, math.hypot(*display.force()["force_N"]))
