// SPDX-License-Identifier: GPL-3.0-or-later
#include "echo_map.hpp"

#include "smooth_noise.hpp"
#include "stylet/imaging/tissue_role.hpp"
#include "voxel_grid.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

/// 0 below `from`, 1 above `to`, smooth in between.
double ramp(double x, double from, double to) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

/// A smooth bump of the height 1 at x = middle, which ends at the distance `half`.
double bump(double x, double middle, double half) { return 1.0 - ramp(std::abs(x - middle), 0.0, half); }

/// The gland's box, and places in it relative to its half sides.
struct GlandFrame {
  Eigen::AlignedBox3d box;
  [[nodiscard]] Vec3 relative(const Vec3& x) const { return (x - box.center()).cwiseQuotient(0.5 * box.sizes()); }
};

/// Where a voxel lies, for the painters of tissues.
struct Spot {
  Vec3 x;                  ///< [mm] LPS
  double inside_mm = 0.0;  ///< depth below the gland's surface, inside the gland
  double beside_mm = 0.0;  ///< distance from the gland, outside of it
  double urethra_mm = 0.0, lumen_mm = 0.0, outside_of_rectum_mm = 0.0;  ///< distances
};

/// Adds what regions lack, in dB, tissue by tissue.
class EchoPainter {
 public:
  EchoPainter(const GlandFrame& gland, bool has_zones, std::uint64_t seed)
      : gland_(gland), has_zones_(has_zones), fine_(seed), coarse_(seed + 1), third_(seed + 2) {}

  [[nodiscard]] double level_dB(TissueRole role, double own_dB, const Spot& spot) const {
    const double texture = 1.3 * coarse_(spot.x / 6.0) + 1.0 * fine_(spot.x / 2.6) + 0.9 * third_(spot.x / 1.3);
    switch (role) {
      case TissueRole::gland:
        return own_dB + texture + gland_dB(spot);
      case TissueRole::zone:
        return own_dB + texture + capsule_dB(spot);
      case TissueRole::urethra:
        return own_dB + 0.7 * texture;
      case TissueRole::rectal_wall:
        return wall_dB(spot) + 0.6 * texture;
      case TissueRole::fat:
        return own_dB + 1.3 * texture + fat_dB(spot);
      case TissueRole::muscle:
      case TissueRole::soft:
        return own_dB + 1.2 * texture + muscle_dB(spot);
      default:
        return own_dB;
    }
  }

 private:
  [[nodiscard]] double capsule_dB(const Spot& spot) const { return 9.0 * bump(spot.inside_mm, 0.5, 1.3); }

  /// Zones, their border with its calcifications, ducts, and the bright rim of the urethra.
  [[nodiscard]] double gland_dB(const Spot& spot) const {
    double level = capsule_dB(spot);
    level += 3.0 * bump(spot.urethra_mm, 0.8, 1.6);
    if (has_zones_) return level;
    const Vec3 q = gland_.relative(spot.x);
    const Vec3 from(q.x() / 0.66, (q.y() + 0.20) / 0.60, (q.z() - 0.06) / 0.74);
    const double f = from.norm() + 0.10 * coarse_(spot.x / 8.0) + 0.05 * fine_(spot.x / 3.5);
    const double inner = 1.0 - ramp(f, 0.94, 1.04);  // share of the transition zone
    const double nodules = 3.2 * coarse_(spot.x / 5.0 + Vec3::Constant(7.3)) - 2.0;
    level += inner * (transition_dB_ + nodules);
    // Its border is a thin line of compressed tissue, clearest at the back.
    const double back = ramp(q.y(), -0.35, 0.1);
    level += 8.0 * (0.3 + 0.7 * back) * bump(f, 1.0, 0.075);
    // Concretions lie along the border in clusters.
    const double cluster = ramp(coarse_(spot.x / 6.0 + Vec3::Constant(3.1)), 0.2, 0.6);
    if (back > 0.0 && std::abs(f - 1.0) < 0.07 && spot.inside_mm > 2.5)
      level += 48.0 * back * cluster * ramp(third_(spot.x / 1.9 + Vec3::Constant(1.7)), 0.5, 1.0);
    // At the verumontanum, behind the urethra at the middle level, concretions are common.
    const double veru = (spot.urethra_mm < 2.0 && std::abs(q.x()) < 0.07 && std::abs(q.z() + 0.05) < 0.07)
                            ? ramp(spot.x.y() - gland_.box.center().y(), -0.12, 0.6)
                            : 0.0;
    level += 40.0 * veru * ramp(third_(spot.x / 1.6), 0.0, 0.8);
    // The fibromuscular stroma in front is dark, ducts of the peripheral zone are streaks towards the urethra.
    level -= 6.0 * ramp(-q.y(), 0.55, 0.85) * (1.0 - ramp(std::abs(q.x()), 0.25, 0.5));
    const double angle = std::atan2(q.x(), q.y() + 0.3);
    level += (1.0 - inner) * 1.6 * third_(Vec3(8.0 * angle, spot.x.z() / 1.5, 1.2 * q.head<2>().norm()));
    return level;
  }

