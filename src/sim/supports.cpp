// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/supports.hpp"

#include "stylet/core/nearest_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

namespace stylet {

namespace {

constexpr double kFreeAroundEntry_mm = 30.0;

std::string count_text(std::size_t count) { return std::to_string(count) + (count == 1 ? " node" : " nodes"); }

}  // namespace

bool is_bone(const std::string& region) {
  return region == "pubic_arch" || region == "femur_left" || region == "femur_right";
}

Result<Supports> find_supports(const TetMesh& mesh, const Topology& topology, const Scenario::Fixed& fixed,
                               const std::vector<int>& target, const std::vector<Vec3>& entries,
                               const std::vector<Vec3>& directions) {
  Supports supports;
  std::set<Index> held;

  // Whole regions.
  std::vector<std::string> names = fixed.regions;
  if (names.empty()) {
    std::copy_if(mesh.regions.begin(), mesh.regions.end(), std::back_inserter(names), is_bone);
  }
  bool arch = false;
  for (const std::string& name : names) {
    const int region = mesh.region_index(name);
    if (region < 0) {
      const std::string near = nearest_name(name, mesh.regions);
      return input_error(
          "fixed.regions",
          fmt::format("there is no region '{}' in the mesh (there are: {})", name, fmt::join(mesh.regions, ", ")),
          near.empty() ? "Use one of these names" : fmt::format("Did you mean '{}'?", near));
    }
    std::set<Index> own;
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      if (mesh.tet_region[t] == region) own.insert(mesh.tets[t].begin(), mesh.tets[t].end());
    }
    held.insert(own.begin(), own.end());
    supports.rigid_regions.push_back(region);
    supports.description.push_back("Region " + name + " is held: " + count_text(own.size()) + ".");
    arch = arch || name == "pubic_arch";
  }

  // Outer faces.
  const bool anatomy = !target.empty() && mesh.region_index("body") >= 0;
  OuterSupport mode = fixed.outer;
  if (mode == OuterSupport::automatic) mode = arch ? OuterSupport::none : OuterSupport::sides;
  std::set<Index> outer;
  if (mode == OuterSupport::all) {
    for (const Face& face : topology.boundary) outer.insert(face.nodes.begin(), face.nodes.end());
    supports.description.push_back("All outer faces are held: " + count_text(outer.size()) + ".");
  } else if (mode == OuterSupport::sides && anatomy) {
    double target_bottom = std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
      if (std::find(target.begin(), target.end(), mesh.tet_region[t]) == target.end()) continue;
      for (const Index node : mesh.tets[t])
        target_bottom = std::min(target_bottom, mesh.nodes[static_cast<std::size_t>(node)].z());
    }
    for (const Face& face : topology.boundary) {
      const Vec3& a = mesh.nodes[static_cast<std::size_t>(face.nodes[0])];
      const Vec3& b = mesh.nodes[static_cast<std::size_t>(face.nodes[1])];
      const Vec3& c = mesh.nodes[static_cast<std::size_t>(face.nodes[2])];
      const Vec3 centre = (a + b + c) / 3.0;
      const Vec3 normal = (b - a).cross(c - a).normalized();
      const bool perineal = normal.z() < -0.3 && centre.z() < target_bottom;
      const bool near_entry = std::any_of(entries.begin(), entries.end(), [&](const Vec3& entry) {
        return (entry - centre).norm() < kFreeAroundEntry_mm;
      });
      if (!perineal && !near_entry) outer.insert(face.nodes.begin(), face.nodes.end());
    }
    supports.description.push_back(
        "The outer faces of the body are held: " + count_text(outer.size()) +
        ". The perineal face (facing inferior, below the gland) and everything within 30 mm of an entry are free.");
  } else if (mode == OuterSupport::sides) {
    // Without known anatomy, hold the outer faces of the far half of the body, seen along the first needle.
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;
    for (const Vec3& x : mesh.nodes) {
      low = low.cwiseMin(x);
      high = high.cwiseMax(x);
    }
    const Vec3 along = directions.empty() ? Vec3(Vec3::UnitZ()) : directions.front();
    double near = std::numeric_limits<double>::infinity();
    double far = -near;
    for (const Vec3& x : mesh.nodes) {
      near = std::min(near, along.dot(x));
      far = std::max(far, along.dot(x));
    }
    for (const Face& face : topology.boundary) {
      for (const Index node : face.nodes) {
        if (along.dot(mesh.nodes[static_cast<std::size_t>(node)]) > 0.5 * (near + far)) outer.insert(node);
      }
    }
    supports.description.push_back(
        "The input has no anatomy that could hold the tissue, so the outer faces of its far half, seen along the "
        "needle, are held: " +
        count_text(outer.size()) + ". Use [fixed] to choose other supports.");
  }
  held.insert(outer.begin(), outer.end());

  if (fixed.box_mm) {
    const auto& b = *fixed.box_mm;
    std::size_t count = 0;
    for (Index node = 0; node < mesh.node_count(); ++node) {
      const Vec3& x = mesh.nodes[static_cast<std::size_t>(node)];
      if (x.x() >= b[0] && x.y() >= b[1] && x.z() >= b[2] && x.x() <= b[3] && x.y() <= b[4] && x.z() <= b[5]) {
        held.insert(node);
        ++count;
      }
    }
    if (count == 0) {
      return input_error("fixed.box_mm", "there is no node inside the box",
                         "Give the low and the high corner in LPS mm; stylet info shows the mesh's extent");
    }
    supports.description.push_back("The nodes inside the box fixed.box_mm are held: " + count_text(count) + ".");
  }
  if (held.empty()) {
    return input_error("[fixed]", "nothing holds the tissue: no bone in the input and fixed.outer = \"none\"",
                       "Name regions in fixed.regions, or set fixed.outer to \"sides\"");
  }
  supports.nodes.assign(held.begin(), held.end());
  return supports;
}

}  // namespace stylet
