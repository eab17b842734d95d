// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/guide_change.hpp"
#include "stylet/needle/guide_meeting.hpp"

#include <memory>
#include <vector>

namespace stylet {

/// A needle of any model whose shaft runs through a hole. The shaft is free while the distance d of its nearest point
/// from the hole's centre is less than the clearance c; beyond, the hole pushes it back with the force k (d − c), and
/// the edge between the two is rounded (docs/theory/needle.md). The force is perpendicular to the shaft: the hole is
/// smooth, and the shaft slides through it without friction. The force is an additional load of the inner needle with a
/// spring, so to the coupling the needle is just stiffer. The tangent stiffness neglects that the force turns with the
/// shaft. There is no force before the tip reaches the hole or after the base has passed it. A tangent that was made
/// for another stiffness of the hole serves on (GuideChange).
class GuidedNeedle final : public Needle {
 public:
  /// @param inner a needle built for at least load_capacity + 1 loads
  GuidedNeedle(std::unique_ptr<Needle> inner, const GuideHole& hole, int load_capacity);

  void place_guide(const Vec3& hole, const Vec3& axis) override;
  [[nodiscard]] PointLoad guide_load() const override { return hole_.load(); }
  /// [mm] Distance between the shaft and the hole's centre; 0 where the shaft is not in the hole.
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
  /// Elastic energy of the needle's shape and of the contact with the hole.
  [[nodiscard]] double energy() const override;
  [[nodiscard]] Eigen::Ref<const VecX> state() const override { return inner_->state(); }
  void set_state(const Eigen::Ref<const VecX>& state) override;

 private:
  /// State of the hole for which a tangent was made.
  struct Hold {
    bool on = false;  ///< whether the hole's load and stiffness, which may be zero, are in the tangent
    PointLoad with;
    Mat3 stiffness = Mat3::Zero();  ///< [N/mm]
  };

  /// Whether the tangent in use serves with the current state of the hole.
  [[nodiscard]] bool fits() const;
  std::span<const PointLoad> with_guide(std::span<const PointLoad> loads, const PointLoad& guide);
  [[nodiscard]] Hold hold() const { return {hole_.has_held(), hole_.load(), hole_.stiffness()}; }
  std::span<const Mat3> with_guide(std::span<const Mat3> springs, std::size_t loads);

  std::unique_ptr<Needle> inner_;
  GuideMeeting hole_;
  Hold held_;                     ///< at the last linearise(), relax() or take_prepared()
  Hold prepared_;                 ///< at the last prepare()
  std::vector<PointLoad> loads_;  ///< the hole's load, then the caller's loads
  std::vector<Mat3> springs_;     ///< [N/mm] the hole's stiffness, then the caller's springs
  MatX N_;                        ///< [mm/N] (3w + 3 square) compliance of the inner needle with the hole's load
  VecX free_;                     ///< [mm] (3w + 3) `free` of the inner needle
  MatX prepared_N_;               ///< as N_, for the prepared tangent
  GuideChange change_;            ///< of the hole since the tangent in use was made
};

}  // namespace stylet
