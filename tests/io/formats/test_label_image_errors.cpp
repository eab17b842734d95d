// SPDX-License-Identifier: GPL-3.0-or-later
#include "files.hpp"
#include "mask_files.hpp"
#include "stylet/io/label_image_io.hpp"

using namespace stylet;
using namespace stylet::test;

namespace {

/// NIfTI with voxels of another type.
template <class T>
std::string typed(std::int16_t code, const std::function<T(std::uint8_t)>& value) {
  const Mask mask;
  std::string bytes = nifti(mask).substr(0, 352);
  poke<std::int16_t>(bytes, 70, code);
  poke<std::int16_t>(bytes, 72, 8 * sizeof(T));
  for (const std::uint8_t label : mask.labels) {
    const T v = value(label);
    bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
  }
  return bytes;
}

constexpr std::int16_t nifti_int16 = 4, nifti_float = 16;

}  // namespace

TEST(LabelImageErrors, whole_numbers_in_floating_point_are_labels_others_are_not) {
  const auto image =
      read_mask("mask.nii", typed<float>(nifti_float, [](std::uint8_t l) { return static_cast<float>(l); }));
  ASSERT_TRUE(image.ok()) << why(image);
  EXPECT_EQ(*std::max_element(image->labels.begin(), image->labels.end()), 2);
  expect_refused(
      read_mask("p.nii", typed<float>(nifti_float, [](std::uint8_t l) { return 0.5F * static_cast<float>(l); })),
      {"voxel (2, 3, 2)", "0.5", "not a whole number", "probability"});
  expect_refused(read_mask("n.nii", typed<float>(nifti_float, [](std::uint8_t l) { return l != 0 ? NAN : 0.0F; })),
                 {"voxel (2, 3, 2)", "nan"});
}

TEST(LabelImageErrors, negative_labels_are_refused) {
  expect_refused(read_mask("ct.nii", typed<std::int16_t>(nifti_int16,
                                                         [](std::uint8_t l) { return static_cast<std::int16_t>(-l); })),
                 {"voxel (2, 3, 2)", "-1", "0…65535"});
}

TEST(LabelImageErrors, a_grey_value_picture_is_refused) {
  int n = 0;
  expect_refused(read_mask("ct.nii", typed<std::int16_t>(nifti_int16,
                                                         [&](std::uint8_t) { return static_cast<std::int16_t>(++n); })),
                 {"ct.nii", "different values", "picture"});
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
  expect_refused(read_mask("mask.nii", bytes), {"4 dimensions", "12 × 10 × 4 × 2", "one 3D label mask"});
  bytes = nifti(mask);
  poke<std::int16_t>(bytes, 46, 1);
  expect_refused(read_mask("mask.nii", bytes), {"12 × 10 × 1", "whole volume"});
  expect_refused(read_mask("mask.mha", replaced(metaimage(mask), "DimSize = 12 10 8", "DimSize = 12 80 1")),
                 {"12 × 80 × 1"});
}

TEST(LabelImageErrors, overlapping_segments_in_layers_are_refused_with_the_way_out) {
  const Mask mask;
  std::string text = replaced(nrrd(mask), "dimension: 3", "dimension: 4");
  text = replaced(text, "sizes: 12 10 8", "sizes: 2 6 10 8");
  text = replaced(text, "space directions: (", "space directions: none (");
  text = replaced(text, "kinds: domain", "kinds: list domain");
  expect_refused(read_mask("case.seg.nrrd", text), {"2 layers", "overlap", "collapse"});
}

TEST(LabelImageErrors, an_image_that_does_not_say_where_it_lies_is_refused) {
  const Mask mask;
  expect_refused(read_mask("mask.nii", nifti(mask, NiftiForm::none)), {"neither sform nor qform", "left and right"});
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
  expect_refused(read_mask("mask.nii", bytes), {"mask.nii", "not finite"});
  bytes = nifti(mask);
  for (int row = 0; row < 3; ++row) poke(bytes, 284 + 16 * row, 0.0F);  // second column
  expect_refused(read_mask("mask.nii", bytes), {"mask.nii"});
  bytes = nifti(mask);
  poke(bytes, 284, 1.5F);
  expect_refused(read_mask("mask.nii", bytes), {"i and j", "90° is expected", "sheared"});
  expect_refused(read_mask("mask.nrrd", replaced(nrrd(mask), "(2,0,0)", "(0,0,0)")), {"mask.nrrd"});
  expect_refused(read_mask("mask.nrrd", replaced(nrrd(mask), "(-10,20,-30)", "(-10,nan,-30)")), {"mask.nrrd"});
  expect_refused(read_mask("mask.mha", replaced(metaimage(mask), "ElementSpacing = 2 ", "ElementSpacing = 0 ")),
                 {"spacing", "zero"});
}

TEST(LabelImageErrors, extents_off_by_1000_are_refused) {
  for (const double factor : {1e-3, 1e3}) {
    Mask mask;
    mask.axes *= factor;
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

TEST(LabelImageErrors, other_files_are_named) {
  const Folder folder;
  expect_refused(read_label_image(write_file(folder / "a.nii", "{\"format\": 1}")), {"a JSON file", "a label mask"});
  expect_refused(read_label_image(write_file(folder / "b.nii", "hello")), {"unknown format", "a label mask"});
}
