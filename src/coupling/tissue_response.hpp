// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/contacts/shaft_contact.hpp"
#include "coupling/tip_relief.hpp"
#include "coupling/tissue_memory.hpp"
#include "stylet/coupling/track.hpp"

#include <memory>
#include <vector>

namespace stylet {

/// How the tissue gives way to the needle: by its compliance among the contacts, where it stiffens under the tip by
/// less than that, and where it is viscous by what it remembers of earlier forces. Nothing allocates after construction
/// unless a comment says so.
class TissueResponse {
 public:
  /// @param relaxation_s τ [s] of the tissue, 0 = elastic
  /// @param needle_radius_mm as the tissue near the needle feels it
  /// @param points most points that are held or remembered at the same time, without the tip
  TissueResponse(std::unique_ptr<ContactCompliance> compliance, double relaxation_s, double needle_radius_mm,
                 int points);

  [[nodiscard]] ContactCompliance& compliance() { return *compliance_; }
  [[nodiscard]] const ContactCompliance& compliance() const { return *compliance_; }
  [[nodiscard]] bool is_viscous() const { return memory_.on(); }

  /// A sub-step of h seconds begins.
  void begin(double h) { memory_.begin(h); }
  /// Weight of this sub-step's forces in the displacement; 1 for elastic tissue.
  [[nodiscard]] double share() const { return memory_.share(); }
  /// [mm] LPS, displacement of a point by earlier forces alone, as far as the tissue is linear.
  [[nodiscard]] Vec3 past_displacement(int point) const { return memory_.displacement(*compliance_, point); }
  /// [mm] LPS, displacement of a point by all forces.
  [[nodiscard]] Vec3 displacement(int point, const ContactForces& contacts) const;
  /// The displacement that stiffening under the tip takes off the linear one; displacement() is without it.
  [[nodiscard]] TipRelief relief(const ContactForces& contacts) const;
  /// [mm/N] mean over the directions of how far a point gives way to a force on itself.
  [[nodiscard]] double own_yield(int point) const { return (*compliance_)(point, point).trace() / 3.0; }

  /// Forces on the points [N] (3 × points) by which u = A g goes: the present ones where the tissue is elastic, else
  /// filtered over time. In room of its own, good until the next call.
  Eigen::Ref<const MatX> filtered_forces(const ContactForces& contacts);
  /// The same. Allocates.
  [[nodiscard]] MatX filtered_forces_of_all(const ContactForces& contacts) const;
  /// The same of one point.
  [[nodiscard]] Vec3 filtered_force(int point, const ContactForces& contacts) const;
  /// Forces of the present contacts [N] (3 × points). Allocates.
  [[nodiscard]] MatX present_forces(const ContactForces& contacts) const;
  /// Elastic energy in the tissue [N mm], ½ fᵀ A f where it is linear; what a viscous tissue has stored.
  [[nodiscard]] double energy(const ContactForces& contacts) const;

  /// Where a point of the compliance is, and which way the piece of shaft runs that its force is spread over (LPS;
  /// zero: the force acts at a point).
  struct Place {
    MaterialPoint at;
    Vec3 along = Vec3::Zero();
  };
  [[nodiscard]] const Place& place(int point) const { return places_[static_cast<std::size_t>(point)]; }
  void set_place(int point, const Place& place) { places_[static_cast<std::size_t>(point)] = place; }

  /// The tip is at another place in the same material. @return whether compliance is there for that place; where not,
  /// that of the last place stands in for it
  bool move_tip(const MaterialPoint& at, const Vec3& x) { return compliance_->move_tip(at, x); }
  /// The same, and the tissue does not move by it.
  bool take_tip_compliance(const MaterialPoint& at, const Vec3& x);
  /// The tip touches material that it has not touched before, at the end of a track of length xi [mm].
  void begin_tip(double xi);

  /// A sub-step is over. What the tip has left behind, it hands over to the track.
  void end(const ContactForces& contacts, const Track& track);
  /// The last point of the track takes over a part of what is remembered at the tip.
  void leave_behind(const Track& track, double part);

  /// The needle is out: a viscous tissue goes on relaxing, an elastic one is at once what it was at first.
  void let_go();
  /// After a sub-step without contact. Once the tissue is still, it is what it was at first.
  void relax(const ContactForces& none);
  /// Whether the needle is out and the tissue not yet at rest.
  [[nodiscard]] bool is_relaxing() const { return relaxing_; }
  /// The tissue becomes what it was before the first contact.
  void reset();

 private:
  void gather(const ContactForces& contacts, Eigen::Ref<MatX> forces) const;
  void filter(Eigen::Ref<MatX> forces) const;

  std::unique_ptr<ContactCompliance> compliance_;
  TissueMemory memory_;
  double needle_radius_mm_;
  double tip_xi_ = 0.0;  ///< [mm] along the track, where the tip's share of the memory is
  bool relaxing_ = false;
  MatX forces_;                ///< [N] (3 × points) room
  std::vector<Place> places_;  ///< (points); the tip's is where it was held last
};

}  // namespace stylet
