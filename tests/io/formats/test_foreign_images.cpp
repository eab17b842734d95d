// SPDX-License-Identifier: GPL-3.0-or-later
// Masks as other programs write them off the beaten track: headers that contradict themselves, values that are no
// labels as they stand.
#include "files.hpp"
#include "mask_files.hpp"
#include "stylet/io/label_image_io.hpp"

#include <algorithm>
#include <cstring>
#include <functional>

using namespace stylet;
using namespace stylet::test;

namespace {

bool tells(const Result<LabelImage>& image, const std::string& words) {
  return image.ok() && std::any_of(image->notes.begin(), image->notes.end(),
                                   [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

std::string all_notes(const Result<LabelImage>& image) {
  std::string text = why(image);
  for (std::size_t n = 0; image.ok() && n < image->notes.size(); ++n) text += image->notes[n] + "\n";
  return text;
}

/// Checks that an image has the labels of the mask at the same places.
void expect_same(const Result<LabelImage>& image, const Mask& mask) {
  ASSERT_TRUE(image.ok()) << why(image);
  EXPECT_EQ(image->labels, std::vector<std::uint16_t>(mask.labels.begin(), mask.labels.end()));
  EXPECT_LT((image->voxel_centre(0, 0, 0) - mask.origin).norm(), 1e-3);
  EXPECT_LT((image->voxel_centre(1, 2, 3) - mask.origin - mask.axes * Vec3(1, 2, 3)).norm(), 1e-3);
}

/// The mask as NIfTI with a sform and the same qform, and then changed.
std::string with_both_forms(const Mask& mask, const std::function<void(std::string&)>& change) {
  std::string bytes = nifti(mask, NiftiForm::sform);
  bytes.replace(252, 2, nifti(mask, NiftiForm::qform), 252, 2);
  bytes.replace(256, 24, nifti(mask, NiftiForm::qform), 256, 24);
  change(bytes);
  return bytes;
}

}  // namespace

TEST(ForeignNifti, voxels_that_begin_within_the_header_begin_after_it) {
  const Mask mask;
  for (const float offset : {0.0F, 348.0F, 100.0F, -5.0F}) {
    std::string bytes = nifti(mask);
    poke(bytes, 108, offset);
    for (const std::string& file : {bytes, gzipped(bytes)}) {
      const auto image = read_mask("m.nii", file);
      expect_same(image, mask);
      EXPECT_TRUE(tells(image, "read from byte 352 on")) << all_notes(image);
    }
    expect_refused(read_mask("m.nii", bytes.substr(0, bytes.size() - 1)), {"truncated"});
  }
  std::string extended = nifti(mask);  // an extension of 16 bytes
  poke(extended, 108, 368.0F);
  extended.insert(352, 16, '\1');
  expect_same(read_mask("m.nii", extended), mask);
  EXPECT_EQ(all_notes(read_mask("m.nii", extended)), "");
}

TEST(ForeignNifti, the_other_byte_order_is_read) {
  const Mask mask;
  std::string bytes = with_values<std::int16_t>(nifti_i16, [](int l) { return l; });
  const auto turn = [&](std::size_t at, std::size_t size, std::size_t count) {
    for (std::size_t n = 0; n < count; ++n) std::reverse(&bytes[at + n * size], &bytes[at + n * size] + size);
  };
  turn(0, 4, 1);
  turn(40, 2, 8);
  turn(70, 2, 2);
  turn(76, 4, 11);
  turn(252, 2, 2);
  turn(256, 4, 18);
  turn(352, 2, mask.labels.size());
  expect_same(read_mask("m.nii", bytes), mask);
}

TEST(ForeignNifti, the_sform_counts_whatever_pixdim_says) {
  Mask mask;
  mask.axes = left_handed_axes();
  for (const float wrong : {-2.0F, 0.0F, NAN, 3.0F}) {
    for (int axis = 0; axis < 3; ++axis) {
      std::string bytes = nifti(mask);
      poke(bytes, 80 + 4 * static_cast<std::size_t>(axis), wrong);
      const auto image = read_mask("m.nii", bytes);
      expect_same(image, mask);
      EXPECT_TRUE(tells(image, "sform counts")) << all_notes(image);
    }
  }
  EXPECT_EQ(all_notes(read_mask("m.nii", nifti(mask))), "");
  std::string bytes = nifti(mask, NiftiForm::qform);
  poke(bytes, 84, -2.5F);
  expect_refused(read_mask("m.nii", bytes), {"pixdim[2]", "-2.5", "above 0"});
}

TEST(ForeignNifti, a_sform_that_is_no_grid_gives_way_to_a_valid_qform) {
  Mask mask;
  mask.axes = oblique_axes();
  const auto sheared = [](std::string& bytes) { poke(bytes, 284, 1.5F); };
  const auto flat = [](std::string& bytes) {
    for (std::size_t row = 0; row < 3; ++row) poke(bytes, 284 + 16 * row, 0.0F);
  };
  const auto no_number = [](std::string& bytes) { poke(bytes, 280, NAN); };
  for (const std::function<void(std::string&)>& damage :
       std::vector<std::function<void(std::string&)>>{sheared, flat, no_number}) {
    const auto image = read_mask("m.nii", with_both_forms(mask, damage));
    expect_same(image, mask);
    EXPECT_TRUE(tells(image, "The qform counts instead")) << all_notes(image);
    std::string bad = with_both_forms(mask, damage);
    poke(bad, 256, 3.0F);  // no quaternion of a rotation
    const auto refused = read_mask("m.nii", bad);
    expect_refused(refused, {"m.nii"});
  }
  std::string alone = nifti(mask);
  sheared(alone);
  expect_refused(read_mask("m.nii", alone), {"sheared", "Resample"});
}

TEST(ForeignValues, one_negative_number_or_nan_is_background) {
  const Mask mask;
  const auto minus = with_values<std::int16_t>(nifti_i16, [](int l) { return l == 0 ? -1 : l; });
  const auto far = with_values<std::int16_t>(nifti_i16, [](int l) { return l == 0 ? -1024 : l; });
  const auto none = with_values<float>(nifti_f32, [](int l) { return l == 0 ? double{NAN} : l; });
  const std::string words = " of 887 voxels is taken as background.";
  for (const auto& [bytes, note] : {std::pair(minus, "-1" + words), std::pair(far, "-1024" + words),
                                    std::pair(none, std::string("887 voxels are no number (NaN)"))}) {
    const auto image = read_mask("m.nii", bytes);
    expect_same(image, mask);
    EXPECT_TRUE(tells(image, note)) << all_notes(image);
  }
  std::string text = replaced(nrrd(mask, "ascii"), "type: unsigned char", "type: short");
  const auto data = text.find("\n\n") + 2;
  for (std::size_t at = data; (at = text.find("0 ", at)) != std::string::npos; at += 3) text.replace(at, 2, "-1 ");
  const auto image = read_mask("m.nrrd", text);
  expect_same(image, mask);
  EXPECT_TRUE(tells(image, "-1" + words)) << all_notes(image);
}

TEST(ForeignValues, beside_0_only_minus_1_is_background) {
  const auto both = [](int rest, double value) {
    return [=, n = 0](int l) mutable { return l == 0 ? (++n % rest == 0 ? value : 0.0) : l; };
  };
  const auto image = read_mask("m.nii", with_values<std::int16_t>(nifti_i16, both(2, -1)));
  expect_same(image, Mask());
  EXPECT_TRUE(tells(image, "of 443 voxels is taken as background, as 0 is")) << all_notes(image);
  expect_refused(read_mask("m.nii", with_values<std::int16_t>(nifti_i16, both(2, -7))), {"-7", "0…65535"});
  int n = 0;
  expect_refused(
      read_mask("m.nii", with_values<std::int16_t>(nifti_i16, [&](int l) { return l == 0 ? -1 - ++n % 2 : l; })),
      {"an image, not a mask", "0…65535"});
  expect_refused(
      read_mask("m.nii", with_values<double>(nifti_f64, [](int l) { return l == 1 ? double{INFINITY} : l; })),
      {"voxel (2, 3, 2)", "inf"});
}

TEST(ForeignValues, labels_near_whole_numbers_are_rounded_with_a_note) {
  const Mask mask;
  for (const double off : {2e-5, -9e-4, 5e-3, -9e-3}) {
    const auto image = read_mask("m.nii", with_values<float>(nifti_f32, [&](int l) { return l == 0 ? 0 : l + off; }));
    expect_same(image, mask);
    EXPECT_TRUE(tells(image, "rounded to whole numbers")) << off << all_notes(image);
  }
  for (const double slope : {2.0 / 255, 20.0 / 255, 1.0 / 3276}) {  // labels stored in steps
    std::string bytes = with_values<std::int16_t>(nifti_i16, [&](int l) { return std::round(l / slope); });
    poke(bytes, 112, static_cast<float>(slope));
    const auto image = read_mask("m.nii", bytes);
    expect_same(image, mask);
    EXPECT_TRUE(slope < 1e-3 || tells(image, "rounded to whole numbers")) << all_notes(image);
  }
  EXPECT_EQ(all_notes(read_mask("m.nii", with_values<double>(nifti_f64, [](int l) { return l; }))), "");
  expect_refused(read_mask("m.nii", with_values<float>(nifti_f32, [](int l) { return l == 2 ? 1.98 : l; })),
                 {"1.98 at voxel (9, 7, 5)", "not a whole number"});
  std::string steps = nifti(mask);
  poke(steps, 112, 0.9F);
  expect_refused(read_mask("m.nii", steps), {"0.9 at voxel (2, 3, 2)"});
}

TEST(ForeignMetaImage, without_place_turn_or_voxel_size_is_refused) {
  const std::string text = metaimage(Mask());
  for (const char* field : {"Offset", "TransformMatrix", "ElementSpacing"}) {
    const auto start = text.find(field);
    std::string without = text;
    without.erase(start, text.find('\n', start) - start + 1);
    expect_refused(read_mask("m.mha", without),
                   {"m.mha", "does not state the position", (std::string("no ") + field).c_str(), "left and right"});
  }
  expect_same(read_mask("m.mha", replaced(replaced(text, "Offset", "Position"), "TransformMatrix", "Orientation")),
              Mask());
  expect_same(read_mask("m.mha", replaced(text, "ElementSpacing", "ElementSize")), Mask());
}

TEST(ForeignNrrd, without_place_or_voxel_size_is_refused) {
  const std::string text = nrrd(Mask());
  for (const char* field : {"space directions", "space origin"}) {
    const auto start = text.find(field);
    std::string without = text;
    without.erase(start, text.find('\n', start) - start + 1);
    expect_refused(read_mask("m.nrrd", without),
                   {"m.nrrd", "does not state the position", (std::string("no '") + field).c_str()});
  }
}

TEST(ForeignNrrd, long_free_text_is_read) {
  const Mask mask;
  for (const char* field : {"content", "sample units"}) {
    for (const std::size_t length : {600U, 5000U, 60000U})
      expect_same(read_mask("m.nrrd", nrrd(mask, "gzip", std::string(field) + ": " + std::string(length, 'x') + "\n")),
                  mask);
  }
  expect_refused(read_mask("m.nrrd", nrrd(mask, "raw", "labels: " + std::string(600, 'x') + "\n")), {"line", "512"});
}

TEST(ForeignNrrd, units_of_length_are_known_by_their_names) {
  for (const auto& [name, mm] : std::vector<std::pair<std::string, double>>{{"microns", 1e-3},
                                                                            {"micron", 1e-3},
                                                                            {"um", 1e-3},
                                                                            {"\u00b5m", 1e-3},
                                                                            {"\u03bcm", 1e-3},
                                                                            {"micrometers", 1e-3},
                                                                            {"nm", 1e-6},
                                                                            {"nanometers", 1e-6},
                                                                            {"millimeters", 1},
                                                                            {"MM", 1},
                                                                            {"cm", 10},
                                                                            {"centimetres", 10},
                                                                            {"m", 1000},
                                                                            {"meters", 1000},
                                                                            {"in", 25.4},
                                                                            {"inches", 25.4}}) {
    Mask file;
    const Mask mask;
    file.axes /= mm;
    file.origin /= mm;
    SCOPED_TRACE(name);
    expect_same(
        read_mask("m.nrrd", nrrd(file, "raw", "space units: \"" + name + "\" \"" + name + "\" \"" + name + "\"\n")),
        mask);
  }
}
