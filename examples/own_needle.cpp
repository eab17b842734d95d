// SPDX-License-Identifier: GPL-3.0-or-later
// A needle model of one's own: a beam of linear theory, in the demo patient, beside the built-in model. Not a medical
// device.
//
// The curvature of the shaft is a sum of Legendre polynomials in both directions across the base's axis,
//   u''(s) = sum over k of q_k / L * P_k(2 s / L - 1),   u(0) = u'(0) = 0,
// with one coefficient q_k [rad] for each polynomial and direction. The polynomials are orthogonal, so the elastic
// energy is a sum of squares, E I / (2 L) * q_k^2 / (2 k + 1). Deflection is small against the length, the needle
// neither stretches nor twists, and it does not buckle: unlike the built-in models it bears any axial force.
#include <stylet/patient/insert.hpp>

#include <Eigen/Cholesky>

#include <array>
#include <iostream>

namespace {

using stylet::Mat3;
using stylet::MatX;
using stylet::Pose;
using stylet::Vec3;
using stylet::VecX;

class LinearBeam final : public stylet::Needle {
 public:
  LinearBeam(const stylet::NeedleSection& section, int loads)
      : length_(section.length_mm),
        q_(VecX::Zero(kUnknowns)),
        step_(VecX::Zero(kUnknowns)),
        stiffness_(kUnknowns),
        shape_(MatX::Zero(3 * loads, kUnknowns)),
        solved_(MatX::Zero(kUnknowns, 3 * loads)),
        tangent_(MatX::Zero(kUnknowns, kUnknowns)),
        factor_(kUnknowns) {
    for (int k = 0; k < kModes; ++k)
      stiffness_.segment<2>(2 * k).setConstant(section.bending_stiffness_Nmm2 / (length_ * (2 * k + 1)));
  }

  double length() const override { return length_; }
  std::string model() const override { return "linear"; }
  void set_base(const Pose& base) override { base_ = base; }
  const Pose& base() const override { return base_; }

  Vec3 point(double s) const override {
    const Modes at = modes(s);
    Vec3 local(0.0, 0.0, s);
    for (int k = 0; k < kModes; ++k) local.head<2>() += at.deflection[index(k)] * q_.segment<2>(2 * k);
    return base_.origin + base_.rotation * local;
  }
  Vec3 tangent(double s) const override {
    const Modes at = modes(s);
    Vec3 local(0.0, 0.0, 1.0);
    for (int k = 0; k < kModes; ++k) local.head<2>() += at.slope[index(k)] * q_.segment<2>(2 * k);
    return (base_.rotation * local).normalized();
  }

  bool linearise(std::span<const stylet::PointLoad> loads, Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free,
                 std::span<const Mat3> springs, stylet::Indefinite) override {
    write_shape(loads);
    tangent_ = stiffness_.asDiagonal();
    for (std::size_t c = 0; c < springs.size(); ++c) {
      const auto rows = shape_.middleRows<3>(3 * static_cast<Eigen::Index>(c));
      tangent_ += rows.transpose() * springs[c] * rows;
    }
    factor_.compute(tangent_);
    const auto size = 3 * static_cast<Eigen::Index>(loads.size());
    solved_.leftCols(size) = shape_.topRows(size).transpose();
    for (Eigen::Index column = 0; column < size; ++column) solve(solved_.col(column));
    compliance.noalias() = shape_.topRows(size) * solved_.leftCols(size);
    move(loads, free);
    return true;
  }
  bool relax(std::span<const stylet::PointLoad> loads, Eigen::Ref<VecX> free) override {
    write_shape(loads);
    move(loads, free);
    return true;
  }
  void advance(std::span<const stylet::PointLoad> loads) override {
    unbalanced(loads);
    solve(step_);
    q_ += step_;
  }
  double residual(std::span<const stylet::PointLoad> loads) override {
    write_shape(loads);
    unbalanced(loads);
    return step_.norm();
  }
  void straighten() override { q_.setZero(); }
  double energy() const override { return 0.5 * q_.dot(stiffness_.cwiseProduct(q_)); }
  Eigen::Ref<const VecX> state() const override { return q_; }
  void set_state(const Eigen::Ref<const VecX>& state) override { q_ = state; }

 private:
  static constexpr int kModes = 12;
  static constexpr int kUnknowns = 2 * kModes;  // across the axis, two directions for each mode

