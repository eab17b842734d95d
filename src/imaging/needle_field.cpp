// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/imaging/needle_field.hpp"

#include "stylet/coupling/near_field/kelvinlet.hpp"

#include <algorithm>

namespace stylet {

NeedleField::NeedleField(const TetMesh& mesh)
    : mesh_(&mesh),
      nodes_(Eigen::Matrix3Xf::Zero(3, mesh.node_count())),
      near_(static_cast<std::size_t>(mesh.node_count()), 0) {
  forces_.reserve(64);
}

void NeedleField::set(std::span<const ShownForce> forces) {
  forces_.assign(forces.begin(), forces.end());
  Eigen::AlignedBox3d box;
  for (const ShownForce& force : forces_) box.extend(force.at_mm);
  for (std::size_t k = 0; k < near_.size(); ++k) {
    const Vec3& x = mesh_->nodes[k];
    near_[k] = !forces_.empty() && box.exteriorDistance(x) < kReach_mm ? 1 : 0;
    const Vec3 u = near_[k] != 0 ? at(x) : Vec3::Zero();
    nodes_.col(static_cast<Eigen::Index>(k)) = u.cast<float>();
  }
}

bool NeedleField::reaches(Index tet) const {
  const auto& corners = mesh_->tets[static_cast<std::size_t>(tet)];
  return std::any_of(corners.begin(), corners.end(),
                     [&](Index node) { return near_[static_cast<std::size_t>(node)] != 0; });
}

Vec3 NeedleField::at(const Vec3& x) const {
  Vec3 sum = Vec3::Zero();
  for (const ShownForce& force : forces_) {
    const double distance = (x - force.at_mm).norm();
    if (distance >= kReach_mm) continue;
    // The far part of the field is left to the mesh; it is smooth there.
    const double t = std::clamp((kReach_mm - distance) / (kReach_mm / 3.0), 0.0, 1.0);
    const double share = t * t * (3.0 - 2.0 * t);
    const Mat3 kernel = kelvinlet(Segment{x, force.along, 0.0}, Segment{force.at_mm, force.along, force.length_mm},
                                  force.along, force.epsilon_mm, Medium{force.shear_MPa, force.poisson});
    sum += share * (kernel * force.force_N);
  }
  return sum;
}

Vec3 NeedleField::beside_mesh(Index tet, const Vec4& weights, const Vec3& x) const {
  Vec3 sum = at(x);
  const auto& corners = mesh_->tets[static_cast<std::size_t>(tet)];
  for (std::size_t k = 0; k < 4; ++k) sum -= weights[static_cast<Eigen::Index>(k)] * at_node(corners[k]);
  return sum;
}

}  // namespace stylet
