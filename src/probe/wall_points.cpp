// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/probe/wall_points.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace stylet {

namespace {

constexpr double kSample_mm = 0.8;       // size of the pieces of which areas are made
constexpr int kRecentred = 4;            // times that the areas' seeds move to their middles
constexpr double kFacesTheShaft = -0.8;  // cosine; such a wall closes the lumen where the shaft comes in

constexpr double kLevelHeight_mm = 6.0;  // over which the middle of the wall is taken

struct Sample {
  Vec3 x;
  Vec3 outward;
  double area;
  double size;  // wanted spacing relative to the finest
  MaterialPoint material;
};

/// The wanted spacing at a place, relative to the finest.
double size_at(const WallReach& reach, const Vec3& x, const Vec3& outward) {
  const double along = std::abs((x - reach.rest.centre_mm).dot(reach.rest.axis));
  const double far = std::clamp((along - reach.fine_mm) / reach.fine_mm, 0.0, 1.0);
  const double away = std::clamp(0.5 * (1.0 - outward.dot(reach.finest) - 0.5), 0.0, 0.75) / 0.75;
  return 1.0 + (reach.coarse - 1.0) * std::max(far, away);
}

std::array<double, 3> corner_shares(int pieces, int i, int j, bool upper) {
  // The centroid of piece (i, j) of a triangle whose edges are cut into equal parts.
  const double third = upper ? 2.0 / 3.0 : 1.0 / 3.0;
  const double a = (i + third) / pieces;
  const double b = (j + third) / pieces;
  return {1.0 - a - b, a, b};
}

class Sampler {
 public:
  Sampler(const Tissue& tissue, const WallReach& reach) : tissue_(tissue), reach_(reach) {}

  void add(const WallFace& face) {
    const TetMesh& mesh = tissue_.mesh();
    std::array<Vec3, 3> x;
    for (std::size_t k = 0; k < 3; ++k) x[k] = mesh.nodes[static_cast<std::size_t>(face.nodes[k])];
    const double area = 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).norm();
    const double longest = std::max({(x[1] - x[0]).norm(), (x[2] - x[1]).norm(), (x[0] - x[2]).norm()});
    const int pieces = std::max(1, static_cast<int>(std::ceil(longest / kSample_mm)));
    const auto& corners = mesh.tets[static_cast<std::size_t>(face.tet)];
    std::array<int, 3> local{};
    for (std::size_t k = 0; k < 3; ++k)
      local[k] = static_cast<int>(std::find(corners.begin(), corners.end(), face.nodes[k]) - corners.begin());
    const auto piece = [&](int i, int j, bool upper) {
      const auto share = corner_shares(pieces, i, j, upper);
      const Vec3 at = share[0] * x[0] + share[1] * x[1] + share[2] * x[2];
      if (!is_in_reach(at, face.outward)) return;
      Vec4 weights = Vec4::Zero();
      for (std::size_t k = 0; k < 3; ++k) weights[local[k]] = share[k];
      samples.push_back(
          {at, face.outward, area / (pieces * pieces), size_at(reach_, at, face.outward), {face.tet, weights}});
    };
    for (int i = 0; i < pieces; ++i) {
      for (int j = 0; i + j < pieces; ++j) {
        piece(i, j, false);
        if (i + j + 1 < pieces) piece(i, j, true);
      }
    }
  }

  std::vector<Sample> samples;

 private:
  [[nodiscard]] bool is_in_reach(const Vec3& x, const Vec3& outward) const {
    const double along = (x - reach_.rest.centre_mm).dot(reach_.rest.axis);
    return outward.dot(reach_.rest.axis) > kFacesTheShaft && along > reach_.lowest_mm &&
           along < reach_.rest.radius_mm + reach_.beyond_mm;
  }

  const Tissue& tissue_;
  const WallReach& reach_;
};

