// SPDX-License-Identifier: GPL-3.0-or-later
#include "files.hpp"
#include "mask_files.hpp"
#include "stylet/io/label_image_io.hpp"

using namespace stylet;
using namespace stylet::test;

TEST(LabelImageErrors, whole_numbers_in_floating_point_are_labels_others_are_not) {
  const auto image = read_mask("mask.nii", with_values<float>(nifti_f32, [](int l) { return l; }));
  ASSERT_TRUE(image.ok()) << why(image);
  EXPECT_EQ(*std::max_element(image->labels.begin(), image->labels.end()), 2);
  expect_refused(read_mask("p.nii", with_values<float>(nifti_f32, [](int l) { return 0.5 * l; })),
                 {"an image, not a mask", "3 different values from 0 to 1", "voxel (2, 3, 2)", "0.5",
                  "not a whole number", "probability"});
  expect_refused(read_mask("n.nii", with_values<float>(nifti_f32, [](int l) { return l != 0 ? double{NAN} : 0.0; })),
                 {"the mask is empty", "nan"});
}

TEST(LabelImageErrors, a_grey_value_picture_is_refused) {
  int n = 0;
  expect_refused(read_mask("ct.nii", with_values<std::int16_t>(nifti_i16, [&](int) { return ++n; })),
                 {"ct.nii", "an image, not a mask", "960 different values from 1 to 960"});
}

TEST(LabelImageErrors, labels_may_be_scaled_and_of_any_type) {
  std::string scaled = nifti(Mask());
  poke(scaled, 112, 2.0F);  // scl_slope
  const auto image = value_of(read_mask("scaled.nii", scaled));
  EXPECT_EQ(*std::max_element(image.labels.begin(), image.labels.end()), 4);
  for (const char* type : {"float", "double"})
    EXPECT_TRUE(read_mask("m.nrrd", replaced(nrrd(Mask(), "ascii"), "unsigned char", type)).ok());
}

TEST(LabelImageErrors, a_picture_with_few_grey_values_is_one_and_a_mask_with_many_labels_is_not) {
  Mask mask;
  for (std::size_t n = 0; n < mask.labels.size(); ++n)
    mask.labels[n] = static_cast<std::uint8_t>(101 * n);  // all bytes
  expect_refused(read_mask("mr.nii", nifti(mask)), {"an image, not a mask", "256 different values from 0 to 255"});
  for (std::uint8_t& v : mask.labels) v %= 40;
  expect_refused(read_mask("mr.mha", metaimage(mask)), {"an image, not a mask", "40 different values from 0 to 39"});
  for (std::size_t n = 0; n < mask.labels.size(); ++n) mask.labels[n] = static_cast<std::uint8_t>(n / 6);  // 160 pieces
  const auto image = read_mask("parts.nrrd", nrrd(mask));
  EXPECT_TRUE(image.ok()) << why(image);
}

TEST(LabelImageErrors, an_empty_mask_is_refused) {
  Mask mask;
  std::fill(mask.labels.begin(), mask.labels.end(), 0);
  expect_refused(read_mask("mask.nii", nifti(mask)), {"every voxel is 0"});
  expect_refused(read_mask("mask.nrrd", nrrd(mask)), {"every voxel is 0"});
  expect_refused(read_mask("mask.mha", metaimage(mask)), {"every voxel is 0"});
}

TEST(LabelImageErrors, truncated_data_are_refused) {
  const Mask mask;
  const auto cut = [](const std::string& bytes) { return bytes.substr(0, bytes.size() - 200); };
  expect_refused(read_mask("mask.nii", cut(nifti(mask))), {"mask.nii", "truncated"});
  expect_refused(read_mask("mask.nii.gz", gzipped(cut(nifti(mask)))), {"mask.nii.gz", "truncated"});
  const std::string packed = gzipped(nifti(mask));
  expect_refused(read_mask("mask.nii.gz", packed.substr(0, packed.size() / 2)), {"mask.nii.gz"});
  expect_refused(read_mask("mask.nrrd", cut(nrrd(mask))), {"mask.nrrd", "truncated"});
  const std::string gzip_nrrd = nrrd(mask, "gzip");
  expect_refused(read_mask("mask.nrrd", gzip_nrrd.substr(0, gzip_nrrd.size() - 20)), {"mask.nrrd", "truncated"});
  expect_refused(read_mask("mask.mha", cut(metaimage(mask))), {"mask.mha", "truncated"});
  const std::string packed_meta = metaimage(mask, true);
  expect_refused(read_mask("mask.mha", packed_meta.substr(0, packed_meta.size() - 20)), {"mask.mha", "truncated"});
}

