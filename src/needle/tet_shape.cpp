// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/tet_shape.hpp"

#include "core/largest.hpp"
#include "needle/rotation_terms.hpp"

#include <utility>

namespace stylet::tet {

TetShape::TetShape(SegmentMesh mesh, int segments, double segment_length, double young_modulus, double poisson)
    : mesh_(std::move(mesh)),
      segments_(segments),
      curve_(segments, segment_length),
      lambda_(young_modulus * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))),
      mu_(young_modulus / (2.0 * (1.0 + poisson))),
      states_(static_cast<std::size_t>(segments) * mesh_.elements.size()),
      damped_from_(states_.size(), Mat3::Zero()) {
  const Eigen::Index unknowns = 3 * segments * (mesh_.middle_nodes() + kLayerNodes);
  displacement.setZero(unknowns);
  rest_.setZero(unknowns);
  force_.setZero(unknowns);
}

Eigen::Index TetShape::dof(int segment, int node) const {
  const int middle = mesh_.middle_nodes();
  const int before = segment * (middle + kLayerNodes);
  if (node >= kFirstMiddle) return 3 * (before + node - kFirstMiddle);
  if (node >= kLayerNodes) return 3 * (before + middle + node - kLayerNodes);
  return 3 * (before - kLayerNodes + node);  // the layer at the end of the preceding segment
}

void TetShape::bend_rest(const Vec3& curvature) {
  const int nodes = static_cast<int>(mesh_.nodes.size());
  std::vector<Vec3> place(static_cast<std::size_t>(nodes));
  bowed_.clear();
  for (int k = 0; k < segments_; ++k) {
    for (int i = 0; i < nodes; ++i) {
      const Vec3 straight = mesh_.nodes[i] + k * curve_.spacing() * Vec3::UnitZ();
      const double s = straight.z();
      const beam::RotationTerms arc(s * curvature);
      place[static_cast<std::size_t>(i)] = s * arc.chord() + arc.rotation() * Vec3(straight.x(), straight.y(), 0.0);
      const Eigen::Index d = dof(k, i);
      if (d >= 0) rest_.segment<3>(d) = place[static_cast<std::size_t>(i)] - straight;
    }
    for (const Element& element : mesh_.elements) bowed_.push_back(make_element(place, element.node));
  }
  displacement = rest_;
  update();
}

void TetShape::scale_modulus(double factor) {
  lambda_ *= factor;
  mu_ *= factor;
  update();
}

void TetShape::damp(double ratio) {
  damping_ = ratio;
  for (std::size_t e = 0; e < states_.size(); ++e) damped_from_[e] = states_[e].elastic;
  update();
}

void TetShape::update() {
  ++revision_;
  energy_ = 0.0;
  force_.setZero();
  auto state = states_.begin();
  auto from = damped_from_.begin();
  std::array<Vec3, kMostNodes> u;
  std::array<Vec3, kMostNodes> f;
  const int nodes = static_cast<int>(mesh_.nodes.size());
  for (int k = 0; k < segments_; ++k) {
    for (int i = 0; i < nodes; ++i) {
      u[i] = strain_displacement_of(k, i);
      f[i].setZero();
    }
    for (int e = 0; e < static_cast<int>(mesh_.elements.size()); ++e) {
      const Element& element = unloaded(k, e);
      // Forming differences before products keeps all digits of the strain where a segment moves but hardly deforms.
      const Vec3& origin = u[element.node[0]];
      Mat3 H = Mat3::Zero();
      for (int i = 1; i < 4; ++i) H += (u[element.node[i]] - origin) * element.gradient[i].transpose();
      const Mat3 strain = 0.5 * (H + H.transpose() + H.transpose() * H);
      Mat3 S = 2.0 * mu_ * strain;
      S.diagonal().array() += lambda_ * strain.trace();
      energy_ += 0.5 * element.volume * S.cwiseProduct(strain).sum();
      state->F = H + Mat3::Identity();
      state->elastic = S;
      if (damping_ > 0.0) S += damping_ * (S - *from);
      state->S = S;
      const Mat3 P = element.volume * state->F * S;
      Vec3 sum = Vec3::Zero();
      for (int i = 1; i < 4; ++i) {
        const Vec3 pull = P * element.gradient[i];
        f[element.node[i]] += pull;
        sum += pull;
      }
      f[element.node[0]] -= sum;
      ++state;
      ++from;
    }
    for (int i = 0; i < nodes; ++i) {
      const Eigen::Index d = dof(k, i);
      if (d >= 0) force_.segment<3>(d) += f[i];
    }
  }
}

Vec3 TetShape::point(double s) const {
  return curve_.point(s, [this](int layer) { return displacement.segment<3>(axis_dof(layer)); });
}

Vec3 TetShape::tangent(double s) const {
  return curve_.tangent(s, [this](int layer) { return displacement.segment<3>(axis_dof(layer)); });
}

Vec3 TetShape::place(int segment, int node) const {
  return mesh_.nodes[node] + segment * curve_.spacing() * Vec3::UnitZ() + displacement_of(segment, node);
}

Vec3 TetShape::axis_point(int layer) const {
  return layer == 0 ? Vec3::Zero() : place(layer - 1, kLayerNodes + kAxisNode);
}

double largest_imbalance(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                         VecX& imbalance) {
  imbalance = shape.force();
  for (const PointLoad& load : loads) {
    const Vec3 force = base_rotation.transpose() * load.force;
    const AxisCurve::Weights w = shape.curve().weights(load.s);
    for (int i = 0; i < AxisCurve::kReach; ++i) {
      if (w.value[i] != 0.0) imbalance.segment<3>(shape.axis_dof(w.first + i)) -= w.value[i] * force;
    }
  }
  Vec3 force = Vec3::Zero();
  Vec3 moment = Vec3::Zero();  // about the centre of the current layer
  double largest = 0.0;
  const auto note = [&largest](double value) { largest = larger_or_nan(largest, value); };
  for (int k = shape.segments() - 1; k >= 0; --k) {
    const Vec3 centre = shape.axis_point(k);
    moment += (shape.axis_point(k + 1) - centre).cross(force);
    for (int i = kLayerNodes; i < static_cast<int>(shape.mesh().nodes.size()); ++i) {
      const Vec3 f = imbalance.segment<3>(shape.dof(k, i));
      force += f;
      moment += (shape.place(k, i) - centre).cross(f);
      note(f.norm() * shape.curve().spacing());
    }
    note(moment.norm());
  }
  return largest;
}

}  // namespace stylet::tet
