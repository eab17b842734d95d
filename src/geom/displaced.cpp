// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/displaced.hpp"

namespace stylet {

namespace {

constexpr int kUndeformedRounds = 20;
constexpr double kUndeformed_mm = 1e-4;

}  // namespace

Vec3 displacement_of(const TetMesh& mesh, const NodalDisplacement& displacement, const MaterialPoint& at) {
  Vec3 u = Vec3::Zero();
  const auto& corners = mesh.tets[static_cast<std::size_t>(at.tet)];
  for (std::size_t k = 0; k < corners.size(); ++k)
    u += at.weights[static_cast<Eigen::Index>(k)] * displacement.col(corners[k]).cast<double>();
  return u;
}

Vec3 displaced_place(const Locator& locator, const NodalDisplacement& displacement, const Vec3& x) {
  const auto at = locator.find(x);
  return at ? Vec3(x + displacement_of(locator.mesh(), displacement, *at)) : x;
}

Vec3 undeformed(const Locator& locator, const NodalDisplacement& displacement, const Vec3& x) {
  Vec3 at = x;
  for (int k = 0; k < kUndeformedRounds; ++k) {
    const auto found = locator.find(at);
    if (!found) return x;
    const Vec3 next = x - displacement_of(locator.mesh(), displacement, *found);
    const bool is_near = (next - at).norm() < kUndeformed_mm;
    at = 0.5 * (at + next);
    if (is_near) break;
  }
  return at;
}

}  // namespace stylet
