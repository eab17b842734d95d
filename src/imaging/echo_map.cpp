// SPDX-License-Identifier: GPL-3.0-or-later
#include "echo_map.hpp"

#include "echo_painter.hpp"
#include "stylet/imaging/tissue_role.hpp"
#include "voxel_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet {

namespace {

float power_of_dB(double dB) { return static_cast<float>(std::exp(0.1 * std::numbers::ln10 * dB)); }

}  // namespace

std::optional<EchoMap> EchoMap::paint(const TetMesh& mesh, std::span<const TissueEcho> echoes, std::uint32_t seed) {
  std::vector<TissueRole> roles;
  for (const std::string& region : mesh.regions) roles.push_back(tissue_role(region));
  Eigen::AlignedBox3d gland, all;
  bool has_zones = false;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const TissueRole role = roles[static_cast<std::size_t>(mesh.tet_region[t])];
    has_zones = has_zones || role == TissueRole::zone;
    for (const Index node : mesh.tets[t]) {
      const Vec3& x = mesh.nodes[static_cast<std::size_t>(node)];
      all.extend(x);
      if (is_gland(role)) gland.extend(x);
    }
  }
  if (gland.isEmpty()) return std::nullopt;
  Eigen::AlignedBox3d box = gland;
  box.extend(gland.min() - Vec3(60.0, 40.0, 40.0));
  box.extend(gland.max() + Vec3(60.0, 32.0, 40.0));
  const VoxelGrid grid(mesh, box.intersection(all), kVoxel_mm);
  const auto depth_in = [&](auto judge) {
    return grid.depth_mm(
        [&roles, judge](int region) { return region >= 0 && judge(roles[static_cast<std::size_t>(region)]); },
        EchoSpot::kReach_mm);
  };
  const std::vector<float> in_gland = depth_in([](TissueRole r) { return is_gland(r) || r == TissueRole::urethra; });
  const std::vector<float> in_urethra = depth_in([](TissueRole r) { return r == TissueRole::urethra; });
  const std::vector<float> in_bladder = depth_in([](TissueRole r) { return r == TissueRole::fluid; });
  const std::vector<float> in_rectum =
      depth_in([](TissueRole r) { return r == TissueRole::lumen || r == TissueRole::rectal_wall; });
  const std::vector<float> in_lumen = depth_in([](TissueRole r) { return r == TissueRole::lumen; });
  const bool has_vesicles =
      std::find(mesh.regions.begin(), mesh.regions.end(), "seminal_vesicles") != mesh.regions.end();
  const EchoPainter painter(gland, has_zones, has_vesicles, seed);
  const auto spot_at = [&](int i, int j, int k) {
    const std::size_t v = grid.index(i, j, k);
    return EchoSpot{grid.centre(i, j, k), in_gland[v], in_urethra[v], in_bladder[v], in_rectum[v], in_lumen[v]};
  };
  std::vector<float> power(grid.size()), concretions(grid.size(), static_cast<float>(EchoPainter::kNone_dB));
  for (int k = 0; k < grid.count().z(); ++k) {
    for (int j = 0; j < grid.count().y(); ++j) {
      for (int i = 0; i < grid.count().x(); ++i) {
        const std::size_t v = grid.index(i, j, k);
        if (grid.region(v) < 0) continue;
        const auto r = static_cast<std::size_t>(grid.region(v));
        const EchoSpot spot = spot_at(i, j, k);
        power[v] = power_of_dB(painter.level_dB(roles[r], echoes[r].echo_dB, spot));
        concretions[v] = static_cast<float>(painter.concretion_dB(roles[r], spot));
      }
    }
  }
  // Borders of regions are soft; the thin layers of the rectal wall stay as they are.
  grid.smooth(power, [&](int region) {
    return region >= 0 && roles[static_cast<std::size_t>(region)] == TissueRole::rectal_wall;
  });
  EchoMap map;
  map.low_ = grid.low();
  map.count_ = grid.count();
  map.levels_.resize(grid.size());
  for (std::size_t d = 0; d < map.above_mean_.size(); ++d) {
    const double half_dB = 0.5 * kStep_dB * static_cast<double>(d);
    map.above_mean_[d] =
        static_cast<float>(10.0 / kStep_dB * std::log10(std::cosh(half_dB * std::numbers::ln10 / 10.0)));
  }
  for (std::size_t v = 0; v < grid.size(); ++v) {
    const double dB = 10.0 * std::log10(std::max(1e-20F, power[v]));
    const double level = (std::max(dB, static_cast<double>(concretions[v])) - kDarkest_dB) / kStep_dB;
    map.levels_[v] = static_cast<std::uint8_t>(std::clamp(std::lround(level), 0L, 255L));
  }
  return map;
}

float EchoMap::at(const Eigen::Vector3f& position) const {
  if (!(position.minCoeff() >= 0.0F) || !((position.array() < (count_.array() - 1).cast<float>()).all())) return -1.0F;
  const Eigen::Vector3i whole = position.cast<int>();
  const Eigen::Vector3f t = position - whole.cast<float>();
  const std::size_t row = static_cast<std::size_t>(count_.x());
  const std::size_t slice = row * static_cast<std::size_t>(count_.y());
  const std::uint8_t* at = &levels_[static_cast<std::size_t>(whole.z()) * slice +
                                    static_cast<std::size_t>(whole.y()) * row + static_cast<std::size_t>(whole.x())];
  const auto along = [&](const std::uint8_t* p) {
    return static_cast<float>(p[0]) + t.x() * static_cast<float>(p[1] - p[0]);
  };
  const auto face = [&](const std::uint8_t* p) {
    const float near = along(p);
    return near + t.y() * (along(p + row) - near);
  };
  const float near = face(at);
  return near + t.z() * (face(at + slice) - near);
}

float EchoMap::mean_power(const Eigen::Vector3f& a, const Eigen::Vector3f& b) const {
  const float one = at(a), other = at(b);
  if (one < 0.0F || other < 0.0F) return std::max(one, other);
  const auto difference = static_cast<std::size_t>(std::min(255.0F, std::abs(one - other) + 0.5F));
  return 0.5F * (one + other) + above_mean_[difference];
}

}  // namespace stylet