  /// Mucosa bright, muscularis mucosae dark, submucosa bright, muscularis propria dark, serosa bright.
  [[nodiscard]] double wall_dB(const Spot& spot) const {
    const double across = spot.lumen_mm / std::max(1e-3, spot.lumen_mm + spot.outside_of_rectum_mm);
    double level = -16.0;
    level += 18.0 * bump(across, 0.06, 0.18);
    level += 17.0 * bump(across, 0.36, 0.20);
    level += 18.0 * ramp(across, 0.84, 0.96);
    return level;
  }

  /// Septa, the fascia and the veins around the gland.
  [[nodiscard]] double fat_dB(const Spot& spot) const {
    const double septum = std::abs(coarse_(spot.x / 7.0) + 0.3 * fine_(spot.x / 3.0));
    double level = 5.0 * (1.0 - ramp(septum, 0.03, 0.16));
    level -= 9.0 * bump(spot.beside_mm, 1.5, 1.7);
    level += 6.0 * bump(spot.beside_mm, 3.6, 1.2);
    const Vec3 q = gland_.relative(spot.x);
    const double where = bump(spot.beside_mm, 3.4, 3.2) * (1.0 - ramp(q.y(), 0.25, 0.7));
    const Vec3 along(spot.x.x() / 4.2, spot.x.y() / 3.6, spot.x.z() / 9.0);  // veins run along the gland
    level -= 19.0 * where * ramp(third_(along), 0.05, 0.45);
    return level;
  }

  /// Bundles of fibres along z, with bright sheaths.
  [[nodiscard]] double muscle_dB(const Spot& spot) const {
    const Vec3 along(spot.x.x() / 2.6, spot.x.y() / 2.6, spot.x.z() / 14.0);
    return 2.2 * fine_(along) + 4.0 * (1.0 - ramp(std::abs(coarse_(spot.x / 10.0)), 0.02, 0.12));
  }

  GlandFrame gland_;
  bool has_zones_;
  double transition_dB_ = default_echo("transition_zone").echo_dB - default_echo("prostate").echo_dB;
  SmoothNoise fine_, coarse_, third_;
};

