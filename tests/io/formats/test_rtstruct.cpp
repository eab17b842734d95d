// SPDX-License-Identifier: GPL-3.0-or-later
#include "files.hpp"
#include "stylet/io/contours_io.hpp"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmrt/drtstrct.h>

#include <functional>

using namespace stylet;
using namespace stylet::test;

namespace {

/// A structure set written by Stylet and then changed with DCMTK, as another program might have written it.
fs::path changed(const Folder& folder, const std::function<void(DcmDataset&)>& change,
                 E_TransferSyntax syntax = EXS_LittleEndianImplicit, E_FileWriteMode mode = EWM_fileformat) {
  const fs::path path = folder / "case.dcm";
  EXPECT_TRUE(write_rtstruct(two_organs(), path).ok());
  DcmFileFormat file;
  EXPECT_TRUE(file.loadFile(path.c_str()).good());
  file.loadAllDataIntoMemory();
  change(*file.getDataset());
  EXPECT_TRUE(file.saveFile(path.c_str(), syntax, EET_ExplicitLength, EGL_recalcGL, EPD_noChange, 0, 0, mode).good());
  return path;
}

DcmItem& item(DcmItem& parent, const DcmTagKey& sequence, long number) {
  DcmItem* found = nullptr;
  EXPECT_TRUE(parent.findOrCreateSequenceItem(sequence, found, number).good());
  return *found;
}

/// Contour `number` of structure `roi`.
DcmItem& contour(DcmDataset& data, long roi, long number) {
  return item(item(data, DCM_ROIContourSequence, roi), DCM_ContourSequence, number);
}

void put(DcmItem& where, const DcmTagKey& tag, const char* value) {
  EXPECT_TRUE(where.putAndInsertString(tag, value).good());
}

}  // namespace

TEST(Rtstruct, what_is_written_comes_back_to_a_hundredth_of_a_millimetre) {
  const Folder folder;
  const ContourSet set = two_organs();
  ASSERT_TRUE(write_rtstruct(set, folder / "case.dcm").ok());
  const auto back = value_of(read_rtstruct(folder / "case.dcm"));
  EXPECT_LT(largest_difference(set, back), 1e-3);
  EXPECT_EQ(back.label, set.label);
  EXPECT_EQ(back.frame_of_reference, "1.2.3.4.5");
  EXPECT_EQ(back.rois[1].number, 2);
  EXPECT_EQ(back.rois[1].type, "ORGAN");
  EXPECT_EQ(back.rois[1].colour, set.rois[1].colour);
  EXPECT_TRUE(back.notes.empty());
  EXPECT_TRUE(back.passed_over.empty());
}

TEST(Rtstruct, a_body_outline_longer_than_64_kB_survives) {
  const Folder folder;
  ContourSet set = two_organs();
  for (Contour& c : set.rois[0].contours) c = circle(c.points[0].z(), 1234.567, 5000);
  ASSERT_TRUE(write_rtstruct(set, folder / "case.dcm").ok());
  const auto back = value_of(read_rtstruct(folder / "case.dcm"));
  EXPECT_LT(largest_difference(set, back), 1e-3);
}

TEST(Rtstruct, dcmtk_finds_what_we_write_a_valid_structure_set_without_identity) {
  const Folder folder;
  ASSERT_TRUE(write_rtstruct(two_organs(), folder / "case.dcm").ok());
  DcmFileFormat file;
  ASSERT_TRUE(file.loadFile((folder / "case.dcm").c_str()).good());
  DRTStructureSetIOD structures;
  EXPECT_TRUE(structures.read(*file.getDataset()).good());
  EXPECT_TRUE(structures.isValid());
  OFString value;
  EXPECT_TRUE(structures.getPatientName(value).good());
  EXPECT_EQ(value, "");
  EXPECT_TRUE(structures.getPatientBirthDate(value).good());
  EXPECT_EQ(value, "");
  EXPECT_TRUE(structures.getSOPInstanceUID(value).good());
  EXPECT_EQ(value.substr(0, 5), "2.25.");
  EXPECT_LE(value.size(), 64U);
  EXPECT_TRUE(file.getDataset()->findAndGetOFString(DCM_StudyDate, value).good());
  EXPECT_EQ(value, "");
}

