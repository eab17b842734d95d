// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/needle.hpp"

#include <span>
#include <vector>

namespace stylet {

/// The needle that the hand moves together with the needles at rest, as one needle for the balance: its loads are those
/// of Contacts, and its compliance has a block for each needle. Questions about the axis, the base and the guide are
/// answered for the needle that the hand moves. Nothing allocates after construction.
///
/// Between needles the compliance is zero. To save time these zeros are not written: a matrix that is passed to
/// linearise() or prepared_compliance() has to be zero there.
class NeedleBundle final : public Needle {
 public:
  /// A needle at rest, and the number of its contacts, which does not change.
  struct AtRest {
    Needle* needle = nullptr;
    int contacts = 0;
  };

  /// All needles outlive the bundle.
  /// @param at_rest in the order of their contacts @param most_own largest number of loads on `moving`, its tip
  /// included
  NeedleBundle(Needle& moving, std::span<const AtRest> at_rest, int most_own);

  [[nodiscard]] double length() const override { return moving_.length(); }
  [[nodiscard]] std::string model() const override { return moving_.model(); }
  void set_base(const Pose& base) override { moving_.set_base(base); }
  [[nodiscard]] const Pose& base() const override { return moving_.base(); }
  [[nodiscard]] Vec3 point(double s) const override { return moving_.point(s); }
  [[nodiscard]] Vec3 tangent(double s) const override { return moving_.tangent(s); }
  [[nodiscard]] AxisPlace place(double s) const override { return moving_.place(s); }

  /// Whether linearise() keeps the tangents of the needles at rest, whose shapes hardly change.
  void keep_resting(bool keep) { keeps_resting_ = keep; }
  bool linearise(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free,
                 std::span<const Mat3> springs = {}, Indefinite otherwise = Indefinite::shift) override;
  bool relax(std::span<const PointLoad> loads, Eigen::Ref<VecX> free) override;
  bool append(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance) override;
  /// Only the needle that the hand moves gets a new tangent; needles at rest keep the one of the last linearise().
  [[nodiscard]] bool prepares() const override { return moving_.prepares(); }
  bool prepare(std::span<const PointLoad> loads, std::span<const Mat3> springs, Indefinite otherwise) override;
  bool prepared_compliance(Eigen::Ref<MatX> compliance) override;
  void take_prepared() override { moving_.take_prepared(); }
  void advance(std::span<const PointLoad> loads) override;
  /// relax() and advance() of the needles at rest alone. A needle whose tangent does not fit, since its guide has begun
  /// or ceased to hold it, is linearised. @param loads, springs of all needles; no springs: none are lent
  /// @return whether all tangents fit
  bool relax_resting(std::span<const PointLoad> loads, Eigen::Ref<VecX> free, std::span<const Mat3> springs);
  void advance_resting(std::span<const PointLoad> loads);
  /// The largest residual of a needle [N mm].
  [[nodiscard]] double residual(std::span<const PointLoad> loads) override;
  /// Those of the needle that the hand moves, and of the needles at rest.
  [[nodiscard]] double residual_of_moving(std::span<const PointLoad> loads) { return moving_.residual(own(loads)); }
  [[nodiscard]] double residual_of_resting(std::span<const PointLoad> loads) const;
  void damp(double ratio) override { moving_.damp(ratio); }
  void straighten() override { moving_.straighten(); }
  [[nodiscard]] double energy() const override;
  void place_guide(const Vec3& hole, const Vec3& axis) override { moving_.place_guide(hole, axis); }
  [[nodiscard]] PointLoad guide_load() const override { return moving_.guide_load(); }
  /// The degrees of freedom of all needles, the one that the hand moves first.
  [[nodiscard]] Eigen::Ref<const VecX> state() const override;
  void set_state(const Eigen::Ref<const VecX>& state) override;

 private:
  struct Resting {
    Needle* needle;
    int first;   ///< number of its first load
    int count;   ///< number of its loads
    MatX block;  ///< [mm/N] (3 count × 3 count) its compliance at the last linearise()
  };

  std::span<const PointLoad> own(std::span<const PointLoad> loads);
  std::span<const Mat3> own_springs(std::span<const Mat3> springs);
  void write_own(const Eigen::Ref<const MatX>& from, Eigen::Ref<MatX> to) const;
  void write_resting(Eigen::Ref<MatX> to) const;
  void write_own_motion(Eigen::Index rows, Eigen::Ref<VecX> to) const;
  [[nodiscard]] Eigen::Index resting_rows() const { return 3 * static_cast<Eigen::Index>(first_own_ - 1); }

  Needle& moving_;
  std::vector<Resting> resting_;
  int first_own_ = 1;  ///< number of the first load on the shaft of the needle that the hand moves
  std::vector<PointLoad> loads_;
  std::vector<Mat3> springs_;
  MatX compliance_;  ///< [mm/N] work space: the own compliance
  MatX prepared_;    ///< [mm/N] the own compliance of the next tangent
  VecX motion_;      ///< [mm] work space
  int prepared_count_ = 0;
  bool keeps_resting_ = false;
  mutable VecX state_;  ///< result of state()
};

}  // namespace stylet
