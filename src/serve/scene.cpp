// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene.hpp"

#include "hand.hpp"
#include "stylet/core/version.hpp"
#include "stylet/geom/centroid.hpp"
#include "stylet/geom/topology.hpp"
#include "stylet/io/region_views.hpp"
#include "stylet/sim/harms.hpp"
#include "wire.hpp"

#include "io/record/json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <utility>

namespace stylet::serve {

namespace {

using record::compact;
using record::Json;

constexpr double kMm3PerCc = 1000.0;

Json numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

constexpr double kBefore_mm = 5.0;   ///< surfaces are refined from this distance in front of the entry point …
constexpr double kBeyond_mm = 10.0;  ///< … to this distance beyond the planned depth

/// Surface triangles, grouped by the two regions that they separate. Corners are indices of the scene's points.
struct Surfaces {
  std::map<std::pair<int, int>, std::vector<std::array<Index, 3>>> patches;  ///< (inside, outside)
  std::vector<Index> nodes;
  std::vector<SurfacePoint> fines;  ///< further points; their `node` are indices in `nodes`
  std::vector<Vec3> positions;      ///< [mm] LPS of nodes and fines

  Surfaces(const TetMesh& mesh, const PlannedInsertion* way) : slot_(mesh.nodes.size(), -1) {
    const Topology topology(mesh);
    const auto region = [&](Index tet) { return tet < 0 ? -1 : mesh.tet_region[static_cast<std::size_t>(tet)]; };
    for (const Face& face : topology.boundary) add(region(face.tet), -1, face);
    for (const Face& face : topology.interfaces) add(region(face.tet), region(face.neighbour), face);
    for (const Index node : nodes) positions.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
    if (way != nullptr) refine(*way);
  }

 private:
  void add(int inside, int outside, const Face& face) {
    std::array<Index, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      Index& slot = slot_[static_cast<std::size_t>(face.nodes[k])];
      if (slot < 0) {
        slot = static_cast<Index>(nodes.size());
        nodes.push_back(face.nodes[k]);
      }
      triangle[k] = slot;
    }
    patches[{inside, outside}].push_back(triangle);
  }

  void refine(const PlannedInsertion& way) {
    std::vector<std::array<Index, 3>> triangles;
    std::vector<int> patch;
    int number = 0;
    for (auto& [sides, own] : patches) {
      triangles.insert(triangles.end(), own.begin(), own.end());
      patch.insert(patch.end(), own.size(), number++);
      own.clear();
    }
    const LineSegment line{way.entry - kBefore_mm * way.direction,
                           way.entry + (way.depth_mm + kBeyond_mm) * way.direction};
    FineSurface fine = refine_surface(positions, std::move(triangles), std::move(patch), std::span(&line, 1));
    for (std::size_t t = 0; t < fine.triangles.size(); ++t)
      std::next(patches.begin(), fine.patch[t])->second.push_back(fine.triangles[t]);
    fines.assign(fine.points.begin() + static_cast<std::ptrdiff_t>(nodes.size()), fine.points.end());
    positions = std::move(fine.positions);
  }
  std::vector<Index> slot_;
};

Json regions_json(const TetMesh& mesh, const std::vector<int>& targets) {
  std::vector<double> volume(mesh.regions.size(), 0.0);
  for (Index t = 0; t < mesh.tet_count(); ++t)
    volume[static_cast<std::size_t>(mesh.tet_region[static_cast<std::size_t>(t)])] += tet_volume(mesh, t);
  Json regions = Json::array();
  for (std::size_t r = 0; r < mesh.regions.size(); ++r)
    regions.push_back({{"name", mesh.regions[r]},
                       {"label", results::readable_name(mesh.regions[r])},
                       {"color", "#999999"},
                       {"opacity", 0.5},
                       {"target", false},
                       {"background", false},
                       {"spared", harmed_by_needle(mesh.regions[r])},
                       {"volume_cc", volume[r] / kMm3PerCc}});
  for (const results::RegionView& view : results::region_views(mesh, targets)) {
    Json& region = regions[static_cast<std::size_t>(view.region)];
    region["color"] = results::hex(view.colour);
    region["opacity"] = view.opacity;
    region["target"] = view.target;
    region["background"] = view.background;
  }
  return regions;
}

}  // namespace