  /// The effect of a coefficient of 1 in each mode at one place.
  struct Modes {
    std::array<double, kModes> slope{};
    std::array<double, kModes> deflection{};  // [mm]
  };
  static std::size_t index(int k) { return static_cast<std::size_t>(k); }

  /// Both integrals of P_k from the base on, by the integral of P_k, (P_(k+1) - P_(k-1)) / (2 k + 1).
  Modes modes(double s) const {
    const double x = 2.0 * s / length_ - 1.0;
    std::array<double, kModes + 3> P{1.0, x};
    for (int k = 1; k < kModes + 2; ++k)
      P[index(k + 1)] = ((2 * k + 1) * x * P[index(k)] - k * P[index(k - 1)]) / (k + 1);
    // The integral of P_k from -1 to x; that of P_0 is x + 1.
    const auto once = [&](int k) { return k == 0 ? x + 1.0 : (P[index(k + 1)] - P[index(k - 1)]) / (2 * k + 1); };
    Modes at;
    for (int k = 0; k < kModes; ++k) {
      const double twice = k == 0   ? 0.5 * (x + 1.0) * (x + 1.0)
                           : k == 1 ? (once(2) - (x + 1.0)) / 3.0
                                    : (once(k + 1) - once(k - 1)) / (2 * k + 1);
      at.slope[index(k)] = 0.5 * once(k);
      at.deflection[index(k)] = 0.25 * length_ * twice;
    }
    return at;
  }

  /// Rows: motion of each load point in LPS for each unknown.
  void write_shape(std::span<const stylet::PointLoad> loads) {
    const Mat3 rotation = base_.rotation.toRotationMatrix();
    for (std::size_t c = 0; c < loads.size(); ++c) {
      const Modes at = modes(loads[c].s);
      for (int k = 0; k < kModes; ++k)
        shape_.block<3, 2>(3 * static_cast<Eigen::Index>(c), 2 * k) = at.deflection[index(k)] * rotation.leftCols<2>();
    }
  }
  /// Puts the unbalanced part of the loads into step_.
  void unbalanced(std::span<const stylet::PointLoad> loads) {
    step_ = -stiffness_.cwiseProduct(q_);
    for (std::size_t c = 0; c < loads.size(); ++c)
      step_.noalias() += shape_.middleRows<3>(3 * static_cast<Eigen::Index>(c)).transpose() * loads[c].force;
  }
  void solve(Eigen::Ref<VecX> x) const {
    factor_.matrixL().solveInPlace(x);
    factor_.matrixU().solveInPlace(x);
  }
  void move(std::span<const stylet::PointLoad> loads, Eigen::Ref<VecX> free) {
    unbalanced(loads);
    solve(step_);
    free.noalias() = shape_.topRows(free.size()) * step_;
  }

  double length_;
  Pose base_;
  VecX q_;          // [rad] (24)
  VecX step_;       // work space
  VecX stiffness_;  // [N mm] (24) diagonal
  MatX shape_;      // [mm] (3 loads x 24)
  MatX solved_;     // work space
  MatX tangent_;    // [N mm] (24 x 24) with the springs
  Eigen::LLT<MatX> factor_;
};

stylet::Result<std::unique_ptr<stylet::Needle>> linear_beam(const stylet::NeedleSection& section, int loads) {
  return std::unique_ptr<stylet::Needle>(std::make_unique<LinearBeam>(section, loads));
}

}  // namespace

int main() {
  stylet::Scenario scenario;
  scenario.patient.source = "phantom";  // the demo patient
  scenario.mesh.nodes = 800;            // coarse, so that the example is quick
  scenario.needle.bevel_deg = 20.0;     // so that the needle bends
  scenario.insertions = {{.hole = "e3.5"}};
  scenario.output.pictures = false;
  auto prepared = stylet::prepare_model(scenario);
  if (!prepared) return std::cerr << prepared.error().message() << '\n', 2;
  const auto linear = prepared->model->with({.needle = linear_beam});
  if (!linear) return std::cerr << linear.error().message() << '\n', 2;
  for (const auto& model : {prepared->model, *linear}) {
    prepared->model = model;
    const auto result = stylet::insert(*prepared, "out/own_needle");
    if (!result) return std::cerr << result.error().message() << '\n', 1;
    std::cout << model->make_needle()->model() << " needle: largest force " << result->summary.peak_axial_N
              << " N, tip bent by up to " << result->summary.tip_deflection_mm << " mm\n";
  }
}