/// Distance of a sample from a seed, relative to the wanted spacing; infinite across a fold.
double apart(const Sample& sample, const Sample& seed) {
  if (sample.outward.dot(seed.outward) <= 0.0) return std::numeric_limits<double>::infinity();
  return (sample.x - seed.x).norm() / std::min(sample.size, seed.size);
}

class Areas {
 public:
  explicit Areas(const std::vector<Sample>& samples)
      : samples_(samples), nearest_(samples.size(), std::numeric_limits<double>::infinity()), seed_(samples.size()) {}

  void add_seed(std::size_t sample) {
    seeds.push_back(sample);
    for (std::size_t s = 0; s < samples_.size(); ++s) {
      const double d = apart(samples_[s], samples_[sample]);
      if (d >= nearest_[s]) continue;
      nearest_[s] = d;
      seed_[s] = seeds.size() - 1;
    }
  }

  /// The sample that is farthest from all seeds.
  [[nodiscard]] std::pair<std::size_t, double> farthest() const {
    const auto at = std::max_element(nearest_.begin(), nearest_.end());
    return {static_cast<std::size_t>(at - nearest_.begin()), *at};
  }

  /// Moves every seed to the sample nearest to the middle of its area.
  void recentre() {
    std::vector<Vec3> middle(seeds.size(), Vec3::Zero());
    std::vector<double> weight(seeds.size(), 0.0);
    for (std::size_t s = 0; s < samples_.size(); ++s) {
      const double w = samples_[s].area / (samples_[s].size * samples_[s].size);
      middle[seed_[s]] += w * samples_[s].x;
      weight[seed_[s]] += w;
    }
    std::vector<double> best(seeds.size(), std::numeric_limits<double>::infinity());
    std::vector<std::size_t> moved = seeds;
    for (std::size_t s = 0; s < samples_.size(); ++s) {
      const std::size_t k = seed_[s];
      const double d = (samples_[s].x - middle[k] / weight[k]).squaredNorm();
      if (d >= best[k]) continue;
      best[k] = d;
      moved[k] = s;
    }
    std::fill(nearest_.begin(), nearest_.end(), std::numeric_limits<double>::infinity());
    seeds.clear();
    for (const std::size_t sample : moved) add_seed(sample);
  }

  [[nodiscard]] std::size_t seed_of(std::size_t sample) const { return seed_[sample]; }

  std::vector<std::size_t> seeds;

 private:
  const std::vector<Sample>& samples_;
  std::vector<double> nearest_;
  std::vector<std::size_t> seed_;
};

std::vector<WallPoint> points_of(const std::vector<Sample>& samples, const Areas& areas, const Tissue& tissue) {
  std::vector<WallPoint> points(areas.seeds.size());
  std::vector<Vec3> outward(points.size(), Vec3::Zero());
  for (std::size_t s = 0; s < samples.size(); ++s) {
    const Sample& sample = samples[s];
    const std::size_t k = areas.seed_of(s);
    points[k].area_mm2 += sample.area;
    points[k].position_mm += sample.area * sample.x;
    outward[k] += sample.area * sample.outward;
    points[k].pieces.emplace_back(sample.material, sample.area);
  }
  for (std::size_t k = 0; k < points.size(); ++k) {
    points[k].position_mm /= points[k].area_mm2;
    points[k].outward = outward[k].normalized();
    for (auto& [at, share] : points[k].pieces) share /= points[k].area_mm2;
    points[k].weights = area_weights(points[k], tissue, [](Index tet) { return tet; });
  }
  return points;
}

}  // namespace

std::vector<std::pair<Index, double>> area_weights(const WallPoint& point, const Tissue& tissue,
                                                   const std::function<Index(Index tet)>& number_of) {
  std::map<Index, double> weights;
  for (const auto& [at, share] : point.pieces) {
    const Shape shape = tissue.shape(number_of(at.tet), at.weights);
    for (int i = 0; i < shape.count; ++i) {
      const auto n = static_cast<std::size_t>(i);
      if (shape.weight[n] != 0.0) weights[shape.node[n]] += share * shape.weight[n];
    }
  }
  return {weights.begin(), weights.end()};
}

