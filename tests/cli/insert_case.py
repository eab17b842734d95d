# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenarios for tests of stylet insert, and checks of the result files that every finished run must have."""
import csv
import json
import math
import re
from pathlib import Path

import samples
from program import InFolder

# A small case that runs in one or two seconds.
FAST = ("--set", "run.dt_ms=4", "--set", "output.pictures=false", "--set", "output.frames_per_s=2")
SMALL = ("--set", "mesh.nodes=800", *FAST)

PHANTOM = """\
[patient]
source = "phantom"
[fixed]
outer = "sides"
[[insertion]]
hole = "e3.5"
speed_mm_per_s = 40
dwell_s = 0.1
retract_speed_mm_per_s = 40
"""


def documented_columns(table):
    """The columns of a table as its documents list them; a test of the library compares that list with the code."""
    page = (Path(__file__).resolve().parents[2] / "docs/results/insertion.md").read_text(encoding="utf-8")
    listed = page.split(f"\n## {table}\n")[1].split("\n## ")[0]
    names = [re.match(r"- ((`\w+`(, )?)+)", line) for line in listed.splitlines()]
    return [name for found in names if found for name in re.findall(r"\w+", found[1])]


FORCES_HEADER = documented_columns("forces.csv")
TIP_STATES = {"air", "pressing", "cutting", "in_track", "bone", "exited"}
FULL_INSERTION = ["skin_contact", "puncture", "region_entered", "retraction_start", "slip_start", "withdrawn"]


def block_mesh(path, cells=4, size=60.0, names=("tissue", "lump"), last_layer=None):
    """A gmsh MSH 2.2 file in mm: a cube from (0, 0, 0) with six tetrahedra per cell; the second region is its centre.
    If `last_layer` is given, it is the thickness of the last layer of cells along z."""
    n = cells + 1
    step = size / cells
    heights = [k * step for k in range(n)]
    if last_layer is not None:
        heights[-1] = heights[-2] + last_layer
    nodes = [(i * step, j * step, z) for z in heights for j in range(n) for i in range(n)]
    tets = []
    for k in range(cells):
        for j in range(cells):
            for i in range(cells):
                corner = lambda a: (i + (a & 1)) + n * ((j + (a >> 1 & 1)) + n * (k + (a >> 2 & 1)))
                group = 2 if all(0 < c < cells - 1 for c in (i, j, k)) else 1
                for a, b in ((1, 3), (3, 2), (2, 6), (6, 4), (4, 5), (5, 1)):
                    tets.append((group, (corner(0), corner(a), corner(b), corner(7))))
    samples.gmsh(path, names, nodes, tets)


BLOCK = """\
[patient]
source = "block.msh"
[fixed]
outer = "sides"
[needle]
length_mm = 100
[[insertion]]
entry_mm = [31, 32, -10]
depth_mm = 40
speed_mm_per_s = 40
retract_speed_mm_per_s = 40
"""


def forces(folder):
    """The rows of forces.csv, with numbers converted."""
    with open(Path(folder) / "forces.csv", newline="", encoding="utf-8") as file:
        lines = list(csv.DictReader(file))
    for line in lines:
        for key, value in line.items():
            if key != "tip_state":
                line[key] = float(value)
    return lines


def without_step_times(folder):
    """The rows of forces.csv as texts, without the column step_us."""
    with open(Path(folder) / "forces.csv", newline="", encoding="utf-8") as file:
        return [{name: text for name, text in row.items() if name != "step_us"} for row in csv.DictReader(file)]


def gland_path(folder):
    """The rows of gland.csv, with numbers converted."""
    with open(Path(folder) / "gland.csv", newline="", encoding="utf-8") as file:
        return [{key: float(value) for key, value in line.items()} for line in csv.DictReader(file)]


