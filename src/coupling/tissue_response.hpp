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
/// less than that, and where it creeps by more, the longer it bears a force. Nothing allocates after construction
/// unless a comment says so.
class TissueResponse {
 public:
  /// @param needle_radius_mm as the tissue near the needle feels it
  /// @param points most points that are held or remembered at the same time, without the tip
  TissueResponse(std::unique_ptr<ContactCompliance> compliance, const Creep& creep, double needle_radius_mm,
                 int points);

  [[nodiscard]] ContactCompliance& compliance() { return *compliance_; }
  [[nodiscard]] const ContactCompliance& compliance() const { return *compliance_; }

  /// A sub-step of h seconds begins.
  void begin(double h) {
    memory_.begin(h);
    compliance_->begin_sub_step();
  }
  /// How much of this sub-step's forces is lasting when it ends; 0 for elastic tissue.
  [[nodiscard]] double creep_share() const { return memory_.share(); }
  /// [mm/N] Displacement of a point by a force on another one that acts in this sub-step: A, and what creeps meanwhile.
  [[nodiscard]] Mat3 compliance_now(int point, int other) const {
    Mat3 now = (*compliance_)(point, other);
    if (const double share = memory_.share(); share > 0.0) now += share * compliance_->wide(point, other);
    return now;
  }
  /// Before past_displacement() is asked for of many points.
  void gather_past() { memory_.gather(*compliance_); }
  /// [mm] LPS, displacement of a point by what lasts of earlier forces.
  [[nodiscard]] Vec3 past_displacement(int point) const { return memory_.displacement(*compliance_, point); }
  /// [mm] LPS, displacement of a point by all forces.
  [[nodiscard]] Vec3 displacement(int point, const ContactForces& contacts) const;
  /// The displacement that stiffening under the tip takes off the linear one; displacement() is without it.
  [[nodiscard]] TipRelief relief(const ContactForces& contacts) const;
  /// [mm/N] mean over the directions of how far a point gives way to a force on itself.
  [[nodiscard]] double own_yield(int point) const { return (*compliance_)(point, point).trace() / 3.0; }

  /// Present and lasting forces on the points together [N] (3 × points): the mesh is displaced by these. In room of its
  /// own, good until the next call.
  Eigen::Ref<const MatX> all_forces(const ContactForces& contacts);
  /// The force of the present contact on a point [N]; zero where none is.
  [[nodiscard]] Vec3 present_force(int point, const ContactForces& contacts) const;
  /// The lasting force on a point [N]: the tissue has crept as far as such forces move it through the wide part of the
  /// compliance. Zero for elastic tissue.
  [[nodiscard]] Vec3 lasting_force(int point, const ContactForces& contacts) const;
  /// The same of all points (3 × points). Allocate.
  [[nodiscard]] MatX present_forces(const ContactForces& contacts) const;
  [[nodiscard]] MatX lasting_forces(const ContactForces& contacts) const;
  /// Energy stored in the tissue [N mm]: ½ fᵀ A f where it is elastic and linear.
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
  /// The tip touches material that it has not touched before, at the end of a track of length xi [mm].
  void begin_tip(double xi);

  /// A sub-step is over. What the tip has left behind, it hands over to the track.
  void end(const ContactForces& contacts, const Track& track);
  /// The last point of the track takes over a part of what is remembered at the tip.
  void leave_behind(const Track& track, double part);

  /// The needle is out: what has crept goes back in time, elastic tissue is at once what it was at first.
  void let_go();
  /// After a sub-step without contact. Once the tissue is still, it is what it was at first.
  void relax(const ContactForces& none);
  /// Whether the needle is out and the tissue not yet at rest.
  [[nodiscard]] bool is_relaxing() const { return relaxing_; }
  /// The tissue becomes what it was before the first contact.
  void reset();

 private:
  void gather(const ContactForces& contacts, Eigen::Ref<MatX> forces) const;

  std::unique_ptr<ContactCompliance> compliance_;
  TissueMemory memory_;
  double reach_mm_;      ///< of the cut, over which the track takes over what is remembered at the tip
  double tip_xi_ = 0.0;  ///< [mm] along the track, where the tip's share of the memory is
  bool relaxing_ = false;
  MatX forces_;                ///< [N] (3 × points) room
  std::vector<Place> places_;  ///< (points); the tip's is where it was held last
};

}  // namespace stylet
