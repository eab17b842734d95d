# SPDX-License-Identifier: GPL-3.0-or-later
"""Hostile HTTP, WebSocket and OpenIGTLink against a server whose needle moves: it goes on, the needle's steps go on,
and the server's memory stays bounded."""
import base64
import json
import os
import socket
import struct
import time
import urllib.request
from urllib.parse import urlsplit, urlunsplit

import bases
import igtl_client
import mutators
from ending import Attempt, End, faults_of, shell
from live import Server, until
from part import AnyPart

GOES_ON_WITHIN_S = 10
MOST_MORE_MB = 300
EACH_SERVER = 50  # attempts
FLOOD = 3000


def connected(port):
    connection = socket.create_connection(("127.0.0.1", port), timeout=5)
    return connection


def sent(connection, data):
    """Sends as much as the other side takes, and hears what it says for a moment."""
    try:
        connection.sendall(data)
        connection.settimeout(0.1)
        end = time.monotonic() + 0.3
        while time.monotonic() < end and connection.recv(65536):
            pass
    except OSError:
        pass


class Attacks:
    """One method for each kind of attack. Each takes a random.Random."""

    def __init__(self, url, igtl_port):
        at = urlsplit(url)
        self.url, self.port, self.query, self.host, self.igtl_port = url, at.port, at.query, at.netloc, igtl_port

    def request(self, path="/", more=""):
        return f"GET {path}?{self.query} HTTP/1.1\r\nHost: {self.host}\r\n{more}\r\n".encode()

    def upgraded(self):
        """A WebSocket connection."""
        connection = connected(self.port)
        key = base64.b64encode(os.urandom(16)).decode()
        connection.sendall(self.request("/live",
                                        "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                                        f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Protocol: stylet-live-4\r\n"))
        return connection

    def http_noise(self, random):
        with connected(self.port) as c:
            sent(c, random.randbytes(random.choice((1, 100, 100000))))

    def http_mutants(self, random):
        paths = ("/", "/live", "/live.js", "/recordings", "/recordings/x/forces.csv", "/recordings/%2e%2e/%00",
                 "/recordings/" + "../" * 20)
        with connected(self.port) as c:
            sent(c, mutators.text(self.request(random.choice(paths), "Range: bytes=0-1\r\nContent-Length: 10\r\n"),
                                  random))

    def http_long(self, random):
        with connected(self.port) as c:
            what = random.choice((b"GET /" + b"a" * 3_000_000, self.request()[:-2] + b"X: " + b"b" * 3_000_000,
                                  self.request()[:-2] + b"X: y\r\n" * 300_000,
                                  b"POST / HTTP/1.1\r\nContent-Length: 99999999999\r\n\r\n" + b"c" * 1_000_000,
                                  b"POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\nffffffffffffffff\r\n"))
            sent(c, what)

    def http_slow(self, random):
        held = [connected(self.port) for _ in range(random.choice((1, 20)))]
        for k, byte in enumerate(self.request()):
            for c in held:
                try:
                    c.send(bytes([byte]))
                except OSError:
                    pass
            time.sleep(0.02)
            if k > 40:
                break
        for c in held:
            c.close()

    def http_many(self, random):
        held = []
        for _ in range(random.choice((80, 300))):
            try:
                held.append(connected(self.port))
            except OSError:
                break
        time.sleep(0.2)
        for c in held:
            c.close()

    def ws_frames(self, random):
        with self.upgraded() as c:
            what = [struct.pack(">BBQ", 0x82, 0xff,
                                random.choice(mutators.INTEGERS) & 0x7fffffffffffffff) + b"abcd" * 3,
                    b"\x82\x05hello", b"\xf2\x80abcd", b"\x83\x80abcd", b"\x00\x80abcd", b"\x02\x81abcd0" * FLOOD,
                    b"\x89\x80abcd" * FLOOD,
                    b"\x89\xfe\x01\x00abcd" + bytes(256), b"\x88\x82abcd\0\0", b"\x81\x84abcd\xff\xff\xff\xff",
                    random.randbytes(5000),
                    b"\x02\x81abcd0" + b"\x00\xff" + struct.pack(">Q", 70_000_000) + b"abcd" + bytes(3_000_000)]
            sent(c, random.choice(what))

    def ws_messages(self, random):
        with self.upgraded() as c:
            for _ in range(random.choice((1, 30, FLOOD))):
                body = random.choice((random.randbytes(random.randrange(60)),
                                      struct.pack("<II", random.choice((0, 2, 16, 17, 18, 19, 2**32 - 1)), 0) +
                                      random.randbytes(random.choice((0, 4, 20, 110)))))
                try:
                    c.sendall(masked(body))
                except OSError:
                    break
            sent(c, b"")

    def ws_commands(self, random):
        commands = [{"do": "take"}, {"do": "hole", "hole": "D4"}, {"do": "insertion", "index": 0},
                    {"do": "needle", "index": 0}, {"do": "case", "index": 0},
                    {"do": "predict", "on": 1}, {"do": "step", "count": 5}, {"do": "replay", "name": "x"},
                    {"do": "seek", "time_s": 1},
                    {"do": "play", "rate": 1}, {"do": "image", "show": "xray"},
                    {"do": "set", "key": "probe.lift_mm", "value": 8}]
        with self.upgraded() as c:
            for _ in range(random.choice((1, 50))):
                try:
                    c.sendall(masked(struct.pack("<II", 17,
                                                 0) + mutators.tree(json.dumps(random.choice(commands)).encode(),
                                                                    random)[:60000]))
                except OSError:
                    break
            sent(c, b"")

    def ws_silent(self, random):
        """Pages that read nothing."""
        held = [self.upgraded() for _ in range(random.choice((1, 25)))]
        time.sleep(1.0)
        for c in held:
            c.close()

    def igtl_mutants(self, random):
        whole = igtl_client.message("TRANSFORM", "HandleToReference", struct.pack(">12f", *range(12)))
        with connected(self.igtl_port) as c:
            sent(c, b"".join(mutators.raw(whole, random) for _ in range(random.choice((1, 20)))))

    def igtl_contents(self, random):
        """Sound messages with odd contents."""
        kind = random.choice(("TRANSFORM", "POSITION", "STRING", "COMMAND", "STATUS", "IMAGE", "POLYDATA", "QTDATA",
                              "TDATA", "GET_STATUS", "X" * 12))
        body = random.choice((b"", struct.pack(">12f",
                                               *(random.choice((0.0, 1e30, float("nan"), float("inf")))
                                                 for _ in range(12))),
                              random.randbytes(random.choice((3, 48, 3000))),
                              struct.pack(">HH", 3, 65535) + b"{\"do\": \"take\"}"))
        with connected(self.igtl_port) as c:
            sent(c, igtl_client.message(kind, random.choice(("HandleToReference", "Stylet", "x" * 20)),
                                        body) * random.choice((1, 100)))

    def igtl_long(self, random):
        with connected(self.igtl_port) as c:
            size = random.choice((2**20, 2**32, 2**40, 2**64 - 1))
            sent(c, igtl_client.HEADER.pack(random.choice((1, 2, 3, 65535)), b"IMAGE", b"x", 0, size,
                                            0) + bytes(3_000_000))

    def igtl_many(self, random):
        held = []
        for _ in range(random.choice((10, 100))):
            try:
                held.append(connected(self.igtl_port))
            except OSError:
                break
        time.sleep(0.2)
        for c in held:
            c.close()