TEST(Rtstruct, the_same_contours_give_the_same_bytes) {
  const Folder folder;
  ASSERT_TRUE(write_rtstruct(two_organs(), folder / "a.dcm").ok());
  ASSERT_TRUE(write_rtstruct(two_organs(), folder / "b.dcm").ok());
  EXPECT_EQ(content_of(folder / "a.dcm"), content_of(folder / "b.dcm"));
  ContourSet other = two_organs();
  other.rois[0].contours[0].points[0].x() += 0.01;
  ASSERT_TRUE(write_rtstruct(other, folder / "c.dcm").ok());
  EXPECT_NE(content_of(folder / "a.dcm"), content_of(folder / "c.dcm"));
}

TEST(Rtstruct, every_uncompressed_transfer_syntax_is_read) {
  for (const E_TransferSyntax syntax :
       {EXS_LittleEndianImplicit, EXS_LittleEndianExplicit, EXS_BigEndianExplicit, EXS_DeflatedLittleEndianExplicit}) {
    const Folder folder;
    const auto set = value_of(read_rtstruct(changed(
        folder, [](DcmDataset&) {}, syntax)));
    EXPECT_LT(largest_difference(two_organs(), set), 1e-3);
  }
  const Folder folder;
  const Result<ContourSet> bare = read_rtstruct(changed(
      folder, [](DcmDataset&) {}, EXS_LittleEndianImplicit, EWM_dataset));
  ASSERT_TRUE(bare.ok()) << "without the part 10 header: " << why(bare);
}

TEST(Rtstruct, empty_structures_and_open_curves_are_passed_over_with_the_reason) {
  const Folder folder;
  const auto set = value_of(read_rtstruct(changed(folder, [](DcmDataset& data) {
    put(item(data, DCM_StructureSetROISequence, 2), DCM_ROINumber, "7");
    put(item(data, DCM_StructureSetROISequence, 2), DCM_ROIName, "CTV");
    put(item(data, DCM_StructureSetROISequence, 3), DCM_ROINumber, "8");
    put(item(data, DCM_StructureSetROISequence, 3), DCM_ROIName, "needle A5");
    put(item(data, DCM_ROIContourSequence, 2), DCM_ReferencedROINumber, "8");
    DcmItem& needle = contour(data, 2, 0);
    put(needle, DCM_ContourGeometricType, "OPEN_NONPLANAR");
    put(needle, DCM_NumberOfContourPoints, "2");
    put(needle, DCM_ContourData, "0\\0\\0\\1\\2\\50");
  })));
  EXPECT_EQ(set.rois.size(), 2U);
  ASSERT_EQ(set.passed_over.size(), 2U);
  EXPECT_EQ(set.passed_over[0].name, "CTV");
  EXPECT_EQ(set.passed_over[0].why, "empty");
  EXPECT_EQ(set.passed_over[1].name, "needle A5");
  EXPECT_NE(set.passed_over[1].why.find("open curves"), std::string::npos);
}

TEST(Rtstruct, names_are_trimmed_and_turned_into_utf8) {
  const Folder folder;
  const auto set = value_of(read_rtstruct(changed(folder, [](DcmDataset& data) {
    put(data, DCM_SpecificCharacterSet, "ISO_IR 100");
    put(item(data, DCM_StructureSetROISequence, 0), DCM_ROIName, "  Blase gef\xfcllt ");
  })));
  EXPECT_EQ(set.rois[0].name, "Blase gef\xc3\xbcllt");
}

