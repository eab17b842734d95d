#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/check_commands reports commands of documents that do not work, each with its document and line."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "check_commands"

# A program in place of stylet: it has help, copies files, refuses wrong options and settings, and serves.
PROGRAM = """#!/usr/bin/env python3
import signal, sys, time
from pathlib import Path
words = sys.argv[1:]
if "--help" in words:
    options = ["-o,--output OUT", "--port P", "--set KEY=VALUE", "--map", "WHAT  step: it; scale: that"]
    commands = ["copy  ", "phantom  ", "serve  ", "bench  ", "insert  "]
    print("\\n  ".join(["", *(options if len(words) > 1 else commands)]))
elif "--lentgh" in words:
    sys.exit("stylet: error: unknown option '--lentgh'")
elif "no.key=1" in words:
    sys.exit("stylet: error: unknown key no.key")
elif words[0] in ("insert", "--version"):
    sys.exit(0 if "--map" not in words else 3)
elif words[0] == "phantom":
    (Path(words[2]) / "phantom.dcm").write_text("contours")
elif words[0] == "copy":
    if not Path(words[1]).is_file():
        sys.exit(f"stylet: error: {words[1]}: no such file")
    Path(words[3]).write_text(Path(words[1]).read_text())
elif words[0] == "serve":
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    print("Open http://127.0.0.1/", flush=True)
    time.sleep(60)
elif words[0] not in ("bench", "help", "version"):
    sys.exit(f"stylet: error: unknown command '{words[0]}'")
"""


def fenced(text, language="sh"):
    return f"# A page\n```{language}\n{text}\n```\n"


class Commands(unittest.TestCase):
    def checked(self, *pages):
        """Exit status and output of the script on documents: README.md, docs/1.md, docs/2.md and so on."""
        with tempfile.TemporaryDirectory() as name:
            root = Path(name)
            for folder in ("build/bin", "docs", "scripts", "scenarios"):
                (root / folder).mkdir(parents=True)
            program = root / "build/bin/stylet"
            program.write_text(PROGRAM, encoding="utf-8")
            program.chmod(0o755)
            (root / "scripts/there").touch()
            (root / "scenarios/demo.toml").touch()
            for number, text in enumerate(pages):
                (root / (f"docs/{number}.md" if number else "README.md")).write_text(text, encoding="utf-8")
            done = subprocess.run([sys.executable, SCRIPT, "--verbose", program, root], capture_output=True, text=True,
                                  check=False)
            return done.returncode, done.stdout + done.stderr

    def accepted(self, *pages):
        status, said = self.checked(*pages)
        self.assertEqual(status, 0, said)
        return said

    def refused(self, page, *texts):
        status, said = self.checked(page)
        self.assertEqual(status, 1, said)
        for text in texts:
            self.assertIn(text, said)

    def test_a_command_finds_the_scenarios_the_stand_ins_and_the_files_of_commands_before_it(self):
        said = self.accepted(fenced("stylet copy scenarios/demo.toml -o a  # a scenario\n"
                                    "build/bin/stylet copy a -o b && stylet copy b -o c\n"
                                    "for x in d e; do stylet copy c \\\n  -o $x; done\nstylet copy e -o f")
                             + fenced("$ stylet copy RS.dcm -o g\nwhat it prints", "console"))
        self.assertIn("README.md: 5 run", said)

    def test_a_wrong_option_is_reported_with_document_and_line(self):
        self.refused(fenced("stylet copy RS.dcm -o a\nstylet copy RS.dcm --lentgh 3 -o b"),
                     "README.md:4: exit status 1: stylet: error: unknown option '--lentgh'\n"
                     "    stylet copy RS.dcm --lentgh 3 -o b")

    def test_a_missing_file_is_reported_with_document_and_line(self):
        self.refused(fenced("\nstylet copy none -o a"), "README.md:4: exit status 1: stylet: error: none: no such")
        self.refused(fenced("stylet copy none -o a | cat"), "README.md:3: exit status 1")

    def test_files_of_another_document_are_not_there(self):
        status, said = self.checked(fenced("stylet copy RS.dcm -o a"), fenced("stylet copy a -o b"))
        self.assertEqual(status, 1)
        self.assertIn("docs/1.md:3: exit status 1: stylet: error: a: no such file", said)

    def test_a_server_is_ended_when_it_listens(self):
        self.assertIn("README.md:3: started and stopped", self.accepted(fenced("stylet serve scenarios/demo.toml")))

    def test_options_of_a_long_command_are_checked(self):
        self.assertIn("README.md:3: options checked", self.accepted(fenced("stylet bench step -o a")))
        self.refused(fenced("stylet bench step --nodes 3"),
                     "README.md:3: exit status 2: check_commands: stylet bench has no option '--nodes'")
        self.refused(fenced("stylet bench stop"), "stylet bench has no 'stop'")

    def test_scenario_and_settings_of_a_long_insertion_are_read(self):
        self.assertIn("README.md:3: options checked", self.accepted(fenced("stylet insert scenarios/demo.toml --map")))
        self.refused(fenced("stylet insert scenarios/demo.toml --map --set no.key=1"), "unknown key no.key")
        self.refused("# A\n`stylet insert scenarios/demo.toml --set no.key=1`\n", "README.md:2: exit status 1: ")

    def test_a_command_in_a_sentence_has_its_options_checked(self):
        self.accepted("# A\nCall `stylet copy\nFILE -o OUT` or `stylet COMMAND --help`.\n")
        self.refused("# A\nCall\n`stylet copy FILE --to OUT`.\n", "README.md:3: stylet copy has no option '--to'")
        self.refused("# A\nCall `stylet move FILE`.\n", "README.md:2: stylet has no command 'move'")

    def test_a_command_that_the_help_does_not_list_is_one_if_the_program_takes_it(self):
        self.accepted("# A\n`stylet version` and `stylet help COMMAND` print the version and the options.\n")

    def test_other_programs_are_not_run_but_scripts_they_name_exist(self):
        said = self.accepted(fenced("scripts/there\ncmake --install build"))
        self.assertIn("README.md: 2 not run", said)
        self.refused(fenced("node tests/none.mjs 9"), "README.md:3: the repository has no tests/none.mjs")

    def test_a_command_outside_a_labelled_fence_is_reported(self):
        self.refused("# A\n\n    stylet copy a -o b\n", "README.md:3: a command stands in an indented block")
        self.refused(fenced("stylet copy a -o b", ""), "README.md:2: a command stands in a fence without a language")

    def test_a_scenario_that_the_reader_saves_is_there(self):
        self.accepted("# A\nSave it as `case.toml`:\n\n```toml\na = 1\n```\n" + fenced("stylet copy case.toml -o b"))

    def test_a_command_without_an_end_is_reported(self):
        self.refused(fenced("for x in a b; do stylet copy RS.dcm -o $x"), "README.md:3: the shell does not accept")


if __name__ == "__main__":
    unittest.main()
