#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""scripts/check_module_order finds includes against the direction of the modules in every notation."""
import unittest

from trees import run_script


class ModuleOrder(unittest.TestCase):
    def passes(self, files):
        status, said = run_script("check_module_order", files)
        self.assertEqual(status, 0, said)
        self.assertRegex(said, r"\AModule order: all \d+ files include only [^\n]+\n\Z")

    def refused(self, files, *texts):
        status, said = run_script("check_module_order", files)
        self.assertEqual(status, 1, said)
        for text in texts:
            self.assertIn(text, said)

    def test_includes_to_the_left_pass(self):
        self.passes({"src/sim/a.cpp": '#include "stylet/fem/tissue.hpp"\n#include <vector>\n',
                     "src/io/b.cpp": '#include "stylet/sim/model.hpp"\n#include <vtkCell.h>\n',
                     "src/mesher/c.cpp": "#include <CGAL/Mesh_3/config.h>\n"})

    def test_public_header_to_the_right_is_refused_with_its_line(self):
        self.refused({"include/stylet/geom/a.hpp": '#pragma once\n#include "stylet/fem/tissue.hpp"\n'},
                     "include/stylet/geom/a.hpp:2: geom must not include fem")

    def test_fem_and_needle_do_not_know_each_other(self):
        for one, other in (("fem", "needle"), ("needle", "fem")):
            self.refused({f"src/{one}/a.cpp": f'#include <stylet/{other}/{other}.hpp>\n'}, f"{one} must not include {other}")

    def test_relative_path_into_another_module_is_seen(self):
        self.refused({"src/core/a.cpp": '#include "../io/inside.hpp"\n', "src/io/inside.hpp": ""},
                     "core must not include io")

    def test_mesher_knows_no_simulation_and_no_files(self):
        self.refused({"src/mesher/a.cpp": '#include "stylet/sim/model.hpp"\n#include "stylet/io/input.hpp"\n'},
                     "mesher must not include sim", "mesher must not include io")

    def test_header_in_c_belongs_to_the_module_of_its_name(self):
        self.passes({"src/stylet_rt/a.cpp": '#include "stylet/stylet_rt.h"\n#include "stylet/io/model_file.hpp"\n',
                     "include/stylet/stylet_rt.h": "#include <stdint.h>\n"})
        self.refused({"src/sim/a.cpp": '#include "stylet/stylet_rt.h"\n',
                      "include/stylet/stylet_rt.h": '#include "stylet/mesher/mesher.hpp"\n'},
                     "sim must not include stylet_rt", "stylet_rt must not include mesher")

    def test_realtime_sees_the_simulation_but_no_files_and_is_not_seen_by_it(self):
        self.passes({"src/realtime/a.cpp": '#include "stylet/sim/simulation.hpp"\n#include <pthread.h>\n'})
        self.refused({"src/realtime/a.cpp": '#include "stylet/io/input.hpp"\n#include <sys/socket.h>\n',
                      "src/sim/b.cpp": '#include "stylet/realtime/runner.hpp"\n'},
                     "realtime must not include io", "sys/socket.h", "sim must not include realtime")

    def test_evidence_sees_all_and_is_seen_by_none(self):
        self.passes({"src/evidence/a.cpp": '#include "stylet/mesher/mesher.hpp"\n#include "io/inside.hpp"\n',
                     "src/io/inside.hpp": ""})
        self.refused({"src/io/a.cpp": '#include "stylet/evidence/reproduce/figure5.hpp"\n'}, "io must not include evidence")

    def test_formats_and_sockets_stay_out_of_the_engine(self):
        for header in ("vtkCell.h", "CGAL/Mesh_3/config.h", "dcmtk/dcmrt/drtstrct.h", "nlohmann/json.hpp",
                       "toml++/toml.h", "hdf5.h", "gmsh.h", "boost/beast/core.hpp", "sys/socket.h", "fstream"):
            self.refused({"src/sim/a.cpp": f"#include <{header}>\n"}, header)

    def test_unknown_module_is_refused(self):
        self.refused({"src/magic/a.cpp": ""}, "unknown module 'magic'")


if __name__ == "__main__":
    unittest.main()
