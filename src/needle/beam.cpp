// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/beam.hpp"

#include "needle/beam_shape.hpp"
#include "needle/beam_tangent.hpp"

#include <cmath>
#include <numbers>
#include <string>

namespace stylet {

namespace {

constexpr double kSteelYoung_MPa = 210e3;
constexpr int kFewestElements = 4;
constexpr int kMostElements = 500;

std::string number(double value) {
  std::string text = std::to_string(value);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text;
}

Error not_positive(const char* name, const char* unit, double value) {
  return input_error(std::string("needle, ") + name, number(value) + " " + unit + ", expected a finite number above 0",
                     std::string("Give the needle's ") + name + " in " + unit);
}

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

Result<> check(const NeedleSection& section, int elements, int load_capacity) {
  if (!positive(section.length_mm)) return not_positive("length", "mm", section.length_mm);
  if (!positive(section.outer_diameter_mm)) return not_positive("outer diameter", "mm", section.outer_diameter_mm);
  if (!positive(section.bending_stiffness_Nmm2)) {
    return not_positive("bending stiffness", "N mm²", section.bending_stiffness_Nmm2);
  }
  if (!positive(section.torsion_stiffness_Nmm2)) {
    return not_positive("torsion stiffness", "N mm²", section.torsion_stiffness_Nmm2);
  }
  const double solid = kSteelYoung_MPa * std::numbers::pi * std::pow(section.outer_diameter_mm, 4) / 64.0;
  if (section.bending_stiffness_Nmm2 > 1.1 * solid) {
    return input_error("needle, bending stiffness",
                       number(section.bending_stiffness_Nmm2) + " N mm², but a solid steel rod of " +
                           number(section.outer_diameter_mm) + " mm has " + number(std::round(solid)) +
                           " N mm² (E = 210 GPa), and no needle is stiffer",
                       "Check the units (N mm²) and the outer diameter (mm)");
  }
  if (elements < kFewestElements || elements > kMostElements) {
    return input_error("needle, elements", std::to_string(elements) + ", expected 4…500",
                       "24 elements follow a 200 mm needle to 0.1 %");
  }
  if (load_capacity < 1) {
    return input_error("needle, load capacity", std::to_string(load_capacity) + ", expected at least 1",
                       "Give the largest number of loads of any call");
  }
  return Ok{};
}

}  // namespace

struct BeamNeedle::Parts {
  Parts(const NeedleSection& section, int elements, int load_capacity)
      : length(section.length_mm),
        shape(elements, section.length_mm, section.bending_stiffness_Nmm2, section.torsion_stiffness_Nmm2),
        tangent(shape, load_capacity) {}

  double length;
  Pose base;
  Mat3 base_rotation = Mat3::Identity();
  beam::BeamShape shape;
  beam::BeamTangent tangent;
};

Result<std::unique_ptr<BeamNeedle>> BeamNeedle::build(const NeedleSection& section, int elements, int load_capacity) {
  if (const Result<> checked = check(section, elements, load_capacity); !checked) return checked.error();
  auto parts = std::make_unique<Parts>(section, elements, load_capacity);
  return std::unique_ptr<BeamNeedle>(new BeamNeedle(std::move(parts)));
}

BeamNeedle::BeamNeedle(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
BeamNeedle::~BeamNeedle() = default;

double BeamNeedle::length() const { return parts_->length; }

void BeamNeedle::set_base(const Pose& base) {
  parts_->base = base;
  parts_->base.rotation.normalize();
  parts_->base_rotation = parts_->base.rotation.toRotationMatrix();
}

const Pose& BeamNeedle::base() const { return parts_->base; }

Vec3 BeamNeedle::point(double s) const {
  return parts_->base.origin + parts_->base_rotation * parts_->shape.point(parts_->shape.locate(s));
}

Vec3 BeamNeedle::tangent(double s) const {
  return parts_->base_rotation * parts_->shape.tangent(parts_->shape.locate(s));
}

bool BeamNeedle::linearise(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free,
                           std::span<const Mat3> springs) {
  parts_->tangent.assemble(parts_->shape, parts_->base_rotation, loads, springs);
  parts_->tangent.condense(compliance, free);
  return parts_->tangent.elastic_shift() == 0.0;
}

void BeamNeedle::advance(std::span<const PointLoad> loads) {
  parts_->tangent.step(loads, parts_->shape);
  parts_->shape.update();
}

double BeamNeedle::residual(std::span<const PointLoad> loads) const {
  return beam::largest_imbalance(parts_->shape, parts_->base_rotation, loads);
}

void BeamNeedle::straighten() {
  parts_->shape.curvature.setZero();
  parts_->shape.update();
}

double BeamNeedle::energy() const { return parts_->shape.energy(); }

Eigen::Ref<const VecX> BeamNeedle::state() const { return parts_->shape.curvature; }

void BeamNeedle::set_state(const Eigen::Ref<const VecX>& state) {
  parts_->shape.curvature = state;
  parts_->shape.update();
}

}  // namespace stylet
