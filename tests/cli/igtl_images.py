#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Receives the pictures of stylet serve over OpenIGTLink with the Python standard library alone, checks every message
against the protocol, and prints how many pictures come in a second.

    tests/cli/igtl_images.py [SCENARIO] [--seconds S] [--set KEY=VALUE ...]
"""
import argparse
import json
import math
import os
import struct
import subprocess
import sys
import time
from pathlib import Path

from igtl_client import Client, crc64

IMAGE = struct.Struct(">HBBBB3H12f3H3H")
PLACE_MM = 1e-3   # single precision of coordinates of some 100 mm


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def minus(a, b):
    return tuple(x - y for x, y in zip(a, b))


class Image:
    """An IMAGE of one slice of grey values. Raises ValueError for a message that breaks the protocol."""

    def __init__(self, body):
        (version, components, scalar, endian, self.frame, self.columns, self.rows, slices,
         *numbers) = IMAGE.unpack(body[:IMAGE.size])
        matrix, offset, part = numbers[:12], numbers[12:15], numbers[15:]
        self.pixels = body[IMAGE.size:]
        self.right, self.down, self.out, self.middle = (tuple(matrix[k:k + 3]) for k in (0, 3, 6, 9))
        size = [self.columns, self.rows, slices]
        for good, why in (
                (version == 1, f"version {version} of an image"),
                (components == 1 and scalar == 3, f"{components} components of type {scalar}; 3 is uint8"),
                (endian in (1, 2, 3), f"byte order {endian}"),
                (self.frame == 1, f"the frame {self.frame}; 1 is RAS"),
                (slices == 1 and self.columns > 1 and self.rows > 1, f"the size {size}"),
                (offset == [0, 0, 0] and part == size, f"a part {part} at {offset} of {size}"),
                (len(self.pixels) == self.columns * self.rows, f"{len(self.pixels)} values for {size}")):
            if not good:
                raise ValueError(why)
        self.mm = math.sqrt(dot(self.right, self.right))
        self.normal = tuple(x / self.mm ** 2 for x in cross(self.right, self.down))
        for good, why in (
                (math.isclose(math.sqrt(dot(self.down, self.down)), self.mm, rel_tol=1e-5), "pixels that are no squares"),
                (abs(dot(self.right, self.down)) < 1e-5 * self.mm ** 2, "axes that are not at right angles"),
                (dot(self.out, self.normal) > 0, "a mirrored matrix"),
                (abs(dot(self.right, self.out)) + abs(dot(self.down, self.out)) < 1e-5 * self.mm ** 2,
                 "a third axis that is not the normal")):
            if not good:
                raise ValueError(why)

    def locate(self, point):
        """Column and row (with fractions) of a point [mm] RAS, and its distance from the plane [mm]."""
        from_middle = minus(point, self.middle)
        return (dot(from_middle, self.right) / self.mm ** 2 + 0.5 * (self.columns - 1),
                dot(from_middle, self.down) / self.mm ** 2 + 0.5 * (self.rows - 1),
                dot(from_middle, self.normal))

    def at(self, column, row):
        """The value of a pixel."""
        return self.pixels[row * self.columns + column]


def check_rotation(pose):
    """Raises ValueError unless a TRANSFORM is a rigid motion."""
    x, y, z, _ = pose
    if max(abs(dot(x, y)), abs(dot(y, z)), abs(dot(z, x)), *(abs(dot(a, a) - 1) for a in (x, y, z))) > 1e-5:
        raise ValueError("a TRANSFORM that is no rotation")
    if dot(cross(x, y), z) < 0:
        raise ValueError("a mirrored TRANSFORM")


class Reception:
    """Everything that has come over a connection: the newest of each kind, and what was counted."""

    def __init__(self, client):
        self.client = client
        self.poses = {}
        self.shaft = []
        self.image = None
        self.loop_s = None     # time of the loop, from BaseForce
        self.image_at = []     # (wall-clock time, loop time) of every image
        self.checked = 0       # checksums that were computed
        self.unchecked = []    # images whose checksums are computed by check_images()

    def take(self):
        """Receives and checks a message; returns its type and name."""
        kind, name, body, checksum = self.client.receive()
        if len(body) < 10_000:
            self.check(kind, body, checksum)
        elif kind == "IMAGE" and len(self.image_at) % 10 == 0:
            self.unchecked.append((kind, body, checksum))
        if kind == "TRANSFORM":
            numbers = struct.unpack(">12f", body)
            self.poses[name] = [numbers[3 * k:3 * k + 3] for k in range(4)]
            check_rotation(self.poses[name])
        elif kind == "POINT" and name == "NeedleShaft":
            # 136 bytes a point: name, group, colour, then the position.
            self.shaft = [struct.unpack(">3f", body[k + 100:k + 112]) for k in range(0, len(body), 136)]
        elif kind == "STRING" and name == "BaseForce":
            self.loop_s = json.loads(body[4:].decode())["time_s"]
        elif kind == "IMAGE":
            self.image = Image(body)
            self.image_at.append((time.monotonic(), self.loop_s))
        return kind, name

    def check(self, kind, body, checksum):
        """Raises ValueError for a wrong checksum."""
        self.checked += 1
        if crc64(body) != checksum:
            raise ValueError(f"{kind} with a wrong checksum")

    def check_images(self):
        """Computes the checksum of one image of ten that have come: afterwards, since each takes Python a tenth of a
        second."""
        while self.unchecked:
            self.check(*self.unchecked.pop())

    def next_image(self):
        """The next image."""
        while self.take()[0] != "IMAGE":
            pass
        return self.image

    def until(self, true):
        """Receives messages until a condition of this object holds."""
        while not true():
            self.take()

    def is_at_probe(self):
        """Whether the image is that of the transverse array at the pose of the probe: normal to the probe's axis, with
        its side to the left, and with the probe's origin in its plane and on its middle column."""
        if not self.image or "ProbeToReference" not in self.poses:
            return False
        side, _, axis, origin = self.poses["ProbeToReference"]
        column, _, off = self.image.locate(origin)
        return (abs(off) < PLACE_MM and abs(column - 0.5 * (self.image.columns - 1)) * self.image.mm < 0.51 * self.image.mm
                and dot(side, self.image.right) < -(1 - 1e-6) * self.image.mm
                and abs(dot(axis, self.image.normal)) > 1 - 1e-6)


