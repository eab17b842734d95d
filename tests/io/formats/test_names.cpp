// SPDX-License-Identifier: GPL-3.0-or-later
// Names of structures: character sets of DICOM, and control characters in every format.
#include "dicom_sets.hpp"
#include "files.hpp"
#include "mesh_files.hpp"
#include "stylet/io/input.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

using namespace stylet;
using namespace stylet::test;
using namespace std::string_literals;

namespace {

/// The name of the first structure of a DICOM file with these bytes as its name.
std::string name_read(const char* character_set, const std::string& bytes) {
  const Folder folder;
  const auto path = bare_file(folder, EXS_LittleEndianExplicit, [&](DcmDataset& data) {
    data.putAndInsertString(DCM_SpecificCharacterSet, character_set);
    DcmItem* item = nullptr;
    EXPECT_TRUE(data.findAndGetSequenceItem(DCM_StructureSetROISequence, item, 0).good());
    EXPECT_TRUE(item->putAndInsertString(DCM_ROIName, bytes.c_str()).good());
  });
  const auto set = read_rtstruct(path);
  return set.ok() ? set->rois.at(0).name : why(set);
}

void expect_no_control(const std::string& text, const std::string& what) {
  EXPECT_TRUE(std::none_of(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7F; }))
      << what << ": " << testing::PrintToString(text);
  for (char c = '\x80'; c < '\xA0'; ++c)
    EXPECT_EQ(text.find(std::string("\xC2") + c), std::string::npos) << what << ": " << testing::PrintToString(text);
}

/// Names of everything in a file, and what the reader says about it.
std::vector<std::string> texts_of(const fs::path& path) {
  std::vector<std::string> texts;
  const auto input = read_input(path, {.notes = &texts});
  if (!input.ok()) return {why(input)};
  if (const auto* set = std::get_if<ContourSet>(&*input)) {
    texts.push_back(set->label);
    for (const Roi& roi : set->rois) texts.push_back(roi.name);
    for (const PassedOver& structure : set->passed_over) texts.push_back(structure.name);
    texts.insert(texts.end(), set->notes.begin(), set->notes.end());
  } else if (const auto* image = std::get_if<LabelImage>(&*input)) {
    for (const auto& [label, name] : image->names) texts.push_back(name);
    texts.insert(texts.end(), image->notes.begin(), image->notes.end());
  } else if (const auto* mesh = std::get_if<TetMesh>(&*input)) {
    texts.insert(texts.end(), mesh->regions.begin(), mesh->regions.end());
  } else {
    for (const Surface& surface : std::get<std::vector<Surface>>(*input)) texts.push_back(surface.name);
  }
  return texts;
}

/// A mask of two labels in NRRD, with the names of 3D Slicer.
std::string nrrd_with(const std::string& name) {
  std::string text =
      "NRRD0004\ntype: unsigned char\ndimension: 3\nspace: left-posterior-superior\nsizes: 8 8 8\n"
      "space directions: (2,0,0) (0,2,0) (0,0,2)\nkinds: domain domain domain\nencoding: raw\n"
      "space origin: (0,0,0)\nSegment0_LabelValue:=1\nSegment0_Name:=" +
      name + "\nSegment1_LabelValue:=2\nSegment1_Name:=b\n\n";
  return text + std::string(256, '\x01') + std::string(256, '\x02');
}

}  // namespace

TEST(DicomText, names_in_all_kinds_of_character_sets_become_utf8) {
  EXPECT_EQ(name_read("\\ISO 2022 IR 87", "\x1b$BA0N)A#\x1b(B"), "前立腺");
  EXPECT_EQ(name_read("ISO 2022 IR 13\\ISO 2022 IR 87", "\xce\xde\xb3\xba\xb3 \x1b$BA0N)A#\x1b(J 2"), "ﾎﾞｳｺｳ 前立腺 2");
  EXPECT_EQ(name_read("\\ISO 2022 IR 149", "\x1b$)C\xc0\xfc\xb8\xb3\xbc\xb1"), "전립선");
  EXPECT_EQ(name_read("ISO 2022 IR 149", "\xc0\xfc\xb8\xb3\xbc\xb1 1"), "전립선 1") << "without an escape sequence";
  EXPECT_EQ(name_read("\\ISO 2022 IR 58", "PTV \x1b$)A\xc7\xb0\xc1\xd0\xcf\xd9"), "PTV 前列腺");
  EXPECT_EQ(name_read("GB18030", "\xc7\xb0\xc1\xd0\xcf\xd9"), "前列腺");
  EXPECT_EQ(name_read("GBK", "\xc7\xb0\xc1\xd0\xcf\xd9"), "前列腺");
  EXPECT_EQ(name_read("GB18030", "\x81\x5c"), "乗") << "the second byte is that of a backslash";
  EXPECT_EQ(name_read("ISO_IR 144", "\xbf\xe0\xde\xe1\xe2\xd0\xe2\xd0"), "Простата");
  EXPECT_EQ(name_read("ISO 2022 IR 6\\ISO 2022 IR 100\\ISO 2022 IR 144",
                      "Harnr\x1b-A\xf6hre \x1b-L\xbf\xe0\xde\xe1\xe2\xd0\xe2\xd0"),
            "Harnröhre Простата");
  EXPECT_EQ(name_read("ISO_IR 100", "Harnr\xf6hre"), "Harnröhre");
  EXPECT_EQ(name_read("ISO_IR 166", "\xb5\xe8\xcd\xc1"), "ต่อม");
  EXPECT_EQ(name_read("ISO_IR 192", "Harnröhre"), "Harnröhre");
  EXPECT_EQ(name_read("", "Harnröhre"), "Harnröhre") << "UTF-8 in a file that states no set";
  EXPECT_EQ(name_read("", "Harnr\xf6hre"), "Harnr\xEF\xBF\xBDhre");
}

