// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/balance/coupled_balance.hpp"
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
  /// @param all all contacts @param whole the balance of all of them; both outlive this @param points largest number of
  /// points of the compliance
  RestingHold(const Contacts& all, CoupledBalance& whole, int most_own, int points);

  /// All needles have been balanced together in a sub-step of h seconds: the needles at rest may follow from there.
  void balanced(double h, bool found);
  /// The moved needle is at another place: all needles have to be balanced together.
  void forget() { h_ = 0.0; }
  /// Begins a sub-step of h seconds, with the base at its new place. @return false, with nothing changed, where all
  /// needles have to be balanced together
  [[nodiscard]] bool begin(double h);

  enum class Followed { done, again, no };
  /// Lets the needles at rest follow after a balance of the moved needle. @return whether that is the balance of the
  /// sub-step; `again`: contacts have changed their state, and the moved needle, back at its start, has to be balanced
  /// again; `no`: all needles have to be balanced together
  [[nodiscard]] Followed follow(Step& step);
  /// The moved needle is back at its start, to be balanced again.
  void start_again() { take_start(); }
  /// Restores the contacts at rest of the start of the sub-step.
  void take_back();

  /// Points of the moved needle's shaft contacts.
  [[nodiscard]] std::span<const int> points() const { return points_; }

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
  bool look(double h);
  void fade(Eigen::Ref<VecX> z);
  void creep_on();
  void take_contacts();
  void take_start();
  void drift_to(Eigen::Ref<VecX> E) const;
  void begin_drift();
  [[nodiscard]] bool drift_fits();
  bool soften();
  void err(VecX& z, int c, double mm);
  void add_errors(VecX& z);
  void add(const Eigen::Ref<const VecX>& z);
  [[nodiscard]] Vec3 more_of_tip(int contact, const TipRelief& relief) const;
  [[nodiscard]] Mat3 compliance(int point, int contact) const;
  [[nodiscard]] Eigen::Index own_index(int point) const { return 3 * index_[static_cast<std::size_t>(point)]; }
  [[nodiscard]] std::span<ShaftContact> resting() const { return all_.shaft.all().first(all_.shaft.others()); }
  [[nodiscard]] double away(const ShaftContact& contact, int c) const;

  /// What is known from the last look at all laws.
  struct Look {
    Vec3 tip_force = Vec3::Zero();  ///< [N]
    VecX tip_moves;                 ///< [mm] (rows) by that force
    MatX tip_columns;               ///< [mm/N] (rows × 3) derivative of tip_moves
    VecX usual;                     ///< [mm] (rows) E directly before that look
    MatX solved;                    ///< [N] (rows × 2) B⁻¹ of it, and of what fades with the memory
    double drifted_as_usual = 0.0;  ///< how many times `usual` is in the forces at rest
    double faded = 1.0;             ///< the part that is left of the memory
  };
  /// E, less the part like Look::usual.
  struct Drift {
    MatX at_rest;   ///< [mm] (rows × 2) at the start of the sub-step, and its change per mm of cut
    MatX of_moved;  ///< [mm] (3 own × 2) what it takes off the displacement of the moved needle's points
  };
  struct WorkSpace {
    VecX z, force, change, fading;
    MatX columns, of_sliding;
    std::vector<int> changing;  ///< contacts that change their states
    bool errs = false;          ///< whether `errors` is not zero
    MatX errors;                ///< [mm] (rows × 1) right-hand side of contacts without a solved column
  };

  Contacts all_;
  CoupledBalance& whole_;
  RestingGrips& grips_;
  double h_ = 0.0;  ///< [s] of the last balance of all needles, 0: none
  int age_ = 0;     ///< sub-steps since the last look
  int rounds_ = 0;  ///< balances of this sub-step
  std::uint64_t version_ = 0;
  std::vector<Kept> kept_;           ///< (contacts at rest)
  std::vector<int> points_;          ///< of the moved needle's shaft contacts
  std::vector<Eigen::Index> index_;  ///< (points) number among the moved needle's contacts, of those in points_
  VecX start_;                       ///< [N] (3 own) forces on the moved needle's contacts at the start of the sub-step
  VecX moved_;                       ///< [mm] (3 own) what displacement() says without E
  Look last_;
  Drift drift_;
  WorkSpace work_;
};

}  // namespace stylet
