// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/file_kind.hpp"

#include "detail/input_file.hpp"
#include "detail/text.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>

namespace stylet::detail {

namespace {

namespace fs = std::filesystem;

/// The first bytes of a file, unpacked if it is gzip; fewer if the file is short or its packing is damaged.
std::string first_bytes(const fs::path& path) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) return {};
  std::string bytes;
  std::array<char, 64> piece{};  // small, because zlib returns nothing of a piece that contains damage
  while (bytes.size() < 4096) {
    const int got = gzread(file.get(), piece.data(), piece.size());
    if (got <= 0) break;
    bytes.append(piece.data(), static_cast<std::size_t>(got));
  }
  return bytes;
}

bool at(const std::string& bytes, std::size_t position, std::string_view mark) {
  return bytes.size() >= position + mark.size() && std::string_view(bytes).substr(position, mark.size()) == mark;
}

std::uint32_t little_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (std::size_t i = bytes.size(); i-- > 0;) value = value << 8U | static_cast<unsigned char>(bytes[i]);
  return value;
}

/// The header of an element of a DICOM data set in little endian.
struct ElementHeader {
  std::uint32_t tag = 0;
  std::uint32_t length = 0;  ///< of the value; 0xFFFFFFFF: a sequence that a delimiter ends
  std::size_t size = 0;      ///< of the header; 0: these bytes are none
};

/// Reads a header with explicit or implicit type of value (VR), DICOM PS3.5 7.1.
ElementHeader element_header(std::string_view bytes) {
  if (bytes.size() < 12) return {};
  const std::uint32_t tag = little_endian(bytes.substr(0, 2)) << 16U | little_endian(bytes.substr(2, 2));
  const std::string_view type = bytes.substr(4, 2);
  constexpr std::string_view short_types = "AE AS AT CS DA DS DT FD FL IS LO LT PN SH SL SS ST TM UI UL US";
  constexpr std::string_view long_types = "OB OD OF OL OV OW SQ SV UC UN UR UT UV";
  const bool word = type[0] >= 'A' && type[1] >= 'A';  // so that no blank of a list is part of it
  if (word && short_types.find(type) != std::string_view::npos) return {tag, little_endian(bytes.substr(6, 2)), 8};
  if (word && long_types.find(type) != std::string_view::npos) return {tag, little_endian(bytes.substr(8, 4)), 12};
  return {tag, little_endian(bytes.substr(4, 4)), 8};
}

/// Whether bytes are the beginning of a DICOM data set in little endian without preamble: elements in ascending order
/// from group 0002 or 0008 on, one of which is a SOP class (0008,0016) or a modality (0008,0060).
bool is_bare_dicom(std::string_view bytes) {
  constexpr std::uint32_t sop_class = 0x00080016, modality = 0x00080060;
  if (bytes.size() < 12) return false;
  const std::uint32_t group = little_endian(bytes.substr(0, 2));
  if (group != 0x0002 && group != 0x0008) return false;
  for (std::int64_t before = -1;;) {
    const ElementHeader element = element_header(bytes);
    if (element.size == 0 || element.tag <= before || element.tag > modality) return false;
    before = element.tag;
    bytes.remove_prefix(element.size);
    std::size_t length = element.length;
    if (element.length == 0xFFFFFFFF) {
      constexpr std::string_view delimiter("\xFE\xFF\xDD\xE0\0\0\0\0", 8);
      const auto end = bytes.find(delimiter);
      if (end == std::string_view::npos) return false;
      length = end + delimiter.size();
    }
    if (length % 2 != 0 || length > bytes.size()) return false;
    const std::string_view value = bytes.substr(0, length);
    if (element.tag == sop_class && value.starts_with("1.2.840.10008.")) return true;
    if (element.tag == modality) {
      return !value.empty() && std::all_of(value.begin(), value.end(),
                                           [](char c) { return (c >= 'A' && c <= 'Z') || c == ' ' || c == '\0'; });
    }
    bytes.remove_prefix(length);
  }
}

bool is_dicom(const std::string& bytes) { return at(bytes, 128, "DICM") || is_bare_dicom(bytes); }

/// Whether a gzip file is too damaged to read its first bytes.
bool is_damaged_gzip(const fs::path& path, const std::string& unpacked) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 2> head{};
  return unpacked.size() < 352 && file.read(head.data(), 2) && head[0] == '\x1f' && head[1] == '\x8b';
}

bool is_nifti(const std::string& bytes) {
  return at(bytes, 344, "n+1") || at(bytes, 344, "ni1") || at(bytes, 4, "n+2") || at(bytes, 4, "ni2");
}

bool is_binary_stl(const std::string& bytes, std::uintmax_t size) {
  if (bytes.size() < 84) return false;
  std::uint32_t triangles = 0;
  std::memcpy(&triangles, bytes.data() + 80, 4);
  return size == 84 + 50 * static_cast<std::uintmax_t>(triangles);
}

