# SPDX-License-Identifier: GPL-3.0-or-later
"""Random hands: a needle is moved for tens of seconds in all directions, gently and madly. All results are finite,
needle and tissue are in balance, and the same motion gives the same results. A motion that fails is shrunk."""
import csv
import json
import math

from ending import Attempt, faults_of, run, shell
from part import AnyPart

SECONDS = 20.0           # of simulated time in one attempt
SAMPLE_S = 0.005
START = (31.0, 32.0, -112.0)
IN_BALANCE = 1e-9
MOST_FORCE_N = 1e4
MOST_SHRINKING = 80      # runs
SCENARIO = """\
[patient]
source = "block.msh"
[fixed]
outer = "sides"
[tissue]
preset = "{preset}"
[needle]
length_mm = 100
model = "{model}"
bevel_deg = {bevel}
[template]
guide = {guide}
[[insertion]]
motion = "motion.csv"
[run]
dt_ms = 1
[output]
pictures = false
frames_per_s = 1
"""


def random_pieces(random):
    """A motion: pieces of (duration [s], depth [mm], x, y [mm], tilt about x and y, roll [deg]); each ends there."""
    madness = random.choice((0.2, 1.0, 1.0, 3.0))
    pieces, left = [], SECONDS
    while left > 0:
        seconds = min(left, random.choice((0.02, 0.1, 0.5, 1.0, 2.0)) * random.uniform(0.5, 1.5))
        left -= seconds
        pieces.append((seconds, random.choice((random.uniform(-10, 50), random.uniform(10, 45), 40.0)),
                       *(madness * random.gauss(0, 1.5) for _ in range(2)),
                       *(madness * random.gauss(0, 1.0) for _ in range(2)),
                       random.choice((0.0, random.uniform(-180, 180)))))
    return pieces


def pose(depth, x, y, tilt_x, tilt_y, roll):
    """Place and quaternion (w first) of the base."""
    half = [math.radians(angle) / 2 for angle in (tilt_x, tilt_y, roll)]
    (a, b, c), (s, t, u) = map(math.cos, half), map(math.sin, half)
    # Turns about x, then y, then the needle's axis.
    w, i, j, k = a * b, s * b, a * t, s * t
    return (START[0] + x, START[1] + y, START[2] + depth, w * c - k * u, i * c + j * u, j * c - i * u, w * u + k * c)


def motion(pieces):
    """The CSV of a motion, which begins outside of the tissue and goes from piece to piece in straight lines."""
    at, time_s = (-10.0, 0.0, 0.0, 0.0, 0.0, 0.0), 0.0
    lines = ["time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz"]
    for seconds, *to in pieces:
        steps = max(1, round(seconds / SAMPLE_S))
        for k in range(not time_s == 0, steps + 1):
            part = k / steps
            values = [a + part * (b - a) for a, b in zip(at, to)]
            lines.append(",".join(f"{value:.9g}" for value in (time_s + seconds * part, *pose(*values))))
        at, time_s = to, time_s + seconds
    return "\n".join(lines) + "\n"


class Part(AnyPart):
    count = 500

    def moved(self, folder, pieces, scenario, out="out"):
        """Runs a motion. Returns its end and its faults."""
        (folder / "case.toml").write_text(scenario, encoding="ascii")
        (folder / "motion.csv").write_text(motion(pieces), encoding="ascii")
        end = run(("insert", "case.toml", "-o", out), folder)
        faults = faults_of(end, allowed=(0,), most_seconds=120)
        if end.status == 0:
            faults += faults_in(folder / out)
        return end, faults

    def attempt(self, number, random, folder):
        (folder / "block.msh").hardlink_to(self.folder / "block.msh")
        scenario = SCENARIO.format(preset=random.choice(("typical", "typical", "linear", "soft")),
                                   model=random.choice(("beam", "beam", "springs")),
                                   bevel=random.choice((0, 20)), guide=random.choice(("false", "true")))
        pieces = random_pieces(random)
        end, faults = self.moved(folder, pieces, scenario)
        if not faults and number % 5 == 0:
            self.moved(folder, pieces, scenario, "again")
            if rows(folder / "out", without="step_us") != rows(folder / "again", without="step_us"):
                faults = ["the same motion gives other results"]
        elif faults:
            pieces = self.shrunk(folder, pieces, scenario, faults)
            self.moved(folder, pieces, scenario)
        return Attempt("motion", f"{len(pieces)} pieces, {sum(piece[0] for piece in pieces):.2f} s",
                       shell(("insert", "case.toml", "-o", "out")),
                       end, faults)

    def shrunk(self, folder, pieces, scenario, faults):
        """A shorter motion with the same kind of fault: without pieces that it does not need, and with shorter ones."""
        left = MOST_SHRINKING

        def still(candidate):
            nonlocal left
            left -= 1
            return left >= 0 and bool(candidate) and kinds(self.moved(folder, candidate, scenario)[1]) == kinds(faults)
        size = len(pieces) // 2
        while size >= 1 and left > 0:
            at = 0
            while at < len(pieces):
                candidate = pieces[:at] + pieces[at + size:]
                if still(candidate):
                    pieces = candidate
                else:
                    at += size
            size //= 2
        for k, piece in enumerate(pieces):
            for simple in ((piece[0] / 2, *piece[1:]), (*piece[:2], 0.0, 0.0, 0.0, 0.0, 0.0)):
                candidate = [*pieces[:k], simple, *pieces[k + 1:]]
                if simple != piece and still(candidate):
                    pieces = candidate
        return pieces


def kinds(faults):
    return sorted(fault.split(":")[0] for fault in faults)


def rows(folder, without=""):
    with (folder / "forces.csv").open(newline="", encoding="utf-8") as file:
        return [{name: text for name, text in row.items() if name != without} for row in csv.DictReader(file)]


def faults_in(folder):
    """What is wrong with the results of a run."""
    found = []
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    for name, value in summary["residual"].items():
        if not value < IN_BALANCE:
            found.append(f"residual {name}: {value}")
    for row in rows(folder):
        bad = [name for name, text in row.items() if name != "tip_state" and not math.isfinite(float(text))]
        if bad:
            found.append(f"not finite: {bad} at {row['time_s']} s")
            break
        if abs(float(row["force_axial_N"])) > MOST_FORCE_N:
            found.append(f"axial force: {row['force_axial_N']} N at {row['time_s']} s")
            break
    return found
