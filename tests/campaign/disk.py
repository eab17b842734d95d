# SPDX-License-Identifier: GPL-3.0-or-later
"""Every command with its results on small file systems of many sizes. It ends with exit status 0, or with 1 and one
line; it leaves no hidden file, and nothing that looks finished unless it is."""
import resource

import full_disk
from ending import Attempt, End
from part import AnyPart

SIZES = 20
NAMES = [*full_disk.QUICK, *(name for name in full_disk.COMMANDS if name not in full_disk.QUICK)]


def spent_s():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Part(AnyPart):
    count = SIZES * len(NAMES)
    inputs = "disk"
    prepare = staticmethod(full_disk.write_inputs)

    def __init__(self, folder):
        super().__init__(folder)
        self.kind = full_disk.small_disk()

    def needed_kB(self, name):
        """The space that the command needs."""
        return self.measured("needed_kB", name, lambda: full_disk.needed_kB(self.kind, name, self.folder))

    def attempt(self, number, _random, _folder):
        name = NAMES[number % len(NAMES)]
        size = full_disk.size_kB(self.needed_kB(name), number // len(NAMES) % SIZES, SIZES)
        before = spent_s()
        with self.kind(size) as disk:
            run = full_disk.run_on(disk, name, self.folder)
        end = End(run.status, "", "\n".join(run.errors), spent_s() - before, 0, False)
        command = f"mount -t tmpfs -o size={size}k tmpfs DISK; stylet {' '.join(full_disk.COMMANDS[name][0])}"
        return Attempt(name, f"{size} kB of {self.needed_kB(name)}", command, end, full_disk.faults(name, run))
