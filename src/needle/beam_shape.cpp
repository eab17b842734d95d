// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/beam_shape.hpp"

#include <algorithm>

namespace stylet::beam {

BeamShape::BeamShape(int elements, double length, double bending_stiffness, double torsion_stiffness, ElementKind kind)
    : curvature(VecX::Zero(dof(elements))),
      rest(VecX::Zero(dof(elements))),
      damped_from(VecX::Zero(dof(elements))),
      kind_(kind),
      clamp_weight_(kind == ElementKind::rod ? 2.0 : 1.0),
      elements_(elements),
      element_length_(length / elements),
      stiffness_(bending_stiffness, bending_stiffness, torsion_stiffness),
      frame_(elements + 1, Mat3::Identity()),
      origin_(elements + 1, Vec3::Zero()),
      spin_(elements, Mat3::Zero()),
      shift_(elements, Mat3::Zero()),
      curve_(elements, length / elements) {
  update();
}

void BeamShape::update() {
  ++revision_;
  const double l = element_length_;
  for (int e = 0; e < elements_; ++e) {
    const RotationTerms terms(l * kappa(e), kind_);
    const Mat3& R = frame_[e];
    frame_[e + 1].noalias() = R * terms.rotation();
    origin_[e + 1] = origin_[e] + l * (R * terms.chord());
    spin_[e].noalias() = l * (R * terms.mean_rotation());
    shift_[e] = l * l * (R * terms.chord_derivative()) + cross(origin_[e + 1]) * spin_[e];
  }
}

Station BeamShape::locate(double s) const {
  if (!(s > 0.0)) return {-1, s};
  const int e = std::min(static_cast<int>(std::min(s / element_length_, 1e9)), elements_ - 1);
  return {e, std::clamp(s - e * element_length_, 0.0, element_length_)};
}

Pulls BeamShape::pulls(double s, const Vec3& force) const {
  Pulls result;
  if (kind_ == ElementKind::arc) {
    const Station at = locate(s);
    result.pull[0] = pull(at, 1.0, force);
    result.count = 1;
    return result;
  }
  const AxisCurve::Weights w = curve_.weights(s);
  for (int i = 0; i < AxisCurve::kReach; ++i) {
    if (w.value[i] == 0.0) continue;
    const int node = w.first + i;
    result.pull[result.count++] = pull({node - 1, element_length_}, w.value[i], w.value[i] * force);
  }
  return result;
}

/// @param force [N] share of the load that acts at the station, base axes
Pull BeamShape::pull(const Station& at, double weight, const Vec3& force) const {
  if (at.element < 0) return {at, weight, force, point(at), Mat3::Zero()};
  const Mat3& R = frame_[at.element];
  const RotationTerms inner = terms(at);
  return {at, weight, force, origin_[at.element] + at.local * (R * inner.chord()),
          at.local * at.local * (R * inner.chord_derivative())};
}

Vec3 BeamShape::point(const Station& at) const {
  if (at.element < 0) return at.local * Vec3::UnitZ();
  return origin_[at.element] + at.local * (frame_[at.element] * terms(at).chord());
}

Vec3 BeamShape::tangent(const Station& at) const {
  if (at.element < 0) return Vec3::UnitZ();
  return frame_[at.element] * terms(at).tangent();
}

Vec3 BeamShape::point(double s) const {
  if (kind_ == ElementKind::arc) return point(locate(s));
  return curve_.point(s, [this](int node) { return deviation(node); });
}

Vec3 BeamShape::tangent(double s) const {
  if (kind_ == ElementKind::arc) return tangent(locate(s));
  return curve_.tangent(s, [this](int node) { return deviation(node); });
}

AxisPlace BeamShape::place(double s) const {
  if (kind_ != ElementKind::arc) return {point(s), tangent(s)};
  const Station at = locate(s);
  if (at.element < 0) return {point(at), tangent(at)};
  const Mat3& R = frame_[at.element];
  const RotationTerms inner = terms(at);
  return {origin_[at.element] + at.local * (R * inner.chord()), R * inner.tangent()};
}

double BeamShape::energy() const {
  double sum = 0.0;
  for (int e = 0; e < elements_; ++e) sum += elastic_weight(e) * stiffness_.dot(strain(e).cwiseAbs2());
  return 0.5 * element_length_ * sum;
}

}  // namespace stylet::beam