TEST(Rtstruct, a_repeated_first_point_is_dropped) {
  const Folder folder;
  const auto set = value_of(read_rtstruct(changed(folder, [](DcmDataset& data) {
    DcmItem& c = contour(data, 0, 0);
    put(c, DCM_NumberOfContourPoints, "4");
    put(c, DCM_ContourData, "0\\0\\0\\10\\0\\0\\10\\10\\0\\0\\0\\0");
  })));
  EXPECT_EQ(set.rois[0].contours[0].points.size(), 3U);
}

/// Whether one of the notes has all of these parts.
bool says(const ContourSet& set, std::initializer_list<const char*> parts) {
  return std::any_of(set.notes.begin(), set.notes.end(), [&](const std::string& note) {
    return std::all_of(parts.begin(), parts.end(),
                       [&](const char* part) { return note.find(part) != std::string::npos; });
  });
}

TEST(Rtstruct, a_damaged_contour_costs_only_itself_and_is_named) {
  const Folder whole;
  const auto sound = value_of(read_rtstruct(changed(whole, [](DcmDataset&) {})));
  const std::size_t all = sound.rois[1].contours.size();
  const auto expect_note = [&](const char* value, const char* count, std::size_t left,
                               std::initializer_list<const char*> parts) {
    const Folder folder;
    const auto set = value_of(read_rtstruct(changed(folder, [&](DcmDataset& data) {
      DcmItem& c = contour(data, 1, 2);
      put(c, DCM_ContourData, value);
      put(c, DCM_NumberOfContourPoints, count);
    })));
    EXPECT_TRUE(says(set, parts)) << value;
    EXPECT_EQ(set.rois[1].contours.size(), left) << value;
    EXPECT_EQ(set.rois[0].contours.size(), sound.rois[0].contours.size());
  };
  expect_note("0\\0\\0\\10\\0\\0\\10\\10", "3", all - 1,
              {"ROI 'Rectum', contour 3", "8 numbers", "multiple of three", "left out"});
  expect_note("0\\0\\0\\10\\x\\0\\10\\10\\0", "3", all - 1, {"ROI 'Rectum', contour 3", "'x'", "point 2"});
  expect_note("0\\0\\0\\10\\nan\\0\\10\\10\\0", "3", all - 1, {"contour 3", "not a finite number"});
  expect_note("0\\0\\0\\10\\1e999\\0\\10\\10\\0", "3", all - 1, {"contour 3", "not a finite number"});
  expect_note("", "3", all - 1, {"contour 3", "no points"});
  expect_note("0\\0\\0\\10\\0\\0\\10\\10\\0", "5", all, {"contour 3", "announces 5 points and holds 3"});
}

TEST(Rtstruct, contours_of_one_structure_in_several_items_are_joined) {
  const Folder folder;
  const auto set = value_of(read_rtstruct(
      changed(folder, [](DcmDataset& d) { put(item(d, DCM_ROIContourSequence, 1), DCM_ReferencedROINumber, "1"); })));
  ASSERT_EQ(set.rois.size(), 1U);
  EXPECT_TRUE(says(set, {"'Prostate'", "several items"}));
  ASSERT_EQ(set.passed_over.size(), 1U);
  EXPECT_EQ(set.passed_over[0].name, "Rectum");
}

TEST(Rtstruct, foreign_parts_are_left_out_and_named) {
  const Folder folder;
  const auto foreign = value_of(read_rtstruct(
      changed(folder, [](DcmDataset& d) { put(item(d, DCM_ROIContourSequence, 1), DCM_ReferencedROINumber, "9"); })));
  EXPECT_TRUE(says(foreign, {"ROI number 9", "left out"}));
  EXPECT_EQ(foreign.rois.size(), 1U);
  const Folder other;
  const auto frames = value_of(read_rtstruct(changed(other, [](DcmDataset& d) {
    put(item(d, DCM_StructureSetROISequence, 1), DCM_ReferencedFrameOfReferenceUID, "9.9");
  })));
  EXPECT_TRUE(says(frames, {"'Rectum'", "9.9", "frame of reference"}));
  EXPECT_EQ(frames.frame_of_reference, "1.2.3.4.5");
  EXPECT_EQ(frames.rois.size(), 1U);
}

