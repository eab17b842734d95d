# SPDX-License-Identifier: GPL-3.0-or-later
"""Every key of a scenario at both ends of its range, beyond them, and as something that is no such number. A value that
is taken may need long; such a run is stopped."""
import re

import bases
from ending import Attempt, faults_of, hidden_under, run, shell
from insert_case import BLOCK
from part import AnyPart

STOPPED_AFTER_S = 30
NUMBER = r"-?\d+(?:\.\d+)?(?:e-?\d+)?"
RANGE = re.compile(rf"(?:^|each |\s)({NUMBER}) … ({NUMBER})")
ODD = ("0", "1", "-1", "nan", "inf", "-inf", "1e308", "-1e308", "1e-320", "9223372036854775807",
       "99999999999999999999", "true", "false", '""', '"text"',
       '"' + "x" * 5000 + '"', '"a\\u001b[31m\\u0000b"', "[]", "[1, 2, 3]", "[nan, nan, nan]", "{}", "{ a = 1 }",
       "1979-05-27", "[[[[[]]]]]")
IMPLANT_TABLES = ("plan", "procedure", "seed", "oedema")
# Regions of the small mesh, and the scenario's names for them.
REGIONS = 'regions = { tissue = "body", lump = "prostate" }\n'


def schema():
    """Each key: (its table, whether that is repeated, the key, low and high end of its range or None, its choices)."""
    table, is_list, comment, found = "", False, "", []
    for line in run(("insert", "--print-schema"), "/").out.splitlines():
        if header := re.fullmatch(r"#?(\[\[?)([\w.]+)\]\]?", line):
            table, is_list, comment = header[2], header[1] == "[[", ""
        elif key := re.fullmatch(r'#("?\w+"?) = .*', line):
            words = comment.replace("\n", " ")
            ends = RANGE.findall(words)
            choices = re.findall(r'"[^"]*"', words.split("One of ")[1]) if "One of " in words else []
            found.append((table, is_list, key[1], *(ends[-1] if ends else (None, None)), choices))
            comment = ""
        elif line.startswith("# "):
            comment += line[2:] + "\n"
        else:
            comment = ""
    return found


def beyond(number):
    """The next numbers on both sides."""
    value = float(number)
    step = max(abs(value) * 1e-9, 1e-9)
    return [f"{value - step!r}", f"{value + step!r}", f"{value + 1!r}", f"{10 * value!r}"]


def scenario(implant, table, is_list, key, value):
    """The text of a scenario with one key set to this TOML value."""
    text = bases.IMPLANT if implant else BLOCK.replace("[fixed]", REGIONS + "[fixed]")
    head = f"[[{table}]]" if is_list else f"[{table}]"
    setting = f"{key} = {value}\n"
    if not table:
        return setting + text
    if f"{head}\n" not in text:
        return f"{text}{head}\n{setting}"
    before, after = text.split(f"{head}\n")
    body, *rest = re.split(r"(?m)^(?=\[)", after, maxsplit=1)
    body = re.sub(rf"(?m)^{re.escape(key)} = .*\n", "", body)
    return f"{before}{head}\n{setting}{body}{''.join(rest)}"


class Part(AnyPart):
    def __init__(self, folder):
        super().__init__(folder)
        self.cases = []
        for table, is_list, key, low, high, choices in schema():
            ends = [low, high, *beyond(low), *beyond(high), f"[{low}, {low}, {low}]",
                    f"[{high}, {high}, {high}]"] if low else []
            for value in dict.fromkeys([*ends, *choices, *ODD]):
                self.cases.append((table, is_list, key, value))
        self.count = len(self.cases)

    def attempt(self, number, random, folder):
        # A step that divides no number of cases takes them from all tables in turn.
        table, is_list, key, value = self.cases[number * 1009 % len(self.cases)]
        implant = table.split(".")[0] in IMPLANT_TABLES
        bases.link(self.folder, folder)
        (folder / "case.toml").write_text(scenario(implant, table, is_list, key, value), encoding="utf-8")
        command = {"fluoroscopy": ("fluoro", "case.toml", "-o", "out.mha"),
                   "ultrasound": ("image", "case.toml", "-o", "out.png")}.get(
            table, ("implant", "case.toml", "-o", "out") if implant else ("insert", "case.toml", "-o", "out",
                                                                          *bases.QUICK[2:]))
        end = run(command, folder, hangs_after_s=STOPPED_AFTER_S)
        faults = [] if end.hung else faults_of(end)
        if hidden := [] if end.hung else hidden_under(folder):
            faults.append(f"left {hidden}")
        return Attempt(table or "name", f"{key} = {value[:60]}", shell(command), end, faults)
