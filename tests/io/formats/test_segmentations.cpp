// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of segmentations with several, possibly overlapping, segments: DICOM SEG and the layers of .seg.nrrd.
#include "segmentation_files.hpp"
#include "stylet/io/input.hpp"

#include <dcmtk/dcmdata/dcrleerg.h>
#include <fmt/format.h>

#include <algorithm>

using namespace stylet;
using namespace stylet::test;

namespace {

bool in_gland(int i, int j, int k) { return i >= 2 && i < 9 && j >= 2 && j < 8 && k >= 1 && k < 7; }
bool in_urethra(int i, int j, int /*k*/) { return i >= 4 && i < 6 && j >= 4 && j < 6; }

std::vector<Drawn> gland_and_urethra() { return {{"Prostate", "Prostate", in_gland}, {"duct", "Urethra", in_urethra}}; }

/// All voxels of the grid of `frame`, with value 1 where `inside` is true.
std::vector<std::uint8_t> voxels(const Mask& frame, const std::function<bool(int, int, int)>& inside) {
  std::vector<std::uint8_t> values;
  for (int k = 0; k < frame.size[2]; ++k) {
    for (int j = 0; j < frame.size[1]; ++j) {
      for (int i = 0; i < frame.size[0]; ++i) values.push_back(static_cast<std::uint8_t>(inside(i, j, k)));
    }
  }
  return values;
}

/// The label of an image at a place in the patient; 0 outside of the image.
int label_at(const LabelImage& image, const Vec3& place) {
  const Vec3 index = (image.direction.transpose() * (place - image.origin)).cwiseQuotient(image.spacing);
  std::array<Index, 3> voxel{};
  for (int a = 0; a < 3; ++a) {
    voxel[a] = static_cast<Index>(std::lround(index[a]));
    EXPECT_NEAR(index[a], voxel[a], 1e-2) << "the grids differ";
    if (voxel[a] < 0 || voxel[a] >= image.size[a]) return 0;
  }
  return image.labels[(static_cast<std::size_t>(voxel[2]) * image.size[1] + voxel[1]) * image.size[0] + voxel[0]];
}

/// Checks that both images have the same labels on the grid of `frame`.
void expect_same_labels(const LabelImage& a, const LabelImage& b, const Mask& frame) {
  std::size_t differing = 0, labelled = 0;
  for (int k = 0; k < frame.size[2]; ++k) {
    for (int j = 0; j < frame.size[1]; ++j) {
      for (int i = 0; i < frame.size[0]; ++i) {
        const Vec3 place = frame.origin + frame.axes * Vec3(i, j, k);
        differing += label_at(a, place) != label_at(b, place) ? 1 : 0;
        labelled += label_at(b, place) != 0 ? 1 : 0;
      }
    }
  }
  EXPECT_EQ(differing, 0U);
  EXPECT_GT(labelled, 200U);
}

bool notes_say(const LabelImage& image, const std::string& words) {
  return std::any_of(image.notes.begin(), image.notes.end(),
                     [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

}  // namespace

TEST(DicomSeg, has_its_voxels_where_the_same_mask_in_nrrd_has_them) {
  const Folder folder;
  for (const Mat3& axes : {Mask().axes, oblique_axes(), left_handed_axes()}) {
    Mask frame;
    frame.axes = axes;
    frame.labels = voxels(frame, in_gland);
    for (std::size_t n = 0; n < frame.labels.size(); ++n)
      frame.labels[n] = static_cast<std::uint8_t>(frame.labels[n] + (voxels(frame, in_urethra)[n] != 0 ? 2 : 0));
    for (std::uint8_t& label : frame.labels) label = label >= 2 ? 2 : label;
    const auto seg = value_of(read_label_image(write_seg(folder / "seg.dcm", frame, gland_and_urethra())));
    const auto same = value_of(read_mask("same.nrrd", nrrd(frame)));
    expect_same_labels(seg, same, frame);
  }
}

TEST(DicomSeg, segments_carry_their_label_and_the_meaning_of_their_code) {
  const Folder folder;
  const auto input = value_of(read_input(write_seg(folder / "seg", Mask(), gland_and_urethra())));
  const auto& image = std::get<LabelImage>(input);
  EXPECT_EQ(image.names, (std::map<int, std::string>{{1, "Prostate"}, {2, "duct"}}));
  EXPECT_EQ(image.meanings, (std::map<int, std::string>{{1, "Prostate"}, {2, "Urethra"}}));
  EXPECT_TRUE(notes_say(image, "'duct' and 'Prostate' share 24 voxels"));
}

TEST(DicomSeg, a_skipped_segment_takes_no_voxel_from_what_lies_below) {
  const Folder folder;
  const fs::path path = write_seg(folder / "seg.dcm", Mask(), gland_and_urethra());
  for (const char* word : {"duct", "DUCT", "2"}) {
    const std::vector<std::string> skip{word};
    const auto input = value_of(read_input(path, {}, {}, skip));
    const auto& image = std::get<LabelImage>(input);
    EXPECT_EQ(std::count(image.labels.begin(), image.labels.end(), 1), 7 * 6 * 6) << word;
    EXPECT_EQ(std::count(image.labels.begin(), image.labels.end(), 2), 0) << word;
    EXPECT_EQ(image.names.at(2), "duct") << "what was skipped is known";
    EXPECT_FALSE(notes_say(image, "share"));
    EXPECT_FALSE(notes_say(image, "is empty"));
  }
  expect_refused(read_label_image(path, {.skip = {"Prostate", "duct"}}), {"seg.dcm", "every segment is left out"});
}

TEST(DicomSeg, slices_without_a_frame_are_empty) {
  const Folder folder;
  const Mask frame;
  const auto gap = [](int i, int j, int k) { return in_gland(i, j, k) && k != 3; };
  const auto image = value_of(read_label_image(write_seg(folder / "seg.dcm", frame, {{"Prostate", "Prostate", gap}})));
  EXPECT_EQ(image.size, (std::array<Index, 3>{12, 10, 6}));
  EXPECT_EQ(label_at(image, frame.origin + frame.axes * Vec3(4, 4, 3)), 0);
  EXPECT_EQ(label_at(image, frame.origin + frame.axes * Vec3(4, 4, 4)), 1);
}

TEST(DicomSeg, a_stated_distance_of_slices_counts_where_most_slices_have_no_frame) {
  const Folder folder;
  const auto seg = [&](const std::function<bool(int)>& in, const char* stated) {
    Mask frame;
    frame.axes = oblique_axes();
    const auto inside = [&](int i, int j, int k) { return in_gland(i, j, 3) && in(k); };
    return read_label_image(
        edit_dicom(write_seg(folder / "seg.dcm", frame, {{"Prostate", "Prostate", inside}}), [&](DcmDataset& data) {
          DcmItem* shared = nullptr;
          DcmItem* measures = nullptr;
          data.findAndGetSequenceItem(DCM_SharedFunctionalGroupsSequence, shared);
          shared->findAndGetSequenceItem(DCM_PixelMeasuresSequence, measures);
          if (*stated != 0) measures->putAndInsertString(DCM_SpacingBetweenSlices, stated);
        }));
  };
  for (const char* stated : {"4", "-4", "3.99"}) {
    const auto odd = seg([](int k) { return k % 2 == 1; }, stated), far = seg([](int k) { return k % 6 == 0; }, stated),
               uneven = seg([](int k) { return k == 0 || k == 2 || k == 5; }, stated);
    ASSERT_TRUE(odd.ok() && far.ok() && uneven.ok()) << why(odd) << why(far) << why(uneven);
    for (const auto* image : {&*odd, &*far, &*uneven}) EXPECT_NEAR(image->spacing[2], 4, 1e-6) << stated;
    EXPECT_EQ(odd->size[2], 7);
    EXPECT_EQ(far->size[2], 7);
    EXPECT_EQ(uneven->size[2], 6);
    EXPECT_TRUE(notes_say(*odd, "3 of 7 slices of 4 mm have no frame and are empty: slices 2, 4, 6,"));
    EXPECT_TRUE(notes_say(*far, "5 of 7 slices of 4 mm have no frame and are empty: slices 2 to 6,"));
    EXPECT_TRUE(notes_say(*uneven, "slices 2, 4 to 5,"));
    EXPECT_EQ(std::count(far->labels.begin(), far->labels.end(), 1), 2 * 7 * 6);
  }
  const auto wrong = seg([](int k) { return k % 2 == 1; }, "3"), thick = seg([](int k) { return k % 2 == 1; }, "");
  ASSERT_TRUE(wrong.ok() && thick.ok()) << why(wrong) << why(thick);
  EXPECT_NEAR(wrong->spacing[2], 8, 1e-6);
  EXPECT_TRUE(notes_say(*wrong, "SpacingBetweenSlices is 3 mm, but the frames do not lie at multiples of it"));
  EXPECT_TRUE(notes_say(*thick, "SpacingBetweenSlices is not stated, SliceThickness is 4 mm"));
  const auto full = value_of(seg([](int) { return true; }, "4"));
  EXPECT_FALSE(notes_say(full, "slices"));
}

TEST(DicomSeg, a_fractional_segment_begins_at_one_half) {
  const Folder folder;
  for (const int most : {255, 100}) {
    const auto value = [&](int i, int, int) { return i == 2 ? most / 2 - 1 : i == 3 ? (most + 1) / 2 : most; };
    const Mask frame;
    const auto image = value_of(
        read_label_image(write_seg(folder / "seg.dcm", frame, {{"Prostate", "Prostate", in_gland}}, most, value)));
    EXPECT_EQ(label_at(image, frame.origin + frame.axes * Vec3(2, 4, 3)), 0);
    EXPECT_EQ(label_at(image, frame.origin + frame.axes * Vec3(3, 4, 3)), 1);
    EXPECT_TRUE(notes_say(image, "one half"));
  }
}

TEST(DicomSeg, compressed_by_run_lengths_is_read) {
  const Folder folder;
  const Mask frame;
  const auto full = [](int, int, int) { return 255; };
  const fs::path plain = write_seg(folder / "a.dcm", frame, gland_and_urethra(), 255, full);
  const auto before = read_label_image(plain);
  DcmRLEEncoderRegistration::registerCodecs();
  DcmFileFormat file;
  ASSERT_TRUE(file.loadFile(plain.c_str()).good());
  ASSERT_TRUE(file.getDataset()->chooseRepresentation(EXS_RLELossless, nullptr).good());
  ASSERT_TRUE(file.saveFile((folder / "b.dcm").c_str(), EXS_RLELossless).good());
  const auto after = read_label_image(folder / "b.dcm");
  ASSERT_TRUE(before.ok() && after.ok()) << why(before) << why(after);
  EXPECT_EQ(before->labels, after->labels);
}

TEST(DicomSeg, frames_that_are_no_regular_stack_are_refused) {
  const Folder folder;
  const auto moved = [&](const Vec3& by) {
    return edit_dicom(write_seg(folder / "seg.dcm", Mask(), gland_and_urethra()), [&](DcmDataset& data) {
      DcmItem& item = group_of_frame(data, 1, DCM_PlanePositionSequence);
      const Vec3 at = Mask().origin + Mask().axes * Vec3(0, 0, 5) + by;
      item.putAndInsertString(DCM_ImagePositionPatient, fmt::format("{}\\{}\\{}", at.x(), at.y(), at.z()).c_str());
    });
  };
  expect_refused(read_input(moved({0, 0, 1})), {"seg.dcm, frame", "slice spacing", "Resample"});
  expect_refused(read_input(moved({3, 0, 0})), {"frame 2", "sheared"});
  expect_refused(read_input(moved({0, 0, 1e12})), {"frame 2, ImagePositionPatient", "1e+12", "at most"});
}

TEST(DicomSeg, damage_is_named) {
  const Folder folder;
  const auto changed = [&](const std::function<void(DcmDataset&)>& change) {
    return read_input(edit_dicom(write_seg(folder / "seg.dcm", Mask(), gland_and_urethra()), change));
  };
  const auto put = [](const DcmTagKey& tag, const char* value) {
    return [=](DcmDataset& data) { data.putAndInsertString(tag, value); };
  };
  expect_refused(changed(put(DCM_SegmentationType, "MAYBE")), {"SegmentationType", "MAYBE", "BINARY"});
  expect_refused(changed(put(DCM_NumberOfFrames, "900")), {"bytes of pixels"});
  expect_refused(changed([](DcmDataset& d) { d.putAndInsertUint16(DCM_Rows, 1); }), {"1 rows"});
  expect_refused(changed([](DcmDataset& d) { d.findAndDeleteElement(DCM_PixelData); }), {"no pixels"});
  expect_refused(changed([](DcmDataset& d) { d.findAndDeleteElement(DCM_SegmentSequence); }), {"no segments"});
  expect_refused(changed([](DcmDataset& d) { d.findAndDeleteElement(DCM_SharedFunctionalGroupsSequence); }),
                 {"frame 1", "ImageOrientationPatient"});
  expect_refused(
      changed([](DcmDataset& d) {
        group_of_frame(d, 0, DCM_SegmentIdentificationSequence).putAndInsertUint16(DCM_ReferencedSegmentNumber, 9);
      }),
      {"frame 1", "segment 9"});
  const std::string whole = content_of(write_seg(folder / "seg.dcm", Mask(), gland_and_urethra()));
  for (const double share : {0.2, 0.5, 0.95}) {
    expect_refused(
        read_input(write_file(folder / "cut.dcm",
                              whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))))),
        {"cut.dcm"});
  }
}

