# SPDX-License-Identifier: GPL-3.0-or-later
"""A server of the campaign, and a page that holds its needle and reads what the server sends."""
import json
import os
import signal
import struct
import tempfile
import threading
import time

from ending import start, wait
from live_viewer import SEEN, LiveViewer

FRAME, STATUS = 2, 3
PATIENCE_S = 60


def until(true, patience_s=PATIENCE_S):
    """Waits until something is true. Returns whether it is."""
    end = time.monotonic() + patience_s
    while time.monotonic() < end:
        if true():
            return True
        time.sleep(0.02)
    return False


class Server:
    """stylet serve in a session of its own, with its texts in files."""

    def __init__(self, arguments, folder, environment=None):
        self.out, self.err = tempfile.TemporaryFile(), tempfile.TemporaryFile()
        self.folder = folder
        self.arguments = [*arguments, "--port", "0", "--models", "models", "-o", "live", "--json", "-"]
        self.process = start(self.arguments, folder, self.out, self.err, environment)
        self.said = None
        self.end = None

    def running(self):
        """Whether it runs, without waiting."""
        return self.end is None and os.waitid(os.P_PID, self.process.pid, os.WEXITED | os.WNOHANG | os.WNOWAIT) is None

    def opened(self):
        """Waits for its address. Returns false if it ended before."""
        def address():
            self.out.seek(0)
            text = self.out.read().decode("utf-8", "replace")
            if text.endswith("\n}\n"):
                self.said = json.loads(text)
            return self.said or not self.running()
        return until(address) and self.said is not None

    def page(self):
        return Page(self.said["url"])

    def megabytes(self):
        with open(f"/proc/{self.process.pid}/status", encoding="utf-8") as file:
            return next(int(line.split()[1]) // 1024 for line in file if line.startswith("VmRSS"))

    def stop(self, how=signal.SIGTERM, patience_s=PATIENCE_S):
        """Sends a signal and waits for the end."""
        if self.end is None:
            if self.running():
                self.process.send_signal(how)
            self.end = wait(self.process, self.out, self.err, patience_s)
            self.out.close()
            self.err.close()
        return self.end


class Page(LiveViewer):
    """A page that reads: the newest status and the newest frame's time and number of steps."""

    def __init__(self, url):
        self.status, self.time_s, self.steps, self.alive = {}, 0.0, 0, True
        super().__init__(url)
        self.socket.settimeout(PATIENCE_S)
        threading.Thread(target=self._listen, daemon=True).start()

    def _exactly(self, count):
        data = b""
        while len(data) < count:
            part = self.socket.recv(count - len(data))
            if not part:
                raise ConnectionError
            data += part
        return data

    def _listen(self):
        try:
            while True:
                kind, size = self._exactly(2)
                size = {126: lambda: int.from_bytes(self._exactly(2), "big"),
                        127: lambda: int.from_bytes(self._exactly(8), "big")}.get(size, lambda: size)()
                body = self._exactly(size)
                if kind & 15 == 2 and size >= 8:
                    self._take(body)
        except (OSError, ValueError):
            self.alive = False

    def _take(self, body):
        kind, number = struct.unpack_from("<II", body)
        if kind == FRAME:
            self.time_s, = struct.unpack_from("<d", body, 8)
            self.steps, = struct.unpack_from("<I", body, 32)
        if kind == STATUS:
            self.status = json.loads(body[8:])
        self._send(SEEN, struct.pack("<I", number))

    def ready(self, patience_s=PATIENCE_S):
        """Waits until the case is ready or has failed. Returns whether it is ready."""
        until(lambda: self.status.get("state") in ("ready", "failed") or not self.alive, patience_s)
        return self.status.get("state") == "ready"


def serve_for_a_moment(arguments, folder):
    """Serves an input until it is ready or has failed, plays or moves for a moment, and ends the server."""
    server = Server(arguments, folder)
    if server.opened():
        try:
            page = server.page()
            if page.ready():
                page.command(do="take")
                page.command(do="play", rate=10)
                page.hand(20.0, 40.0)
                time.sleep(0.3)
                page.command(do="seek", time_s=1e9)
                time.sleep(0.1)
            page.close()
        except OSError:
            pass  # its end says why
    return server.stop()
