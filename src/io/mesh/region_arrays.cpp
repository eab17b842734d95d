// SPDX-License-Identifier: GPL-3.0-or-later
// Which array of numbers of a foreign mesh its regions are: one rule for all formats.
#include "mesh/raw_mesh.hpp"

#include "stylet/core/nearest_name.hpp"
#include "stylet/geom/structure_names.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace stylet::detail {

namespace {

// More different numbers than a mesh of a patient has regions are numbers of cells or parts of a computation.
constexpr std::size_t kMostRegions = 256;

bool is_region_number(double value) { return std::abs(value) < 1e9 && value == std::floor(value); }

bool is_whole(const CellArray& array) {
  return !array.values.empty() && std::all_of(array.values.begin(), array.values.end(), is_region_number);
}

std::size_t different(const CellArray& array) { return std::set(array.values.begin(), array.values.end()).size(); }

/// Whether numbers divide the mesh and are no numbers of VTK itself (ghost cells, original numbers).
bool divides(const CellArray& array) {
  return is_whole(array) && different(array) >= 2 && !array.name.starts_with("vtk");
}

/// Whether so few numbers divide the mesh that they can be regions, and not for instance a number for each cell.
bool can_be_regions(const CellArray& array) {
  return divides(array) && different(array) <= kMostRegions && 2 * different(array) <= array.values.size();
}

/// Whether two arrays have the same borders, whatever their numbers.
bool same_parts(const CellArray& a, const CellArray& b) {
  std::map<double, double> to, from;
  if (a.values.size() != b.values.size()) return false;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    if (to.emplace(a.values[i], b.values[i]).first->second != b.values[i]) return false;
    if (from.emplace(b.values[i], a.values[i]).first->second != a.values[i]) return false;
  }
  return true;
}

std::string quoted(const CellArray& array) {
  return fmt::format("'{}' ({} different numbers)", array.name, different(array));
}

std::string listed(const std::vector<const CellArray*>& arrays) {
  std::vector<std::string> words;
  for (const CellArray* array : arrays) words.push_back(quoted(*array));
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string how_to_choose(const CellArray& example) {
  return fmt::format("To choose one: --regions-from \"{0}\" (in a scenario: regions_from = \"{0}\" below [patient])",
                     example.name);
}

Result<> take(RawMesh& raw, const CellArray& array, const std::string& source) {
  const std::string what = fmt::format("the {} '{}'", raw.array_word, array.name);
  if (array.values.size() != raw.tets.size())
    return input_error(source, what + " does not have one number per cell", "Write one region number per cell");
  for (std::size_t t = 0; t < array.values.size(); ++t) {
    if (is_region_number(array.values[t])) continue;
    return input_error(raw.cells.empty() ? fmt::format("{}, tetrahedron {}", source, t)
                                         : fmt::format("{}, {} {}", source, raw.cell_word, raw.cells[t]),
                       fmt::format("the region number {} in {} is not a whole number", array.values[t], what),
                       "Write whole numbers");
  }
  raw.tag.assign(array.values.begin(), array.values.end());
  raw.tag_names = array.names;
  return Ok{};
}

/// The array that the user names.
Result<const CellArray*> named(const RawMesh& raw, const std::string& wanted, const std::string& source) {
  std::vector<std::string> names;
  for (const CellArray& array : raw.arrays) names.push_back(array.name);
  if (const auto found = find_named(names, wanted); !found.empty()) return &raw.arrays[found.front()];
  const std::string near = nearest_name(wanted, names);
  return input_error(
      source,
      names.empty()
          ? fmt::format("there is no {} '{}' for the regions; the file has none", raw.array_word, wanted)
          : fmt::format("there is no {} '{}' for the regions; the file has {}", raw.array_word, wanted, names),
      names.empty()  ? "Leave out --regions-from or patient.regions_from"
      : near.empty() ? "Name one of these"
                     : fmt::format("Did you mean '{}'?", near));
}

}  // namespace

Result<> choose_regions(RawMesh& raw, const std::string& wanted, const std::string& source,
                        std::vector<std::string>& notes) {
  raw.tag.assign(raw.tets.size(), 0);
  if (!wanted.empty()) {
    const auto array = named(raw, wanted, source);
    return array ? take(raw, **array, source) : Result<>(array.error());
  }
  const CellArray* own = raw.own ? &raw.arrays[*raw.own] : nullptr;
  if (own != nullptr) {
    if (Result<> taken = take(raw, *own, source); !taken) return taken;
  }
  std::vector<const CellArray*> candidates, too_many;
  for (const CellArray& array : raw.arrays) {
    const auto same = [&](const CellArray* other) { return same_parts(*other, array); };
    if (!divides(array) || (own != nullptr && same(own))) continue;
    std::vector<const CellArray*>& list = can_be_regions(array) ? candidates : too_many;
    if (std::none_of(list.begin(), list.end(), same)) list.push_back(&array);
  }
  const std::string& word = raw.array_word;
  const bool one = own == nullptr || different(*own) < 2;
  if (!one || (own != nullptr && !own->names.empty())) {  // the file itself says which regions there are
    if (!candidates.empty())
      notes.push_back(fmt::format("The regions are those of '{}'; other whole numbers of the cells are the {} {}. {}.",
                                  own->name, word, listed(candidates), how_to_choose(*candidates.front())));
    return Ok{};
  }
  if (candidates.size() == 1) {
    const CellArray& only = *candidates.front();
    notes.push_back(fmt::format("The regions come from the {} '{}' ({} regions), the only one that can be them.", word,
                                only.name, different(only)));
    return take(raw, only, source);
  }
  if (!candidates.empty()) {
    notes.push_back(
        fmt::format("All tetrahedra are one region, since several arrays can be the regions: the {} {}. {}.", word,
                    listed(candidates), how_to_choose(*candidates.front())));
  } else if (!too_many.empty()) {
    notes.push_back(fmt::format("All tetrahedra are one region, since the {} {} has too many different numbers. {}.",
                                word, listed(too_many), how_to_choose(*too_many.front())));
  } else {
    notes.emplace_back("All tetrahedra are one region, since nothing in the file divides them.");
  }
  return Ok{};
}

}  // namespace stylet::detail
