#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""For every kind of faulty file, both commands that read it report the fault with the file's name and write nothing."""
import gzip
import json
import os
import unittest
import unittest.mock
from pathlib import Path

import samples
from program import InFolder, run


class BadInput(InFolder):
    def refused_by_both(self, name, says=()):
        self.refuse("info", name, says=[name, *says])
        self.refuse("mesh", name, "-o", "out/model.vtu", "--json", "out/report.json", says=[name, *says])

    def write(self, name, content):
        (self.folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        return name

    def test_missing_file(self):
        self.refused_by_both("nowhere/case.dcm", ["no such file"])

    def test_folder_without_a_structure_set(self):
        (self.folder / "case").mkdir()
        self.refused_by_both("case")

    def test_empty_file(self):
        for name in ("case.dcm", "case.json", "mask.nii.gz", "mask.nrrd", "mask.mha", "mesh.vtu", "mesh.msh", "s.stl"):
            self.refused_by_both(self.write(name, b""))

    def test_garbage_under_every_extension(self):
        noise = bytes((37 * k * k + 11 * k) % 256 for k in range(4000))
        for name in ("case.dcm", "case.json", "mask.nii", "mask.nii.gz", "mask.nrrd", "mask.mha", "mesh.vtu", "mesh.vtk",
                     "mesh.msh", "mesh.mesh", "mesh.ele", "s.stl", "s.ply", "s.obj", "s.vtp", "s.glb", "case"):
            self.refused_by_both(self.write(name, noise))

    def test_text_that_is_no_format_at_all(self):
        self.refused_by_both(self.write("notes.txt", "Prostate looks fine.\n"))
        self.refused_by_both(self.write("notes.dcm", "Prostate looks fine.\n"))

    def test_truncated_dicom(self):
        self.succeed("phantom", "-o", "case")
        whole = (self.folder / "case/phantom.dcm").read_bytes()
        for share in (0.02, 0.3, 0.7, 0.99):
            self.refused_by_both(self.write("cut.dcm", whole[:int(share * len(whole))]))

    def test_truncated_mask(self):
        samples.nifti_mask(self.folder / "mask.nii.gz")
        whole = (self.folder / "mask.nii.gz").read_bytes()
        self.refused_by_both(self.write("cut.nii.gz", whole[:len(whole) // 2]))
        self.refused_by_both(self.write("short.nii.gz", gzip.compress(gzip.decompress(whole)[:-100])))

    def test_mask_without_a_label(self):
        samples.nifti_mask(self.folder / "mask.nii.gz")
        raw = gzip.decompress((self.folder / "mask.nii.gz").read_bytes())
        self.write("blank.nii.gz", gzip.compress(raw[:352] + bytes(len(raw) - 352)))
        self.refuse("mesh", "blank.nii.gz", "-o", "m.vtu", says=["blank.nii.gz"])

    def test_json_that_is_no_contours(self):
        self.refused_by_both(self.write("other.json", '{"patients": []}'))
        self.refused_by_both(self.write("broken.json", '{"format": "stylet-contours", "version": 1,'))

    def test_contours_that_cannot_be_a_structure(self):
        def changed(name, change):
            samples.contour_json(self.folder / "gland.json")
            data = json.loads((self.folder / "gland.json").read_text())
            change(data["structures"][0]["contours"])
            return self.write(name, json.dumps(data))

        def one_slice(contours):
            del contours[1:]

        def crossing(contours):
            contours[3][2], contours[3][12] = contours[3][12], contours[3][2]

        def not_a_number(contours):
            contours[2][5][0] = "x"

        def metres(contours):
            for contour in contours:
                for point in contour:
                    point[:] = [x / 1000 for x in point]

        for change in (one_slice, crossing, not_a_number, metres):
            name = changed(f"{change.__name__}.json", change)
            self.refuse("mesh", name, "-o", "m.vtu", says=[name, "Prostate"])

    def test_no_structure_to_aim_at(self):
        samples.contour_json(self.folder / "nose.json", ("Nose",))
        self.refuse("mesh", "nose.json", "-o", "m.vtu", says=["nose.json"])

    def test_tetrahedra_no_simulation_may_use(self):
        samples.tet_mesh(self.folder / "flat.msh", last_tet=(1, 2, 3, 2))
        self.refused_by_both("flat.msh")
        samples.tet_mesh(self.folder / "twice.msh", last_tet=(1, 3, 2, 0))
        self.refused_by_both("twice.msh")
        samples.tet_mesh(self.folder / "beyond.msh", last_tet=(1, 2, 3, 40))
        self.refused_by_both("beyond.msh")
        samples.tet_mesh(self.folder / "metres.msh", unit=1000)
        self.refused_by_both("metres.msh")

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

    def test_hdf5_that_is_no_recording(self):
        self.write("run.h5", b"\x89HDF\r\n\x1a\n" + bytes(500))
        self.refuse("info", "run.h5", says=["run.h5"])


if __name__ == "__main__":
    unittest.main()
