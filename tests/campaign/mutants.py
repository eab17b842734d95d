# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged and forged files of every format: each command that reads one ends with exit status 0 or 2 and one line,
within 20 s of processor time, and says neither control characters nor a library's words."""

import bases
import mutators
from ending import Attempt, faults_of, hidden_under, run, shell
from live import serve_for_a_moment
from part import AnyPart


class Part(AnyPart):
    count = 20_000

    def __init__(self, folder):
        super().__init__(folder)
        self.bases = bases.bases(self.blocks)

    def blocks(self, name):
        return self.measured("blocks", name, lambda: mutators.checked_blocks((self.folder / name).read_bytes()))

    def attempt(self, number, random, folder):
        base = self.bases[number % len(self.bases)]
        mutant = base.mutate((self.folder / base.name).read_bytes(), random)
        weights, commands = zip(*base.commands)
        command = random.choices(commands, weights)[0]
        bases.link(self.folder, folder)
        (folder / base.name).unlink()
        (folder / base.name).write_bytes(mutant)
        arguments = [base.name if part == "FILE" else part for part in command]
        end = serve_for_a_moment(arguments, folder) if command[0] == "serve" else run(arguments, folder)
        faults = faults_of(end, arguments=arguments)
        if end.status != 0 and (folder / "out").exists():
            faults.append("results of a run that failed")
        if hidden := hidden_under(folder):
            faults.append(f"left {hidden}")
        return Attempt(base.name, " ".join(command), shell(arguments), end, faults)
