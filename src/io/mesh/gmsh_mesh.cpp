// SPDX-License-Identifier: GPL-3.0-or-later
// Reader of gmsh MSH 1, 2.2, 4.1 (ASCII, binary) and MEDIT .mesh with the gmsh library.
#include "detail/text.hpp"
#include "mesh/gmsh_library.hpp"
#include "mesh/msh_numbers.hpp"
#include "mesh/raw_mesh.hpp"

#include <fmt/format.h>

#include <fstream>
#include <unordered_map>

namespace stylet::detail {

namespace {

namespace fs = std::filesystem;

constexpr int tetrahedron_4 = 4, tetrahedron_10 = 11;  // gmsh element types

/// Region numbers and names of volumes, from the volume's first physical group. If there are no groups, or if one group
/// without a name holds several volumes (gmsh needs some group to save a mesh), each volume is a region.
class Regions {
 public:
  explicit Regions(const GmshLibrary& gmsh) : gmsh_(gmsh) {
    const auto volumes = gmsh.entities(3), groups = gmsh.physical_groups(3);
    const std::string name = groups.size() == 1 ? gmsh.physical_name(3, groups.front().second) : "";
    by_volume_ = groups.empty() || (groups.size() == 1 && name.empty() && volumes.size() > 1);
  }
  [[nodiscard]] bool by_volume() const { return by_volume_; }
  /// Number and name of the region of a volume; the name is empty if it says no more than the number.
  [[nodiscard]] std::pair<int, std::string> of(int volume) const {
    if (by_volume_) return {volume, ""};
    const std::vector<int> groups = gmsh_.physical_groups_of(3, volume);
    // The minus sign distinguishes the number of a volume outside all groups from the numbers of groups.
    if (groups.empty()) return {-volume, fmt::format("region {}", volume)};
    return {groups.front(), gmsh_.physical_name(3, groups.front())};
  }

