// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/imaging/needle_field.hpp"

#include "stylet/coupling/near_field/kelvinlet.hpp"

#include <algorithm>

namespace stylet {

NeedleField::NeedleField(const TetMesh& mesh)
    : mesh_(&mesh),
      nodes_(Eigen::Matrix3Xf::Zero(3, mesh.node_count())),
      state_(static_cast<std::size_t>(mesh.node_count()), State::far) {
  forces_.reserve(64);
}

void NeedleField::set(std::span<const ShownForce> forces) {
  forces_.assign(forces.begin(), forces.end());
  Eigen::AlignedBox3d box;
  for (const ShownForce& force : forces_) box.extend(force.at_mm);
  for (std::size_t k = 0; k < state_.size(); ++k)
    state_[k] = !forces_.empty() && box.exteriorDistance(mesh_->nodes[k]) < kReach_mm ? State::unknown : State::far;
}

bool NeedleField::reaches(Index tet) const {
  const auto& corners = mesh_->tets[static_cast<std::size_t>(tet)];
  return std::any_of(corners.begin(), corners.end(),
                     [&](Index node) { return state_[static_cast<std::size_t>(node)] != State::far; });
}

Vec3 NeedleField::at_node(Index node) {
  State& state = state_[static_cast<std::size_t>(node)];
  if (state == State::far) return Vec3::Zero();
  if (state == State::unknown) {
    nodes_.col(node) = at(mesh_->nodes[static_cast<std::size_t>(node)]).cast<float>();
    state = State::known;
  }
  return nodes_.col(node).cast<double>();
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

Vec3 NeedleField::beside_mesh(Index tet, const Vec4& weights, const Vec3& x) {
  Vec3 sum = at(x);
  const auto& corners = mesh_->tets[static_cast<std::size_t>(tet)];
  for (std::size_t k = 0; k < 4; ++k) sum -= weights[static_cast<Eigen::Index>(k)] * at_node(corners[k]);
  return sum;
}

}  // namespace stylet
