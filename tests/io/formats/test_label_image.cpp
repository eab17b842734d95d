// SPDX-License-Identifier: GPL-3.0-or-later
#include "files.hpp"
#include "mask_files.hpp"
#include "stylet/io/label_image_io.hpp"

using namespace stylet;
using namespace stylet::test;

namespace {

Vec3 centre(const LabelImage& image, int label) {
  Vec3 sum = Vec3::Zero();
  int count = 0;
  std::size_t n = 0;
  for (int k = 0; k < image.size[2]; ++k) {
    for (int j = 0; j < image.size[1]; ++j) {
      for (int i = 0; i < image.size[0]; ++i, ++n) {
        if (image.labels[n] != label) continue;
        sum += image.voxel_centre(i, j, k);
        ++count;
      }
    }
  }
  EXPECT_EQ(count, label == 1 ? 72 : 1);
  return sum / count;
}

/// Checks that both labels of an image are at the same places in the patient as in the mask, for any order of voxels.
void expect_same_place(const Result<LabelImage>& image, const Mask& mask, const std::string& what) {
  ASSERT_TRUE(image.ok()) << what << ": " << why(image);
  for (const int label : {1, 2}) {
    EXPECT_LT((centre(*image, label) - mask.centre(label)).norm(), 1e-3) << what << ", label " << label;
  }
  EXPECT_LT((image->direction.transpose() * image->direction - Mat3::Identity()).norm(), 1e-5) << what;
}

}  // namespace

TEST(LabelImage, nifti_keeps_oblique_and_left_handed_frames) {
  for (const Mat3& axes : {Mask().axes, oblique_axes(), left_handed_axes()}) {
    Mask mask;
    mask.axes = axes;
    expect_same_place(read_mask("mask.nii", nifti(mask, NiftiForm::sform)), mask, "sform");
    expect_same_place(read_mask("mask.nii", nifti(mask, NiftiForm::qform)), mask, "qform");
    expect_same_place(read_mask("mask.nii.gz", gzipped(nifti(mask))), mask, "gzip");
  }
}

TEST(LabelImage, nifti_prefers_the_sform) {
  Mask mask;
  std::string bytes = nifti(mask);
  poke<std::int16_t>(bytes, 252, 1);  // a contradicting qform
  poke(bytes, 268, 500.0F);
  expect_same_place(read_mask("mask.nii", bytes), mask, "both");
}

TEST(LabelImage, nifti_units_are_turned_into_mm) {
  Mask metres;
  std::string bytes = nifti(metres);
  for (int i = 0; i < 3; ++i) {
    for (int a = 0; a < 4; ++a) {
      float value = 0.0F;
      std::memcpy(&value, bytes.data() + 280 + 16 * i + 4 * a, 4);
      poke(bytes, 280 + 16 * i + 4 * a, value * 1e-3F);
    }
    poke(bytes, 80 + 4 * i, static_cast<float>(metres.axes.col(i).norm()) * 1e-3F);
  }
  poke<char>(bytes, 123, 1);
  expect_same_place(read_mask("mask.nii", bytes), metres, "metres");
  poke<char>(bytes, 123, 2);
  expect_refused(read_mask("mask.nii", bytes), {"0.016 mm long", "1 mm to 2 m", "spacing"});
}

TEST(LabelImage, nrrd_keeps_oblique_and_left_handed_frames) {
  for (const Mat3& axes : {Mask().axes, oblique_axes(), left_handed_axes()}) {
    Mask mask;
    mask.axes = axes;
    for (const char* encoding : {"raw", "gzip", "ascii"})
      expect_same_place(read_mask("mask.nrrd", nrrd(mask, encoding)), mask, encoding);
  }
}

TEST(LabelImage, nrrd_spaces_are_turned_into_lps) {
  Mask mask, ras, las;
  ras.axes = Vec3(-1, -1, 1).asDiagonal() * mask.axes;
  ras.origin = Vec3(-1, -1, 1).asDiagonal() * mask.origin;
  las.axes = Vec3(1, -1, 1).asDiagonal() * mask.axes;
  las.origin = Vec3(1, -1, 1).asDiagonal() * mask.origin;
  expect_same_place(read_mask("mask.nrrd", nrrd(ras, "raw", "", "right-anterior-superior")), mask, "RAS");
  expect_same_place(read_mask("mask.nrrd", nrrd(las, "raw", "", "left-anterior-superior")), mask, "LAS");
  expect_same_place(read_mask("mask.nrrd", nrrd(ras, "raw", "", "RAS")), mask, "RAS, short");
}

