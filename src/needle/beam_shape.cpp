// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/beam_shape.hpp"

#include <algorithm>

namespace stylet::beam {

BeamShape::BeamShape(int elements, double length, double bending_stiffness, double torsion_stiffness)
    : curvature(VecX::Zero(dof(elements))),
      elements_(elements),
      element_length_(length / elements),
      stiffness_(bending_stiffness, bending_stiffness, torsion_stiffness),
      frame_(elements + 1, Mat3::Identity()),
      origin_(elements + 1, Vec3::Zero()),
      spin_(elements, Mat3::Zero()),
      shift_(elements, Mat3::Zero()) {
  update();
}

void BeamShape::update() {
  const double l = element_length_;
  for (int e = 0; e < elements_; ++e) {
    const RotationTerms terms(l * kappa(e));
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

LocatedLoad BeamShape::locate_load(double s, const Vec3& force) const {
  const Station at = locate(s);
  return {at, force, point(at)};
}

Vec3 BeamShape::point(const Station& at) const {
  if (at.element < 0) return at.local * Vec3::UnitZ();
  const RotationTerms terms(at.local * kappa(at.element));
  return origin_[at.element] + at.local * (frame_[at.element] * terms.chord());
}

Vec3 BeamShape::tangent(const Station& at) const {
  if (at.element < 0) return Vec3::UnitZ();
  return frame_[at.element] * RotationTerms(at.local * kappa(at.element)).rotation().col(2);
}

double BeamShape::energy() const {
  double sum = 0.0;
  for (int e = 0; e < elements_; ++e) sum += stiffness_.dot(kappa(e).cwiseAbs2());
  return 0.5 * element_length_ * sum;
}

Mat3 BeamShape::inner_jacobian(const Station& at) const {
  const RotationTerms terms(at.local * kappa(at.element));
  return at.local * at.local * (frame_[at.element] * terms.chord_derivative());
}

}  // namespace stylet::beam
