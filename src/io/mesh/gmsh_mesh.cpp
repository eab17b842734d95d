// SPDX-License-Identifier: GPL-3.0-or-later
// gmsh MSH 1, 2.2, 4.1 (ASCII, binary) and MEDIT .mesh, by the gmsh library.
#include "detail/text.hpp"
#include "mesh/raw_mesh.hpp"

#include <fmt/format.h>
#include <gmsh.h>

#include <fstream>
#include <unordered_map>

namespace stylet::detail {

namespace {

namespace fs = std::filesystem;

constexpr int tetrahedron_4 = 4, tetrahedron_10 = 11;  // gmsh element types

struct Gmsh {
  Gmsh() {
    gmsh::initialize(0, nullptr, false);  // without the user's configuration files
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("General.AbortOnError", 2);  // throw
    gmsh::option::setNumber("General.NumThreads", 1);
    gmsh::logger::start();
  }
  /// gmsh goes on after errors; its log knows.
  static std::string first_error() {
    std::vector<std::string> lines;
    gmsh::logger::get(lines);
    for (const std::string& line : lines) {
      if (line.starts_with("Error")) return line.substr(line.find(':') == std::string::npos ? 0 : line.find(':') + 2);
    }
    return {};
  }
};

/// Region numbers and names of volumes: the volume's first physical group. Without groups, or when one group without a
/// name holds several volumes (gmsh wants some group to save a mesh), the volumes themselves.
class Regions {
 public:
  Regions() {
    gmsh::vectorpair volumes, groups;
    gmsh::model::getEntities(volumes, 3);
    gmsh::model::getPhysicalGroups(groups, 3);
    std::string name;
    if (groups.size() == 1) gmsh::model::getPhysicalName(3, groups.front().second, name);
    by_volume_ = groups.empty() || (groups.size() == 1 && name.empty() && volumes.size() > 1);
  }
  [[nodiscard]] std::pair<int, std::string> of(int volume) const {
    std::vector<int> groups;
    if (!by_volume_) gmsh::model::getPhysicalGroupsForEntity(3, volume, groups);
    // Minus keeps the number of a volume outside all groups apart from those of the groups.
    if (groups.empty()) return {by_volume_ ? volume : -volume, fmt::format("region {}", volume)};
    std::string name;
    gmsh::model::getPhysicalName(3, groups.front(), name);
    return {groups.front(), name};
  }

