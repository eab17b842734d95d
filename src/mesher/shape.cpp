// SPDX-License-Identifier: GPL-3.0-or-later
#include "shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stylet::meshing {

double GridShape::distance(const Vec3& p) const {
  const Vec3 g = (frame.local(p) - low).cwiseQuotient(spacing);
  double beyond2 = 0;
  std::array<int, 3> cell{};
  std::array<double, 3> f{};
  for (int a = 0; a < 3; ++a) {
    const double last = size[a] - 1;
    const double c = std::clamp(g[a], 0.0, last);
    const double out = (g[a] - c) * spacing[a];
    beyond2 += out * out;
    cell[a] = std::min(static_cast<int>(c), size[a] - 2);
    f[a] = c - cell[a];
  }
  const float* v = values.data() + at(cell[0], cell[1], cell[2]);
  const std::size_t dj = size[0];
  const std::size_t dk = static_cast<std::size_t>(size[0]) * size[1];
  const auto row = [&](const float* w) { return w[0] + f[0] * (w[1] - w[0]); };
  const auto plane = [&](const float* w) {
    const double a = row(w);
    return a + f[1] * (row(w + dj) - a);
  };
  const double a = plane(v);
  const double value = a + f[2] * (plane(v + dk) - a);
  return beyond2 > 0 ? value + std::sqrt(beyond2) : value;
}

Eigen::AlignedBox3d GridShape::box() const {
  Eigen::AlignedBox3d inside;  // in the slice frame
  for (int k = 0; k < size[2]; ++k) {
    for (int j = 0; j < size[1]; ++j) {
      for (int i = 0; i < size[0]; ++i) {
        if (values[at(i, j, k)] < 0) inside.extend(low + spacing.cwiseProduct(Vec3(i, j, k)));
      }
    }
  }
  Eigen::AlignedBox3d lps;
  if (inside.isEmpty()) return lps;
  inside.min() -= spacing;
  inside.max() += spacing;
  for (int c = 0; c < 8; ++c) {
    lps.extend(frame.lps(inside.corner(static_cast<Eigen::AlignedBox3d::CornerType>(c))));
  }
  return lps;
}

double GridShape::volume(double offset) const {
  // Each node represents a voxel; its distance determines which part of the voxel is inside.
  const double width = spacing.mean();
  double sum = 0;
  for (const float v : values) sum += std::clamp(0.5 - (v - offset) / width, 0.0, 1.0);
  return sum * spacing.prod();
}

double GridShape::inner_radius() const {
  float lowest = 0;
  for (const float v : values) lowest = std::min(lowest, v);
  return -lowest;
}

double Capsule::distance(const Vec3& p) const {
  const Vec3 axis = to_ - from_;
  const double t = std::clamp((p - from_).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
  return (p - from_ - t * axis).norm() - radius_;
}

Eigen::AlignedBox3d Capsule::box() const {
  Eigen::AlignedBox3d box(from_.cwiseMin(to_), from_.cwiseMax(to_));
  box.min().array() -= radius_;
  box.max().array() += radius_;
  return box;
}

double Capsule::volume(double offset) const {
  const double r = std::max(0.0, radius_ + offset);
  return std::numbers::pi * r * r * ((to_ - from_).norm() + 4.0 / 3.0 * r);
}

double Superquadric::distance(const Vec3& p) const {
  // f = (Σ(x/a)⁴)^¼ is homogeneous of degree one, so (f − 1)/|∇f| is the distance to first order.
  const Vec3 scaled = (p - centre_).cwiseQuotient(half_axes_);
  const Vec3 squared = scaled.cwiseProduct(scaled);
  const double sum = squared.squaredNorm();
  const double f = std::sqrt(std::sqrt(sum));
  if (f < 1e-6) return -half_axes_.minCoeff();
  const Vec3 gradient = scaled.cwiseProduct(squared).cwiseQuotient(half_axes_) * (f / sum);
  return (f - 1) / gradient.norm();
}

Eigen::AlignedBox3d Superquadric::box() const { return {centre_ - half_axes_, centre_ + half_axes_}; }

double Superquadric::volume(double offset) const {
  // 8abc Γ(1 + 1/4)³ / Γ(1 + 3/4) (Dirichlet).
  const Vec3 a = half_axes_.array() + offset;
  return 8 * a.prod() * std::pow(std::tgamma(1.25), 3) / std::tgamma(1.75);
}

}  // namespace stylet::meshing