KINDS = [name for name in vars(Attacks) if name.split("_")[0] in ("http", "ws", "igtl")]


def masked(body):
    size = bytes([0x80 | len(body)]) if len(body) < 126 else bytes([0xfe]) + struct.pack(">H", len(body))
    mask = os.urandom(4)
    return b"\x82" + size + mask + bytes(b ^ mask[k % 4] for k, b in enumerate(body))


class Part(AnyPart):
    count = 9_000
    server = page = None
    attempts = seen = 0

    def open(self):
        """A server and a page that moves its needle in and out."""
        own = self.folder / "served"
        if not own.exists():
            own.mkdir()
            bases.link(self.folder, own)
        self.server = Server(("serve", "block.toml", "--igtl", "0"), own)
        if not self.server.opened():
            raise RuntimeError(f"the server does not start: {self.server.stop().err}")
        self.page = self.server.page()
        if not self.page.ready():
            raise RuntimeError(f"the case is not ready: {self.page.status}")
        self.page.command(do="take")
        self.attacks = Attacks(self.server.said["url"], self.server.said["igtl"]["port"])
        self.attempts = 0
        if self.faults_now():
            raise RuntimeError("the needle does not move")
        self.megabytes = self.server.megabytes()

    def close(self):
        if self.server:
            self.page.close()
            end = self.server.stop()
            self.server = None
            return end
        return None

    def moves(self):
        """Moves the hand, and says whether the needle has made a step since it was asked last."""
        depth = 40.0 if int(time.monotonic()) % 8 < 4 else -3.0
        self.page.hand(depth, 20.0)
        before, self.seen = self.seen, self.page.steps
        return self.seen > before

    def faults_now(self):
        """What is wrong with the server now."""
        if not self.server.running():
            return ["the server ended"]
        found = []
        try:
            if not until(self.moves, GOES_ON_WITHIN_S):
                found.append(f"the needle makes no steps: {self.page.status}"[:300])
        except OSError as error:
            found.append(f"the page is cut off: {error}")
        at = urlsplit(self.server.said["url"])
        try:
            with urllib.request.urlopen(urlunsplit(at._replace(path="/recordings")),
                                        timeout=GOES_ON_WITHIN_S) as answer:
                json.load(answer)
        except (OSError, ValueError) as error:
            if "503" not in str(error):
                found.append(f"no answer: {error}")
        return found

    def attempt(self, number, random, folder):
        if self.server is None:
            self.open()
        kind = KINDS[number % len(KINDS)]
        self.attempts += 1
        try:
            getattr(self.attacks, kind)(random)
        except OSError:
            pass  # refused, or cut off
        faults = self.faults_now()
        megabytes = self.server.megabytes() if self.server.running() else 0
        if megabytes > self.megabytes + MOST_MORE_MB:
            faults.append(f"{megabytes} MB instead of {self.megabytes} MB")
        arguments = self.server.arguments
        end = End(0, "", "", 0.0, megabytes, False)
        if faults or self.attempts >= EACH_SERVER:
            end = self.close()
            end.megabytes = megabytes
            faults += faults_of(end, allowed=(0,), most_seconds=float("inf"))
            (folder / "stderr").write_text(end.err, encoding="utf-8", errors="replace")
        return Attempt(kind, f"after {self.attempts - 1} others",
                       shell(arguments) + f"  # scripts/campaign FOLDER hostile --attempt {number}", end, faults)