TEST(LabelImage, nrrd_units_are_turned_into_mm) {
  Mask mask, centimetres;
  centimetres.axes *= 0.1;
  centimetres.origin *= 0.1;
  expect_same_place(read_mask("mask.nrrd", nrrd(centimetres, "raw", "space units: \"cm\" \"cm\" \"cm\"\n")), mask,
                    "cm");
  expect_refused(read_mask("mask.nrrd", nrrd(mask, "raw", "space units: \"ell\" \"ell\" \"ell\"\n")), {"unit 'ell'"});
}

TEST(LabelImage, segment_names_of_seg_nrrd_are_kept) {
  const Mask mask;
  const auto image = value_of(
      read_mask("case.seg.nrrd",
                nrrd(mask, "gzip",
                     "Segment0_ID:=Segment_1\nSegment0_LabelValue:=1\nSegment0_Layer:=0\nSegment0_Name:=Prostate\n"
                     "Segment1_LabelValue:=2\nSegment1_Layer:=0\nSegment1_Name:=Urethra \n")));
  EXPECT_EQ(image.names, (std::map<int, std::string>{{1, "Prostate"}, {2, "Urethra"}}));
}

TEST(LabelImage, nrrd_with_its_data_beside_it_is_read) {
  const Folder folder;
  const Mask mask;
  write_file(folder / "mask.raw", std::string(mask.labels.begin(), mask.labels.end()));
  const std::string header = nrrd(mask, "raw", "data file: mask.raw\n");
  write_file(folder / "mask.nhdr", header.substr(0, header.size() - mask.labels.size()));
  expect_same_place(read_label_image(folder / "mask.nhdr"), mask, "nhdr");
}

TEST(LabelImage, metaimage_keeps_oblique_and_left_handed_frames) {
  for (const Mat3& axes : {Mask().axes, oblique_axes(), left_handed_axes()}) {
    Mask mask;
    mask.axes = axes;
    expect_same_place(read_mask("mask.mha", metaimage(mask)), mask, "raw");
    expect_same_place(read_mask("mask.mha", metaimage(mask, true)), mask, "compressed");
  }
}

TEST(LabelImage, metaimage_with_its_data_beside_it_is_read) {
  const Folder folder;
  const Mask mask;
  write_file(folder / "mask.raw", std::string(mask.labels.begin(), mask.labels.end()));
  write_file(folder / "mask.mhd", metaimage(mask, false, "mask.raw"));
  expect_same_place(read_label_image(folder / "mask.mhd"), mask, "mhd");
  fs::remove(folder / "mask.raw");
  expect_refused(read_label_image(folder / "mask.mhd"), {"mask.mhd", "mask.raw", "in one folder"});
}

TEST(LabelImage, the_same_mask_in_three_formats_is_the_same_image) {
  Mask mask;
  mask.axes = oblique_axes();
  const Result<LabelImage> a = read_mask("a.nii", nifti(mask)), b = read_mask("b.nrrd", nrrd(mask)),
                           c = read_mask("c.mha", metaimage(mask));
  ASSERT_TRUE(a.ok() && b.ok() && c.ok());
  EXPECT_EQ(a->labels, b->labels);
  EXPECT_EQ(b->labels, c->labels);
  EXPECT_LT((a->origin - b->origin).norm() + (a->direction - b->direction).norm() + (a->spacing - b->spacing).norm(),
            1e-4);
  EXPECT_LT((c->origin - b->origin).norm() + (c->direction - b->direction).norm() + (c->spacing - b->spacing).norm(),
            1e-10);
}

TEST(LabelImage, a_format_is_known_by_its_content_not_its_name) {
  const Mask mask;
  expect_same_place(read_mask("mask.nrrd", nifti(mask)), mask, "NIfTI called .nrrd");
  expect_same_place(read_mask("mask", nrrd(mask)), mask, "NRRD without extension");
  expect_same_place(read_mask("mask.nii", metaimage(mask)), mask, "MetaImage called .nii");
}
