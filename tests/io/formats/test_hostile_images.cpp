// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of files that would make a program read other files, wait forever or compute with absurd numbers.
#include "detail/text.hpp"
#include "files.hpp"
#include "mask_files.hpp"
#include "mesh_files.hpp"
#include "stylet/io/input.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <sstream>

using namespace stylet;
using namespace stylet::test;

TEST(HostileImages, origins_out_of_reach_are_refused_with_field_and_value) {
  for (const double far : {1e308, -1e12, 1.1e5}) {
    Mask mask;
    mask.origin.y() = far;
    const std::string value = fmt::format("{:.6g}", far);
    expect_refused(read_mask("m.nrrd", nrrd(mask)), {"m.nrrd, space origin", value.c_str(), "100000 mm"});
    expect_refused(read_mask("m.mha", metaimage(mask)), {"m.mha, Offset", value.c_str(), "100000 mm"});
    if (std::abs(far) < 1e30) expect_refused(read_mask("m.nii", nifti(mask)), {"m.nii, sform", "100000 mm"});
  }
  Mask mask;
  mask.origin.y() = 9e4;
  EXPECT_TRUE(read_mask("m.nrrd", nrrd(mask)).ok());
}

TEST(HostileImages, spacings_that_no_scanner_makes_are_refused) {
  const Mask mask;
  for (const char* spacing : {"0", "-2", "1e-9", "1e9", "1e308"}) {
    const std::string text =
        replaced(metaimage(mask), "ElementSpacing = 2 ", fmt::format("ElementSpacing = {} ", spacing));
    expect_refused(read_mask("m.mha", text), {"m.mha, ElementSpacing", "axis i", "expected"});
  }
  expect_refused(read_mask("m.mha", replaced(metaimage(mask), "ElementSpacing = 2 ", "ElementSpacing = nan ")),
                 {"m.mha", "the header of the MetaImage file cannot be read"});
  for (const char* spacing : {"0", "1e-9", "1e9", "1e308", "nan"}) {
    expect_refused(read_mask("m.nrrd", replaced(nrrd(mask), "(2,0,0)", fmt::format("({},0,0)", spacing))), {"m.nrrd"});
  }
  std::string bytes = nifti(mask, NiftiForm::qform);
  poke(bytes, 80, -2.0F);
  expect_refused(read_mask("m.nii", bytes), {"m.nii, pixdim[1]", "-2"});
  poke(bytes, 80, 1e9F);
  expect_refused(read_mask("m.nii", bytes), {"m.nii, pixdim", "1e+09"});
  poke(bytes, 80, NAN);
  expect_refused(read_mask("m.nii", bytes), {"m.nii, pixdim[1]", "nan"});
}

TEST(HostileImages, an_image_longer_than_ten_metres_is_refused) {
  Mask mask;
  mask.size = {200, 10, 2};
  mask.labels.assign(4000, 1);
  mask.axes = Vec3(60, 2, 2).asDiagonal();
  expect_refused(read_mask("m.nrrd", nrrd(mask)), {"m.nrrd", "12000 mm long", "10000 mm"});
}

TEST(HostileImages, contours_and_meshes_have_the_same_reach) {
  const Folder folder;
  ContourSet set = two_organs();
  for (Contour& c : set.rois[1].contours) {
    for (Vec3& p : c.points) p.x() += 2e5;
  }
  ASSERT_TRUE(write_contour_json(set, folder / "far.json").ok());
  ASSERT_TRUE(write_rtstruct(set, folder / "far.dcm").ok());
  for (const char* name : {"far.json", "far.dcm"}) {
    expect_refused(read_input(folder / name), {name, "ROI 'Rectum', contour 1", "point 1", "100000 mm"});
  }
  TetMesh mesh = two_region_box();
  for (Vec3& x : mesh.nodes) x.z() -= 2e5;
  for (const MeshFile& file : write_all_formats(mesh, folder.path())) {
    expect_refused(read_input(file.path), {"node 0", "100000 mm"});
  }
  expect_refused(read_input(write_file(folder / "s.obj", "v 2e5 0 0\nv 200030 0 0\nv 200000 30 0\nf 1 2 3\n")),
                 {"s.obj", "point 0", "100000 mm"});
}