def check_gland(test, folder, summary):
    """Checks that the gland's motion in summary.json agrees with gland.csv and with the steps and events."""
    gland, path, steps = summary["gland"], gland_path(folder), forces(folder)
    test.assertEqual([(p["time_s"], p["base_depth_mm"]) for p in path],
                     [(s["time_s"], s["base_depth_mm"]) for s in steps])

    def norm(line):
        return math.hypot(*(line[f"shift_{axis}_mm"] for axis in ("LR", "AP", "SI")))

    def same(shift, line):
        for axis in ("LR", "AP", "SI"):
            test.assertAlmostEqual(shift[axis], line[f"shift_{axis}_mm"], delta=1e-6)
        test.assertAlmostEqual(shift["norm"], norm(line), delta=2e-6)

    deepest = max(range(len(path)), key=lambda k: (path[k]["base_depth_mm"], k))
    same(gland["shift_in_place_mm"], path[deepest])
    largest = max(path[:deepest + 1], key=norm)
    test.assertAlmostEqual(gland["shift_max_mm"]["norm"], norm(largest), delta=2e-6)
    for plane in ("coronal", "sagittal", "transverse"):
        test.assertAlmostEqual(gland["rotation_deg"][plane], largest[f"rotation_{plane}_deg"], delta=1e-3)
    broken = [e["time_s"] for e in summary["events"] if (e["kind"], e["region"]) == ("puncture", "prostate")]
    same(gland["shift_at_break_mm"], [p for p in path if p["time_s"] < broken[0] - 1e-7][-1])
    parts = [gland[part]["SI"] for part in ("base_mm", "mid_mm", "apex_mm")]
    test.assertTrue(min(parts) < gland["shift_max_mm"]["SI"] < max(parts), gland)
    return gland


def kinds(summary):
    return [event["kind"] for event in summary["events"]]


def check_results(test, folder, summary=None, pictures=False):
    """Checks that every documented result file exists and is valid. Returns the summary."""
    folder = Path(folder)
    for name in ("summary.json", "forces.csv", "tissue.pvd", "needle.vtp", "run.h5", "report.html"):
        test.assertTrue((folder / name).is_file(), name)
        test.assertGreater((folder / name).stat().st_size, 100, name)
    test.assertTrue(list(folder.glob("tissue_*.vtu")))
    test.assertEqual([p.name for p in folder.iterdir() if p.name.startswith(".") or p.name.endswith(".part")], [])
    written = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    if summary is not None:
        test.assertEqual(written, summary)
    for key in ("version", "scenario", "mesh", "steps", "peak_force_N", "events", "tip_deflection_mm",
                "tip_error_mm", "target_shift_mm", "gland", "residual", "step_us", "contacts_max", "capacity", "mesh_changes", "warnings"):
        test.assertIn(key, written)
    test.assertEqual(set(written["mesh"]), {"nodes", "tets"})
    test.assertEqual(set(written["peak_force_N"]), {"axial", "sagittal", "lateral"})
    test.assertEqual(set(written["step_us"]), {"p50", "p99", "p999", "max"})
    test.assertLess(written["residual"]["force_balance"], 1e-9)
    test.assertLess(written["residual"]["torque_balance"], 1e-9)
    for event in written["events"]:
        test.assertEqual(set(event), {"kind", "time_s", "depth_mm", "force_N", "region"})

    lines = forces(folder)
    test.assertEqual(list(lines[0]), FORCES_HEADER)
    test.assertEqual(len(lines), written["steps"])
    for line in lines:
        test.assertIn(line["tip_state"], TIP_STATES)
        test.assertTrue(all(math.isfinite(v) for k, v in line.items() if k != "tip_state"), line)
    test.assertAlmostEqual(max(abs(line["force_axial_N"]) for line in lines), written["peak_force_N"]["axial"], places=8)
    test.assertEqual(max(line["contacts"] for line in lines), written["contacts_max"])
    test.assertEqual(set(written["capacity"]), {"contacts", "spare_nodes", "tracks", "events"})
    for use in written["capacity"].values():
        test.assertLessEqual(use["most"], use["room"])
    shaft = written["capacity"]["contacts"]["most"]  # without the tip
    test.assertTrue(written["contacts_max"] - 1 <= shaft <= written["contacts_max"], written["capacity"])

    report = (folder / "report.html").read_text(encoding="utf-8")
    test.assertIn("<html", report)
    test.assertNotIn("src=\"http", report, "the report stands alone")
    if pictures:
        test.assertIn("data:image/", report)
    return written


class Cases(InFolder):
    """A folder with the scenarios block.toml, of the mesh block.msh, and phantom.toml."""

    def setUp(self):
        super().setUp()
        block_mesh(self.folder / "block.msh")
        self.write("block.toml", BLOCK)
        self.write("phantom.toml", PHANTOM)
