#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/check_module_order finds includes against the direction of the modules in every notation."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "check_module_order"


class ModuleOrder(unittest.TestCase):
    def check(self, files):
        """Exit status and messages of the script for a tree with these files (path: text)."""
        with tempfile.TemporaryDirectory() as folder:
            for path, text in files.items():
                file = Path(folder) / path
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text, encoding="utf-8")
            done = subprocess.run([sys.executable, SCRIPT, folder], capture_output=True, text=True, check=False)
            return done.returncode, done.stderr

    def test_includes_to_the_left_pass(self):
        status, text = self.check({"src/sim/a.cpp": '#include "stylet/fem/tissue.hpp"\n#include <vector>\n',
                                   "src/io/b.cpp": '#include "stylet/sim/model.hpp"\n#include <vtkCell.h>\n',
                                   "src/mesher/c.cpp": "#include <CGAL/Mesh_3/config.h>\n"})
        self.assertEqual((status, text), (0, ""))

    def test_public_header_to_the_right_is_refused_with_its_line(self):
        status, text = self.check({"include/stylet/geom/a.hpp": '#pragma once\n#include "stylet/fem/tissue.hpp"\n'})
        self.assertEqual(status, 1)
        self.assertIn("include/stylet/geom/a.hpp:2: geom must not include fem", text)

    def test_fem_and_needle_do_not_know_each_other(self):
        for one, other in (("fem", "needle"), ("needle", "fem")):
            status, text = self.check({f"src/{one}/a.cpp": f'#include <stylet/{other}/{other}.hpp>\n'})
            self.assertEqual(status, 1)
            self.assertIn(f"{one} must not include {other}", text)

    def test_relative_path_into_another_module_is_seen(self):
        status, text = self.check({"src/core/a.cpp": '#include "../io/inside.hpp"\n', "src/io/inside.hpp": ""})
        self.assertEqual(status, 1)
        self.assertIn("core must not include io", text)

    def test_mesher_knows_no_simulation_and_no_files(self):
        status, text = self.check({"src/mesher/a.cpp": '#include "stylet/sim/model.hpp"\n#include "stylet/io/input.hpp"\n'})
        self.assertEqual(status, 1)
        self.assertIn("mesher must not include sim", text)
        self.assertIn("mesher must not include io", text)

    def test_header_in_c_belongs_to_the_module_of_its_name(self):
        status, text = self.check({"src/stylet_rt/a.cpp": '#include "stylet/stylet_rt.h"\n#include "stylet/io/model_file.hpp"\n',
                                   "include/stylet/stylet_rt.h": "#include <stdint.h>\n"})
        self.assertEqual((status, text), (0, ""))
        status, text = self.check({"src/sim/a.cpp": '#include "stylet/stylet_rt.h"\n',
                                   "include/stylet/stylet_rt.h": '#include "stylet/mesher/mesher.hpp"\n'})
        self.assertEqual(status, 1)
        self.assertIn("sim must not include stylet_rt", text)
        self.assertIn("stylet_rt must not include mesher", text)

    def test_realtime_sees_the_simulation_but_no_files_and_is_not_seen_by_it(self):
        status, text = self.check({"src/realtime/a.cpp": '#include "stylet/sim/simulation.hpp"\n#include <pthread.h>\n'})
        self.assertEqual((status, text), (0, ""))
        status, text = self.check({"src/realtime/a.cpp": '#include "stylet/io/input.hpp"\n#include <sys/socket.h>\n',
                                   "src/sim/b.cpp": '#include "stylet/realtime/runner.hpp"\n'})
        self.assertEqual(status, 1)
        self.assertIn("realtime must not include io", text)
        self.assertIn("sys/socket.h", text)
        self.assertIn("sim must not include realtime", text)

    def test_evidence_sees_all_and_is_seen_by_none(self):
        status, text = self.check({"src/evidence/a.cpp": '#include "stylet/mesher/mesher.hpp"\n#include "io/inside.hpp"\n',
                                   "src/io/inside.hpp": ""})
        self.assertEqual((status, text), (0, ""))
        status, text = self.check({"src/io/a.cpp": '#include "stylet/evidence/reproduce/figure5.hpp"\n'})
        self.assertEqual(status, 1)
        self.assertIn("io must not include evidence", text)

    def test_formats_and_sockets_stay_out_of_the_engine(self):
        for header in ("vtkCell.h", "CGAL/Mesh_3/config.h", "dcmtk/dcmrt/drtstrct.h", "nlohmann/json.hpp",
                       "toml++/toml.h", "hdf5.h", "gmsh.h", "boost/beast/core.hpp", "sys/socket.h", "fstream"):
            status, text = self.check({"src/sim/a.cpp": f"#include <{header}>\n"})
            self.assertEqual(status, 1, header)
            self.assertIn(header, text)

    def test_unknown_module_is_refused(self):
        status, text = self.check({"src/magic/a.cpp": ""})
        self.assertEqual(status, 1)
        self.assertIn("unknown module 'magic'", text)


if __name__ == "__main__":
    unittest.main()
