# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs commands of the program on file systems that are too small for their results, and judges how they end."""
import json
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import samples
from insert_case import BLOCK, FAST, PHANTOM, SMALL, block_mesh
from live_viewer import LiveViewer
from program import STYLET

HANGS_AFTER_S = 300
FILLER = "filler"
PAGE_KB = 4  # the smallest piece of a file system in memory
PLENTY_KB = 200_000

BODY = BLOCK.replace("[fixed]", 'regions = { tissue = "body", lump = "prostate" }\n[fluoroscopy]\npixels = 128\n[fixed]')
IMPLANT = """\
[patient]
source = "phantom"
[fixed]
outer = "sides"
[mesh]
nodes = 800
[plan]
file = "seeds.csv"
[procedure]
speed_mm_per_s = 60
pause_s = 0.5
drop_speed_mm_per_s = 20
retract_speed_mm_per_s = 60
[run]
dt_ms = 8
"""
SEEDS = """\
# source: i125_6711
# strength_U: 0.5
# prescription_Gy: 145
# template_origin_mm: 0.0 0.2 20.0
hole,retraction_mm,train
C4,5,S-1-S
"""
PLAN = {"format": "stylet-plan", "version": 1, "units": "mm", "frame": "LPS", "strength_U": 0.5, "source": "i125_6711",
        "prescription_Gy": 145, "seeds": [{"position_mm": [x, 0, z], "axis": [0, 0, 1]} for x in (-5, 5) for z in (-5, 5)]}

# Each command with its arguments, where DISK is the small file system, and the file without which nothing looks finished.
COMMANDS = {
    "info": (("info", "gland.json", "--json", "DISK/info.json"), "info.json"),
    "info_scenario": (("info", "gland.json", "--scenario", "-o", "DISK/case.toml"), "case.toml"),
    "phantom": (("phantom", "-o", "DISK/out"), "out/phantom.json"),
    "mesh": (("mesh", "gland.json", "--preset", "paper", "-o", "DISK/out.vtu"), "out.vtu"),
    "prepare": (("prepare", "block.toml", "-o", "DISK/case.stylet"), "case.stylet"),
    "insert": (("insert", "block.toml", "-o", "DISK/out", *FAST), "out/summary.json"),
    "dose": (("dose", "plan.json", "--structures", "structures.json", "-o", "DISK/out"), "out/dose.json"),
    "fluoro": (("fluoro", "body.toml", "-o", "DISK/out.mha"), "out.mha"),
    "image": (("image", "phantom.toml", "--set", "mesh.nodes=800", "-o", "DISK/out.png"), "out.png"),
    "image_volume": (("image", "phantom.toml", "--set", "mesh.nodes=800", "--all", "-o", "DISK/out.mha"), "out.mha"),
    "implant": (("implant", "implant.toml", "-o", "DISK/out"), "out/summary.json"),
    "bench": (("bench", "remesh", "--nodes", "125", "--json", "DISK/out.json"), "out.json"),
    "validate": (("validate", "--only", "patch_test", "-o", "DISK/out"), "out/validate.json"),
    "reproduce": (("reproduce", "--quick", "-o", "DISK/out"), "out/reproduce.json"),
    "serve": (("serve", "phantom.toml", *SMALL, "--models", "", "-o", "DISK/live"), None),
    "serve_cache": (("serve", "phantom.toml", *SMALL, "--models", "DISK/models", "-o", "live"), None),
}
QUICK = ("info", "info_scenario", "phantom", "mesh", "prepare", "insert", "dose", "fluoro")


def write_inputs(folder):
    """Writes the files that the commands read."""
    folder = Path(folder)
    samples.contour_json(folder / "gland.json")
    block_mesh(folder / "block.msh")
    for name, text in (("block.toml", BLOCK), ("body.toml", BODY), ("phantom.toml", PHANTOM), ("implant.toml", IMPLANT),
                       ("seeds.csv", SEEDS)):
        (folder / name).write_text(text, encoding="utf-8")
    (folder / "plan.json").write_text(json.dumps(PLAN), encoding="utf-8")
    (folder / "structures.json").write_text(json.dumps(samples.structure_set(samples.ball(14))), encoding="utf-8")


class Mounted:
    """A file system in memory with this much space. Needs the right to mount."""

    def __init__(self, size_kB):
        self.folder = tempfile.mkdtemp(prefix="stylet-disk-")
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size_kB + PAGE_KB}k", "tmpfs", self.folder], check=True,
                       capture_output=True)
        (Path(self.folder) / FILLER).write_bytes(bytes(1024 * PAGE_KB))  # a size of 0 would mean no limit
        self.limit = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        subprocess.run(["umount", "-l", self.folder], check=True)
        os.rmdir(self.folder)


