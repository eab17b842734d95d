// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/region_distance.hpp"

#include "stylet/geom/topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace stylet {

namespace {

constexpr double kOnFace_mm = 1e-9;  ///< a path closer to a face than this lies in the face
constexpr double kPoint = 1e-7;      ///< a part of a path whose share is not above this is a single point

using Corners = std::array<Vec3, 4>;

/// A straight path from `a` to `b`.
struct Segment {
  Vec3 a;
  Vec3 b;
};

Corners corners_of(const TetMesh& mesh, std::size_t tet) {
  Corners corners;
  for (std::size_t i = 0; i < 4; ++i) corners[i] = mesh.nodes[static_cast<std::size_t>(mesh.tets[tet][i])];
  return corners;
}

bool is_one_of(std::span<const int> regions, int region) {
  return std::find(regions.begin(), regions.end(), region) != regions.end();
}

/// A part of a path: its ends as shares of the path's length, 0…1.
struct Part {
  double from = 0.0;
  double to = 1.0;
};

/// The part of a path that lies in a tetrahedron, including its faces. The planes of the four faces cut off the path
/// one after the other. Empty where the path misses the tetrahedron or only touches it in a point.
std::optional<Part> part_in(const Corners& x, const Segment& way) {
  Part part;
  for (const auto& face : kFaceVertices) {
    const Vec3& p = x[static_cast<std::size_t>(face[0])];
    const Vec3 outwards =
        (x[static_cast<std::size_t>(face[1])] - p).cross(x[static_cast<std::size_t>(face[2])] - p).normalized();
    const double at_a = outwards.dot(way.a - p) - kOnFace_mm;
    const double at_b = outwards.dot(way.b - p) - kOnFace_mm;
    if (at_a >= 0.0 && at_b >= 0.0) return std::nullopt;
    if (at_a > 0.0) part.from = std::max(part.from, at_a / (at_a - at_b));
    if (at_b > 0.0) part.to = std::min(part.to, at_a / (at_a - at_b));
  }
  if (part.to - part.from <= kPoint) return std::nullopt;
  return part;
}

/// Shortest distance between two segments (Ericson, Real-Time Collision Detection, 2005, section 5.1.9).
double distance(const Segment& one, const Segment& other) {
  const Vec3 d1 = one.b - one.a;
  const Vec3 d2 = other.b - other.a;
  const Vec3 r = one.a - other.a;
  const double a = d1.squaredNorm();
  const double e = d2.squaredNorm();
  const double b = d1.dot(d2);
  const double c = d1.dot(r);
  const double f = d2.dot(r);
  const double denominator = a * e - b * b;
  // Parallel segments have many pairs of nearest points; the pair at the start of the first segment is as good as any.
  double s = denominator > 1e-12 * a * e ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  double t = (b * s + f) / e;
  if (t < 0.0 || t > 1.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = std::clamp((b * t - c) / a, 0.0, 1.0);
  }
  return (r + s * d1 - t * d2).norm();
}

/// Distance between a point and the plane of a triangle if the foot of the perpendicular is in the triangle, else
/// infinite.
double height_over(const Vec3& x, const std::array<Vec3, 3>& corners) {
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& from = corners[i];
    if (normal.cross(corners[(i + 1) % 3] - from).dot(x - from) < 0.0) return std::numeric_limits<double>::infinity();
  }
  return std::abs(normal.normalized().dot(x - corners[0]));
}

/// Shortest distance between a path and a tetrahedron through which it does not pass. Either the nearest point of the
/// tetrahedron is on an edge, or an end of the path lies over a face.
double distance(const Corners& x, const Segment& way) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = i + 1; j < 4; ++j) least = std::min(least, distance(way, {x[i], x[j]}));
  }
  for (const auto& face : kFaceVertices) {
    const std::array<Vec3, 3> corners{x[static_cast<std::size_t>(face[0])], x[static_cast<std::size_t>(face[1])],
                                      x[static_cast<std::size_t>(face[2])]};
    least = std::min({least, height_over(way.a, corners), height_over(way.b, corners)});
  }
  return least;
}

}  // namespace

double length_in_regions(const TetMesh& mesh, std::span<const int> regions, const Vec3& from, const Vec3& to) {
  std::vector<Part> parts;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!is_one_of(regions, mesh.tet_region[t])) continue;
    if (const auto part = part_in(corners_of(mesh, t), {from, to})) parts.push_back(*part);
  }
  // A path in a face or along an edge lies in several tetrahedra at once, but counts once.
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.from < b.from; });
  double share = 0.0;
  double counted = 0.0;
  for (const Part& part : parts) {
    share += std::max(0.0, part.to - std::max(part.from, counted));
    counted = std::max(counted, part.to);
  }
  return share * (to - from).norm();
}

std::optional<double> distance_to_regions(const TetMesh& mesh, std::span<const int> regions, const Vec3& from,
                                          const Vec3& to) {
  std::optional<double> least;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!is_one_of(regions, mesh.tet_region[t])) continue;
    const Corners corners = corners_of(mesh, t);
    if (part_in(corners, {from, to})) return 0.0;
    least = std::min(least.value_or(std::numeric_limits<double>::infinity()), distance(corners, {from, to}));
  }
  return least;
}

}  // namespace stylet
