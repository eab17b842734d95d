# SPDX-License-Identifier: GPL-3.0-or-later
"""A client for OpenIGTLink with header version 1, used by tests as a tracker or a display."""
import json
import socket
import struct

HEADER = struct.Struct(">H12s20sQQQ")  # version, type, name, time stamp, bytes of the body, checksum of the body
POLYNOMIAL = 0x42F0E1EBA9EA3693        # CRC-64 of ECMA-182, most significant bit first


def remainder(value):
    """The remainder of eight bits that are at the top of a value."""
    for _ in range(8):
        value = (value << 1 ^ (POLYNOMIAL if value >> 63 else 0)) & (1 << 64) - 1
    return value


REMAINDERS = [remainder(byte << 56) for byte in range(256)]


def crc64(data):
    value = 0
    for byte in data:
        value = (value << 8 & (1 << 64) - 1) ^ REMAINDERS[value >> 56 ^ byte]
    return value


def message(kind, name, body):
    return HEADER.pack(1, kind.encode(), name.encode(), 0, len(body), crc64(body)) + body


class Client:
    """A connection. Positions are in mm, RAS."""

    def __init__(self, connection):
        self.connection = connection
        self.connection.settimeout(120)

    @classmethod
    def to(cls, port):
        return cls(socket.create_connection(("127.0.0.1", port)))

    def close(self):
        self.connection.close()

    def send_transform(self, name, columns):
        """Sends a TRANSFORM. @param columns: three axes and the origin, three numbers each."""
        body = struct.pack(">12f", *(value for column in columns for value in column))
        self.connection.sendall(message("TRANSFORM", name, body))

    def read(self, count):
        data = memoryview(bytearray(count))
        have = 0
        while have < count:
            part = self.connection.recv_into(data[have:])
            if part == 0:
                raise ConnectionError("the other side has closed")
            have += part
        return bytes(data)

    def receive(self):
        """The next message: its type, its name, its body, and the checksum that came with it."""
        version, kind, name, _, size, checksum = HEADER.unpack(self.read(HEADER.size))
        if version not in (1, 2):
            raise ValueError(f"a message of version {version}")
        return kind.rstrip(b"\0").decode(), name.rstrip(b"\0").decode(), self.read(size), checksum

    def next(self, kind, name):
        """The body of the next message of this type and name."""
        while True:
            its_kind, its_name, body, checksum = self.receive()
            if (its_kind, its_name) != (kind, name):
                continue
            if len(body) < 1000 and crc64(body) != checksum:
                raise ValueError(f"{kind} {name} with a wrong checksum")
            return body

    def transform(self, name):
        """The next TRANSFORM of this name: three axes and the origin."""
        numbers = struct.unpack(">12f", self.next("TRANSFORM", name))
        return [numbers[3 * k:3 * k + 3] for k in range(4)]

    def force(self):
        """The next text of BaseForce, parsed as JSON."""
        return json.loads(self.next("STRING", "BaseForce")[4:].decode())

    def status(self):
        """The code of the next heartbeat: 1 OK, 13 not ready."""
        return struct.unpack(">H", self.next("STATUS", "Stylet")[:2])[0]

    def surface(self):
        """The points of the next surface as bytes (three big-endian floats each), and its number of triangles."""
        body = self.next("POLYDATA", "TissueSurface")
        header = struct.unpack(">10I", body[:40])
        return body[40:40 + 12 * header[0]], header[5]