 private:
  const GmshLibrary& gmsh_;
  bool by_volume_ = true;
};

/// Numbers of all elements of every dimension that gmsh has read from a file.
std::vector<std::size_t> element_numbers(const GmshLibrary& gmsh) {
  std::vector<std::size_t> numbers;
  for (const auto& [dimension, entity] : gmsh.entities(-1)) {
    for (const auto& elements : gmsh.elements(dimension, entity))
      numbers.insert(numbers.end(), elements.tags.begin(), elements.tags.end());
  }
  return numbers;
}

/// The $ElementData of the file, with their values at the tetrahedra.
/// @param tets numbers of the tetrahedra
void add_element_data(const GmshLibrary& gmsh, const std::vector<std::int64_t>& tets, RawMesh& raw) {
  for (const GmshLibrary::ElementData& data : gmsh.element_data()) {
    std::unordered_map<std::size_t, double> value;
    for (std::size_t i = 0; i < data.values.size(); ++i) value.emplace(data.tags[i], data.values[i]);
    CellArray& added = raw.arrays.emplace_back(CellArray{.name = data.name, .values = {}, .names = {}});
    for (const std::int64_t tet : tets) {
      if (const auto found = value.find(static_cast<std::size_t>(tet)); found != value.end())
        added.values.push_back(found->second);
    }
    if (added.values.size() != tets.size()) added.values.clear();
  }
}

Result<RawMesh> to_raw(const GmshLibrary& gmsh, const std::string& source, bool medit) {
  RawMesh raw;
  const auto [tags, coordinates] = gmsh.nodes();
  std::unordered_map<std::size_t, Index> node;
  node.reserve(tags.size());
  for (std::size_t a = 0; a < tags.size(); ++a) {
    if (!node.emplace(tags[a], static_cast<Index>(a)).second) {
      return input_error(source, fmt::format("node {} appears twice", tags[a]),
                         "The file is damaged; export the mesh again");
    }
    raw.nodes.emplace_back(coordinates[3 * a], coordinates[3 * a + 1], coordinates[3 * a + 2]);
  }
  raw.used_elsewhere.assign(raw.nodes.size(), false);

  const Regions regions(gmsh);
  CellArray own{.name = medit                 ? "references"
                        : regions.by_volume() ? "volumes"
                                              : "physical groups",
                .values = {},
                .names = {}};
  for (const auto& [dimension, entity] : gmsh.entities(-1)) {
    const auto [tag, name] = dimension == 3 ? regions.of(entity) : std::pair<int, std::string>{};
    for (const auto& [type, elements, nodes] : gmsh.elements(dimension, entity)) {
      const std::size_t count = elements.size();
      if (count == 0) continue;
      const std::size_t per_element = nodes.size() / count;
      const bool tets = type == tetrahedron_4 || type == tetrahedron_10;
      if (!tets) {
        const std::string kind = gmsh.element_type(type).name;
        raw.passed_over[fmt::format("element(s) of type {}", kind)] += static_cast<Index>(count);
      } else {
        raw.quadratic = raw.quadratic || type == tetrahedron_10;
        if (!name.empty()) own.names[tag] = name;
      }
      for (std::size_t e = 0; e < count; ++e) {
        std::array<Index, 4> tet{};
        for (std::size_t i = 0; i < per_element; ++i) {
          const auto found = node.find(nodes[e * per_element + i]);
          if (found == node.end()) {
            return input_error(fmt::format("{}, element {}", source, elements[e]),
                               fmt::format("node {} is not in the file", nodes[e * per_element + i]),
                               "The file is damaged; export the mesh again");
          }
          if (tets && i < 4) {
            tet[i] = found->second;
          } else {
            raw.used_elsewhere[found->second] = true;
          }
        }
        if (tets) {
          raw.tets.push_back(tet);
          raw.cells.push_back(static_cast<std::int64_t>(elements[e]));
          own.values.push_back(tag);
        }
      }
    }
  }
  raw.array_word = medit ? "array" : "$ElementData";
  raw.own = 0;
  raw.arrays.push_back(std::move(own));
  add_element_data(gmsh, raw.cells, raw);
  return raw;
}

/// Checks that gmsh will treat a file as a mesh and not as a script, because scripts can start programs. gmsh chooses
/// its reader by extension and first bytes, runs unknown content as a script, and also runs a script FILE.opt in the
/// same folder.
Result<> check_harmless(const fs::path& path, bool medit) {
  const std::string source = path.string();
  const std::string ending = path.extension().string();
  if (ending != (medit ? ".mesh" : ".msh")) {
    return input_error(source,
                       fmt::format("this is a {} mesh, but its name ends in '{}'", medit ? "MEDIT" : "gmsh", ending),
                       fmt::format("Rename it to end in {}", medit ? ".mesh" : ".msh"));
  }
  std::string first_line;
  std::getline(std::ifstream(path, std::ios::binary), first_line);
  const auto begins = [&](std::string_view mark) { return first_line.starts_with(mark); };
  if (!medit && !begins("$MeshFormat") && !begins("$NOD") && !begins("$Comments")) {
    return input_error(source, "the first line is not $MeshFormat, $NOD or $Comments",
                       "Remove everything before that line");
  }
  std::error_code code;
  if (fs::exists(source + ".opt", code)) {
    return input_error(
        source, fmt::format("gmsh would run the script '{}' in the same folder", path.filename().string() + ".opt"),
        "Move that script to another folder");
  }
  return Ok{};
}

/// The number of tetrahedra that a MEDIT file announces, to detect a truncated file, which gmsh reads as a smaller
/// mesh.
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
  const Result<const GmshLibrary*> library = GmshLibrary::get();
  if (!library) return library.error();
  const GmshLibrary& gmsh = **library;
  gmsh.start();
  try {
    gmsh.merge(source);
    if (!gmsh.has_failed()) {
      if (!medit) {  // MEDIT elements have no numbers
        const auto nodes_of = [&gmsh](int type) { return gmsh.element_type(type).nodes; };
        if (Result<> numbered = check_element_numbers(path, element_numbers(gmsh), nodes_of); !numbered)
          return numbered.error();
      }
      Result<RawMesh> raw = to_raw(gmsh, source, medit);
      const std::size_t announced = medit ? announced_tetrahedra(path) : 0;
      if (raw && medit && raw->tets.size() != announced) {
        return input_error(source,
                           fmt::format("the file announces {} tetrahedra and holds {}", announced, raw->tets.size()),
                           "The file is truncated or damaged; copy or export it again");
      }
      return raw;
    }
  } catch (const std::runtime_error&) {  // gmsh refuses a call for this file
  }
  return input_error(source, "gmsh cannot read the file: its data end too early or do not fit their description",
                     "The file is truncated or damaged; copy or export it again");
}

}  // namespace stylet::detail
