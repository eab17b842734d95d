// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/probe/capsule.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

constexpr double kTiny = 1e-12;

/// The direction of the largest n · w among the directions that a wall allows.
class BestDirection {
 public:
  explicit BestDirection(const Vec3& w) : w_(w) {}
  void offer(const Vec3& n) {
    const double value = n.dot(w_);
    if (is_any_ && value <= value_) return;
    is_any_ = true;
    value_ = value;
    n_ = n;
  }
  [[nodiscard]] bool is_any() const { return is_any_; }
  [[nodiscard]] const Vec3& direction() const { return n_; }

 private:
  Vec3 w_;
  Vec3 n_ = Vec3::UnitZ();
  double value_ = 0.0;
  bool is_any_ = false;
};

}  // namespace

Capsule::Gap Capsule::gap(const Vec3& p, const Vec3& outward) const {
  const Vec3 w = p - centre_mm;
  // The wall's direction, without a part that points back along the shaft.
  Vec3 m = outward - std::min(0.0, outward.dot(axis)) * axis;
  const double length = m.norm();
  if (length < kTiny) return nearest(p);
  m /= length;
  const auto along = [&](const Vec3& n) { return Gap{n.dot(w) - radius_mm, n}; };

  const double size = w.norm();
  if (size > kTiny && w.dot(axis) >= 0.0 && w.dot(m) >= kCosSide * size) return along(w / size);

  BestDirection best(w);
  // Across the shaft.
  const Vec3 across = w - w.dot(axis) * axis;
  const double across_size = across.norm();
  if (across_size > kTiny && across.dot(m) >= kCosSide * across_size) best.offer(across / across_size);
  // At the largest angle from the wall's direction.
  const double sine = std::sqrt(1.0 - kCosSide * kCosSide);
  const auto off_m = [&](const Vec3& v) { return Vec3(v - v.dot(m) * m); };
  Vec3 aside = off_m(w);
  if (aside.norm() <= kTiny) aside = off_m(axis);  // every direction is as good
  if (aside.norm() <= kTiny) aside = m.unitOrthogonal();
  const Vec3 edge = kCosSide * m + sine * aside.normalized();
  if (edge.dot(axis) >= 0.0) best.offer(edge);
  // Both: n · axis = 0 and n · m = kCosSide.
  const Vec3 m_across = m - m.dot(axis) * axis;
  const double m_size = m_across.norm();
  if (m_size >= kCosSide) {
    const Vec3 e = m_across / m_size;
    const double cosine = kCosSide / m_size;
    const Vec3 side = std::sqrt(std::max(0.0, 1.0 - cosine * cosine)) * axis.cross(e);
    best.offer(cosine * e + side);
    best.offer(cosine * e - side);
  }
  if (!best.is_any()) best.offer(m);
  return along(best.direction());
}

Capsule::Gap Capsule::nearest(const Vec3& p) const {
  Vec3 w = p - centre_mm;
  w -= std::min(0.0, w.dot(axis)) * axis;
  const double size = w.norm();
  const Vec3 n = size > kTiny ? Vec3(w / size) : axis.unitOrthogonal();
  return {size - radius_mm, n};
}

Capsule capsule_of(const ProbePlace& place) {
  const Vec3 axis = place.axes.col(2);
  return {place.origin_mm + kRoundBeyondArray_mm * axis, axis, place.radius_mm};
}

}  // namespace stylet