Result<std::vector<WallFace>> rectal_wall(const TetMesh& mesh, const Topology& topology, const std::string& where) {
  const int lumen = mesh.region_index("rectal_lumen");
  const int inside = lumen >= 0 ? lumen : mesh.region_index("rectum");
  if (inside < 0)
    return input_error(where, "it has no rectum, so no probe can be in it",
                       "Add a structure rectum, or set probe.kind = \"none\"");
  std::vector<WallFace> faces;
  for (const Face& face : topology.interfaces) {
    const int own = mesh.tet_region[static_cast<std::size_t>(face.tet)];
    const int other = mesh.tet_region[static_cast<std::size_t>(face.neighbour)];
    if ((own == inside) == (other == inside)) continue;
    const Vec3 a = mesh.nodes[static_cast<std::size_t>(face.nodes[0])];
    const Vec3 b = mesh.nodes[static_cast<std::size_t>(face.nodes[1])];
    const Vec3 c = mesh.nodes[static_cast<std::size_t>(face.nodes[2])];
    const Vec3 normal = (b - a).cross(c - a).normalized();
    faces.push_back({face.nodes, face.tet, own == inside ? normal : Vec3(-normal)});
  }
  return faces;
}

double lowest_level_mm(const TetMesh& mesh, const std::vector<WallFace>& faces, const Capsule& rest) {
  struct Level {
    Vec3 sum = Vec3::Zero();
    double area = 0.0;
  };
  std::map<int, Level> levels;
  for (const WallFace& face : faces) {
    const Vec3& a = mesh.nodes[static_cast<std::size_t>(face.nodes[0])];
    const Vec3& b = mesh.nodes[static_cast<std::size_t>(face.nodes[1])];
    const Vec3& c = mesh.nodes[static_cast<std::size_t>(face.nodes[2])];
    const Vec3 w = (a + b + c) / 3.0 - rest.centre_mm;
    const double along = w.dot(rest.axis);
    Level& level = levels[static_cast<int>(std::floor(along / kLevelHeight_mm))];
    const double area = 0.5 * (b - a).cross(c - a).norm();
    level.sum += area * (w - along * rest.axis);
    level.area += area;
  }
  for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
    if (level->first >= -1) continue;  // the hemisphere and the arrays
    if (level->second.sum.norm() > 0.5 * rest.radius_mm * level->second.area)
      return (level->first + 1) * kLevelHeight_mm;
  }
  return WallReach{}.lowest_mm;
}

std::vector<WallPoint> wall_points(const Tissue& tissue, const std::vector<WallFace>& faces, const WallReach& reach) {
  Sampler sampler(tissue, reach);
  for (const WallFace& face : faces) sampler.add(face);
  const std::vector<Sample>& samples = sampler.samples;
  if (samples.empty()) return {};
  const Vec3 start = reach.rest.centre_mm + reach.rest.radius_mm * reach.finest;
  std::size_t first = 0;
  for (std::size_t s = 1; s < samples.size(); ++s) {
    if ((samples[s].x - start).squaredNorm() < (samples[first].x - start).squaredNorm()) first = s;
  }
  Areas areas(samples);
  areas.add_seed(first);
  // Seeds at this distance from each other have areas whose middles are about 1.2 times as far apart.
  constexpr double kSeedsToMiddles = 1.2;
  while (static_cast<int>(areas.seeds.size()) < reach.points) {
    const auto [sample, distance] = areas.farthest();
    if (distance < reach.spacing_mm / kSeedsToMiddles) break;
    areas.add_seed(sample);
  }
  for (int i = 0; i < kRecentred; ++i) areas.recentre();
  return points_of(samples, areas, tissue);
}

}  // namespace stylet
