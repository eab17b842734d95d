// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "coupling/contacts/shaft_contact.hpp"
#include "coupling/tip_relief.hpp"
#include "coupling/tissue_hold.hpp"
#include "coupling/tissue_memory.hpp"
#include "stylet/coupling/track.hpp"

#include <memory>
#include <span>
#include <vector>

namespace stylet {

/// The displacement of the tissue under the forces of the contacts: by its compliance, less where it stiffens under the
/// tip, and more where it creeps, the longer a force lasts. Nothing allocates after construction except where a comment
/// says so.
class TissueResponse {
 public:
  /// @param needle_radius_mm outer radius of the needle
  /// @param points largest number of points with a contact or a memory at the same time, without the tip
  TissueResponse(std::unique_ptr<ContactCompliance> compliance, const Creep& creep, double needle_radius_mm,
                 int points);

  [[nodiscard]] ContactCompliance& compliance() { return *compliance_; }
  [[nodiscard]] const ContactCompliance& compliance() const { return *compliance_; }

  /// While the needle that the hand moves is balanced alone, the contacts in all questions are its own, and all others
  /// are in `hold`; null: there are none. @param points of the own shaft contacts @param free points without a contact
  /// at rest, but for the tip
  void hold_by(const TissueHold* hold, std::span<const int> points = {}, std::span<const int> free = {}) {
    hold_ = hold;
    if (hold != nullptr) {
      memory_.gather(*compliance_, points, free);
    } else {
      memory_.release();
    }
  }
  [[nodiscard]] const TissueHold* hold() const { return hold_; }
  [[nodiscard]] const TissueMemory& memory() const { return memory_; }
  /// Changes whenever compliance_now() among points other than the tip has changed.
  [[nodiscard]] std::uint64_t version() const {
    return compliance_->version() + (hold_ != nullptr ? hold_->version() << 32u : 0u);
  }

  /// Begins a sub-step of h seconds.
  void begin(double h) {
    memory_.begin(h);
    compliance_->begin_sub_step();
  }
  /// The part of this sub-step's forces that is lasting at its end; 0 for elastic tissue.
  [[nodiscard]] double creep_share() const { return memory_.share(); }
  /// [mm/N] Displacement of a point by a force on another point during this sub-step: A, and the creep in this
  /// sub-step.
  [[nodiscard]] Mat3 compliance_now(int point, int other) const {
    const Mat3 own = own_compliance_now(point, other);
    return hold_ != nullptr ? Mat3(own - hold_->reduction(point, other)) : own;
  }
  /// The same without what needles at rest take off it.
  [[nodiscard]] Mat3 own_compliance_now(int point, int other) const {
    Mat3 now = (*compliance_)(point, other);
    if (const double share = memory_.share(); share > 0.0) now += share * compliance_->wide(point, other);
    return now;
  }
  /// Prepares past_displacement() for calls with many points.
  void gather_past() {
    if (hold_ == nullptr) memory_.gather(*compliance_);
  }
  /// [mm] LPS, displacement of a point by the lasting forces of earlier sub-steps.
  [[nodiscard]] Vec3 past_displacement(int point) const {
    const Vec3 lasting = memory_.displacement(*compliance_, point);
    return hold_ != nullptr ? Vec3(lasting + hold_->displacement(point)) : lasting;
  }
  /// [mm] LPS, displacement of a point by all forces.
  [[nodiscard]] Vec3 displacement(int point, const ContactForces& contacts) const;
  /// [mm] LPS, the part of displacement() to which the tissue has crept, the creep of this sub-step included.
  [[nodiscard]] Vec3 lasting_displacement(int point, const ContactForces& contacts) const;
  /// The relief, by which stiffening under the tip reduces the linear displacement; it is already subtracted in
  /// displacement().
  [[nodiscard]] TipRelief relief(const ContactForces& contacts) const;
  /// [mm/N] Displacement of a point per force on itself, mean over the directions.
  [[nodiscard]] double own_yield(int point) const { return (*compliance_)(point, point).trace() / 3.0; }

