// SPDX-License-Identifier: GPL-3.0-or-later
#include "files.hpp"
#include "mask_files.hpp"
#include "mesh_files.hpp"
#include "stylet/io/input.hpp"

#include <sys/stat.h>

using namespace stylet;
using namespace stylet::test;

TEST(Input, each_kind_of_file_is_recognised_by_its_content) {
  const Folder folder;
  ASSERT_TRUE(write_rtstruct(two_organs(), folder / "contours").ok());
  ASSERT_TRUE(write_contour_json(two_organs(), folder / "also_contours").ok());
  for (const char* name : {"contours", "also_contours"}) {
    const auto input = value_of(read_input(folder / name));
    EXPECT_TRUE(std::holds_alternative<ContourSet>(input));
  }
  for (const std::string& bytes : {nifti(Mask()), gzipped(nifti(Mask())), nrrd(Mask()), metaimage(Mask())}) {
    const auto input = value_of(read_input(write_file(folder / "mask", bytes)));
    EXPECT_TRUE(std::holds_alternative<LabelImage>(input));
  }
  for (const MeshFile& file : write_all_formats(two_region_box(), folder.path())) {
    const auto input = value_of(read_input(file.path));
    EXPECT_TRUE(std::holds_alternative<TetMesh>(input)) << file.what;
  }
  const auto surface = value_of(read_input(write_file(folder / "s.obj", "v 0 0 0\nv 30 0 0\nv 0 30 0\nf 1 2 3\n")));
  EXPECT_TRUE(std::holds_alternative<std::vector<Surface>>(surface));
}

TEST(Input, a_folder_with_one_structure_set_is_contours) {
  const Folder folder;
  ASSERT_TRUE(write_rtstruct(two_organs(), folder / "case.dcm").ok());
  const auto input = value_of(read_input(folder.path()));
  EXPECT_TRUE(std::holds_alternative<ContourSet>(input));
}

TEST(Input, the_scale_reaches_the_mesh) {
  const Folder folder;
  const auto input = value_of(read_input(write_file(folder / "m.msh", msh22_text(two_region_box())), {.scale = 2.0}));
  EXPECT_NEAR(std::get<TetMesh>(input).nodes[0].x(), -40.0, 1e-9);
}

TEST(Input, files_that_are_not_there_or_cannot_be_opened_are_refused) {
  const Folder folder;
  expect_refused(read_input(folder / "none.dcm"), {"none.dcm", "no such file"});
  expect_refused(read_input(folder / "no/folder/none.dcm"), {"none.dcm", "no such file"});
  expect_refused(read_input(folder.path()), {"no DICOM RT Structure Set"});
  write_file(folder / "file", "x");
  expect_refused(read_input(folder / "file/below"), {"below"});
  ASSERT_EQ(::mkfifo((folder / "pipe").c_str(), 0600), 0);
  expect_refused(read_input(folder / "pipe"), {"not a regular file"});
  if (::geteuid() != 0) {  // root can read everything
    fs::permissions(write_file(folder / "locked", "x"), fs::perms::none);
    expect_refused(read_input(folder / "locked"), {"locked", "cannot be opened"});
  }
}

TEST(Input, empty_and_unknown_files_are_refused_with_a_list_of_what_can_be_read) {
  const Folder folder;
  expect_refused(read_input(write_file(folder / "e.dcm", "")), {"empty", "RTSTRUCT", "NIfTI", "gmsh"});
  expect_refused(read_input(write_file(folder / "t.txt", "Dear reader")),
                 {"not recognised", "RTSTRUCT", "NRRD", "TetGen", "GLB"});
  expect_refused(read_input(write_file(folder / "x.xml", "<html></html>")), {"not recognised"});
  expect_refused(read_input(write_file(folder / "image.dcm", "not DICOM at all")), {"not a DICOM file"});
}

TEST(Input, a_reader_asked_for_something_else_says_what_the_file_is) {
  const Folder folder;
  write_file(folder / "m.nii", nifti(Mask()));
  expect_refused(read_rtstruct(folder / "m.nii"), {"a NIfTI image", "RT Structure Set is expected"});
  expect_refused(read_contour_json(folder / "m.nii"), {"a NIfTI image", "contour JSON"});
  expect_refused(read_tet_mesh(folder / "m.nii"), {"a NIfTI image", "tetrahedral mesh"});
  expect_refused(read_surfaces(folder / "m.nii"), {"a NIfTI image", "triangulated surface"});
}
