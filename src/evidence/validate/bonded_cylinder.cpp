// SPDX-License-Identifier: GPL-3.0-or-later
#include "bonded_cylinder.hpp"

#include "quadrature.hpp"

#include <Eigen/LU>

#include <cmath>
#include <numbers>

namespace stylet::validate {

namespace {

using Place2 = Eigen::Vector2d;  ///< distance from the axis, height [mm]

/// A segment of the cylinder's meridian; rotated about the axis it gives a ring.
struct Ring {
  Place2 from;
  Place2 to;
  [[nodiscard]] Place2 at(double s) const { return (1.0 - s) * from + s * to; }
  [[nodiscard]] double width() const { return (to - from).norm(); }
};

/// The meridian, divided into segments that become short towards the edges, where tractions are unbounded.
std::vector<Ring> meridian(double length, double radius) {
  std::vector<Ring> rings;
  const auto divide = [&](const Place2& from, const Place2& to, int count, const auto& place) {
    for (int k = 0; k < count; ++k) {
      const Ring whole{from, to};
      rings.push_back({whole.at(place(static_cast<double>(k) / count)), whole.at(place((k + 1.0) / count))});
    }
  };
  constexpr int on_end = 6;
  constexpr int along = 64;
  const Place2 edge(radius, 0.5 * length);
  const auto short_at_end = [](double t) { return std::sin(0.5 * std::numbers::pi * t); };
  const auto short_at_both = [](double t) { return 0.5 * (1.0 - std::cos(std::numbers::pi * t)); };
  divide({0.0, -edge.y()}, {radius, -edge.y()}, on_end, short_at_end);
  divide({radius, -edge.y()}, edge, along, short_at_both);
  divide(edge, {0.0, edge.y()}, on_end, [&](double t) { return 1.0 - short_at_end(1.0 - t); });
  return rings;
}

/// Kelvin's solution for a force at the origin.
Mat3 kelvin(const Vec3& r, const Medium& medium) {
  const double d = r.norm();
  const double scale = 1.0 / (16.0 * std::numbers::pi * medium.mu * (1.0 - medium.poisson) * d);
  return scale * ((3.0 - 4.0 * medium.poisson) * Mat3::Identity() + r * r.transpose() / (d * d));
}

/// Radial, circumferential and axial unit vectors at an angle, as columns.
Mat3 cylindrical(double theta) {
  Mat3 frame;
  frame << std::cos(theta), -std::sin(theta), 0.0, std::sin(theta), std::cos(theta), 0.0, 0.0, 0.0, 1.0;
  return frame;
}

/// Factors by which the radial, circumferential and axial parts vary around the axis, for a motion along x (lateral) or
/// along the axis.
Vec3 around(bool lateral, double theta) {
  return lateral ? Vec3(std::cos(theta), std::sin(theta), std::cos(theta)) : Vec3(Vec3::Ones());
}

class TractionLayer {
 public:
  TractionLayer(const Medium& medium, bool lateral) : medium_(medium), lateral_(lateral) {}

  /// Displacement amplitudes in the middle of the ring `at` per traction amplitudes on the ring `on` [mm/MPa].
  [[nodiscard]] Mat3 operator()(const Ring& at, const Ring& on) const {
    Mat3 sum = Mat3::Zero();
    if (&at != &on) {
      for (const GaussPoint& s : far_) sum += s.weight * turned(at.at(0.5), on.at(s.x));
    } else {
      // The cubic substitution concentrates the points in the middle, where the distance vanishes; its Jacobian removes
      // the singularity.
      for (const GaussPoint& q : near_) {
        const double off = 0.5 * q.x * q.x * q.x;
        const double weight = 1.5 * q.x * q.x * q.weight;
        sum += weight * (turned(at.at(0.5), on.at(0.5 - off)) + turned(at.at(0.5), on.at(0.5 + off)));
      }
    }
    return on.width() * sum;
  }

 private:
  /// Integral around the axis.
  [[nodiscard]] Mat3 turned(const Place2& at, const Place2& on) const {
    constexpr double seen = 0.25 * std::numbers::pi;  // any angle at which neither cosine nor sine vanishes
    const Mat3 frame = cylindrical(seen);
    const Vec3 x = at.x() * frame.col(0) + at.y() * Vec3::UnitZ();
    const Vec3 scale = around(lateral_, seen).cwiseInverse();
    Mat3 sum = Mat3::Zero();
    for (const GaussPoint& q : near_) {
      const double off = std::numbers::pi * q.x * q.x * q.x;
      const double weight = 3.0 * std::numbers::pi * q.x * q.x * q.weight * on.x();
      for (const double theta : {seen - off, seen + off}) {
        const Mat3 there = cylindrical(theta);
        const Vec3 y = on.x() * there.col(0) + on.y() * Vec3::UnitZ();
        sum += weight * scale.asDiagonal() * frame.transpose() * kelvin(x - y, medium_) * there *
               around(lateral_, theta).asDiagonal();
      }
    }
    return sum;
  }

  Medium medium_;
  bool lateral_;
  std::vector<GaussPoint> far_ = gauss_legendre(4);
  std::vector<GaussPoint> near_ = gauss_legendre(12);
};

double force(double length, double radius, double way, const Medium& medium, bool lateral) {
  const auto rings = meridian(length, radius);
  const TractionLayer layer(medium, lateral);
  const auto count = static_cast<Eigen::Index>(rings.size());
  MatX moved(3 * count, 3 * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j)
      moved.block<3, 3>(3 * i, 3 * j) = layer(rings[static_cast<std::size_t>(i)], rings[static_cast<std::size_t>(j)]);
  }
  const Vec3 motion = way * (lateral ? Vec3(1.0, -1.0, 0.0) : Vec3(0.0, 0.0, 1.0));
  const VecX traction = moved.partialPivLu().solve(VecX(motion.replicate(count, 1)));
  double sum = 0.0;
  for (Eigen::Index j = 0; j < count; ++j) {
    const Ring& ring = rings[static_cast<std::size_t>(j)];
    const double area = 2.0 * std::numbers::pi * ring.at(0.5).x() * ring.width();
    const Vec3 t = traction.segment<3>(3 * j);
    sum += area * (lateral ? 0.5 * (t[0] - t[1]) : t[2]);
  }
  return sum;
}

}  // namespace

CylinderForces bonded_cylinder(double length, double radius, double way, const Medium& medium) {
  return {force(length, radius, way, medium, true), force(length, radius, way, medium, false)};
}

CylinderForces slender_cylinder(double length, double radius, double way, const Medium& medium) {
  const double log = std::log(2.0 * length / radius);
  const double nu = medium.poisson;
  const double scale = 2.0 * std::numbers::pi * medium.mu * length * way;
  return {4.0 * (1.0 - nu) * scale / ((3.0 - 4.0 * nu) * (log - 1.0) + 0.5),
          scale / (log - 1.0 - 1.0 / (4.0 * (1.0 - nu)))};
}

}  // namespace stylet::validate
