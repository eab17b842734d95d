#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""For a faulty file of every kind, both commands that read it report the fault with the file's name and write nothing.
The faults of each format are in tests/io/formats."""
import gzip
import os
import unittest
import unittest.mock
from pathlib import Path

import samples
from program import InFolder, run


class BadInput(InFolder):
    def refused_by_both(self, name, *says):
        self.refuse("info", name, says=[name, *says])
        self.refuse("mesh", name, "-o", "out/model.vtu", "--json", "out/report.json", says=[name, *says])

    def test_what_is_not_there_empty_or_of_no_format(self):
        self.refused_by_both("nowhere/case.dcm", "no such file")
        (self.folder / "folder").mkdir()
        self.refused_by_both("folder")
        self.refused_by_both(self.write("empty.nii.gz", b""))
        self.refused_by_both(self.write("notes.txt", "Prostate looks fine.\n"))
        self.refused_by_both(self.write("other.json", '{"patients": []}'))
        self.refuse("info", self.write("run.h5", b"\x89HDF\r\n\x1a\n" + bytes(500)), says=["run.h5"])

    def test_garbage_under_every_extension(self):
        noise = bytes((37 * k * k + 11 * k) % 256 for k in range(4000))
        for name in ("case.dcm", "case.json", "mask.nii", "mask.nii.gz", "mask.nrrd", "mask.mha", "mesh.vtu", "mesh.vtk",
                     "mesh.msh", "mesh.mesh", "mesh.ele", "s.stl", "s.ply", "s.obj", "s.vtp", "s.glb", "case"):
            self.refused_by_both(self.write(name, noise))

    def test_json_nested_without_end(self):
        deep = "[" * 88000 + "]" * 88000
        for name, begin in (("plain.json", ""), ("case.json", '{"format": "stylet-contours", "version": 1, "a": '),
                            ("plan.json", '{"format": "stylet-plan", "version": 1, "sources": '),
                            ("source.json", '{"format": "stylet-source", "version": 1, "g": ')):
            self.write(name, begin + deep + ("}" if begin else ""))
            self.refuse("info", name, says=[name])
            self.refuse("mesh", name, "-o", "out/model.vtu", says=[name])
            self.refuse("dose", name, name, "-o", "out/dose", says=[name])
        self.write("implant.toml", '[patient]\nsource = "phantom"\n[plan]\nfile = "plan.json"\n')
        self.refuse("implant", "implant.toml", "-o", "out/implant", says=["plan.json"])
        self.write("source.toml", '[patient]\nsource = "phantom"\n[plan]\nfile = "x.csv"\nsource = "source.json"\n')
        self.write("x.csv", "x_mm,y_mm,z_mm,strength_U\n0,0,0,0.5\n")
        self.refuse("implant", "source.toml", "-o", "out/implant", says=["source.json"])

    def test_files_cut_short(self):
        self.succeed("phantom", "-o", "case")
        samples.nifti_mask(self.folder / "mask.nii.gz")
        for whole in ("case/phantom.dcm", "mask.nii.gz"):
            content = (self.folder / whole).read_bytes()
            self.refused_by_both(self.write(f"cut_{Path(whole).name}", content[:len(content) // 2]))

    def test_what_cannot_be_meshed(self):
        samples.nifti_mask(self.folder / "mask.nii.gz")
        raw = gzip.decompress((self.folder / "mask.nii.gz").read_bytes())
        self.write("blank.nii.gz", gzip.compress(raw[:352] + bytes(len(raw) - 352)))
        gland = samples.ball(15)
        gland["contours"][3][2], gland["contours"][3][12] = gland["contours"][3][12], gland["contours"][3][2]
        self.write("crossing.json", samples.structure_set(gland))
        self.write("nose.json", samples.structure_set(samples.ball(15, "Nose")))
        for name, *says in (("blank.nii.gz",), ("crossing.json", "Prostate"), ("nose.json",)):
            self.refuse("mesh", name, "-o", "m.vtu", says=[name, *says])
        samples.tet_mesh(self.folder / "flat.msh", last_tet=(1, 2, 3, 2))
        self.refused_by_both("flat.msh")

    def test_a_gmsh_library_that_cannot_be_loaded_is_named_where_it_is_needed_only(self):
        samples.tet_mesh(self.folder / "mesh.msh")
        libraries = [*Path("/usr/lib").glob("**/libgmsh.so.*")]
        self.assertTrue(libraries, "the library is looked for in /usr/lib")
        for library in libraries:
            (self.folder / library.name).touch()
        with unittest.mock.patch.dict(os.environ, {"LD_LIBRARY_PATH": str(self.folder)}):
            done = run("info", "mesh.msh", cwd=self.folder)
            self.assertEqual(done.returncode, 1)  # not 2, because the file may be good
            self.assertRegex(done.stderr, r"\Astylet: error: libgmsh\.so[^\n]+ cannot be loaded [^\n]+ Install gmsh[^\n]+\n\Z")
            self.succeed("--version")


if __name__ == "__main__":
    unittest.main()
