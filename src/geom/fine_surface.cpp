// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/fine_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <unordered_map>

namespace stylet {

namespace {

constexpr double kSmallestShare = 0.005;  ///< a point with a smaller barycentric weight is moved to the edge or corner
constexpr double kOn = 1e-9;              ///< a point counts as inside with weights down to minus this

double distance_to(const LineSegment& line, const Vec3& x) {
  const Vec3 way = line[1] - line[0];
  const double share = std::clamp((x - line[0]).dot(way) / std::max(way.squaredNorm(), 1e-12), 0.0, 1.0);
  return (x - line[0] - share * way).norm();
}

/// Barycentric weights of the point where a line passes through a triangle; empty where it does not.
std::optional<Vec3> crossing(const LineSegment& line, const Vec3& a, const Vec3& b, const Vec3& c) {
  Mat3 system;
  system << b - a, c - a, line[0] - line[1];
  const double volume = system.determinant();
  if (std::abs(volume) < 1e-12) return std::nullopt;
  const Vec3 at = system.inverse() * (line[0] - a);
  const Vec3 weights(1.0 - at[0] - at[1], at[0], at[1]);
  if (weights.minCoeff() < -kOn || at[2] < 0.0 || at[2] > 1.0) return std::nullopt;
  return weights;
}

/// Splits edges of triangles. All triangles at an edge are split together, so that no gap opens.
class Refiner {
 public:
  Refiner(FineSurface& surface, std::span<const LineSegment> lines, const Fineness& fineness)
      : s_(surface), lines_(lines), fineness_(fineness) {
    for (std::size_t t = 0; t < s_.triangles.size(); ++t) add_edges(t);
  }

  /// Adds a point wherever a line passes through a triangle.
  void pierce() {
    for (const LineSegment& line : lines_) {
      for (std::size_t t = 0; t < s_.triangles.size(); ++t) {
        const auto [a, b, c] = s_.triangles[t];
        if (const auto weights = crossing(line, at(a), at(b), at(c))) pierce(t, *weights);
      }
    }
  }

  /// Halves edges until each is as short as Fineness demands.
  void refine() {
    while (true) {
      std::vector<std::pair<double, std::uint64_t>> long_ones;
      for (const auto& [edge, triangles] : edges_) {
        if (const double own = length(edge); own > wanted(edge)) long_ones.emplace_back(own, edge);
      }
      if (long_ones.empty()) return;
      std::sort(long_ones.rbegin(), long_ones.rend());
      for (const auto& [how_long, edge] : long_ones) {
        while (edges_.contains(edge)) split(end_of_path(edge), 0.5);
      }
    }
  }

 private:
  [[nodiscard]] const Vec3& at(Index point) const { return s_.positions[static_cast<std::size_t>(point)]; }

  static std::uint64_t key(Index a, Index b) {
    const auto [low, high] = std::minmax(a, b);
    return static_cast<std::uint64_t>(low) << 32U | static_cast<std::uint32_t>(high);
  }
  static std::array<Index, 2> ends(std::uint64_t edge) {
    return {static_cast<Index>(edge >> 32U), static_cast<Index>(edge & 0xffffffffU)};
  }
  [[nodiscard]] double length(std::uint64_t edge) const {
    const auto [a, b] = ends(edge);
    return (at(a) - at(b)).norm();
  }
  [[nodiscard]] double wanted(std::uint64_t edge) const {
    const auto [a, b] = ends(edge);
    double distance = std::numeric_limits<double>::infinity();
    for (const LineSegment& line : lines_) {
      for (const Vec3& x : {at(a), at(b), Vec3(0.5 * (at(a) + at(b)))})
        distance = std::min(distance, distance_to(line, x));
    }
    if (distance > fineness_.reach_mm) return std::numeric_limits<double>::infinity();
    return std::max(fineness_.finest_mm, fineness_.growth * distance);
  }

  [[nodiscard]] std::uint64_t longest_edge(std::size_t triangle) const {
    const auto& corner = s_.triangles[triangle];
    std::pair<double, std::uint64_t> longest{-1.0, 0};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t edge = key(corner[k], corner[(k + 1) % 3]);
      longest = std::max(longest, {length(edge), edge});
    }
    return longest.second;
  }
  /// Follows ever longer edges through neighbouring triangles to an edge that is the longest of all its triangles
  /// (Rivara's longest edge propagation path). Halving that edge first preserves the triangles' shape quality.
  [[nodiscard]] std::uint64_t end_of_path(std::uint64_t edge) const {
    while (true) {
      const auto& triangles = edges_.at(edge);
      const auto longer =
          std::find_if(triangles.begin(), triangles.end(), [&](std::size_t t) { return longest_edge(t) != edge; });
      if (longer == triangles.end()) return edge;
      edge = longest_edge(*longer);
    }
  }

