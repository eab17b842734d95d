# SPDX-License-Identifier: GPL-3.0-or-later
"""Insert, implant and serve are killed (SIGKILL) or told to end (SIGTERM, SIGINT) at any moment. What they leave is
absent or complete, the next run removes what is unfinished, and a recording lacks at most half a second."""
import json
import shutil
import signal
import tempfile
import threading
import time

import bases
from ending import Attempt, faults_of, files_under, hidden_under, run, shell, start, wait
from live import Server, until
from part import AnyPart

MOST_LOST_S = 0.5
COMMANDS = {
    "insert": ("insert", "block.toml", "-o", "out", *bases.QUICK),
    "implant": ("implant", "implant.toml", "-o", "out"),
}
SIGNALS = (signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT)


def killed(command, folder, after_s, how):
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        process = start(command, folder, out, err)
        timer = threading.Timer(after_s, process.send_signal, (how,))
        timer.start()
        end = wait(process, out, err)
        timer.cancel()
    return end


def move(page, seconds):
    """Moves the needle of a page for this time. Returns faults."""
    if not page.ready():
        return [f"the case is not ready: {page.status}"]
    page.command(do="take")
    # Again and again, as a page does: what comes before the needle exists is ignored.
    if not until(lambda: page.hand(40.0, 8.0) or page.time_s > 0.1):
        return ["the needle does not move"]
    end_s = page.time_s + seconds
    return [] if until(lambda: page.hand(40.0, 8.0) or page.time_s >= end_s) else ["the needle does not go on"]


class Part(AnyPart):
    count = 1_000

    def seconds(self, name, folder):
        """How long a command takes undisturbed."""
        def measure():
            begin = time.monotonic()
            run(COMMANDS[name], folder)
            shutil.rmtree(folder / "out")
            return time.monotonic() - begin
        return self.measured("seconds", name, measure)

    def attempt(self, number, random, folder):
        bases.link(self.folder, folder)
        how = SIGNALS[number // 2 % len(SIGNALS)]
        if number % 2:
            return self.of_server(random, folder, how)
        return self.of_command(random.choice(list(COMMANDS)), random, folder, how)

    def of_command(self, name, random, folder, how):
        after_s = random.uniform(0.0, 1.1) * self.seconds(name, folder)
        end = killed(COMMANDS[name], folder, after_s, how)
        own = end.status != 0
        faults = [] if end.status == -how else faults_of(end, allowed=(0, 1))
        if own and (folder / "out/summary.json").exists() and run(("info", "out/run.h5"), folder).status != 0:
            faults.append("it looks complete, but its recording cannot be read")
        again = run(COMMANDS[name], folder)
        faults += [f"next run: {fault}" for fault in faults_of(again, allowed=(0,))]
        if hidden := hidden_under(folder):
            faults.append(f"the next run left {hidden}")
        if "out/summary.json" not in files_under(folder):
            faults.append("the next run has no results")
        return Attempt(f"{name} {how.name}", f"after {after_s:.3f} s", shell(COMMANDS[name]),
                       end if not own else again, faults)

    def of_server(self, random, folder, how):
        """A server whose needle moves is ended."""
        after_s = random.uniform(0.05, 3.0)
        server = Server(("serve", "block.toml"), folder)
        faults, heard_s = [], 0.0
        if not server.opened():
            faults.append("the server did not start")
        else:
            try:
                page = server.page()
                faults += move(page, after_s)
                heard_s = page.time_s
                server.stop(how)
                page.close()
            except OSError as error:
                faults.append(f"the page was cut off: {error}")
        end = server.stop(how)
        if end.status != (-how if how == signal.SIGKILL else 0):
            faults.append(f"it ended with {end.name}")
        recordings = sorted((folder / "live").glob("*/run.h5"))
        if not recordings:
            faults.append("no recording")
        else:
            said = run(("info", recordings[-1], "--json", "-"), folder)
            faults += faults_of(said, allowed=(0,))
            lost_s = heard_s - (json.loads(said.out)["duration_s"] if said.status == 0 else 0.0)
            if lost_s > MOST_LOST_S:
                faults.append(f"{lost_s:.2f} s of the recording are lost")
        return Attempt(f"serve {how.name}", f"after {after_s:.3f} s", shell(server.arguments),
                       said if recordings else end, faults)