TEST(LabelImageErrors, absurd_sizes_are_refused_and_not_allocated) {
  const Mask mask;
  std::string bytes = nifti(mask);
  for (int d = 0; d < 3; ++d) poke<std::int16_t>(bytes, 42 + 2 * d, 30000);
  expect_refused(read_mask("mask.nii", bytes), {"mask.nii"});
  expect_refused(read_mask("mask.nrrd", replaced(nrrd(mask), "sizes: 12 10 8", "sizes: 12000 10000 800000")),
                 {"mask.nrrd"});
  expect_refused(read_mask("mask.mha", replaced(metaimage(mask), "DimSize = 12 10 8", "DimSize = 12000 10000 800000")),
                 {"mask.mha"});
  expect_refused(read_mask("mask.mha", replaced(metaimage(mask), "DimSize = 12 10 8", "DimSize = 12 -10 8")),
                 {"mask.mha"});
}

TEST(LabelImageErrors, images_that_are_not_3d_are_refused) {
  Mask mask;
  std::string bytes = nifti(mask);
  poke<std::int16_t>(bytes, 40, 4);
  poke<std::int16_t>(bytes, 46, 4);
  poke<std::int16_t>(bytes, 48, 2);
  expect_refused(read_mask("mask.nii", bytes),
                 {"2 volumes", "12 × 10 × 4 × 2", "volume = 1 below [patient]", "--volume 1"});
  bytes = nifti(mask);
  poke<std::int16_t>(bytes, 46, 1);
  expect_refused(read_mask("mask.nii", bytes), {"12 × 10 × 1", "whole volume"});
  expect_refused(read_mask("mask.mha", replaced(metaimage(mask), "DimSize = 12 10 8", "DimSize = 12 80 1")),
                 {"12 × 80 × 1"});
}

namespace {

/// A file with two volumes: the first has only label 5, the second is the mask.
std::string two_volumes(const Mask& mask, const std::string& one) {
  return one.substr(0, one.size() - mask.labels.size()) + std::string(mask.labels.size(), '\5') +
         one.substr(one.size() - mask.labels.size());
}

}  // namespace

TEST(LabelImageErrors, one_volume_of_several_can_be_chosen) {
  const Folder folder;
  const Mask mask;
  std::string bytes = nifti(mask);
  poke<std::int16_t>(bytes, 40, 4);
  poke<std::int16_t>(bytes, 48, 2);
  write_file(folder / "m.nii", two_volumes(mask, bytes));
  std::string text =
      replaced(replaced(nrrd(mask), "dimension: 3", "dimension: 4"), "sizes: 12 10 8", "sizes: 12 10 8 2");
  text = replaced(replaced(text, "(0,0,4)", "(0,0,4) none"), "domain domain domain", "domain domain domain list");
  write_file(folder / "m.nrrd", two_volumes(mask, text));
  text = replaced(replaced(metaimage(mask), "NDims = 3", "NDims = 4"), "DimSize = 12 10 8", "DimSize = 12 10 8 2");
  text = replaced(replaced(text, "ElementSpacing = 2 2.5 4", "ElementSpacing = 2 2.5 4 1"), "Offset = -10 20 -30",
                  "Offset = -10 20 -30 0");
  text = replaced(text, "TransformMatrix = 1 0 0 0 1 0 0 0 1", "TransformMatrix = 1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1");
  write_file(folder / "m.mha",
             two_volumes(mask, replaced(text, "CenterOfRotation = 0 0 0", "CenterOfRotation = 0 0 0 0")));
  for (const char* name : {"m.nii", "m.nrrd", "m.mha"}) {
    SCOPED_TRACE(name);
    expect_refused(read_label_image(folder / name), {name, "2 volumes", "12 × 10 × 8 × 2", "--volume 1"});
    expect_refused(read_label_image(folder / name, {.volume = 3}), {name, "volume 3", "holds 2"});
    const auto first = read_label_image(folder / name, {.volume = 1}),
               second = read_label_image(folder / name, {.volume = 2});
    ASSERT_TRUE(first.ok() && second.ok()) << why(first) << why(second);
    EXPECT_EQ(std::count(first->labels.begin(), first->labels.end(), 5), 960);
    EXPECT_EQ(second->labels, std::vector<std::uint16_t>(mask.labels.begin(), mask.labels.end()));
    EXPECT_NEAR((second->voxel_centre(0, 0, 0) - mask.origin).norm(), 0, 1e-4);
  }
  expect_refused(read_label_image(write_file(folder / "one.nii", nifti(mask)), {.volume = 2}), {"volume 2", "holds 1"});
}

