# SPDX-License-Identifier: GPL-3.0-or-later
"""Calls of the system that fail: the n-th write, open, rename, fsync, fork, mmap or malloc of a command. It ends with
0, 1 or 2 and at most one line of error, and nothing looks complete that is not."""
import errno
import math
import subprocess
import tempfile
from pathlib import Path

import bases
from ending import Attempt, faults_of, files_under, hidden_under, run, shell
from part import AnyPart

CALLS = {"write": (errno.ENOSPC, errno.EIO), "open": (errno.EMFILE, errno.EACCES, errno.ENOSPC),
         "rename": (errno.ENOSPC, errno.EIO),
         "sync": (errno.EIO, errno.ENOSPC), "fork": (errno.EAGAIN, errno.ENOMEM), "mmap": (errno.ENOMEM,),
         "malloc": (errno.ENOMEM,)}
# Each command, and the file without which nothing looks finished.
COMMANDS = {
    "info": (("info", "rtstruct.dcm", "--json", "out.json"), "out.json"),
    "info_scenario": (("info", "gland.json", "--scenario", "-o", "out.toml"), "out.toml"),
    "mesh": (("mesh", "two.msh", "-o", "out.vtu"), "out.vtu"),
    "prepare": (("prepare", "block.toml", "-o", "out.stylet"), "out.stylet"),
    "insert": (("insert", "block.toml", "-o", "out", *bases.QUICK), "out/summary.json"),
    "insert_saved": (("insert", "block.stylet", "-o", "out", *bases.QUICK), "out/summary.json"),
    "insert_again": (("insert", "run.h5", "-o", "out"), "out/summary.json"),
    "dose": (("dose", "rtplan.dcm", "--source", "i125_6711", "--structures", "structures.json", "-o", "out",
              *bases.DOSE), "out/dose.json"),
    "implant": (("implant", "implant.toml", "-o", "out"), "out/summary.json"),
    "phantom": (("phantom", "-o", "out"), "out/phantom.json"),
}


class Part(AnyPart):
    count = 7_000

    def __init__(self, folder):
        super().__init__(folder)
        self.library = folder / "fault.so"
        if not self.library.exists():
            subprocess.run(["cc", "-O1", "-shared", "-fPIC", "-o", self.library, Path(__file__).with_name("fault.c"),
                            "-ldl"], check=True)

    def calls(self, name, call, folder):
        """How often a command makes a call, or one of the program that reads files for it."""
        log = folder / "log"
        run(COMMANDS[name][0], folder, {"LD_PRELOAD": str(self.library), "FAULT_CALL": call, "FAULT_LOG": str(log)})
        return max(map(int, log.read_text(encoding="ascii").split()))

    def attempt(self, number, random, folder):
        name = random.choice(list(COMMANDS))
        call = list(CALLS)[number % len(CALLS)]
        command, marker = COMMANDS[name]
        with tempfile.TemporaryDirectory() as undisturbed:
            bases.link(self.folder, Path(undisturbed))
            calls = self.measured("calls", f"{name} {call}", lambda: self.calls(name, call, Path(undisturbed)))
        nth = round(math.exp(random.uniform(0, math.log(max(calls, 1)))))
        settings = {"LD_PRELOAD": str(self.library), "FAULT_CALL": call, "FAULT_NTH": str(nth),
                    "FAULT_ERRNO": str(random.choice(CALLS[call]))}
        if call not in ("malloc", "mmap") and random.random() < 0.3:
            settings["FAULT_EVER"] = "1"
        bases.link(self.folder, folder)
        end = run(command, folder, settings)
        faults = faults_of(end, allowed=(0, 1, 2))
        files = files_under(folder)
        if (marker in files) != (end.status == 0):
            faults.append(f"{marker} is {'there' if marker in files else 'missing'}")
        if hidden := hidden_under(folder):
            faults.append(f"left {hidden}")
        what = f"{name}, call {nth} of {calls}, {errno.errorcode[int(settings['FAULT_ERRNO'])]}"
        return Attempt(call, what + ", and all later ones" * ("FAULT_EVER" in settings), shell(command, settings), end,
                       faults)
