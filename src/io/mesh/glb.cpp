// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of binary glTF 2.0 scenes with VTK. glTF lengths are metres, +y is up (glTF 2.0 specification, 3.4).
#include "detail/json_text.hpp"
#include "detail/text.hpp"
#include "detail/vtk_messages.hpp"
#include "mesh/surfaces.hpp"

#include <fmt/format.h>
#include <vtkCompositeDataSet.h>
#include <vtkGLTFReader.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkNew.h>
#include <nlohmann/json.hpp>

#include <cstring>
#include <fstream>
#include <new>

namespace stylet::detail {

namespace {

/// Converts to LPS the coordinates of a standing patient as in anatomical atlases: facing +z, head +y, left side +x.
Vec3 to_lps(const Vec3& x, double scale) { return scale * Vec3(x.x(), -x.z(), x.y()); }

/// Collects all triangles below a block into one surface. Error: that of to_surface().
Result<> collect(vtkDataObject* block, Surface& into, const std::string& source) {
  auto* data = vtkPolyData::SafeDownCast(block);
  if (data == nullptr) return Ok{};
  const Result<Surface> part = to_surface(*data, {}, source);
  if (!part) return part.error();
  const auto offset = static_cast<Index>(into.points.size());
  into.points.insert(into.points.end(), part->points.begin(), part->points.end());
  for (const auto& t : part->triangles) into.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return Ok{};
}

/// The names of the scene's nodes from the file's JSON part (glTF 2.0, 4.4); VTK does not provide them.
std::vector<std::string> node_names(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 20> head{};  // magic, version, length; length and type of the first part
  std::uint32_t size = 0;
  if (!file.read(head.data(), head.size())) return {};
  std::memcpy(&size, head.data() + 12, 4);
  std::error_code code;
  if (size > std::filesystem::file_size(path, code)) return {};
  std::string text(size, '\0');
  if (!file.read(text.data(), size)) return {};
  const auto json = parse_json(text, path.string());
  std::vector<std::string> names;
  if (!json || !json->is_object() || !json->contains("nodes") || !(*json)["nodes"].is_array()) return names;
  for (const auto& node : (*json)["nodes"]) {
    names.push_back(
        node.is_object() && node.contains("name") && node["name"].is_string() ? node["name"].get<std::string>() : "");
  }
  return names;
}

/// The number i of a block that VTK names "Node_i"; -1 for other blocks.
int node_number(vtkMultiBlockDataSet& parent, unsigned index) {
  const char* name = parent.HasMetaData(index) ? parent.GetMetaData(index)->Get(vtkCompositeDataSet::NAME()) : nullptr;
  if (name == nullptr || !std::string_view(name).starts_with("Node_")) return -1;
  return static_cast<int>(to_number(std::string_view(name).substr(5)).value_or(-1.0));
}

/// Collects the surfaces below a block. VTK makes a block for each node, which contains blocks for the node's mesh
/// (whose primitives are the surfaces) and for its children.
Result<> walk(vtkMultiBlockDataSet& parent, Surface& own, const std::vector<std::string>& names,
              std::vector<Surface>& surfaces, const std::string& source) {
  for (unsigned i = 0; i < parent.GetNumberOfBlocks(); ++i) {
    auto* children = vtkMultiBlockDataSet::SafeDownCast(parent.GetBlock(i));
    const int number = node_number(parent, i);
    if (children == nullptr) {
      if (Result<> done = collect(parent.GetBlock(i), own, source); !done) return done;
    } else if (number < 0) {
      if (Result<> done = walk(*children, own, names, surfaces, source); !done) return done;
    } else {
      Surface node;
      node.name = static_cast<std::size_t>(number) < names.size() ? names[number] : "";
      if (node.name.empty()) node.name = fmt::format("node {}", number);
      if (Result<> done = walk(*children, node, names, surfaces, source); !done) return done;
      if (!node.triangles.empty()) surfaces.push_back(std::move(node));
    }
  }
  return Ok{};
}

}  // namespace

Result<SurfacesWithNotes> parse_glb(const std::filesystem::path& path, double scale) {
  const std::string source = path.string();
  const auto messages = VtkMessages::install();
  vtkNew<vtkGLTFReader> reader;
  reader->SetFileName(path.c_str());
  reader->ApplyDeformationsToGeometryOn();
  const Error unreadable = input_error(source, "the GLB scene cannot be read: its data do not fit their description",
                                       "The file is truncated, damaged or compressed (Draco); copy or export it again");
  try {
    reader->Update();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {  // VTK takes fields and lengths of the file as they are
    return unreadable;
  }
  auto* scene = vtkMultiBlockDataSet::SafeDownCast(reader->GetOutput());
  if (messages->failed() || reader->GetErrorCode() != 0 || scene == nullptr) return unreadable;
  std::vector<Surface> raw;
  Surface loose;
  loose.name = path.stem().string();
  if (Result<> done = walk(*scene, loose, node_names(path), raw, source); !done) return done.error();
  if (!loose.triangles.empty()) raw.push_back(std::move(loose));
  for (Surface& surface : raw) {
    for (Vec3& x : surface.points) x = to_lps(x, scale > 0.0 ? scale : 1000.0);
  }
  return finish_surfaces(std::move(raw), source);
}

}  // namespace stylet::detail