def main():
    parser = argparse.ArgumentParser(description="Counts the pictures of stylet serve over OpenIGTLink.")
    parser.add_argument("scenario", nargs="?", default="scenarios/demo.toml")
    parser.add_argument("--seconds", type=int, default=10, help="how long to count")
    parser.add_argument("--set", action="append", default=[], help="as for stylet serve")
    arguments = parser.parse_args()
    stylet = os.environ.get("STYLET", str(Path(__file__).parents[2] / "build" / "bin" / "stylet"))
    server = subprocess.Popen([stylet, "serve", arguments.scenario, "--port", "0", "--igtl", "0", "--json", "-",
                               *(word for text in arguments.set for word in ("--set", text))],
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        text = ""
        while not text.endswith("\n}\n"):
            line = server.stdout.readline()
            if not line:
                sys.exit(f"{stylet} serve has ended")
            text += line
        came = Reception(Client.to(json.loads(text)["igtl"]["port"]))
        came.next_image()
        came.until(lambda: came.image_at[-1][0] - came.image_at[0][0] > 10)  # the tissue's motion is being prepared
        begin, begin_loop = came.image_at[-1]
        came.image_at.clear()
        came.until(lambda: came.image_at and came.image_at[-1][0] - begin > arguments.seconds)
    finally:
        server.terminate()
        server.wait()
    came.check_images()
    end, end_loop = came.image_at[-1]
    image = came.image
    gaps = sorted(b[0] - a[0] for a, b in zip(came.image_at, came.image_at[1:]))
    print(f"Images of {image.columns} × {image.rows} pixels of {image.mm:.2f} mm, {came.checked} checksums were right.")
    print(f"{len(came.image_at) / (end - begin):.1f} images per second over {end - begin:.1f} s; from image to image "
          f"{1e3 * gaps[len(gaps) // 2]:.0f} ms (median), at most {1e3 * gaps[-1]:.0f} ms.")
    print(f"Meanwhile the simulated time went on by {end_loop - begin_loop:.2f} s.")


if __name__ == "__main__":
    main()
