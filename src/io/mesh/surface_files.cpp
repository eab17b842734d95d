// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of STL, PLY, OBJ and VTP with VTK.
#include "detail/text.hpp"
#include "detail/vtk_messages.hpp"
#include "mesh/surfaces.hpp"
#include "mesh/vtk_hints.hpp"

#include <fmt/format.h>
#include <vtkNew.h>
#include <vtkOBJReader.h>
#include <vtkPLYReader.h>
#include <vtkSTLReader.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>

#include <cstring>
#include <fstream>
#include <iterator>

namespace stylet::detail {

namespace {

/// Reads the file's polygons; `header` receives comments that may state the frame.
template <class Reader>
vtkSmartPointer<vtkPolyData> read(const std::filesystem::path& path, std::string& header, unsigned long& error) {
  vtkNew<Reader> reader;
  reader->SetFileName(path.c_str());
  reader->Update();
  error = reader->GetErrorCode();
  if constexpr (std::is_same_v<Reader, vtkSTLReader>) {
    if (reader->GetHeader() != nullptr) header = reader->GetHeader();
  } else if constexpr (std::is_same_v<Reader, vtkPLYReader>) {
    for (vtkIdType i = 0; i < reader->GetComments()->GetNumberOfValues(); ++i)
      header += reader->GetComments()->GetValue(i) + '\n';
  } else if constexpr (std::is_same_v<Reader, vtkOBJReader>) {
    if (reader->GetComment() != nullptr) header = reader->GetComment();
  }
  return reader->GetOutput();
}

/// Checks that an STL file is complete, since VTK reads truncated files without an error: a binary file states the
/// number of triangles, and a text file ends with a keyword.
Result<> check_stl_is_whole(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes(std::istreambuf_iterator<char>(file), {});
  std::uint32_t triangles = 0;
  if (bytes.size() >= 84) std::memcpy(&triangles, bytes.data() + 80, 4);
  const std::size_t binary_size = 84 + 50 * static_cast<std::size_t>(triangles);
  if (bytes.size() == binary_size) return Ok{};
  const bool text =
      lower(bytes.substr(0, 512)).find("solid") != std::string::npos && bytes.find("facet") != std::string::npos;
  if (text && lower(bytes.substr(bytes.size() - std::min<std::size_t>(bytes.size(), 512))).find("endsolid") !=
                  std::string::npos)
    return Ok{};
  if (!text && bytes.size() > binary_size && bytes.size() >= 84) return Ok{};
  return input_error(path.string(),
                     text ? "the last line is not 'endsolid'"
                          : fmt::format("{} bytes cannot hold the {} triangles announced", bytes.size(), triangles),
                     "The file is truncated or damaged; copy or export it again");
}

}  // namespace

Result<SurfacesWithNotes> parse_surface(const std::filesystem::path& path, FileKind kind, double scale) {
  const std::string source = path.string();
  const auto messages = VtkMessages::install();
  std::string header;
  unsigned long error = 0;
  vtkSmartPointer<vtkPolyData> data;
  if (kind == FileKind::stl) {
    if (Result<> whole = check_stl_is_whole(path); !whole) return whole.error();
  }
  switch (kind) {
    case FileKind::stl:
      data = read<vtkSTLReader>(path, header, error);
      break;
    case FileKind::ply:
      data = read<vtkPLYReader>(path, header, error);
      break;
    case FileKind::obj:
      data = read<vtkOBJReader>(path, header, error);
      break;
    default:
      data = read<vtkXMLPolyDataReader>(path, header, error);
      break;
  }
  if (messages->failed() || error != 0 || data == nullptr) {
    return input_error(source, "the surface cannot be read: its data end too early or do not fit their description",
                       "The file is truncated or damaged; copy or export it again");
  }
  const VtkHints hints = vtk_hints(*data, header);
  const double unit = scale > 0.0 ? scale : hints.unit_mm > 0.0 ? hints.unit_mm : 1.0;
  Result<Surface> surface = to_surface(*data, path.stem().string(), source);
  if (!surface) return surface.error();
  for (Vec3& x : surface->points) {
    x *= unit;
    if (hints.ras) x.head<2>() *= -1.0;
  }
  std::vector<Surface> surfaces;
  surfaces.push_back(*std::move(surface));
  return finish_surfaces(std::move(surfaces), source);
}

}  // namespace stylet::detail
