# SPDX-License-Identifier: GPL-3.0-or-later
"""A viewer of stylet serve (docs/live_protocol.md) that only sends: the target of its hand, and that it is there. It reads
nothing, so it answers no ping either."""
import base64
import json
import os
import socket
import struct
import threading
from urllib.parse import urlsplit

HAND, COMMAND, SEEN = 16, 17, 18
HERE_EVERY_S = 0.2


class LiveViewer:
    def __init__(self, url):
        """url: the address that the server printed. Raises ConnectionError if the server refuses the connection."""
        at = urlsplit(url)
        self.socket = socket.create_connection((at.hostname, at.port))
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(f"GET /live?{at.query} HTTP/1.1\r\nHost: {at.netloc}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n"
                            "Sec-WebSocket-Protocol: stylet-live-3\r\n\r\n".encode())
        answer = self._answer()
        if " 101 " not in answer.split("\r\n", 1)[0]:
            self.socket.close()
            raise ConnectionError(answer)
        self.turn = threading.Lock()
        self.closed = threading.Event()
        threading.Thread(target=self._stay, daemon=True).start()

    def _answer(self):
        """The head of the server's answer, and nothing of the messages that may have come with it."""
        answer = b""
        while not answer.endswith(b"\r\n\r\n"):
            part = self.socket.recv(1)
            if not part:
                break
            answer += part
        return answer.decode(errors="replace")

    def close(self):
        self.closed.set()
        self.socket.close()

    def _stay(self):
        """Says again and again that the viewer is there; otherwise the server stops its hand."""
        while not self.closed.wait(HERE_EVERY_S):
            try:
                self._send(SEEN, struct.pack("<I", 0))
            except OSError:
                return

    def _send(self, kind, body):
        """Sends one masked binary frame of less than 64 KB."""
        data = struct.pack("<II", kind, 0) + body
        mask = os.urandom(4)
        size = bytes([0x80 | len(data)]) if len(data) < 126 else bytes([0x80 | 126]) + struct.pack(">H", len(data))
        with self.turn:
            self.socket.sendall(b"\x82" + size + mask + bytes(b ^ mask[k % 4] for k, b in enumerate(data)))

    def command(self, **what):
        self._send(COMMAND, json.dumps(what).encode())

    def hand(self, depth_mm, speed_mm_per_s):
        self._send(HAND, struct.pack("<5f", depth_mm, speed_mm_per_s, 0, 0, 0))
