// SPDX-License-Identifier: GPL-3.0-or-later
#include "xray_catheter.hpp"

#include "stylet/imaging/xray_materials.hpp"
#include "xray_rods.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

namespace stylet {

namespace {

// A catheter of 16 French: 5.3 mm thick, with a lumen of about half of that; a balloon of 5 ml.
constexpr double kCatheterLumen_mm = 2.7;
constexpr double kBalloonRadius_mm = 10.6;
constexpr double kCatheterIodine_mg_per_ml = 100.0;  ///< contrast of 300 mg/ml, diluted to a third
constexpr double kBalloonIodine_mg_per_ml = 50.0;    ///< diluted to a sixth
constexpr double kBulbRadius_mm = 30.0;              ///< radius of the arc of the bulbar urethra
constexpr std::size_t kArcPoints = 8;
constexpr double kPointDistance_mm = 4.0;
constexpr double kFadesOver = 2.0;     ///< layers on each side of a point that have a share in it
constexpr std::size_t kDirection = 3;  ///< the direction at an end is that over this many points

}  // namespace

XrayCatheter::XrayCatheter(const TetMesh& mesh, const FluoroscopySettings& settings) {
  const int urethra = mesh.region_index("urethra");
  if (!settings.catheter || urethra < 0) return;
  const auto is_urethra = [&](std::size_t t) { return mesh.tet_region[t] == urethra; };
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!is_urethra(t)) continue;
    for (const Index node : mesh.tets[t]) {
      low = std::min(low, mesh.nodes[static_cast<std::size_t>(node)].z());
      high = std::max(high, mesh.nodes[static_cast<std::size_t>(node)].z());
    }
  }
  if (!(high - low > kPointDistance_mm)) return;
  // Each point is the centroid of a layer of the urethra whose weight fades over two layers to both sides, since the
  // elements are as large as the layers.
  const auto layers = static_cast<std::size_t>((high - low) / kPointDistance_mm);
  const double height = (high - low) / static_cast<double>(layers);
  std::vector<std::map<Index, double>> weights(layers);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!is_urethra(t)) continue;
    double middle = 0.0;
    for (const Index node : mesh.tets[t]) middle += 0.25 * mesh.nodes[static_cast<std::size_t>(node)].z();
    const double volume = tet_volume(mesh, static_cast<Index>(t));
    for (std::size_t layer = 0; layer < layers; ++layer) {
      const double off = std::abs(middle - low - (static_cast<double>(layer) + 0.5) * height) / height;
      const double share = std::max(0.0, 1.0 - off / kFadesOver);
      if (share <= 0.0) continue;
      for (const Index node : mesh.tets[t]) weights[layer][node] += 0.25 * volume * share;
    }
  }
  for (const std::map<Index, double>& layer : weights) {
    double volume = 0.0;
    for (const auto& [node, weight] : layer) volume += weight;
    if (volume <= 0.0) continue;
    Vec3 centre = Vec3::Zero();
    for (const auto& [node, weight] : layer) {
      centre += weight / volume * mesh.nodes[static_cast<std::size_t>(node)];
      shares_.push_back({at_rest_.size(), node, static_cast<float>(weight / volume)});
    }
    at_rest_.push_back(centre);
  }
  if (at_rest_.size() < 2) {
    at_rest_.clear();
    return;
  }
  end_mm_ = std::max(0.0, high - at_rest_.back().z());
  arc_points_ = kArcPoints;
  centreline_.resize(arc_points_ + at_rest_.size() + 1);
  const double filling = contrast_per_mm(kCatheterIodine_mg_per_ml, settings.energy_keV);
  contrast_per_mm_ = filling - attenuation_per_mm(XrayMaterial::soft_tissue, settings.energy_keV);
  balloon_ = mesh.region_index("bladder") >= 0;
  balloon_per_mm_ =
      contrast_per_mm(kBalloonIodine_mg_per_ml, settings.energy_keV) - region_attenuation_per_mm("bladder", settings);
}

void XrayCatheter::add(const XrayGeometry& unit, const Eigen::Matrix3Xf& displacement, std::span<float> sums) {
  if (at_rest_.empty()) return;
  const std::span<Vec3> urethra = std::span(centreline_).subspan(arc_points_);
  std::copy(at_rest_.begin(), at_rest_.end(), urethra.begin());
  for (const Share& share : shares_) urethra[share.point] += share.weight * displacement.col(share.node).cast<double>();
  const std::size_t last = at_rest_.size() - 1;
  const std::size_t along = std::min(last, kDirection);
  const Vec3 upward = (urethra[last] - urethra[last - along]).normalized();
  urethra[last + 1] = urethra[last] + end_mm_ * upward;
  // The arc begins in the direction of the urethra's lower end and turns to anterior.
  const Vec3 downward = (urethra[0] - urethra[along]).normalized();
  const Vec3 anterior = -Vec3::UnitY();
  const Vec3 inward = (anterior - anterior.dot(downward) * downward).normalized();
  for (std::size_t k = 0; k < arc_points_; ++k) {
    const double turn =
        0.5 * std::numbers::pi * static_cast<double>(arc_points_ - k) / static_cast<double>(arc_points_);
    centreline_[k] = urethra[0] + kBulbRadius_mm * (std::sin(turn) * downward + (1.0 - std::cos(turn)) * inward);
  }
  add_tube(unit, centreline_, kCatheterLumen_mm, 0.0, contrast_per_mm_, sums);
  if (balloon_)
    add_ball(unit, urethra[last + 1] + kBalloonRadius_mm * upward, kBalloonRadius_mm, balloon_per_mm_, sums);
}

}  // namespace stylet