TEST(LabelImageErrors, an_nrrd_of_five_dimensions_is_refused_whatever_volume_is_chosen) {
  const Folder folder;
  const Mask mask;
  std::string text =
      replaced(replaced(nrrd(mask), "dimension: 3", "dimension: 5"), "sizes: 12 10 8", "sizes: 12 10 8 1 2");
  text = replaced(replaced(text, "(0,0,4)", "(0,0,4) none none"), "domain domain domain",
                  "domain domain domain list list");
  const fs::path path = write_file(folder / "m.nrrd", two_volumes(mask, text));
  for (const int volume : {0, 1, 2}) {
    expect_refused(read_label_image(path, {.volume = volume}),
                   {"m.nrrd, dimension", "the value is 5", "3 or 4 is expected"});
  }
}

TEST(LabelImageErrors, an_image_that_does_not_say_where_it_lies_is_refused) {
  const Mask mask;
  expect_refused(read_mask("mask.nii", nifti(mask, NiftiForm::none)),
                 {"neither sform nor qform", "left and right are unknown"});
  expect_refused(read_mask("mask.nrrd", nrrd(mask, "raw", "", "scanner-xyz")), {"scanner-xyz"});
  std::string text = nrrd(mask);
  for (const char* key : {"space: ", "space directions: ", "space origin: "}) {
    const auto start = text.find(key);
    text.erase(start, text.find('\n', start) - start + 1);
  }
  expect_refused(read_mask("mask.nrrd", text), {"no 'space'", "space directions"});
}

TEST(LabelImageErrors, frames_that_are_no_frames_are_refused) {
  const Mask mask;
  std::string bytes = nifti(mask);
  poke(bytes, 280, NAN);
  expect_refused(read_mask("mask.nii", bytes), {"mask.nii, sform", "nan mm"});
  bytes = nifti(mask);
  for (int row = 0; row < 3; ++row) poke(bytes, 284 + 16 * row, 0.0F);  // second column
  expect_refused(read_mask("mask.nii", bytes), {"mask.nii"});
  bytes = nifti(mask);
  poke(bytes, 284, 1.5F);
  expect_refused(read_mask("mask.nii", bytes), {"i and j", "90° is expected", "sheared"});
  expect_refused(read_mask("mask.nrrd", replaced(nrrd(mask), "(2,0,0)", "(0,0,0)")), {"mask.nrrd"});
  expect_refused(read_mask("mask.nrrd", replaced(nrrd(mask), "(-10,20,-30)", "(-10,nan,-30)")), {"mask.nrrd"});
  expect_refused(read_mask("mask.mha", replaced(metaimage(mask), "ElementSpacing = 2 ", "ElementSpacing = 0 ")),
                 {"ElementSpacing", "above 0"});
}

TEST(LabelImageErrors, extents_off_by_1000_are_refused) {
  for (const double factor : {1e-3, 40.0}) {
    Mask mask;
    mask.axes = Vec3(2.0, 2.5, 2.4).asDiagonal();
    mask.axes *= factor;
    for (int i = 0; factor > 1 && i < 3; ++i) mask.size[i] *= 3;  // voxels of at most 100 mm
    if (factor > 1) mask.labels.assign(mask.labels.size() * 27, 1);
    for (const auto& result :
         {read_mask("m.nii", nifti(mask)), read_mask("m.nrrd", nrrd(mask)), read_mask("m.mha", metaimage(mask))}) {
      expect_refused(result, {"1 mm to 2 m is expected", "not mm"});
    }
  }
}

TEST(LabelImageErrors, colour_images_are_refused) {
  const Mask mask;
  std::string bytes = nifti(mask);
  poke<std::int16_t>(bytes, 70, 128);  // RGB
  poke<std::int16_t>(bytes, 72, 24);
  bytes += std::string(2 * mask.labels.size(), '\0');
  expect_refused(read_mask("mask.nii", bytes), {"3 components"});
}

TEST(LabelImageErrors, nifti_voxel_types_of_no_standard_are_refused) {
  for (const int code : {0, 3, 26989}) {
    std::string bytes = nifti(Mask());
    poke<std::int16_t>(bytes, 70, static_cast<std::int16_t>(code));
    const std::string said = "the voxel type (code " + std::to_string(code) + ")";
    expect_refused(read_mask("mask.nii", bytes), {said.c_str()});
  }
}

TEST(LabelImageErrors, other_files_are_named) {
  const Folder folder;
  expect_refused(read_label_image(write_file(folder / "a.nii", "{\"format\": 1}")), {"a JSON file", "a label mask"});
  expect_refused(read_label_image(write_file(folder / "b.nii", "hello")), {"unknown format", "a label mask"});
}
