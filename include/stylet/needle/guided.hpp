// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/guide_meeting.hpp"

#include <memory>
#include <vector>

namespace stylet {

/// A needle of any model whose shaft runs through a hole. Where the shaft crosses the hole's plane, at x, it is free
/// while its distance d from the hole's axis is less than the clearance c; beyond, the hole pushes back:
///   W = ½ k (d − c)²,   force on the needle  −Pᵀ ∇W,   P = I − t nᵀ/(t·n)
/// with the shaft's tangent t and the hole's axis n. P takes a motion of the shaft to that of the crossing, so the
/// force is square to the shaft: the hole is smooth and the shaft slides through it without friction. It is one more
/// load of the inner needle, with Pᵀ ∇²W P as its spring; the tangent of the coupling sees nothing but a stiffer
/// needle. What the tangent leaves out is how the force turns with the shaft. There is no force while the tip has not
/// reached the plane, and none when the base has passed it.
class GuidedNeedle final : public Needle {
 public:
  /// @param inner built for at least load_capacity + 1 loads
  GuidedNeedle(std::unique_ptr<Needle> inner, const GuideHole& hole, int load_capacity);

  void place_guide(const Vec3& hole, const Vec3& axis) override;
  [[nodiscard]] PointLoad guide_load() const override { return hole_.load(); }
  /// Distance [mm] of the shaft from the hole's axis in its plane; 0 where it does not cross it.
  [[nodiscard]] double offset() const { return hole_.offset(); }

  [[nodiscard]] double length() const override { return inner_->length(); }
  [[nodiscard]] std::string model() const override { return inner_->model(); }
  void set_base(const Pose& base) override;
  [[nodiscard]] const Pose& base() const override { return inner_->base(); }
  [[nodiscard]] Vec3 point(double s) const override { return inner_->point(s); }
  [[nodiscard]] Vec3 tangent(double s) const override { return inner_->tangent(s); }
  [[nodiscard]] AxisPlace place(double s) const override { return inner_->place(s); }
  bool linearise(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free,
                 std::span<const Mat3> springs = {}, Indefinite otherwise = Indefinite::shift) override;
  bool append(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance) override;
  bool relax(std::span<const PointLoad> loads, Eigen::Ref<VecX> free) override;
  [[nodiscard]] bool prepares() const override { return inner_->prepares(); }
  bool prepare(std::span<const PointLoad> loads, std::span<const Mat3> springs, Indefinite otherwise) override;
  bool prepared_compliance(Eigen::Ref<MatX> compliance) override;
  void take_prepared() override;
  void advance(std::span<const PointLoad> loads) override;
  [[nodiscard]] double residual(std::span<const PointLoad> loads) override;
  void damp(double ratio) override { inner_->damp(ratio); }
  void straighten() override;
  /// Elastic energy of shape and hole.
  [[nodiscard]] double energy() const override;
  [[nodiscard]] Eigen::Ref<const VecX> state() const override { return inner_->state(); }
  void set_state(const Eigen::Ref<const VecX>& state) override;

 private:
  /// How the hole held when a tangent was made.
  struct Hold {
    bool on = false;
    PointLoad with;
    Mat3 stiffness = Mat3::Zero();  ///< [N/mm]
  };

  /// Whether the tangent is one with the hole as it holds now.
  [[nodiscard]] bool fits() const;
  std::span<const PointLoad> with_guide(std::span<const PointLoad> loads, const PointLoad& guide);
  [[nodiscard]] Hold hold() const { return {hole_.holds(), hole_.load(), hole_.stiffness()}; }
  std::span<const Mat3> with_guide(std::span<const Mat3> springs, std::size_t loads);

  std::unique_ptr<Needle> inner_;
  GuideMeeting hole_;
  Hold held_;                     ///< at the last linearise()
  Hold prepared_;                 ///< at the last prepare()
  std::vector<PointLoad> loads_;  ///< the hole's, then the caller's
  std::vector<Mat3> springs_;     ///< [N/mm] of the hole and the caller's
  MatX N_;                        ///< [mm/N] (3w + 3)²
  VecX free_;                     ///< [mm] (3w + 3)
  MatX prepared_N_;               ///< as N_, of the tangent that is prepared
};

}  // namespace stylet