TEST(DicomText, no_control_character_comes_out) {
  for (const char* set : {"", "ISO_IR 100", "ISO_IR 192", "GB18030", "\\ISO 2022 IR 87", "\\ISO 2022 IR 149",
                          "ISO 2022 IR 100\\nonsense"}) {
    for (const std::string& name : {"Pro\x1b[31mstate"s, "A\x1b$Z\x07"s, "A\x1b"s, "\x1b$B\x21"s, "\x1b$)C\xc0"s,
                                    "A\xc2\x9b"
                                    "31m"s,
                                    "A\x9b"
                                    "31m"s,
                                    "A\rB"s}) {
      const std::string read = name_read(set, name);
      EXPECT_FALSE(read.empty());
      expect_no_control(read, set);
    }
  }
}

TEST(Names, of_no_format_bring_control_characters) {
  const Folder folder;
  const std::string evil =
      "Pro\x1b]0;x\x07st\x7f"
      "a\xc2\x9b"
      "31mte";
  const std::string clean = "Pro ]0;x st a 31mte";
  TetMesh mesh = two_region_box();
  mesh.regions[0] = evil;
  ContourSet organs = two_organs();
  organs.rois[0].name = organs.label = evil;

  std::vector<fs::path> files;
  ASSERT_TRUE(write_contour_json(organs, files.emplace_back(folder / "c.json")).ok());
  ASSERT_TRUE(write_rtstruct(organs, files.emplace_back(folder / "c.dcm")).ok());
  ASSERT_TRUE(write_vtu(mesh, files.emplace_back(folder / "m.vtu")).ok());
  files.push_back(write_file(folder / "m.msh", msh22_text(mesh)));
  files.push_back(write_file(folder / "m.nrrd", nrrd_with(evil)));
  for (const fs::path& path : files) {
    const auto texts = texts_of(path);
    EXPECT_NE(std::find(texts.begin(), texts.end(), clean), texts.end())
        << path.filename() << ": " << testing::PrintToString(texts);
    for (const std::string& text : texts) expect_no_control(text, path.filename());
  }
}

TEST(Names, of_two_regions_that_differ_in_control_characters_only_stay_apart) {
  const Folder folder;
  TetMesh mesh = two_region_box();
  mesh.regions = {"a\x01", "a\x02"};
  ASSERT_TRUE(write_vtu(mesh, folder / "m.vtu").ok());
  const auto read = value_of(read_tet_mesh(folder / "m.vtu"));
  EXPECT_EQ(read.regions.size(), 2U);
  EXPECT_NE(read.regions[0], read.regions[1]);
}

TEST(Names, in_errors_bring_no_control_characters_either) {
  const Folder folder;
  const auto vtk = write_file(
      folder / "m.vtk", replaced(vtk_text(two_region_box()), "SCALARS region int 1", "SCALARS region\x1b[31m int 1"));
  for (const fs::path& path :
       {write_file(folder / "c.json", "{\"format\": \"stylet-contours\x1b[31m\"}"),
        write_file(folder / "m.nrrd", replaced(nrrd_with("a"), "encoding: raw", "encoding: \x1b[31mraw"))}) {
    const auto input = read_input(path);
    ASSERT_FALSE(input.ok()) << path;
    expect_no_control(why(input), path.filename());
  }
  const auto wrong = read_tet_mesh(vtk, {.regions_from = "b"});
  ASSERT_FALSE(wrong.ok());
  expect_no_control(why(wrong), "array names");
}