/// The text after leading blanks, a byte order mark and '#' comment lines.
std::string_view after_comments(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  for (;;) {
    const auto start = text.find_first_not_of(" \t\r\n");
    if (start == std::string_view::npos) return {};
    text.remove_prefix(start);
    if (text.front() != '#') return text;
    const auto end = text.find('\n');
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end);
  }
}

bool is_metaimage(std::string_view text) {
  for (const auto line : split(text.substr(0, 1024), '\n')) {
    const std::string key = trimmed(line.substr(0, line.find('=')));
    if (key == "ObjectType" || key == "NDims" || key == "DimSize") return line.find('=') != std::string_view::npos;
    if (key.empty() || line.find('=') == std::string_view::npos) return false;
  }
  return false;
}

FileKind kind_of_xml(std::string_view text) {
  if (text.find("<VTKFile") == std::string_view::npos) return FileKind::unknown;
  if (text.find("\"UnstructuredGrid\"") != std::string_view::npos) return FileKind::vtu;
  if (text.find("\"PolyData\"") != std::string_view::npos) return FileKind::vtp;
  return FileKind::unknown;
}

FileKind kind_of(const std::string& bytes, std::uintmax_t size, const std::string& extension) {
  const std::string_view text = after_comments(bytes);
  if (is_dicom(bytes)) return FileKind::dicom;
  if (is_nifti(bytes)) return FileKind::nifti;
  if (at(bytes, 0, "NRRD0")) return FileKind::nrrd;
  if (at(bytes, 0, "glTF")) return FileKind::glb;
  if (lower(bytes.substr(0, 15)).starts_with("# vtk datafile")) return FileKind::vtk_legacy;
  if (text.starts_with('<')) return kind_of_xml(text);
  if (text.starts_with("MeshVersionFormatted")) return FileKind::medit;
  if (text.starts_with('$')) return FileKind::gmsh;
  if (at(bytes, 0, "ply\n") || at(bytes, 0, "ply\r\n")) return FileKind::ply;
  if (is_binary_stl(bytes, size)) return FileKind::stl;
  if (lower(text.substr(0, 6)).starts_with("solid ") || text.starts_with("solid\n")) return FileKind::stl;
  if (text.starts_with('{')) return FileKind::contour_json;
  if (is_metaimage(text)) return FileKind::metaimage;
  // Formats without a mark in their content are recognised by the extension.
  const std::string ending = lower(extension);
  if (ending == ".obj") return FileKind::obj;
  if (ending == ".node" || ending == ".ele") return FileKind::tetgen;
  if (ending == ".dcm") return FileKind::dicom;
  if (ending == ".stl") return FileKind::stl;
  return FileKind::unknown;
}

}  // namespace

std::string name_of(FileKind kind) {
  switch (kind) {
    case FileKind::dicom:
      return "a DICOM file";
    case FileKind::contour_json:
      return "a JSON file";
    case FileKind::nifti:
      return "a NIfTI image";
    case FileKind::nrrd:
      return "an NRRD image";
    case FileKind::metaimage:
      return "a MetaImage";
    case FileKind::vtu:
      return "a VTU mesh";
    case FileKind::vtk_legacy:
      return "a legacy VTK file";
    case FileKind::gmsh:
      return "a gmsh mesh";
    case FileKind::medit:
      return "a MEDIT mesh";
    case FileKind::tetgen:
      return "a TetGen mesh";
    case FileKind::stl:
      return "an STL surface";
    case FileKind::ply:
      return "a PLY surface";
    case FileKind::obj:
      return "an OBJ surface";
    case FileKind::vtp:
      return "a VTP surface";
    case FileKind::glb:
      return "a GLB scene";
    case FileKind::unknown:
      break;
  }
  return "a file of unknown format";
}

std::string readable_formats() {
  return "Stylet reads DICOM RTSTRUCT and contour JSON; label masks in NIfTI, NRRD, MetaImage, DICOM SEG; tetrahedra "
         "in "
         "VTU, legacy VTK, gmsh .msh, MEDIT .mesh, TetGen .node/.ele; surfaces in STL, PLY, OBJ, VTP, GLB";
}

Result<FileKind> identify(const fs::path& path) {
  const std::string where = path.string();
  if (Result<> file = check_input_file(path); !file) return file.error();
  std::error_code code;
  const std::uintmax_t size = fs::file_size(path, code);
  if (size == 0) return input_error(where, "the file is empty", "Export it again. " + readable_formats());
  const std::string bytes = first_bytes(path);
  if (is_damaged_gzip(path, bytes)) {
    return input_error(where, "this gzip file cannot be unpacked",
                       "The file is truncated or damaged; copy or export it again");
  }
  return kind_of(bytes, size, path.extension().string());
}

}  // namespace stylet::detail
