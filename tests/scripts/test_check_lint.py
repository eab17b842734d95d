#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/check_lint refuses the JSON library's own writer, and only that."""
import importlib.machinery
import importlib.util
import tempfile
import unittest
from pathlib import Path

from trees import SCRIPTS

_loader = importlib.machinery.SourceFileLoader("check_lint", str(SCRIPTS / "check_lint"))
_spec = importlib.util.spec_from_loader("check_lint", _loader)
check_lint = importlib.util.module_from_spec(_spec)
_loader.exec_module(check_lint)


class StrictWriters(unittest.TestCase):
    def found(self, files):
        with tempfile.TemporaryDirectory() as folder:
            for path, text in files.items():
                file = Path(folder) / path
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text, encoding="utf-8")
            return check_lint.strict_writers(Path(folder))

    def test_own_writers_are_named_with_their_line(self):
        found = self.found({"src/serve/a.cpp": "int a;\nreturn list.dump();\n", "apps/cli/b.cpp": "text = json->dump(2);\n",
                            "src/io/c.cpp": "json_text(Json{1})\n    .dump(1);\n"})
        self.assertEqual(found, ["apps/cli/b.cpp:1: text = json->dump(2);", "src/io/c.cpp:2: .dump(1);",
                                 "src/serve/a.cpp:2: return list.dump();"])

    def test_the_one_writer_and_other_functions_pass(self):
        self.assertEqual(self.found({"include/stylet/core/json_text.hpp": "json.dump(1);\n",
                                     "src/io/a.cpp": "core_dump(1); json_text(list);\n"}), [])

    def test_the_repository_has_none(self):
        self.assertEqual(check_lint.strict_writers(SCRIPTS.parent), [])


if __name__ == "__main__":
    unittest.main()