TEST(HostileImages, an_absurd_number_of_dimensions_is_refused_before_the_library_sees_it) {
  for (const char* dimensions : {"4294967296", "-1", "0", "11", "three"}) {
    expect_refused(read_mask("m.mha", replaced(metaimage(Mask()), "NDims = 3", fmt::format("NDims = {}", dimensions))),
                   {"m.mha, NDims", dimensions, "3 is expected"});
  }
}

namespace {

/// Checks the error for a MetaImage header and for an NRRD header that name this data file.
void expect_data_file_refused(const Folder& folder, const std::string& name, const char* says) {
  const Mask mask;
  write_file(folder / "case/m.mhd", metaimage(mask, false, name));
  std::string header = nrrd(mask);
  header.resize(header.size() - mask.labels.size() - 1);
  write_file(folder / "case/m.nhdr", header + "data file: " + name + "\n\n");
  expect_refused(read_input(folder / "case/m.mhd"), {"m.mhd", says});
  expect_refused(read_input(folder / "case/m.nhdr"), {"m.nhdr", says});
}

}  // namespace

TEST(HostileImages, a_header_names_data_beside_itself_only) {
  const Folder folder;
  const Mask mask;
  fs::create_directories(folder / "case/below");
  write_file(folder / "outside.raw", {mask.labels.begin(), mask.labels.end()});
  fs::copy_file(folder / "outside.raw", folder / "case/below/inside.raw");
  fs::create_symlink("../outside.raw", folder / "case/link.raw");
  fs::create_symlink("below/inside.raw", folder / "case/good_link.raw");
  ASSERT_EQ(::mkfifo((folder / "case/pipe.raw").c_str(), 0600), 0);
  expect_data_file_refused(folder, (folder / "outside.raw").string(), "an absolute path is not followed");
  expect_data_file_refused(folder, "/etc/passwd", "an absolute path is not followed");
  expect_data_file_refused(folder, "../outside.raw", "out of the header's folder");
  expect_data_file_refused(folder, "below/../../outside.raw", "out of the header's folder");
  expect_data_file_refused(folder, "link.raw", "a link that leads out");
  expect_data_file_refused(folder, "pipe.raw", "a named pipe");
  expect_data_file_refused(folder, "below", "a folder");
  expect_data_file_refused(folder, "none.raw", "no such file");
  expect_data_file_refused(folder, "LIST", "many files are not supported");
  expect_data_file_refused(folder, "slice%03d.raw 1 8 1", "many files are not supported");
  for (const char* name : {"below/inside.raw", "good_link.raw"}) {
    const auto image = read_input(write_file(folder / "case/m.mhd", metaimage(mask, false, name)));
    EXPECT_TRUE(image.ok()) << why(image);
  }
}

TEST(HostileImages, a_line_of_a_header_ends_however_a_library_may_think_it_does) {
  std::istringstream stream("a\nb\rc\r\n\r\rd" + std::string(70000, 'e'));
  std::vector<std::string> lines;
  std::vector<bool> lone, whole;
  while (const auto line = detail::next_header_line(stream)) {
    lines.push_back(line->text.substr(0, 3));
    lone.push_back(line->lone_return);
    whole.push_back(line->whole);
  }
  EXPECT_EQ(lines, (std::vector<std::string>{"a", "b", "c", "", "", "dee", "eee"}));
  EXPECT_EQ(lone, (std::vector<bool>{false, true, false, true, true, false, false}));
  EXPECT_EQ(whole, (std::vector<bool>{true, true, true, true, true, false, true}));
}