TEST(DicomSeg, a_folder_may_hold_it_but_not_beside_a_structure_set) {
  const Folder folder;
  write_seg(folder / "seg.dcm", Mask(), gland_and_urethra());
  const auto input = value_of(read_input(folder.path()));
  EXPECT_TRUE(std::holds_alternative<LabelImage>(input));
  ASSERT_TRUE(write_rtstruct(two_organs(), folder / "rs.dcm").ok());
  expect_refused(read_input(folder.path()), {"rs.dcm, seg.dcm", "one is expected"});
  expect_refused(read_label_image(folder / "rs.dcm"), {"RTSTRUCT", "segmentation (SEG) is expected"});
}

TEST(LayeredNrrd, the_smaller_of_two_overlapping_segments_has_the_voxel) {
  const Mask frame;
  const std::string keys =
      "Segment0_Name:=urethra\nSegment0_LabelValue:=1\nSegment0_Layer:=0\n"
      "Segment1_Name:=Prostate\nSegment1_LabelValue:=1\nSegment1_Layer:=1\n"
      "Segment2_Name:=nothing\nSegment2_LabelValue:=2\nSegment2_Layer:=1\n";
  for (const bool gland_first : {false, true}) {
    auto layers = std::vector{voxels(frame, in_urethra), voxels(frame, in_gland)};
    std::string names = keys;
    if (gland_first) {
      std::swap(layers[0], layers[1]);
      names = replaced(replaced(keys, "urethra", "P"), "Prostate", "urethra");
    }
    const auto image = value_of(read_mask("case.seg.nrrd", layered_nrrd(frame, layers, names)));
    const Vec3 in_both = frame.origin + frame.axes * Vec3(4, 4, 3),
               in_gland_only = frame.origin + frame.axes * Vec3(2, 2, 3);
    EXPECT_EQ(image.names.at(label_at(image, in_both)), "urethra");
    EXPECT_EQ(image.names.at(label_at(image, in_gland_only)), gland_first ? "P" : "Prostate");
    EXPECT_TRUE(notes_say(image, "share 24 voxels"));
    EXPECT_TRUE(notes_say(image, "3 segments in 2 layers"));
    EXPECT_TRUE(notes_say(image, "'nothing' is empty"));
  }
}

