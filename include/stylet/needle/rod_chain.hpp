// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/needle.hpp"
#include "stylet/needle/section.hpp"

namespace stylet {

/// Common part of BeamNeedle and SpringsNeedle: an inextensible, unshearable chain of elements. The unknowns are the
/// curvatures κ = rotation vector / element length, three per element (body frame; x, y bending, z twist).
///
/// state() is κ [1/mm], ordered from the base. residual() is the largest |D Δκ − m| of all elements, with D = diag(EI,
/// EI, GJ), Δκ the curvature minus the curvature of the unloaded shape, and m the moment of the loads averaged over the
/// element (by virtual work). Loads at s ≤ 0 act on the clamp; s beyond the tip counts as the tip. Beyond the buckling
/// load, a multiple of the elastic part is added to keep the tangent positive definite.
class RodChain : public Needle {
 public:
  ~RodChain() override;

  [[nodiscard]] double length() const final;
  void set_base(const Pose& base) final;
  [[nodiscard]] const Pose& base() const final;
  [[nodiscard]] Vec3 point(double s) const final;
  [[nodiscard]] Vec3 tangent(double s) const final;
  [[nodiscard]] AxisPlace place(double s) const final;
  bool linearise(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free,
                 std::span<const Mat3> springs = {}, Indefinite otherwise = Indefinite::shift) final;
  bool append(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance) final;
  bool relax(std::span<const PointLoad> loads, Eigen::Ref<VecX> free) final;
  [[nodiscard]] bool prepares() const final { return true; }
  bool prepare(std::span<const PointLoad> loads, std::span<const Mat3> springs, Indefinite otherwise) final;
  bool prepared_compliance(Eigen::Ref<MatX> compliance) final;
  void take_prepared() final;
  void advance(std::span<const PointLoad> loads) final;
  [[nodiscard]] double residual(std::span<const PointLoad> loads) final;
  void damp(double ratio) final;
  void straighten() final;
  [[nodiscard]] double energy() const final;
  [[nodiscard]] Eigen::Ref<const VecX> state() const final;
  void set_state(const Eigen::Ref<const VecX>& state) final;

 protected:
  struct Parts;
  explicit RodChain(std::unique_ptr<Parts> parts);

 private:
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet
