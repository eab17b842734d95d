#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/check_documents finds long lines, broken links, pages without a link to them, and phrases without a noun."""
import unittest

from trees import run_script

SOUND = {"README.md": "# A\n", "CONTRIBUTING.md": "# B\n", "CHANGELOG.md": "# C\n",
         "docs/index.md": "# Index\n[one](one.md#a-first-heading)\n",
         "docs/one.md": "# One\n## A `first` heading\n| " + "wide " * 20 + "|\n\n    code\n[two](sub/two.md)\n",
         "docs/sub/two.md": "# Two\n```\n" + "long " * 20 + "\n```\n[back](../index.md)\n"}


class Documents(unittest.TestCase):
    def complaints(self, changes):
        """Exit status and output of the script for the correct documents plus some others."""
        return run_script("check_documents", {**SOUND, **changes})

    def refused(self, changes, *texts):
        status, said = self.complaints(changes)
        self.assertEqual(status, 1, said)
        for text in texts:
            self.assertIn(text, said)

    def test_sound_documents_pass(self):
        self.assertEqual(self.complaints({})[0], 0)

    def test_a_long_line_is_named_with_its_length(self):
        self.refused({"README.md": "# A\n" + "word " * 24 + "x\n"}, "README.md:2: 121 columns")

    def test_a_long_row_of_a_table_and_long_code_are_no_exception(self):
        self.refused({"README.md": "# A\n| " + "wide " * 24 + "|\n```\n" + "long " * 25 + "\n```\n"},
                     "README.md:2: 123 columns", "README.md:4: 125 columns")

    def test_a_file_that_is_not_there_is_named(self):
        self.refused({"README.md": "# A\nSee `src/none.cpp`.\n"}, "README.md:2: there is no src/none.cpp")

    def test_a_folder_that_a_module_does_not_have_is_named(self):
        self.refused({"src/io/image/a.cpp": "", "tests/io/formats/b.py": "",
                      "src/io/README.md": "# io\nSee `image/`, `a.cpp`, `formats/`, `c.cpp` and `io/mesh/`.\n"},
                     "src/io/README.md:2: there is no formats/", "there is no c.cpp", "there is no io/mesh/", "3 problems")

    def test_a_test_that_is_not_there_is_named(self):
        self.refused({"tests/a.cpp": "TEST(Needle, bends) {}\n", "README.md": "# A\n`Needle.bends`, `Needle.b…`, `Rod.*`\n"},
                     "README.md:2: there is no test Rod.*", "1 problems")

    def test_a_thing_that_is_there_although_a_document_says_it_is_absent_is_named(self):
        said = "# A\nPictures <!-- absent: stylet image --> and a probe <!-- absent: probe in src/io/*.cpp --> are absent.\n"
        self.assertEqual(self.complaints({"README.md": said, "src/io/a.cpp": "", "src/io/README.md": "# io\n"})[0], 0)
        self.refused({"README.md": said, "src/io/a.cpp": "int x;\nint probe;\n", "src/io/README.md": "# io\n",
                      "build/docs/reference/options.md": "# O\n`stylet image`\n"},
                     "README.md:2: stylet image is said to be absent, and build/docs/reference/options.md:2 has it",
                     "README.md:2: probe is said to be absent, and src/io/a.cpp:2 has it")
        self.refused({"README.md": said}, "there is no file src/io/*.cpp")

    def test_an_absence_without_a_mark_is_named(self):
        self.refused({"README.md": "# A\n\n- One.\n- Muscle is not modelled.\n"}, 'README.md:4: "is not modelled" needs a mark')

    def test_a_line_that_begins_with_a_comment_is_named(self):
        self.refused({"README.md": "# A\nIt is\n<!-- row -->3 mm.\n"}, "README.md:3: a line that begins with a comment")

    def test_a_module_without_its_readme_is_named(self):
        self.refused({"src/core/a.cpp": ""}, "src/core/README.md:1: a module says")

    def test_a_test_named_in_camel_case_is_named(self):
        self.refused({"tests/a.cpp": "TEST(Needle, BendsUnderLoad) {}\nTEST(Needle, weighs_2_kN_at_D4) {}\n"},
                     "tests/a.cpp:1: the test's name BendsUnderLoad")

    def test_a_cure_with_a_full_stop_is_named(self):
        self.refused({"src/core/a.cpp": 'return input_error(where, "it is not.", "Do it"\n" now.");\n',
                      "src/core/README.md": "# core\n"}, 'src/core/a.cpp:2: the cure " now." ends with a full stop')

    def test_a_link_to_no_file_or_no_heading_is_named(self):
        self.refused({"README.md": "# A\n[x](docs/none.md) and [y](docs/one.md#another)\n"},
                     "README.md:2: the link docs/none.md leads to no file",
                     "the link docs/one.md#another leads to no heading of one.md")

    def test_a_page_that_is_three_links_away_is_named(self):
        self.refused({"docs/sub/two.md": "# Two\n[three](three.md)\n", "docs/sub/three.md": "# Three\n"},
                     "docs/sub/three.md:1: no two links lead here")

    def test_a_phrase_without_its_noun_is_named_wherever_it_stands(self):
        self.refused({"include/a.hpp": "/// @param loads those of " + "then\n"}, 'include/a.hpp:1: "those of then"')


if __name__ == "__main__":
    unittest.main()
