// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/tet.hpp"

#include "needle/bow.hpp"
#include "needle/tet_shape.hpp"
#include "needle/tet_tangent.hpp"

#include <array>
#include <cmath>

namespace stylet {

namespace {
constexpr double kSteelPoisson = 0.3;
}  // namespace

struct TetNeedle::Parts {
  Parts(const NeedleSection& section, int segments, int load_capacity, Segment segment)
      : length(section.length_mm),
        theory_modulus(12.0 * section.bending_stiffness_Nmm2 / std::pow(section.outer_diameter_mm, 4)),
        shape(tet::make_segment(segment, section.outer_diameter_mm, section.length_mm / segments), segments,
              section.length_mm / segments, theory_modulus, kSteelPoisson),
        tangent(shape, load_capacity),
        imbalance(VecX::Zero(shape.displacement.size())) {
    calibrate(section);
    if (section.bow_mm > 0.0) bend_rest(section);
  }

  void bend_rest(const NeedleSection& section) {
    const Vec3 axis = bow_axis(section);
    shape.bend_rest(axis * bow_curvature(section, [&](double k) { return (1.0 - std::cos(k * length)) / k; }));
  }

  /// Scales Young's modulus so that the tip of the straight needle yields to a lateral force as theory says.
  void calibrate(const NeedleSection& section) {
    const std::array<PointLoad, 1> tip{PointLoad{length, Vec3::Zero()}};
    MatX compliance(3, 3);
    VecX free(3);
    tangent.assemble(shape, base_rotation, tip);
    tangent.condense(compliance, free);
    const double theory = std::pow(length, 3) / (3.0 * section.bending_stiffness_Nmm2);
    softness = compliance(0, 0) / theory;
    axial_stiffness = softness / compliance(2, 2);
    shape.scale_modulus(softness);
  }

  double length;
  double theory_modulus;  ///< [MPa] modulus with which theory gives the square section the needle's bending stiffness
  double softness = 1.0;  ///< compliance of the tetrahedra with theory_modulus / compliance of theory
  double axial_stiffness = 0.0;  ///< [N/mm]
  Pose base;
  Mat3 base_rotation = Mat3::Identity();
  tet::TetShape shape;
  tet::TetTangent tangent;
  VecX imbalance;  ///< work space of residual()
};

Result<std::unique_ptr<TetNeedle>> TetNeedle::build(const NeedleSection& section, int segments, int load_capacity,
                                                    Segment segment) {
  if (const Result<> checked = check_needle(section, segments, load_capacity); !checked) return checked.error();
  auto parts = std::make_unique<Parts>(section, segments, load_capacity, segment);
  return std::unique_ptr<TetNeedle>(new TetNeedle(std::move(parts)));
}

TetNeedle::TetNeedle(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
TetNeedle::~TetNeedle() = default;

double TetNeedle::stiffening() const { return 1.0 / parts_->softness; }
double TetNeedle::young_modulus() const { return parts_->theory_modulus * parts_->softness; }
double TetNeedle::axial_stiffness() const { return parts_->axial_stiffness; }

double TetNeedle::length() const { return parts_->length; }

void TetNeedle::set_base(const Pose& base) {
  parts_->base = base;
  parts_->base.rotation.normalize();
  parts_->base_rotation = parts_->base.rotation.toRotationMatrix();
}

const Pose& TetNeedle::base() const { return parts_->base; }

Vec3 TetNeedle::point(double s) const { return parts_->base.origin + parts_->base_rotation * parts_->shape.point(s); }

Vec3 TetNeedle::tangent(double s) const { return parts_->base_rotation * parts_->shape.tangent(s); }

bool TetNeedle::linearise(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free,
                          std::span<const Mat3> springs, Indefinite otherwise) {
  if (!parts_->tangent.assemble(parts_->shape, parts_->base_rotation, loads, springs, otherwise)) return false;
  parts_->tangent.condense(compliance, free);
  return parts_->tangent.material_shift() == 0.0;
}

bool TetNeedle::relax(std::span<const PointLoad> loads, Eigen::Ref<VecX> free) {
  return parts_->tangent.relax(parts_->shape, parts_->base_rotation, loads, free);
}

void TetNeedle::advance(std::span<const PointLoad> loads) {
  parts_->tangent.step(loads, parts_->shape);
  parts_->shape.update();
}

double TetNeedle::residual(std::span<const PointLoad> loads) {
  return tet::largest_imbalance(parts_->shape, parts_->base_rotation, loads, parts_->imbalance);
}

void TetNeedle::damp(double ratio) { parts_->shape.damp(ratio); }

void TetNeedle::straighten() {
  parts_->shape.displacement = parts_->shape.rest();
  parts_->shape.update();
}

double TetNeedle::energy() const { return parts_->shape.energy(); }

Eigen::Ref<const VecX> TetNeedle::state() const { return parts_->shape.displacement; }

void TetNeedle::set_state(const Eigen::Ref<const VecX>& state) {
  parts_->shape.displacement = state;
  parts_->shape.update();
}

}  // namespace stylet
