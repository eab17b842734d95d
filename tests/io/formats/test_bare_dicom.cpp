// SPDX-License-Identifier: GPL-3.0-or-later
// DICOM data sets without a header, which have no mark and are recognised by their elements.
#include "detail/file_kind.hpp"
#include "dicom_sets.hpp"
#include "files.hpp"
#include "stylet/io/input.hpp"

using namespace stylet;
using namespace stylet::test;
using namespace std::string_literals;
using detail::FileKind;

namespace {

FileKind kind_of(const fs::path& path) {
  const auto kind = detail::identify(path);
  EXPECT_TRUE(kind.ok()) << why(kind);
  return kind.ok() ? *kind : FileKind::unknown;
}

/// An element of a data set, group 0008, with implicit type.
std::string element(unsigned number, const std::string& value) {
  const auto byte = [](std::size_t n) { return std::string(1, static_cast<char>(n & 0xFFU)); };
  return "\x08\0"s + byte(number) + byte(number >> 8U) + byte(value.size()) + byte(value.size() >> 8U) + "\0\0"s +
         value;
}

/// A small data set whose elements are all right.
std::string small_set() { return element(0x05, "ISO_IR 100") + element(0x16, "1.2.840.10008.5.1.4.1.1.481.3\0"s); }

}  // namespace

TEST(BareDicom, is_recognised_by_its_elements_whatever_comes_first) {
  for (const E_TransferSyntax syntax : {EXS_LittleEndianImplicit, EXS_LittleEndianExplicit}) {
    for (const E_GrpLenEncoding lengths : {EGL_withoutGL, EGL_withGL}) {
      for (const DcmTagKey& first : {DCM_InstanceCreationDate, DCM_SpecificCharacterSet, DCM_ImageType}) {
        const Folder folder;
        const auto path = bare_file(
            folder, syntax,
            [&](DcmDataset& data) {
              data.remove(DCM_SpecificCharacterSet);
              data.putAndInsertString(first, first == DCM_SpecificCharacterSet ? "ISO_IR 100" : "20200101");
            },
            lengths);
        EXPECT_EQ(kind_of(path), FileKind::dicom);
        const auto input = value_of(read_input(path));
        ASSERT_TRUE(std::holds_alternative<ContourSet>(input));
        EXPECT_EQ(std::get<ContourSet>(input).rois.size(), 2U);
      }
    }
  }
}

TEST(BareDicom, is_recognised_by_a_sop_class_or_a_modality) {
  const Folder folder;
  EXPECT_EQ(kind_of(write_file(folder / "sop", small_set())), FileKind::dicom);
  EXPECT_EQ(kind_of(write_file(folder / "mod", element(0x12, "20200101") + element(0x60, "RTSTRUCT"))),
            FileKind::dicom);
  const std::string sequence = "\x08\0\x51\0\xFF\xFF\xFF\xFF\xFE\xFF\xDD\xE0\0\0\0\0"s;
  EXPECT_EQ(kind_of(write_file(folder / "seq", element(0x12, "20200101") + sequence + element(0x60, "RTSTRUCT"))),
            FileKind::dicom);
}

TEST(BareDicom, other_files_are_not_taken_for_it) {
  const Folder folder;
  const std::vector<std::pair<std::string, std::string>> others{
      {"text", "\x08\0\x05\0 this is a text that begins like one"s},
      {"zeros", std::string(600, '\0')},
      {"group 2 alone", "\x02\0\0\0\x04\0\0\0\x01\0\0\0"s + std::string(200, '\0')},
      {"another class", "\x08\0\x16\0\x04\0\0\0"s + "ABCDEFGHIJKLMNOP"},
      {"length beyond the end", "\x08\0\0\0\xFF\xFF\xFF\x7F"s + std::string(300, 'x')},
      {"odd length", element(0x05, "ISO_IR 10") + element(0x16, "1.2.840.10008.1")},
      {"descending", element(0x16, "1.2.3.4.") + element(0x05, "ISO_IR 100") + element(0x60, "RTSTRUCT")},
      {"modality in small letters", element(0x12, "20200101") + element(0x60, "whatever")},
      {"neither class nor modality", element(0x12, "20200101") + element(0x70, "the maker of it ")},
      {"twice the same element", element(0x12, "20200101") + element(0x12, "20200101") + element(0x60, "RTSTRUCT")},
      {"open sequence", "\x08\0\x51\0\xFF\xFF\xFF\xFF"s + std::string(300, 'x')},
      {"cut in its first element", small_set().substr(0, 10)},
      {"cut in its second element", small_set().substr(0, 30)},
      {"PNG", "\x89PNG\r\n\x1a\n\0\0\0\rIHDR"s + std::string(100, '\x01')},
      {"ZIP", "PK\x03\x04\x14\0\0\0\x08\0"s + std::string(100, 'a')},
      {"ELF", "\x7f\x45LF\x02\x01\x01"s + std::string(100, '\0')},
      {"16-bit samples", "\x08\0\x09\0\x08\0\x0a\0\x09\0\x08\0\x07\0\x08\0\x08\0\x09\0\x0a\0\x08\0"s},
      {"big endian", "\0\x08\0\x05\0\0\0\x0aISO_IR 100\0\x08\0\x16\0\0\0\x04"s + "1.2.3.4."}};
  for (const auto& [what, bytes] : others) {
    EXPECT_EQ(kind_of(write_file(folder / "file", bytes)), FileKind::unknown) << what;
    expect_refused(read_input(folder / "file"), {"the format is not recognised"});
  }
}