  /// The sum of present and lasting forces on the points [N] (3 × points), which displaces the mesh. A view of work
  /// space, valid until the next call.
  Eigen::Ref<const MatX> all_forces(const ContactForces& contacts);
  /// The force of the present contact on a point [N]; zero without a contact.
  [[nodiscard]] Vec3 present_force(int point, const ContactForces& contacts) const;
  /// The lasting force on a point [N]: the creep displacement is the wide part of the compliance times the lasting
  /// forces. Zero for elastic tissue.
  [[nodiscard]] Vec3 lasting_force(int point, const ContactForces& contacts) const;
  /// The same for all points (3 × points). Both allocate.
  [[nodiscard]] MatX present_forces(const ContactForces& contacts) const;
  [[nodiscard]] MatX lasting_forces(const ContactForces& contacts) const;
  /// Energy stored in the tissue [N mm]; ½ fᵀ A f for elastic, linear tissue.
  [[nodiscard]] double energy(const ContactForces& contacts) const;

  /// The place of a point of the compliance, and the direction of the piece of shaft over which its force is spread
  /// (unit vector LPS; zero: the force acts at a point).
  struct Place {
    MaterialPoint at;
    Vec3 along = Vec3::Zero();
  };
  [[nodiscard]] const Place& place(int point) const { return places_[static_cast<std::size_t>(point)]; }
  void set_place(int point, const Place& place) { places_[static_cast<std::size_t>(point)] = place; }

  /// Moves the tip to another place in the same material. @return whether the compliance there has been computed; if
  /// not, the compliance of the last place is used
  bool move_tip(const MaterialPoint& at, const Vec3& x) { return compliance_->move_tip(at, x); }
  /// Begins the memory of a tip that touches new material, at the end of a track of length xi [mm].
  void begin_tip(double xi);

  /// The forces on a point in earlier sub-steps were larger than those that the tissue remembers, together by `force`
  /// [N]. To be called in a sub-step.
  void make_up(int point, const Vec3& force) {
    if (memory_.on()) memory_.make_up(point, force);
  }

  /// Moves the memory of a tip that comes to rest to the point that stands for it from then on.
  void lay_tip_down(int point) {
    if (memory_.on()) memory_.hand_over(ContactCompliance::kTip, point, 1.0);
  }
  /// Moves it back from that point, −1 for none: the needle is taken up again, and its track ends at the arc length xi
  /// [mm].
  void take_tip_up(int point, double xi) {
    if (memory_.on() && point >= 0) memory_.hand_over(point, ContactCompliance::kTip, 1.0);
    tip_xi_ = xi;
  }

  /// Ends a sub-step. The track takes over the memory of the material that the tip has passed.
  void end(const ContactForces& contacts, const Track& track);
  /// Moves a part of the tip's memory to the last point of the track.
  void leave_behind(const Track& track, double part);

  /// The needle is out of the tissue: creep recovers over time; elastic tissue is reset at once.
  void let_go();
  /// Lets creep recover over a sub-step without contact. Once the tissue is at rest, it is reset.
  void relax(const ContactForces& none);
  /// Whether the needle is out and the creep has not recovered yet.
  [[nodiscard]] bool is_relaxing() const { return relaxing_; }
  /// Restores the state before the first contact.
  void reset();

 private:
  void gather(const ContactForces& contacts, Eigen::Ref<MatX> forces) const;

  std::unique_ptr<ContactCompliance> compliance_;
  TissueMemory memory_;
  const TissueHold* hold_ = nullptr;
  double reach_mm_;      ///< [mm] length of cut over which the track takes over the tip's memory
  double tip_xi_ = 0.0;  ///< [mm] arc length on the track of the tip's memory
  bool relaxing_ = false;
  MatX forces_;                ///< [N] (3 × points) work space
  std::vector<Place> places_;  ///< (points); the tip's is the place where it was last held
};

}  // namespace stylet
