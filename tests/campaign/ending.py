# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the built program and judges how it ends. The environment variable STYLET names the program."""
import os
import re
import shlex
import signal
import subprocess
import tempfile
import threading
from dataclasses import dataclass, field
from pathlib import Path

from words import FOREIGN, harmful

STYLET = os.environ["STYLET"]
MOST_SECONDS = 20    # of processor time, which does not depend on what else the machine does
HANGS_AFTER_S = 300
NO_ERROR = re.compile(r"stylet: (?!error: )|.*( \.\.\.|: \d+ %)$")  # warnings, estimates and progress
QUOTED = re.compile(r"'[^'\n]*'|\"[^\"\n]*\"")


@dataclass
class End:
    """How a run ended: status (negative: the signal), texts, processor time [s], largest memory [MB]."""
    status: int
    out: str
    err: str
    seconds: float
    megabytes: int
    hung: bool

    @property
    def name(self):
        return "stopped" if self.hung else signal.Signals(-self.status).name if self.status < 0 else str(self.status)

    @property
    def errors(self):
        """The lines of standard error without warnings, estimates and progress."""
        return [line for line in self.err.splitlines() if not NO_ERROR.match(line)]


@dataclass
class Attempt:
    """One attempt of a part: its kind, what was tried, the shell command that repeats it, its end, and its faults."""
    kind: str
    what: str
    command: str
    end: End
    faults: list = field(default_factory=list)


def shell(arguments, environment=None):
    """The shell command of a run, for whoever wants to repeat it."""
    settings = [f"{name}={shlex.quote(value)}" for name, value in (environment or {}).items()]
    return " ".join([*settings, "stylet", *(shlex.quote(str(a)) for a in arguments)])


def start(arguments, folder, out, err, environment=None):
    return subprocess.Popen([STYLET, *map(str, arguments)], cwd=folder, stdin=subprocess.DEVNULL, stdout=out,
                            stderr=err,
                            env={**os.environ, **(environment or {})}, start_new_session=True)


def wait(process, out, err, hangs_after_s=HANGS_AFTER_S):
    """Waits for a process of start(), whose texts are in two files, and ends it when it hangs."""
    hung = threading.Event()

    def end():
        hung.set()
        os.killpg(process.pid, signal.SIGKILL)
    timer = threading.Timer(hangs_after_s, end)
    timer.start()
    _, status, usage = os.wait4(process.pid, 0)
    timer.cancel()
    process.returncode = os.waitstatus_to_exitcode(status)
    texts = []
    for file in (out, err):
        file.seek(0)
        texts.append(file.read().decode("utf-8", "surrogateescape"))
    return End(process.returncode, *texts, usage.ru_utime + usage.ru_stime, usage.ru_maxrss // 1024, hung.is_set())


def run(arguments, folder, environment=None, hangs_after_s=HANGS_AFTER_S):
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        return wait(start(arguments, folder, out, err, environment), out, err, hangs_after_s)


def faults_of(end, allowed=(0, 2), arguments=(), most_seconds=MOST_SECONDS):
    """What is wrong with how a run ended: sentences. Words that the arguments or quoted texts have may be anything."""
    found = []
    if end.hung:
        found.append("it hung")
    elif end.status < 0:
        found.append(f"signal {end.name}")
    elif end.status not in allowed:
        found.append(f"exit status {end.status}")
    if end.seconds > most_seconds:
        found.append("it took too long")
    if bad := harmful(end.out + end.err):
        found.append(f"control characters {bad[:5]}")
    said = end.err
    for argument in sorted(map(str, arguments), key=len, reverse=True):
        said = said.replace(argument, "…")
    if words := [word for word in FOREIGN if word in QUOTED.sub("…", said)]:
        found.append(f"words of a library: {words}")
    if end.status > 0 and (len(end.errors) != 1 or not end.errors[0].startswith("stylet: error: ")):
        found.append(f"{len(end.errors)} lines of error")
    if end.status == 0 and any(line.startswith("stylet: error: ") for line in end.errors):
        found.append("an error, but exit status 0")
    return found


def files_under(folder):
    return sorted(str(p.relative_to(folder)) for p in Path(folder).rglob("*"))


def hidden_under(folder):
    """Files of a run that has not ended well."""
    return [name for name in files_under(folder) if Path(name).name.startswith(".") or name.endswith(".part")]