std::array<double, 2> template_centre(const TetMesh& mesh, const std::vector<int>& targets, const TemplateGrid& grid) {
  if (grid.centre_mm) return *grid.centre_mm;
  const Vec3 centre = centroid(mesh, targets);
  return {centre.x(), centre.y()};
}

MadeScene make_scene(const TetMesh& mesh, const std::vector<int>& targets, const Scenario& scenario,
                     const std::vector<PlannedInsertion>& insertions, const std::vector<std::string>& warnings,
                     const CaseList& cases, const PlannedInsertion* way) {
  Surfaces surfaces(mesh, way);
  auto scene = std::make_shared<Scene>();
  scene->positions.reserve(3 * surfaces.positions.size());
  double lowest = std::numeric_limits<double>::infinity();
  for (const Vec3& x : surfaces.positions) {
    for (const double value : x) scene->positions.push_back(static_cast<float>(value));
    lowest = std::min(lowest, x.z());
  }
  Json patches = Json::array();
  std::size_t first = 0;
  for (const auto& [sides, triangles] : surfaces.patches) {
    patches.push_back(
        {{"inside", sides.first}, {"outside", sides.second}, {"first", first}, {"count", triangles.size()}});
    for (const auto& triangle : triangles)
      for (const Index corner : triangle) scene->triangles.push_back(static_cast<std::uint32_t>(corner));
    first += triangles.size();
  }

  Json planned = Json::array();
  for (std::size_t i = 0; i < insertions.size(); ++i) {
    const PlannedInsertion& p = insertions[i];
    const bool known = i < scenario.insertions.size();
    const auto hole = known ? scenario.insertions[i].hole : std::nullopt;
    planned.push_back({{"name", p.name},
                       {"hole", hole.value_or("")},
                       {"entry_mm", numbers(p.entry)},
                       {"direction", numbers(p.direction)},
                       {"depth_mm", p.depth_mm},
                       {"speed_mm_per_s", known ? scenario.insertions[i].speed_mm_per_s : 20.0}});
  }
  const auto centre = template_centre(mesh, targets, scenario.grid);
  const HandLimits limits = hand_limits(scenario);
  const Json text{
      {"protocol", wire::kProtocol},
      {"version", version()},
      {"name", scenario.name},
      {"case", cases.open},
      {"cases", cases.titles},
      {"regions", regions_json(mesh, targets)},
      {"patches", patches},
      {"template",
       {{"pitch_mm", scenario.grid.pitch_mm},
        {"columns", scenario.grid.columns},
        {"rows", scenario.grid.rows},
        {"centre_mm", centre},
        {"z_mm", lowest - scenario.grid.distance_mm}}},
      {"insertions", planned},
      {"stabilising", scenario.procedure.stabilising},
      {"needle",
       {{"length_mm", scenario.needle.length_mm},
        {"diameter_mm", scenario.needle.diameter_mm},
        {"bevel_deg", scenario.needle.bevel_deg},
        {"model", word(scenario.needle.model)}}},
      {"limits",
       {{"depth_mm", limits.depth_mm},
        {"behind_mm", limits.behind_mm},
        {"speed_mm_per_s", limits.speed_mm_per_s},
        {"tilt_deg", limits.tilt_deg}}},
      {"mesh", {{"nodes", mesh.node_count()}, {"tets", mesh.tet_count()}}},
      {"dt_ms", cases.dt_ms},
      {"warnings", warnings},
      {"notice", "Not a medical device. For research and training; not for planning or treating patients."}};
  // Names come from files of many kinds, so bytes that are not UTF-8 are replaced, not refused.
  scene->text = compact(text);
  return {scene, {std::move(surfaces.nodes), std::move(surfaces.fines)}};
}

}  // namespace stylet::serve
