# SPDX-License-Identifier: GPL-3.0-or-later
"""The results of the campaign: a table for each part, with a row for each attempt, and a summary of all of them."""
import collections
import csv

COLUMNS = ("attempt", "seed", "kind", "what", "status", "seconds", "megabytes", "said", "faults")


def is_word_of_library(fault):
    return fault.startswith(("words of a library", "control characters"))


class Book:
    """The table of one part. A row that a killed campaign left unfinished is cut off."""

    def __init__(self, path):
        self.path = path
        if not path.exists():
            path.write_text(",".join(COLUMNS) + "\n", encoding="utf-8")
        text = path.read_bytes()
        if not text.endswith(b"\n"):
            path.write_bytes(text[:text.rfind(b"\n") + 1])
        self.rows = read(path)

    def append(self, number, seed, attempt):
        end = attempt.end
        said = end.errors[-1] if end.errors else ""
        row = dict(zip(COLUMNS, map(one_line, (number, seed, attempt.kind, attempt.what, end.name, f"{end.seconds:.2f}",
                                               end.megabytes, said[:300], "; ".join(attempt.faults)))))
        with self.path.open("a", newline="", encoding="utf-8") as file:
            csv.DictWriter(file, COLUMNS, lineterminator="\n").writerow(row)
        self.rows.append(row)
        return row


def one_line(value):
    return "".join(c if c.isprintable() else "�" for c in str(value))


def read(path):
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def summary(folder):
    """The Markdown table of all parts that the folder has, and a list of the faults."""
    lines = ["| part | attempts | exits | signals | longest [s] | most memory [MB] | bad words | with a fault |",
             "|---|---|---|---|---|---|---|---|"]
    kinds, faulty = [], []
    for path in sorted(folder.glob("*.csv")):
        rows = read(path)
        if not rows:
            continue
        exits = collections.Counter(row["status"] for row in rows)
        faults = [row for row in rows if row["faults"]]
        every = [fault for row in faults for fault in row["faults"].split("; ")]
        lines.append("| " + " | ".join(map(str, (
            path.stem, f"{len(rows):,}", ", ".join(f"{status}: {count:,}" for status, count in sorted(exits.items())),
            sum(fault.startswith("signal ") for fault in every), max(float(row["seconds"]) for row in rows),
            max(int(row["megabytes"]) for row in rows), sum(map(is_word_of_library, every)), len(faults)))) + " |")
        counts = collections.Counter(row["kind"] for row in rows)
        kinds.append(f"- `{path.stem}`: " + ", ".join(f"{kind} {count:,}" for kind, count in sorted(counts.items())))
        faulty += [f"- {path.stem} {row['attempt']}, {row['kind']}, {row['what']}: {row['faults']}" for row in faults]
    return "\n".join([*lines, "", *kinds, *([""] if faulty else []), *faulty])