class Limited:
    """A folder in which no file may be larger than this: the next best thing where nothing can be mounted."""

    def __init__(self, size_kB):
        self.temporary = tempfile.TemporaryDirectory(prefix="stylet-disk-")
        self.folder = self.temporary.name
        size = 1024 * size_kB
        self.limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.temporary.cleanup()


def small_disk():
    """The kind of small disk that this machine permits. Where only a user's own namespace may mount, the program that
    calls this starts anew in one."""
    try:
        with Mounted(64):
            return Mounted
    except (subprocess.CalledProcessError, FileNotFoundError):
        pass
    inside = ["unshare", "--user", "--map-root-user", "--mount"]
    try:
        able = subprocess.run([*inside, "mount", "-t", "tmpfs", "tmpfs", "/mnt"], capture_output=True, check=False).returncode == 0
    except FileNotFoundError:
        able = False
    if able and "STYLET_UNSHARED" not in os.environ:
        os.environ["STYLET_UNSHARED"] = "1"
        os.execvp("unshare", [*inside, sys.executable, "-B", *sys.argv])
    return Limited


class End:
    """How a run ended: its exit status, what it said on standard error without progress, and what it left."""

    def __init__(self, status, errors, files):
        self.status, self.errors, self.files = status, errors, files

    @property
    def lines(self):
        """What it said beside warnings."""
        return [line for line in self.errors if not line.startswith("stylet: warning: ")]


def push_for_a_moment(server):
    """Moves the needle of a server that has printed its address, if it is still there, and ends it."""
    text = ""
    while not text.endswith("\n}\n"):
        line = server.stdout.readline()
        if not line:
            return
        text += line
    try:
        viewer = LiveViewer(json.loads(text)["url"])
        viewer.command(do="take")
        end = time.monotonic() + 3
        while time.monotonic() < end and server.poll() is None:
            viewer.hand(40.0, 20.0)
            time.sleep(0.05)
        viewer.close()
    except OSError:
        pass
    server.send_signal(signal.SIGTERM)


def run_on(disk, name, inputs):
    """Runs a command with its results on a small disk. inputs: the folder of write_inputs()."""
    arguments, _ = COMMANDS[name]
    command = [STYLET, *(str(a).replace("DISK", disk.folder) for a in arguments)]
    is_server = name.startswith("serve")
    if is_server:
        command += ["--port", "0", "--json", "-", "--quiet"]
    meshes = {**os.environ, "STYLET_CACHE": str(Path(inputs) / "meshes")}
    with subprocess.Popen(command, cwd=inputs, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, preexec_fn=disk.limit, env=meshes) as process:
        if is_server:
            push_for_a_moment(process)
        _, errors = process.communicate(timeout=HANGS_AFTER_S)
    errors = [line for line in errors.splitlines() if not re.search(r"( \.\.\.|: \d+ %)$", line)]
    files = sorted(str(p.relative_to(disk.folder)) for p in Path(disk.folder).rglob("*") if p.name != FILLER)
    return End(process.returncode, errors, files)


def faults(name, end):
    """What is wrong with how a command ended on a small disk: sentences."""
    found = []
    marker = COMMANDS[name][1]
    if end.status not in (0, 1):
        found.append(f"exit status {end.status}")
    if end.status == 1 and len(end.lines) != 1:
        found.append(f"{len(end.lines)} lines")
    if end.status == 0 and end.lines:
        found.append("an error, but exit status 0")
    if end.status == 1 and not re.search(r"no space is left on the disk|File too large", "\n".join(end.errors)):
        found.append("says nothing of a full disk")
    if marker and (marker in end.files) != (end.status == 0):
        found.append(f"{marker} is {'there' if marker in end.files else 'missing'}")
    hidden = [file for file in end.files if Path(file).name.startswith(".")]
    if hidden:
        found.append(f"left {hidden}")
    return found


def needed_kB(kind, name, inputs):
    """The disk space that the command's results take, at least."""
    with kind(PLENTY_KB) as disk:
        end = run_on(disk, name, inputs)
        assert end.status == 0, (name, end.errors)
        sizes = [p.stat().st_blocks // 2 for p in Path(disk.folder).rglob("*") if p.name != FILLER]
        return max(PAGE_KB, sum(sizes) if kind is Mounted else max(sizes, default=0))


def sizes_kB(needed, count):
    """No space, and sizes from one page to a tenth more than is needed, each the same factor larger than the one before.
    There are fewer than `count` where these are too near each other."""
    last = max(1.1 * needed / PAGE_KB, 2)
    return sorted({0} | {PAGE_KB * round(last ** (k / (count - 2))) for k in range(count - 1)})
