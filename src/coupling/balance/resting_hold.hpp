// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/coupled_balance.hpp"
#include "coupling/balance/own_points.hpp"
#include "coupling/balance/resting_creep.hpp"
#include "coupling/balance/resting_errors.hpp"
#include "coupling/balance/resting_forces.hpp"
#include "coupling/balance/resting_points.hpp"
#include "coupling/balance/tip_reach.hpp"
#include "coupling/tissue_hold.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace stylet {

/// Needles at rest that follow the needle that the hand moves, instead of being balanced with it. The moved needle is
/// balanced alone, in a tissue that they hold: with the compliance A_oo − A_or S B⁻¹ Sᵀ A_ro (RestingGrips). The forces
/// at rest follow by the same linear equations (RestingForces).
///
/// In each sub-step the forces along the needles are computed for all contacts at rest, and their friction laws are
/// looked at. All three components of a force are computed for some contacts in turn, and for those that slide,
/// together with the effect of the tip on these contacts (TipReach). So a sub-step reads O(contacts of the moved needle
/// × contacts at rest) numbers, most of them once per contact at rest. Linear equations leave over what the needles'
/// bending, the tip's way through the tissue and creep change at rest. Every twenty sub-steps all of it is looked at
/// and solved for (CoupledBalance::settle_rest).
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
  /// Writes the present forces to all contacts at rest, before something else than this changes them.
  void settle();
  /// Writes the present forces to all contacts at rest for those who look at them between sub-steps. The next sub-step
  /// does not depend on that.
  void show();
  /// Begins a sub-step of h seconds, with the base at its new place. @return false, with the contacts at rest settled,
  /// where all needles have to be balanced together
  [[nodiscard]] bool begin(double h);

  enum class Followed { done, again, no };
  /// Lets the needles at rest follow after a balance of the moved needle.
  /// @return `done`: this is the balance of the sub-step; `again`: contacts contradict their laws; `no`: all needles
  /// have to be balanced together
  [[nodiscard]] Followed follow();
  /// The moved needle is back at the start of the sub-step: contacts that contradicted their laws change their states.
  /// @return false where all needles have to be balanced together
  [[nodiscard]] bool start_again(Step& step);
  /// Restores the contacts at rest of the start of the sub-step, with the moved needle back there. All needles have to
  /// be balanced together.
  void take_back();

  /// Points of the moved needle's shaft contacts.
  [[nodiscard]] std::span<const int> points() const { return own_.all(); }
  /// Points without a contact at rest, but for the tip.
  [[nodiscard]] std::span<const int> free_points() const { return points_.free(); }

  [[nodiscard]] Mat3 reduction(int point, int other) const override;
  [[nodiscard]] Vec3 displacement(int point) const override;
  [[nodiscard]] Vec3 of_others() const override { return reach_.of_others(all_); }
  void write_forces(Eigen::Ref<MatX> forces) const override;
  [[nodiscard]] std::uint64_t version() const override { return version_; }

 private:
  /// A contact at rest at the start of a sub-step, and its force before show().
  struct Kept {
    Vec3 force = Vec3::Zero();
    double s = 0.0;
    ShaftContact::State state = ShaftContact::State::stick;
    bool fast = false;
    int since = 0;  ///< sub-steps since its force was computed
  };
  /// A contact whose law is contradicted.
  struct Contradicted {
    int contact = 0;
    ContactStates::Trial trial;
  };

  void write_all();
  void hide();
  void keep();
  [[nodiscard]] bool look(double h);
  void go_on();
  void take_contacts();
  void take_start(bool columns);
  void take_force(int grip, const Vec3& force);
  void look_at_laws(const Eigen::Ref<const VecX>& axial);
  void begin_balance();
  [[nodiscard]] Eigen::Ref<const VecX> own_forces() const {
    return own_.forces(all_.tip.force, std::as_const(all_.shaft).own(), grips().held().known());
  }
  [[nodiscard]] double slides(const ShaftContact& contact, int c, const Vec3& force) const;
  [[nodiscard]] RestingGrips& grips() const { return whole_.system().resting(); }
  [[nodiscard]] std::span<ShaftContact> resting() const { return all_.shaft.all().first(all_.shaft.others()); }

  Contacts all_;
  CoupledBalance& whole_;
  double h_ = 0.0;      ///< [s] of the last balance of all needles, 0: none
  int age_ = 0;         ///< sub-steps since the last look
  bool shown_ = false;  ///< show() was called since the last sub-step
  int turn_ = 0;        ///< the contact at rest, from 0 on, that is visited next
  std::uint64_t version_ = 0;
  std::vector<Kept> kept_;                  ///< (contacts at rest)
  std::vector<Contradicted> contradicted_;  ///< in the last balance
  RestingPoints points_;
  OwnPoints own_;
  TipReach reach_;
  RestingCreep creep_;
  RestingForces forces_;
  RestingErrors errors_;
};

}  // namespace stylet
