// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/coupled_balance.hpp"
#include "coupling/balance/fading_creep.hpp"
#include "coupling/balance/own_points.hpp"
#include "coupling/balance/resting_errors.hpp"
#include "coupling/balance/tip_drift.hpp"
#include "coupling/tissue_hold.hpp"

#include <cstdint>
#include <vector>

namespace stylet {

/// Needles at rest that follow the needle that the hand moves, instead of being balanced with it. The moved needle is
/// balanced alone, in a tissue that they hold: with the compliance A_oo − A_or S B⁻¹ Sᵀ A_ro (RestingGrips). Then the
/// forces at rest follow by the same linear equations, and their laws are looked at. So a sub-step reads
/// O(contacts of the moved needle × contacts at rest) numbers, and not the square of the latter.
///
/// Linear equations leave over what the needles' bending, the tip's way through the tissue and creep change at rest.
/// Every few sub-steps all of it is looked at and solved for (CoupledBalance::settle_rest). In between
/// - the tip's columns belong to the place of the last look; how much more it moves the contacts at rest at its present
///   place, E, moves the moved needle by −A_or B⁻¹ E at once, while their own forces follow at the next look;
/// - the lasting forces go on as under the forces of the last look, which gives one solved column, scaled with time.
///
/// Where a contact at rest begins or ends to slip, the moved needle is balanced again with it. Where that does not end,
/// or where B does not fit any longer, all needles have to be balanced together. Nothing allocates after construction.
class RestingHold final : public TissueHold {
 public:
  /// @param all all contacts @param whole the balance of all of them; outlives this @param most_own largest number of
  /// contacts of the moved needle, its tip included @param points largest number of points of the compliance
  RestingHold(const Contacts& all, CoupledBalance& whole, int most_own, int points);

  /// All needles have been balanced together in a sub-step of h seconds: the needles at rest may follow from there.
  void balanced(double h, bool found);
  /// The moved needle is at another place: all needles have to be balanced together.
  void forget() { h_ = 0.0; }
  /// Begins a sub-step of h seconds, with the base at its new place. @return false, with nothing changed, where all
  /// needles have to be balanced together
  [[nodiscard]] bool begin(double h);
  /// The moved needle is back at the start of the sub-step, to be balanced again.
  void start_again() { take_start(); }

  enum class Followed { done, again, no };
  /// Lets the needles at rest follow after a balance of the moved needle.
  /// @param last whether a tip that has gone another way than expected is accepted
  /// @return `done`: this is the balance of the sub-step; `again`: contacts have changed their states, or the tip has
  /// gone another way, and the moved needle has to be balanced again; `no`: all needles have to be balanced together
  [[nodiscard]] Followed follow(bool last, Step& step);
  /// Restores the contacts at rest of the start of the sub-step. All needles have to be balanced together.
  void take_back();

  /// Points of the moved needle's shaft contacts.
  [[nodiscard]] std::span<const int> points() const { return own_.all(); }

  [[nodiscard]] Mat3 reduction(int point, int other) const override;
  [[nodiscard]] Vec3 displacement(int point) const override;
  [[nodiscard]] Vec3 of_others() const override;
  void write_forces(Eigen::Ref<MatX> forces) const override;
  [[nodiscard]] std::uint64_t version() const override { return version_; }

 private:
  /// A contact at rest at the start of a sub-step.
  struct Kept {
    Vec3 force = Vec3::Zero();
    double s = 0.0;
    ShaftContact::State state = ShaftContact::State::stick;
    bool fast = false;
  };

  void keep();
  [[nodiscard]] bool look(double h);
  void go_on();
  void take_contacts();
  void take_start();
  [[nodiscard]] bool soften();
  [[nodiscard]] bool change_states(Step& step);
  void add_solved();
  [[nodiscard]] double slides(const ShaftContact& contact, int c) const;
  [[nodiscard]] RestingGrips& grips() const { return whole_.system().resting(); }
  [[nodiscard]] std::span<ShaftContact> resting() const { return all_.shaft.all().first(all_.shaft.others()); }

  Contacts all_;
  CoupledBalance& whole_;
  double h_ = 0.0;  ///< [s] of the last balance of all needles, 0: none
  int age_ = 0;     ///< sub-steps since the last look
  std::uint64_t version_ = 0;
  std::vector<Kept> kept_;  ///< (contacts at rest)
  OwnPoints own_;
  VecX start_;  ///< [N] (3 own) forces on the moved needle's contacts at the start of the sub-step
  MatX moved_;  ///< [mm] (3 own × 3) displacement without E, what E takes off it, and its change per mm of cut
  TipDrift drift_;
  FadingCreep creep_;
  MatX solved_;  ///< [N] (rows × 2) B⁻¹ of the usual E, and of what the creep moves
  RestingErrors errors_;
  VecX z_;      ///< (rows) work space: a solved column
  VecX force_;  ///< [N] (3 contacts at rest) work space
};

}  // namespace stylet