TEST(Rtstruct, a_skipped_structure_may_lie_in_another_frame) {
  for (const long odd : {0L, 1L}) {
    const Folder folder;
    const fs::path file = changed(folder, [&](DcmDataset& d) {
      put(item(d, DCM_StructureSetROISequence, odd), DCM_ReferencedFrameOfReferenceUID, "9.9");
    });
    const std::vector<std::string> skip{odd == 0 ? "Prostate" : "Rectum"};
    const auto set = value_of(read_rtstruct(file, skip));
    EXPECT_EQ(set.frame_of_reference, "1.2.3.4.5");
  }
}

TEST(Rtstruct, contradicting_structures_are_refused) {
  const auto with = [](const std::function<void(DcmDataset&)>& change) {
    const Folder folder;
    return read_rtstruct(changed(folder, change));
  };
  expect_refused(with([](DcmDataset& d) { put(item(d, DCM_StructureSetROISequence, 1), DCM_ROINumber, "1"); }),
                 {"two structures have ROI number 1"});
  expect_refused(with([](DcmDataset& d) { delete d.remove(DCM_StructureSetROISequence); }), {"no structures"});
  expect_refused(with([](DcmDataset& d) { delete d.remove(DCM_ROIContourSequence); }), {"none of its 2 structures"});
}

TEST(Rtstruct, another_modality_is_named) {
  const Folder folder;
  expect_refused(read_rtstruct(changed(folder,
                                       [](DcmDataset& d) {
                                         put(d, DCM_Modality, "CT");
                                         put(d, DCM_SOPClassUID, UID_CTImageStorage);
                                       })),
                 {"modality 'CT'", "RTSTRUCT is expected"});
}

TEST(Rtstruct, a_truncated_file_is_refused) {
  const Folder folder;
  ASSERT_TRUE(write_rtstruct(two_organs(), folder / "case.dcm").ok());
  const std::string whole = content_of(folder / "case.dcm");
  for (const double share : {0.05, 0.2, 0.5, 0.9, 0.999}) {
    write_file(folder / "cut.dcm",
               whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
    expect_refused(read_rtstruct(folder / "cut.dcm"), {"cut.dcm"});
  }
}

TEST(Rtstruct, a_folder_must_hold_exactly_one_structure_set) {
  const Folder folder;
  write_file(folder / "notes.txt", "not DICOM");
  expect_refused(read_rtstruct(folder.path()), {"no DICOM RT Structure Set"});
  changed(folder, [](DcmDataset& d) {
    put(d, DCM_Modality, "CT");
    put(d, DCM_SOPClassUID, UID_CTImageStorage);
  });
  fs::rename(folder / "case.dcm", folder / "slice.dcm");
  ASSERT_TRUE(write_rtstruct(two_organs(), folder / "one.dcm").ok());
  const auto set = value_of(read_rtstruct(folder.path()));
  EXPECT_EQ(set.source, (folder / "one.dcm").string());
  ASSERT_TRUE(write_rtstruct(two_organs(), folder / "two.dcm").ok());
  expect_refused(read_rtstruct(folder.path()), {"2 RT Structure Sets", "one.dcm, two.dcm"});
}

TEST(Rtstruct, what_cannot_be_written_leaves_no_file) {
  const Folder folder;
  ContourSet set = two_organs();
  set.rois[0].contours[0].points[0].y() = INFINITY;
  EXPECT_FALSE(write_rtstruct(set, folder / "case.dcm").ok());
  set = two_organs();
  set.rois[0].name = std::string(65, 'x');
  EXPECT_FALSE(write_rtstruct(set, folder / "case.dcm").ok());
  EXPECT_FALSE(write_rtstruct({}, folder / "case.dcm").ok());
  EXPECT_FALSE(write_rtstruct(two_organs(), folder / "no/such/folder.dcm").ok());
  EXPECT_TRUE(fs::is_empty(folder.path()));
}