/// Softens borders by the weights 1, 2, 1 along each axis. The thin layers of the rectal wall stay as they are.
void soften(std::vector<float>& levels, const VoxelGrid& grid, const std::vector<TissueRole>& roles) {
  const Eigen::Vector3i& n = grid.count();
  const std::array<std::ptrdiff_t, 3> strides{1, n.x(), static_cast<std::ptrdiff_t>(n.x()) * n.y()};
  std::vector<float> before;
  for (int axis = 0; axis < 3; ++axis) {
    before = levels;
    const std::ptrdiff_t d = strides[static_cast<std::size_t>(axis)];
    for (int k = 0; k < n.z(); ++k) {
      for (int j = 0; j < n.y(); ++j) {
        for (int i = 0; i < n.x(); ++i) {
          const int at = axis == 0 ? i : axis == 1 ? j : k;
          if (at == 0 || at == n[axis] - 1) continue;
          const auto v = static_cast<std::ptrdiff_t>(grid.index(i, j, k));
          const int region = grid.region(static_cast<std::size_t>(v));
          if (region >= 0 && roles[static_cast<std::size_t>(region)] == TissueRole::rectal_wall) continue;
          const auto value = [&](std::ptrdiff_t w) { return before[static_cast<std::size_t>(w)]; };
          levels[static_cast<std::size_t>(v)] = 0.25F * value(v - d) + 0.5F * value(v) + 0.25F * value(v + d);
        }
      }
    }
  }
}

}  // namespace

std::optional<EchoMap> EchoMap::paint(const TetMesh& mesh, std::span<const TissueEcho> echoes, std::uint32_t seed) {
  std::vector<TissueRole> roles;
  for (const std::string& region : mesh.regions) roles.push_back(tissue_role(region));
  GlandFrame gland;
  Eigen::AlignedBox3d all;
  bool has_zones = false;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const TissueRole role = roles[static_cast<std::size_t>(mesh.tet_region[t])];
    has_zones = has_zones || role == TissueRole::zone;
    for (const Index node : mesh.tets[t]) {
      const Vec3& x = mesh.nodes[static_cast<std::size_t>(node)];
      all.extend(x);
      if (is_gland(role)) gland.box.extend(x);
    }
  }
  if (gland.box.isEmpty()) return std::nullopt;
  Eigen::AlignedBox3d box = gland.box;
  box.extend(gland.box.min() - Vec3(40.0, 40.0, 40.0));
  box.extend(gland.box.max() + Vec3(40.0, 32.0, 40.0));
  const VoxelGrid grid(mesh, box.intersection(all), kVoxel_mm);
  const auto is = [&roles](auto judge) {
    return [&roles, judge](int region) { return region >= 0 && judge(roles[static_cast<std::size_t>(region)]); };
  };
  const auto in_gland = is([](TissueRole r) { return is_gland(r) || r == TissueRole::urethra; });
  const std::vector<float> to_gland = grid.distance_mm(in_gland);
  const std::vector<float> to_outside = grid.distance_mm([&](int region) { return !in_gland(region); });
  const std::vector<float> to_urethra = grid.distance_mm(is([](TissueRole r) { return r == TissueRole::urethra; }));
  const std::vector<float> to_lumen = grid.distance_mm(is([](TissueRole r) { return r == TissueRole::lumen; }));
  const std::vector<float> out_of_rectum = grid.distance_mm([&](int region) {
    return region < 0 || (roles[static_cast<std::size_t>(region)] != TissueRole::lumen &&
                          roles[static_cast<std::size_t>(region)] != TissueRole::rectal_wall);
  });
  const EchoPainter painter(gland, has_zones, seed);
  std::vector<float> levels(grid.size());
  for (int k = 0; k < grid.count().z(); ++k) {
    for (int j = 0; j < grid.count().y(); ++j) {
      for (int i = 0; i < grid.count().x(); ++i) {
        const std::size_t v = grid.index(i, j, k);
        const int region = grid.region(v);
        if (region < 0) continue;
        const auto r = static_cast<std::size_t>(region);
        const Spot spot{grid.centre(i, j, k), to_outside[v], to_gland[v], to_urethra[v], to_lumen[v], out_of_rectum[v]};
        levels[v] = static_cast<float>(painter.level_dB(roles[r], echoes[r].echo_dB, spot));
      }
    }
  }
  soften(levels, grid, roles);
  EchoMap map;
  map.low_ = grid.low();
  map.count_ = grid.count();
  map.levels_.resize(grid.size());
  for (std::size_t v = 0; v < grid.size(); ++v) {
    const double level = (static_cast<double>(levels[v]) - kDarkest_dB) / kStep_dB;
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

}  // namespace stylet