TEST(LayeredNrrd, a_skipped_segment_takes_no_voxel_from_what_lies_below) {
  const Mask frame;
  const std::string text = layered_nrrd(frame, {voxels(frame, in_urethra), voxels(frame, in_gland)},
                                        "Segment0_Name:=urethra\nSegment0_LabelValue:=1\nSegment0_Layer:=0\n"
                                        "Segment1_Name:=Prostate\nSegment1_LabelValue:=1\nSegment1_Layer:=1\n");
  const Folder folder;
  const fs::path path = write_file(folder / "case.seg.nrrd", text);
  const auto image = value_of(read_label_image(path, {.skip = {"Urethra"}}));
  EXPECT_EQ(std::count(image.labels.begin(), image.labels.end(), 2), 7 * 6 * 6);
  EXPECT_EQ(label_at(image, frame.origin + frame.axes * Vec3(4, 4, 3)), 2);
  EXPECT_EQ(image.names.at(1), "urethra");
}

TEST(LayeredNrrd, no_segment_is_lost_without_a_word) {
  const Mask frame;
  auto gland = voxels(frame, in_gland);
  gland[0] = 5;  // not one of the segments below
  const auto image = value_of(
      read_mask("case.seg.nrrd", layered_nrrd(frame, {voxels(frame, in_urethra), gland},
                                              "Segment0_Name:=urethra\nSegment0_LabelValue:=1\nSegment0_Layer:=0\n"
                                              "Segment2_Name:=\nSegment2_LabelValue:=1\nSegment2_Layer:=1\n"
                                              "Segment3_Name:=lost\nSegment3_LabelValue:=1\nSegment3_Layer:=2\n"
                                              "Segment4_Name:=odd\nSegment4_LabelValue:=one\nSegment4_Layer:=1\n"
                                              "Segment5_Name:=half\nSegment5_LabelValue:=1.5\nSegment5_Layer:=1\n"
                                              "Segment6_Name:=where\nSegment6_LabelValue:=1\nSegment6_Layer:=x\n")));
  EXPECT_EQ(image.names, (std::map<int, std::string>{{1, "urethra"}})) << "no empty names";
  EXPECT_EQ(label_at(image, frame.origin + frame.axes * Vec3(2, 2, 3)), 2);
  EXPECT_EQ(label_at(image, frame.origin), 3);
  EXPECT_TRUE(notes_say(image, "Label 5 of layer 1 does not belong to a segment"));
  EXPECT_TRUE(
      notes_say(image, "Segment 'lost' has no voxels: its Segment3_Layer is 2, and the file's last layer is 1"));
  EXPECT_TRUE(notes_say(image, "Segment 'odd' has no voxels: its Segment4_LabelValue is 'one'"));
  EXPECT_TRUE(notes_say(image, "Segment 'half' has no voxels"));
  EXPECT_TRUE(notes_say(image, "Segment 'where' has no voxels: its Segment6_Layer is 'x'"));
}

