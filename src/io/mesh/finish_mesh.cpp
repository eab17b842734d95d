// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/raw_mesh.hpp"

#include "detail/reach.hpp"
#include "stylet/core/printable.hpp"
#include "stylet/geom/plausible_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::detail {

namespace {

/// Drops nodes that only other elements than tetrahedra use. Nodes without any element stay and are an error later.
Index drop_foreign_nodes(RawMesh& raw) {
  if (raw.used_elsewhere.empty()) return 0;
  std::vector<bool> keep(raw.nodes.size());
  for (std::size_t a = 0; a < raw.nodes.size(); ++a) keep[a] = !raw.used_elsewhere[a];
  for (const auto& tet : raw.tets) {
    for (const Index a : tet) {
      if (a >= 0 && static_cast<std::size_t>(a) < keep.size()) keep[a] = true;
    }
  }
  std::vector<Index> renumbered(raw.nodes.size(), -1);
  Index count = 0;
  for (std::size_t a = 0; a < raw.nodes.size(); ++a) {
    if (!keep[a]) continue;
    raw.nodes[count] = raw.nodes[a];
    renumbered[a] = count++;
  }
  const Index dropped = static_cast<Index>(raw.nodes.size()) - count;
  raw.nodes.resize(count);
  for (auto& tet : raw.tets) {
    for (Index& a : tet) {
      if (a >= 0 && static_cast<std::size_t>(a) < renumbered.size()) a = renumbered[a];
    }
  }
  return dropped;
}

/// Converts the file's region numbers to 0, 1, … in ascending order, with names.
void set_regions(const RawMesh& raw, TetMesh& mesh) {
  std::map<int, int> index;
  for (const int tag : raw.tag) index[tag] = 0;
  for (auto& [tag, number] : index) {
    number = static_cast<int>(mesh.regions.size());
    const auto name = raw.tag_names.find(tag);
    std::string text = name != raw.tag_names.end() && !name->second.empty() ? printable_name(name->second)
                                                                            : fmt::format("region {}", tag);
    // Two numbers may have the same name in the file, but regions need different names.
    if (mesh.region_index(text) >= 0) text += fmt::format(" {}", tag);
    mesh.regions.push_back(std::move(text));
  }
  mesh.tet_region.reserve(raw.tag.size());
  for (const int tag : raw.tag) mesh.tet_region.push_back(index.at(tag));
}

bool numbers_in_range(const TetMesh& mesh) {
  return std::all_of(mesh.tets.begin(), mesh.tets.end(), [&](const auto& tet) {
    return std::all_of(tet.begin(), tet.end(), [&](Index a) { return a >= 0 && a < mesh.node_count(); });
  });
}

/// Inverts all tetrahedra if all of them are inverted, which is a convention of some programs; if only some are, the
/// mesh is damaged.
bool turn_if_all_inverted(TetMesh& mesh) {
  if (mesh.tets.empty() || !numbers_in_range(mesh)) return false;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    if (!(tet_volume(mesh, t) < 0.0)) return false;
  }
  for (auto& tet : mesh.tets) std::swap(tet[2], tet[3]);
  return true;
}

}  // namespace

Result<> check_scale(double scale) {
  if (scale == 0.0 || (std::isfinite(scale) && scale > 0.0)) return Ok{};
  return input_error("--scale",
                     fmt::format("{} is not a unit of length, a number above 0 is expected (mm per file unit)", scale),
                     "Pass e.g. --scale 1000 for metres");
}

Result<MeshWithNotes> finish_mesh(RawMesh raw, const std::string& source, const MeshReadOptions& options) {
  if (Result<> good = check_scale(options.scale); !good) return good.error();
  MeshWithNotes out;
  for (const auto& [kind, count] : raw.passed_over) {
    out.notes.push_back(fmt::format("{} {} ignored, because only tetrahedra are used.", count, kind));
  }
  if (raw.tets.empty()) {
    return input_error(source,
                       raw.passed_over.empty()
                           ? "the file holds no tetrahedra"
                           : fmt::format("the file holds no tetrahedra, only {}", raw.passed_over.begin()->first),
                       "Export a volume mesh of tetrahedra; fill a surface with tetrahedra first");
  }
  if (raw.quadratic) out.notes.emplace_back("Of the quadratic tetrahedra only the corner nodes are used.");
  if (Result<> chosen = choose_regions(raw, options.regions_from, source, out.notes); !chosen) return chosen.error();
  if (const Index dropped = drop_foreign_nodes(raw); dropped > 0) {
    out.notes.push_back(fmt::format("Dropped {} node{} that no tetrahedron uses.", dropped, dropped == 1 ? "" : "s"));
  }
  const double scale = options.scale > 0.0 ? options.scale : raw.unit_mm > 0.0 ? raw.unit_mm : 1.0;
  for (Vec3& x : raw.nodes) {
    x *= scale;
    if (raw.ras) x.head<2>() *= -1.0;
  }
  Eigen::AlignedBox3d box;
  for (const Vec3& x : raw.nodes) box.extend(x);
  if (!box.isEmpty()) {
    // Where the unit is stated, check_mesh() judges the size, too, and takes a smaller one.
    const bool stated = options.scale != 0.0 || raw.unit_mm != 0.0;
    const double smallest_mm = stated ? 0.5 * kSmallestPatient_mm : kSmallestPatient_mm;
    if (Result<> size = check_size(box.sizes().maxCoeff(), source, "the mesh", scale, smallest_mm); !size)
      return size.error();
  }
  for (std::size_t a = 0; a < raw.nodes.size(); ++a) {
    if (is_in_reach(raw.nodes[a])) continue;
    return check_reach(source, raw.nodes[a], fmt::format("node {}", a)).error();
  }
  set_regions(raw, out.mesh);
  out.mesh.nodes = std::move(raw.nodes);
  out.mesh.tets = std::move(raw.tets);
  if (turn_if_all_inverted(out.mesh))
    out.notes.emplace_back("The nodes of all tetrahedra were numbered the other way round; this was corrected.");
  if (Result<> sound = check_mesh(out.mesh, source); !sound) return sound.error();
  return out;
}

}  // namespace stylet::detail