  void add_edges(std::size_t triangle) {
    const auto& corner = s_.triangles[triangle];
    for (std::size_t k = 0; k < 3; ++k) edges_[key(corner[k], corner[(k + 1) % 3])].push_back(triangle);
  }
  void remove_edges(std::size_t triangle) {
    const auto& corner = s_.triangles[triangle];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto found = edges_.find(key(corner[k], corner[(k + 1) % 3]));
      std::erase(found->second, triangle);
      if (found->second.empty()) edges_.erase(found);
    }
  }

  Index add_point(std::span<const Index> of, std::span<const double> weights) {
    SurfacePoint made;
    std::size_t used = 0;
    for (std::size_t i = 0; i < of.size(); ++i) {
      const SurfacePoint& from = s_.points[static_cast<std::size_t>(of[i])];
      for (std::size_t k = 0; k < 3 && from.node[k] >= 0; ++k) {
        const auto end = made.node.begin() + static_cast<std::ptrdiff_t>(used);
        const auto found = std::find(made.node.begin(), end, from.node[k]);
        const auto slot = static_cast<std::size_t>(found - made.node.begin());
        if (found == end) made.node[used++] = from.node[k];
        made.weight[slot] += weights[i] * from.weight[k];
      }
    }
    Vec3 x = Vec3::Zero();
    for (std::size_t k = 0; k < used; ++k) x += made.weight[k] * at(made.node[k]);
    s_.points.push_back(made);
    s_.positions.push_back(x);
    return static_cast<Index>(s_.points.size()) - 1;
  }

  /// @param share position of the new point, 0 at the end of the edge with the lower number, 1 at the other end
  void split(std::uint64_t edge, double share) {
    const auto found = edges_.find(edge);
    if (found == edges_.end()) return;
    const std::vector<std::size_t> triangles = found->second;
    const auto [a, b] = ends(edge);
    const Index middle = add_point(std::array{a, b}, std::array{1.0 - share, share});
    for (const std::size_t t : triangles) {
      remove_edges(t);
      auto other = s_.triangles[t];
      std::replace(s_.triangles[t].begin(), s_.triangles[t].end(), b, middle);
      std::replace(other.begin(), other.end(), a, middle);
      s_.triangles.push_back(other);
      s_.patch.push_back(s_.patch[t]);
      add_edges(t);
      add_edges(s_.triangles.size() - 1);
    }
  }

  void pierce(std::size_t t, const Vec3& weights) {
    const std::array<Index, 3> corner = s_.triangles[t];
    Eigen::Index nearest = 0;
    if (weights.maxCoeff() > 1.0 - kSmallestShare) return;  // the line passes through a corner
    if (weights.minCoeff(&nearest) < kSmallestShare) {
      const auto first = static_cast<std::size_t>((nearest + 1) % 3);
      const auto second = static_cast<std::size_t>((nearest + 2) % 3);
      const double along = weights[static_cast<Eigen::Index>(second)] /
                           (weights[static_cast<Eigen::Index>(first)] + weights[static_cast<Eigen::Index>(second)]);
      return split(key(corner[first], corner[second]), corner[first] < corner[second] ? along : 1.0 - along);
    }
    const Index middle = add_point(corner, std::array{weights[0], weights[1], weights[2]});
    remove_edges(t);
    s_.triangles[t] = {corner[0], corner[1], middle};
    add_edges(t);
    for (std::size_t k = 1; k < 3; ++k) {
      s_.triangles.push_back({corner[k], corner[(k + 1) % 3], middle});
      s_.patch.push_back(s_.patch[t]);
      add_edges(s_.triangles.size() - 1);
    }
  }

  FineSurface& s_;
  std::span<const LineSegment> lines_;
  Fineness fineness_;
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> edges_;  ///< numbers of the triangles at each edge
};

}  // namespace

FineSurface refine_surface(std::span<const Vec3> points, std::vector<std::array<Index, 3>> triangles,
                           std::vector<int> patch, std::span<const LineSegment> lines, const Fineness& fineness) {
  FineSurface surface;
  surface.positions.assign(points.begin(), points.end());
  for (Index k = 0; k < static_cast<Index>(points.size()); ++k)
    surface.points.push_back({{k, -1, -1}, {1.0, 0.0, 0.0}});
  surface.triangles = std::move(triangles);
  surface.patch = std::move(patch);
  if (lines.empty()) return surface;
  Refiner refiner(surface, lines, fineness);
  refiner.pierce();
  refiner.refine();
  return surface;
}

}  // namespace stylet