 private:
  bool by_volume_ = true;
};

Result<RawMesh> to_raw(const std::string& source) {
  RawMesh raw;
  std::vector<std::size_t> tags;
  std::vector<double> coordinates, parameters;
  gmsh::model::mesh::getNodes(tags, coordinates, parameters);
  std::unordered_map<std::size_t, Index> node;
  node.reserve(tags.size());
  for (std::size_t a = 0; a < tags.size(); ++a) {
    if (!node.emplace(tags[a], static_cast<Index>(a)).second) {
      return input_error(source, fmt::format("node {} appears twice", tags[a]),
                         "Export the mesh again; the file is damaged.");
    }
    raw.nodes.emplace_back(coordinates[3 * a], coordinates[3 * a + 1], coordinates[3 * a + 2]);
  }
  raw.used_elsewhere.assign(raw.nodes.size(), false);

  const Regions regions;
  gmsh::vectorpair entities;
  gmsh::model::getEntities(entities);
  for (const auto& [dimension, entity] : entities) {
    const auto [tag, name] = dimension == 3 ? regions.of(entity) : std::pair<int, std::string>{};
    std::vector<int> types;
    std::vector<std::vector<std::size_t>> elements, nodes;
    gmsh::model::mesh::getElements(types, elements, nodes, dimension, entity);
    for (std::size_t k = 0; k < types.size(); ++k) {
      const std::size_t count = elements[k].size();
      if (count == 0) continue;
      const std::size_t per_element = nodes[k].size() / count;
      const bool tets = types[k] == tetrahedron_4 || types[k] == tetrahedron_10;
      if (!tets) {
        std::string kind;
        int element_dimension = 0, order = 0, corners = 0, primary = 0;
        std::vector<double> local;
        gmsh::model::mesh::getElementProperties(types[k], kind, element_dimension, order, corners, local, primary);
        raw.passed_over[fmt::format("element(s) of type {}", kind)] += static_cast<Index>(count);
      } else {
        raw.quadratic = raw.quadratic || types[k] == tetrahedron_10;
        raw.tag_names[tag] = name;
      }
      for (std::size_t e = 0; e < count; ++e) {
        std::array<Index, 4> tet{};
        for (std::size_t i = 0; i < per_element; ++i) {
          const auto found = node.find(nodes[k][e * per_element + i]);
          if (found == node.end()) {
            return input_error(fmt::format("{}, element {}", source, elements[k][e]),
                               fmt::format("node {} is not in the file", nodes[k][e * per_element + i]),
                               "Export the mesh again; the file is damaged.");
          }
          if (tets && i < 4) {
            tet[i] = found->second;
          } else {
            raw.used_elsewhere[found->second] = true;
          }
        }
        if (tets) {
          raw.tets.push_back(tet);
          raw.tag.push_back(tag);
        }
      }
    }
  }
  return raw;
}

/// gmsh chooses its reader by extension and first bytes, takes what it does not know for a script, and runs a script
/// called FILE.opt beside the file; scripts may start programs. Lets through only what it will take for a mesh.
Result<> check_harmless(const fs::path& path, bool medit) {
  const std::string source = path.string();
  const std::string ending = path.extension().string();
  if (ending != (medit ? ".mesh" : ".msh")) {
    return input_error(source,
                       fmt::format("this is a {} mesh, but its name ends in '{}'", medit ? "MEDIT" : "gmsh", ending),
                       fmt::format("Rename it to end in {}.", medit ? ".mesh" : ".msh"));
  }
  std::string first_line;
  std::getline(std::ifstream(path, std::ios::binary), first_line);
  const auto begins = [&](std::string_view mark) { return first_line.starts_with(mark); };
  if (!medit && !begins("$MeshFormat") && !begins("$NOD") && !begins("$Comments")) {
    return input_error(source, "the first line is none of $MeshFormat, $NOD, $Comments",
                       "Remove what stands before it.");
  }
  std::error_code code;
  if (fs::exists(source + ".opt", code)) {
    return input_error(source,
                       fmt::format("gmsh would run the script '{}' beside it", path.filename().string() + ".opt"),
                       "Move that script away.");
  }
  return Ok{};
}

/// How many tetrahedra a MEDIT file announces. gmsh takes a file that ends too early for a smaller mesh.
std::size_t announced_tetrahedra(const fs::path& path) {
  std::ifstream file(path);
  std::size_t announced = 0, count = 0;
  for (std::string word; file >> word;) {
    if ((word == "Tetrahedra" || word == "TetrahedraP2") && file >> count) announced += count;
  }
  return announced;
}

}  // namespace

Result<RawMesh> parse_gmsh_mesh(const fs::path& path, bool medit) {
  if (Result<> harmless = check_harmless(path, medit); !harmless) return harmless.error();
  const std::string source = path.string();
  std::string problem;
  const Gmsh library;
  try {
    gmsh::merge(source);
    problem = Gmsh::first_error();
    if (problem.empty()) {
      Result<RawMesh> raw = to_raw(source);
      const std::size_t announced = medit ? announced_tetrahedra(path) : 0;
      if (raw && medit && raw->tets.size() != announced) {
        return input_error(source,
                           fmt::format("the file announces {} tetrahedra and holds {}", announced, raw->tets.size()),
                           "Copy or export it again; it is truncated or damaged.");
      }
      return raw;
    }
  } catch (const std::exception& error) {
    problem = error.what();
  } catch (...) {
    problem = Gmsh::first_error();
  }
  return input_error(source,
                     fmt::format("gmsh cannot read the file ({})", problem.empty() ? "no reason given" : problem),
                     "Copy or export it again; it is truncated or damaged.");
}

}  // namespace stylet::detail