TEST(HostileImages, no_line_of_an_nrrd_header_hides_from_the_checks) {
  const Mask mask;
  for (const char* hidden : {"# a comment\rdata file: /etc/passwd\n", "key:=value\rDataFile: /etc/passwd\n",
                             "data file: /etc/passwd :=\n", "   \ndata file: /etc/passwd\n"}) {
    expect_refused(read_mask("m.nrrd", nrrd(mask, "raw", hidden)), {"m.nrrd", "an absolute path is not followed"});
  }
  const std::string longest(70000, 'x'), word(600, 'x');
  expect_refused(read_mask("m.nrrd", nrrd(mask, "raw", "key:=" + longest + "\ndata file: /etc/passwd\n")),
                 {"m.nrrd, line 10", "more than 65535 characters"});
  expect_refused(read_mask("m.nrrd", nrrd(mask, "raw", "# " + longest + "\n")), {"m.nrrd, line 10"});
  expect_refused(read_mask("m.nrrd", nrrd(mask, "raw", "labels: " + word + ":=\n")),
                 {"m.nrrd, line 10", "at most 512 are expected"});
  EXPECT_TRUE(read_mask("m.nrrd", nrrd(mask, "raw", "key:=" + word + "\n")).ok());
}

TEST(HostileImages, no_line_of_a_metaimage_header_hides_from_the_checks) {
  const std::string good = metaimage(Mask());
  const auto expect = [&](const char* line, const std::string& instead, std::vector<const char*> says) {
    const auto image = read_mask("m.mha", replaced(good, line, instead));
    ASSERT_FALSE(image.ok()) << instead;
    for (const char* words : says) EXPECT_NE(why(image).find(words), std::string::npos) << why(image);
  };
  expect("NDims = 3", "NDims : 11", {"m.mha, NDims", "'11'"});
  expect("NDims = 3", "NDims:11", {"m.mha, NDims", "'11'"});
  expect("NDims = 3", "ndims = 3\nNDims = 11", {"m.mha, NDims", "'11'"});
  expect("NDims = 3", "NDims : 11 = 3", {"m.mha, NDims"});
  expect("NDims = 3", "Comment = x\rNDims = 11", {"m.mha, line 2", "a carriage return alone"});
  expect("NDims = 3", "NDims\n= 11", {"m.mha, line 2", "KEY = VALUE"});
  expect("NDims = 3", "Comment = " + std::string(5000, 'x') + "\nNDims = 3", {"m.mha, line 2", "4095"});
  expect("NDims = 3", "Comment = " + std::string(255, 'x') + "\nNDims = 3", {"m.mha, line 2", "Comment has 255"});
  expect("NDims = 3", std::string(255, 'x') + " = 1\nNDims = 3", {"m.mha, line 2", "more than 254"});
  expect("ElementDataFile = LOCAL", "ElementDataFile : /etc/passwd", {"an absolute path is not followed"});
  expect("ElementDataFile = LOCAL", "elementdatafile = LOCAL\nElementDataFile = /etc/passwd",
         {"an absolute path is not followed"});
  const auto plain = read_mask("m.mha", good),
             named = read_mask("m.mha", replaced(good, "NDims = 3", "Comment = ElementDataFile\nNDims = 3"));
  ASSERT_TRUE(plain.ok() && named.ok()) << why(plain) << why(named);
  EXPECT_EQ(named->labels, plain->labels) << "the voxels begin after the line itself, not after its name";
}

TEST(HostileImages, what_is_no_regular_file_is_refused_at_once) {
  const Folder folder;
  for (const char* name : {"m.nii.gz", "m.mha", "case.dcm", "c.json", "m.vtu", "m.msh", "s.stl", "run.h5"}) {
    ASSERT_EQ(::mkfifo((folder / name).c_str(), 0600), 0);
    expect_refused(read_input(folder / name), {name, "a named pipe, not a regular file"});
  }
  expect_refused(read_input("/dev/zero"), {"/dev/zero", "a device, not a regular file"});
}
