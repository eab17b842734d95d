// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/needle.hpp"

namespace stylet {

/// Parameters of a steel needle.
struct NeedleSection {
  double length_mm = 200.0;
  double outer_diameter_mm = 1.27;        ///< 18 gauge
  double bending_stiffness_Nmm2 = 15700;  ///< E I; 12,700…25,500 for an 18 gauge cannula without…with stylet
  double torsion_stiffness_Nmm2 = 12100;  ///< G J
};

/// Inextensible, unshearable, geometrically exact rod with piecewise constant curvature: element e turns the frame by
/// the rotation vector l κ_e, so the centreline is a chain of circular helices with a continuous tangent.
/// Unknowns: κ (3 per element, body frame; x, y bending, z twist). Energy ½ Σ l κᵀ diag(EI, EI, GJ) κ − Σ f·r.
/// state() is κ [1/mm], from the base; residual() is the largest over the elements of |diag(EI, EI, GJ) κ − m|, m the
/// loads' moment averaged over the element as virtual work sees it. Loads at s ≤ 0 act on the clamp, s past the tip
/// counts as the tip. Beyond the buckling load a multiple of the elastic part keeps the tangent positive definite.
/// @cite Bertails2006
class BeamNeedle final : public Needle {
 public:
  /// @param elements number of elements, ≥ 4
  /// @param load_capacity largest number of loads in any call
  static Result<std::unique_ptr<BeamNeedle>> build(const NeedleSection& section, int elements, int load_capacity);
  ~BeamNeedle() override;

  [[nodiscard]] double length() const override;
  [[nodiscard]] std::string model() const override { return "beam"; }
  void set_base(const Pose& base) override;
  [[nodiscard]] const Pose& base() const override;
  [[nodiscard]] Vec3 point(double s) const override;
  [[nodiscard]] Vec3 tangent(double s) const override;
  bool linearise(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free,
                 std::span<const Mat3> springs = {}) override;
  void advance(std::span<const PointLoad> loads) override;
  [[nodiscard]] double residual(std::span<const PointLoad> loads) const override;
  void straighten() override;
  [[nodiscard]] double energy() const override;
  [[nodiscard]] Eigen::Ref<const VecX> state() const override;
  void set_state(const Eigen::Ref<const VecX>& state) override;

 private:
  struct Parts;
  explicit BeamNeedle(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet
