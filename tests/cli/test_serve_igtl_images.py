#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures and the probe of stylet serve over OpenIGTLink, read by a client that shares no code with the program:
places of pictures, probe and needle have to agree."""
import math
import unittest

from igtl_images import PLACE_MM, Reception, dot, minus
from igtl_server import BASE, LinkedServe, along

PROBE = "ProbeToReference"
STEPPER = "StepperToReference"


class ServeIgtlImages(LinkedServe):
    def receive(self, port):
        return Reception(self.client(port))

    def move_probe(self, came, pose):
        """Moves the probe to a pose and waits for its picture."""
        def is_there():
            came.client.send_transform(STEPPER, pose)
            apart = max(math.dist(a, b) for a, b in zip(came.poses[PROBE], pose))
            return apart < PLACE_MM and came.is_at_probe()
        came.until(is_there)

    def bright_spot(self, image, point, reach_mm):
        """The mean place (right, down) [mm] from a point of the plane, of the pixels within reach that are nearly as
        bright as the brightest."""
        column, row, _ = image.locate(point)
        reach = round(reach_mm / image.mm)
        around = [(image.at(c, r), c, r) for c in range(round(column) - reach, round(column) + reach + 1)
                  for r in range(round(row) - reach, round(row) + reach + 1)]
        most = max(around)[0]
        bright = [(c, r) for value, c, r in around if value > most - 5]
        return tuple(image.mm * (sum(p[k] for p in bright) / len(bright) - at) for k, at in ((0, column), (1, row)))

    def test_pictures_lie_where_the_probe_is_and_show_the_needle(self):
        # The hole lies in the plane of symmetry, above the probe. Without probe.kind the probe looks but does not press;
        # a probe that presses moves the needle of the picture away from that of the loop.
        _, port = self.link("--hand", "igtl", "--set", "insertion.hole=\"D3\"")
        came = self.receive(port)
        image = came.next_image()
        self.assertGreater(image.columns, 100)
        self.assertLess(image.right[0], 0, "the patient's left, -x in RAS, is at the viewer's right")
        self.assertLess(image.down[1], 0, "anterior, +y in RAS, is up")
        self.assertGreater(max(image.pixels), 100)
        came.until(came.is_at_probe)

        # Pictures come one after the other while the loop goes on in real time: at 25 a second, 20 take 0.8 s.
        first = came.loop_s
        count = len(came.image_at)
        came.until(lambda: len(came.image_at) == count + 20)
        came.check_images()
        print(f"{20 / (came.loop_s - first):.1f} pictures per second of simulated time; "
              f"{came.checked} checksums were right")
        self.assertGreater(came.loop_s - first, 0.7, "the loop goes on while pictures are made")

        # The needle goes into the gland; the plane crosses its shaft behind its tip.
        hand = self.client(port)
        start = hand.transform(BASE)
        self.lead(hand, hand, start, 70.0)
        hand.close()
        came.until(lambda: math.dist(came.poses[BASE][3], start[3]) > 69.9)
        tip = came.shaft[-1]
        pose = came.poses[PROBE]
        axis = pose[2]
        self.assertGreater(dot(axis, came.poses["NeedleTipToReference"][2]), 0.98, "the needle runs along the probe")
        for behind_mm in (15.0, 8.0):
            ahead = dot(axis, minus(tip, pose[3])) - behind_mm
            self.move_probe(came, along(pose, ahead))
            offs = [came.image.locate(point)[2] for point in came.shaft]
            k = next(k for k in range(len(offs) - 1) if offs[k] * offs[k + 1] <= 0)
            share = offs[k] / (offs[k] - offs[k + 1])
            crossing = tuple(a + share * (b - a) for a, b in zip(came.shaft[k], came.shaft[k + 1]))
            right, down = self.bright_spot(came.image, crossing, 5.0)
            print(f"the needle's echo {behind_mm:.0f} mm behind the tip lies {right:.2f} mm to the right of its axis and "
                  f"{down:.2f} mm below it")
            self.assertLess(math.hypot(right, down), 1.0, "the needle's echo is at the needle")

        # A rolled pose, as a stepper can hold it, and one beside the rectum, where no stepper gets.
        there = came.poses[PROBE]
        roll = math.radians(20)
        x, y, z, origin = there
        rolled = [tuple(math.cos(roll) * a + math.sin(roll) * b for a, b in zip(x, y)),
                  tuple(math.cos(roll) * b - math.sin(roll) * a for a, b in zip(x, y)), z, origin]
        self.move_probe(came, rolled)
        self.assertGreater(abs(dot(came.image.right, y)), 0.3 * came.image.mm, "the picture is rolled with the probe")
        beside = [*rolled[:3], (origin[0] - 40.0, *origin[1:])]
        count = len(came.image_at)
        while len(came.image_at) < count + 10:
            came.client.send_transform(STEPPER, beside)
            came.take()
        self.assertLess(math.dist(came.poses[PROBE][3], origin), PLACE_MM, "the probe stays in the rectum")
        self.assertTrue(came.is_at_probe())

    def test_a_scenario_may_choose_the_sagittal_array(self):
        _, port = self.link("--set", "ultrasound.array=\"sagittal\"")
        came = self.receive(port)
        came.until(lambda: came.image and PROBE in came.poses)
        _, look, axis, origin = came.poses[PROBE]
        self.assertLess(abs(came.image.locate(origin)[2]), PLACE_MM)
        self.assertLess(max(abs(dot(axis, came.image.normal)), abs(dot(look, came.image.normal))), 1e-5)


if __name__ == "__main__":
    unittest.main()