TEST(LayeredNrrd, labels_that_no_other_layer_has_are_kept) {
  const Mask frame;
  auto urethra = voxels(frame, in_urethra);
  for (std::uint8_t& v : urethra) v *= 7;
  const auto image = value_of(read_mask("case.seg.nrrd", layered_nrrd(frame, {urethra, voxels(frame, in_gland)},
                                                                      "Segment0_Name:=urethra\nSegment0_LabelValue:=7\n"
                                                                      "Segment0_Layer:=0\nSegment1_Name:=gland\n"
                                                                      "Segment1_LabelValue:=1\nSegment1_Layer:=1\n")));
  EXPECT_EQ(label_at(image, frame.origin + frame.axes * Vec3(4, 4, 3)), 7);
  EXPECT_EQ(image.names.at(7), "urethra");
}

TEST(LayeredNrrd, a_volume_for_each_segment_needs_no_labels_and_layers) {
  const Mask frame;
  auto urethra = voxels(frame, in_urethra);
  for (std::uint8_t& v : urethra) v *= 255;
  const std::string keys =
      "Segment0_ID:=Segment_1\nSegment0_Name:=Prostate\nSegment1_ID:=Segment_2\n"
      "Segment1_Name:=Urethra\n";
  const std::string text = layered_nrrd(frame, {voxels(frame, in_gland), urethra}, keys);
  const auto image = value_of(read_mask("case.seg.nrrd", text));
  EXPECT_EQ(image.names, (std::map<int, std::string>{{1, "Prostate"}, {2, "Urethra"}}));
  EXPECT_EQ(std::count(image.labels.begin(), image.labels.end(), 1), 7 * 6 * 6 - 4 * 6);
  EXPECT_EQ(std::count(image.labels.begin(), image.labels.end(), 2), 4 * 8);
  EXPECT_TRUE(notes_say(image, "'Urethra' and 'Prostate' share 24 voxels"));
  EXPECT_FALSE(notes_say(image, "without a name"));
  const auto more =
      value_of(read_mask("case.seg.nrrd", replaced(text, "Segment1_ID", "Segment7_Name:=lost\nSegment1_ID")));
  EXPECT_TRUE(notes_say(more, "Segment 'lost' has no voxels: it would be volume 8, and the file has 2."));
  const auto one =
      value_of(read_mask("case.seg.nrrd", layered_nrrd(frame, {voxels(frame, in_gland)}, "Segment0_Name:=Gland\n")));
  EXPECT_EQ(one.names, (std::map<int, std::string>{{1, "Gland"}}));
}
