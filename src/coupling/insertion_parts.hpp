// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "contact_system.hpp"
#include "effort.hpp"
#include "paper/staggered.hpp"
#include "stylet/coupling/insertion.hpp"
#include "tissue_memory.hpp"

#include <cmath>
#include <deque>
#include <limits>
#include <optional>

namespace stylet {

/// A place where shaft and tissue hold each other.
struct Grip {
  enum class State {
    stick,
    forward,
    backward
  };  ///< forward: the needle slides into the tissue, friction pushes it along

  int point = -1;          ///< in ContactCompliance
  double xi = 0.0;         ///< [mm] along the track
  Vec3 x = Vec3::Zero();   ///< [mm] tissue point, undeformed
  double s = 0.0;          ///< [mm] where on the needle it is now
  double s_start = 0.0;    ///< … at the start of the sub-step
  double slid = 0.0;       ///< [mm] along the needle in the last sub-step, …
  double slid_more = 0.0;  ///< [mm] … and how much of that was beyond what was in proportion to the one before
  double softness = 0.0;   ///< [mm/N] a young contact yields this much: it comes alive and dies without a jump
  double length = 0.0;     ///< [mm] tributary length
  FrictionLaw law;
  State state = State::stick;
  bool fast = false;          ///< slides faster than friction grows with speed
  double coulomb = 0.0;       ///< [N] sliding friction, continued to speed 0 from the present speed
  double slip = 0.0;          ///< [mm/N] by which it slides in this sub-step for each newton beyond that
  double reach = 0.0;         ///< [mm] by which it slides in this sub-step at the speed where friction stops growing
  int toggles = 0;            ///< changes of state in this sub-step
  Vec3 force = Vec3::Zero();  ///< [N] on the tissue
  Vec3 force_start = Vec3::Zero();  ///< … at the start of the sub-step
  Vec3 gained = Vec3::Zero();       ///< [N] by which it changed in the last sub-step, …
  Vec3 gained_more = Vec3::Zero();  ///< [N] … and how much of that was beyond what was in proportion to the one before
};

/// The tip against the end of its track.
struct Tip {
  enum class State { open, stick, cut };

  State state = State::open;
  bool touching = false;  ///< there is an end of a track to push against
  Vec3 x = Vec3::Zero();  ///< [mm] end of the track, undeformed
  MaterialPoint at;
  Vec3 x_start = Vec3::Zero();  ///< … at the start of the sub-step
  MaterialPoint at_start;
  Vec3 direction = Vec3::UnitZ();  ///< in which cutting moves x (unit, undeformed)
  double advance = 0.0;            ///< [mm] cut in this sub-step
  bool blocked = false;            ///< the cut met a surface in this sub-step
  Crossing crossing;               ///< that surface
  bool stale = false;              ///< its compliance is that of an earlier place, none is there where it is
  bool at_membrane = false;        ///< x lies on a surface that has not been broken
  Vec3 into_body = Vec3::Zero();   ///< inward normal of that surface if it is the patient's, zero within the patient
  Index next_tet = -1;             ///< element behind that surface, -1 = outside the patient
  double limit = 0.0;              ///< [N] force that starts the cut
  double cutting = 0.0;            ///< [N] force that keeps it going
  double lateral_softness = 0.0;   ///< [mm/N]; infinite: the tip is not held sideways
  int toggles = 0;
  Vec3 force = Vec3::Zero();        ///< [N] on the tissue
  Vec3 force_start = Vec3::Zero();  ///< … at the start of the sub-step
  Vec3 gained = Vec3::Zero();       ///< [N] by which it changed in the last sub-step, …
  Vec3 gained_more = Vec3::Zero();  ///< [N] … and how much of that was beyond what was in proportion to the one before
};

constexpr int kTryWithout = 16;  ///< tangents on springs, then one without
constexpr int kFewSprings = 6;   ///< as a rule enough

struct Insertion::Parts {
  Parts(InsertionTissue tissue_, std::unique_ptr<Needle> needle_, const CouplingSettings& settings_);

  InsertionTissue tissue;
  std::unique_ptr<Needle> needle;
  CouplingSettings settings;
  std::unique_ptr<ContactCompliance> owned_compliance;
  ContactCompliance& compliance;
  ComplianceSupply supply;
  TissueMemory memory;
  double memory_xi = 0.0;  ///< [mm] along the track, where the tip's share of the memory is
  bool relaxing = false;   ///< the needle is out, the tissue not yet at rest
  Pose base;
  TipPhase phase = TipPhase::air;
  Vec3 air_tip = Vec3::Zero();  ///< where the tip was, in undeformed coordinates, while it is in the air
  Track track;
  std::vector<Track> old_tracks;  ///< the first old_count are in use, the rest is room
  std::size_t old_count = 0;
  int joined = -1;          ///< old track this insertion runs in
  std::vector<Grip> grips;  ///< grip k sits on mark k of the track
  Tip tip;
  Eigen::Vector<double, 6> last_motion = Eigen::Vector<double, 6>::Zero();  ///< of the base in the last sub-step
  double last_way = 0.0;          ///< [mm] of the base along its axis in the last sub-step …
  double last_cut = 0.0;          ///< [mm] … and of the tip through tissue, …
  double cut_more = 0.0;          ///< [mm] … of which beyond what was in proportion to the one before
  Vec3 tip_start = Vec3::Zero();  ///< [mm] the needle's at the start of the sub-step, with the base of its end
  VecX shape_start;               ///< Needle::state() at the start of the sub-step …
  VecX shape_gained;              ///< … and by how much it changed in the last one, …
  VecX shape_more;                ///< … of which beyond what was in proportion to the one before
  double force_share = 0.0;  ///< forces and shape are expected to change so many times as much as in the last sub-step,
  double force_trend = 0.0;  ///< and so many times what was beyond proportion then comes again; 0 = not known
  double way_share = 0.0;    ///< the same of slides and the cut
  double way_trend = 0.0;
  bool going_on = false;      ///< the balance is solved from there
  bool steady = false;        ///< the last sub-step was balanced soon, and the tip kept its state in it
  double candidate_xi = 0.0;  ///< next place on the track where a contact may be laid
  Vec3 rows_complete_at = Vec3::Constant(std::numeric_limits<double>::infinity());  ///< the tip in the last prepare() …
  std::uint64_t rows_arrived = 0;                  ///< … and ComplianceStore::arrived()
  std::optional<NeedleWhereabouts> awaited_entry;  ///< surface met where no compliance is there yet
  bool went_past_surface = false;                  ///< … and gone too far beyond: it is to be drawn out first
  void forget_entry() {
    awaited_entry.reset();
    went_past_surface = false;
  }
  CapacityUses capacities;
  Index nodes_at_start = 0;  ///< in the store
  PhaseObserver* phases = nullptr;

  // Scratch of the equilibrium, sized once.
  std::vector<PointLoad> loads;  ///< tip first, then the grips: the needle's side, −force
  std::vector<Vec3> shaft;       ///< [mm] needle at each load; past its ends, straight on
  std::vector<Vec3> past;        ///< [mm] by which earlier forces displace the tissue at each load
  ContactSystem system;
  std::vector<Mat3>& frames = system.frame;
  std::vector<Mat3> springs;       ///< [N/mm] lent to the needle at each load
  std::vector<int> system_points;  ///< points whose compliance system.A holds, …
  unsigned system_version = 0;     ///< … as of this version of it, …
  double system_share = 0.0;       ///< … and times this share
  Vec3 system_tip = Vec3::Zero();  ///< [mm] where the tip was then, …
  bool system_stale = false;       ///< … and its compliance was that of another place
  MatX tip_slope;  ///< [1/N] (3 contacts × 3) by how much A's columns of the tip change per mm of cut …
  Vec3 slope_at = Vec3::Zero();  ///< [mm] … where the tip was then
  double damping_ratio = 0.0;    ///< Needle::damp() of this sub-step, …
  double tangent_damping = 0.0;  ///< … and of the one whose tangent is in use
  double on_bone_for = 0.0;      ///< [s] the tip, without a break
  bool balanced = true;          ///< the last sub-step
  double rescue_s = 0.0;         ///< damping since one was not
  bool foresees_cut = true;      ///< the equations know that compliance changes as the cut goes on
  int supported_for = 0;         ///< tangents on springs since one without was tried
  bool tangent_fits = false;     ///< the needle's tangent is of these contacts
  bool matrix_fits = false;      ///< the system's matrix is of that tangent and compliance
  /// A tangent and matrix for steps to come: what of them is there.
  struct Preparation {
    enum class Stage { none, begun, tangent, compliance, filled, matrix } stage = Stage::none;
    int lent = 0;             ///< most springs, 0 = none
    std::vector<int> points;  ///< of the contacts they are of
    double worn_mm = 0.0;     ///< way of the base since those in use were made
  } preparation;
  /// An iterate, before an old matrix is tried on it.
  struct Iterate {
    struct AtGrip {
      Vec3 force = Vec3::Zero();
      double s = 0.0;
    };
    VecX needle;
    Vec3 tip_force = Vec3::Zero();
    double advance = 0.0;
    std::vector<AtGrip> grips;
  } kept;
  std::unique_ptr<paper::Staggered> staggered;  ///< where that solver is chosen
  int toggle_limit = 0;                         ///< a contact that changes its state more often is frozen
  Vec3 hand_start = Vec3::Zero();               ///< [N] of the hand at the start of the sub-step
  MatX forces;                                  ///< (3 × points) on the tissue
  std::vector<MaterialPoint> point_at;          ///< (points) where they are; the tip's is where it was held last
  std::vector<Vec3> point_along;                ///< (points) direction of their pieces of shaft; zero for the tip

  // gathering.cpp: where contacts and forces are, and the equations among them.
  [[nodiscard]] double arc_of(int load) const;
  [[nodiscard]] Vec3 shaft_point(int load) const;  ///< [mm] needle at a contact; past its ends, straight on
  [[nodiscard]] Vec3 tissue_displacement(int point) const;
  void gather_forces();
  void set_frames();
  void fill_loads();
  [[nodiscard]] double slip_of_cut(double h) const;  ///< [mm/N] by which the tip goes on in a sub-step
  void soften_rows(double h);
  int renew_contacts();
  void append_contact(int load);
  void gather_tip_columns(double share, int same);
  void gather_drift();
  void gather_system();

  // equilibrium.cpp: one sub-step's balance of needle, tissue, friction and cutting.
  void solve_equilibrium(double h, Effort& effort, StepReport& report);
  void begin_balance(int most_toggles);
  void keep_iterate();
  [[nodiscard]] bool went_astray(double largest_at_start) const;
  void go_back();
  void linearise(Effort& effort);
  [[nodiscard]] bool relax_needle();
  void lend_springs(int most, std::vector<LentSpring>& lent);
  [[nodiscard]] bool pivot(double h, Effort& effort, StepReport& report, bool& changed);
  /// What a solution says of a contact.
  struct Trial {
    double axial = 0.0;    ///< [N] force on the tissue
    double slides = 0.0;   ///< [mm] in this sub-step, in the sense of its state
    double opening = 0.0;  ///< [N] what an open tip would take if it were held
  };
  [[nodiscard]] Trial trial(int load) const;
  [[nodiscard]] double contradiction(int load, const Trial& trial) const;
  [[nodiscard]] static double way(const Grip& grip, double axial);
  void change_state(int load, const Trial& trial, StepReport& report);
  void change_and_tell(int load, StepReport& report);
  void slide(int load);
  [[nodiscard]] ContactSystem::TipRows tip_rows() const;
  [[nodiscard]] double equation_error() const;
  [[nodiscard]] double imbalance_over_tolerance() const;
  [[nodiscard]] double largest_force() const;

  [[nodiscard]] double damping_s(double h);
  void damp_needle(double ratio);

  // preparation.cpp: the next tangent, in pieces.
  void prepare_tangent();
  bool prepare_on_springs();
  [[nodiscard]] bool prepared_contacts_are_there() const;
  void take_prepared_tangent();
  void forget_preparation() { preparation.stage = Preparation::Stage::none; }

  // expectation.cpp: where the balance is solved from.
  void keep_start();
  void expect(const Pose& from, const Pose& to);  ///< how far all will go; contacts that slide go at once
  void go_on();                                   ///< the rest, once the cut is aimed
  void stay();                                    ///< where there is no balance: as all was
  void keep_gains(double cut);                    ///< @param cut [mm] by the tip in the sub-step

  // paper/staggered.cpp: the same balance, needle and tissue in turn.
  void solve_staggered(double h, StepReport& report);
  void condense_tissue();
  void impose_needle_on_tissue(double h);
  void solve_tissue(double h);
  bool switch_contacts(StepReport& report);
  void load_needle();
  [[nodiscard]] double loaded_arc(double s) const;  ///< [mm] where on the needle a force at s is put
  [[nodiscard]] double imbalance() const;
  bool cut(bool nearly);
  void bend_needle();

  /// The tip is held by what is ahead of it.
  [[nodiscard]] bool tip_holds() const { return tip.touching && tip.state != Tip::State::open; }
  [[nodiscard]] bool on_bone() const { return tip.touching && tip.state == Tip::State::stick && std::isinf(tip.limit); }
  [[nodiscard]] double length() const { return needle->length(); }
  [[nodiscard]] int load_count() const { return 1 + static_cast<int>(grips.size()); }
  [[nodiscard]] int point_of(int load) const {
    return load == 0 ? ContactCompliance::kTip : grips[static_cast<std::size_t>(load - 1)].point;
  }
  [[nodiscard]] Vec3& force_of(int load) {
    return load == 0 ? tip.force : grips[static_cast<std::size_t>(load - 1)].force;
  }
  [[nodiscard]] const Vec3& material_of(int load) const {
    return load == 0 ? tip.x : grips[static_cast<std::size_t>(load - 1)].x;
  }
  /// Where the tissue at a contact would be without the forces of now.
  [[nodiscard]] Vec3 unloaded(int load) const { return material_of(load) + past[static_cast<std::size_t>(load)]; }

  // bevel.cpp: what an asymmetric tip does.
  [[nodiscard]] Vec3 lead_of_bevel(const Vec3& tangent) const;
  [[nodiscard]] double tip_lateral_softness() const;
  [[nodiscard]] bool tip_lateral_rows() const;
  [[nodiscard]] Vec3 bevel_force() const;

  // cutting.cpp: the tip, its track and surfaces.
  void aim_tip();
  void march(double advance);
  [[nodiscard]] bool membrane_gives() const;
  void break_membrane(StepReport& report);
  void take_back_cut();
  void commit_tip(StepReport& report);
  void cross_surface(StepReport& report);
  bool enter(const Vec3& from, const Vec3& to, StepReport& report);
  void take_compliance();
  [[nodiscard]] bool tip_waits() const { return tip.touching && tip.stale; }
  [[nodiscard]] bool contact_waits() const;
  [[nodiscard]] NeedleWhereabouts whereabouts() const;
  void touch_surface(const Crossing& crossing, const Vec3& x, StepReport& report, InsertionEventKind kind);
  [[nodiscard]] int old_track_at(const Vec3& x, const Vec3& direction) const;
  void begin_track(const Vec3& x, const Vec3& direction);
  void join_track(int old, const Vec3& x);
  void begin_at(const Vec3& entry);
  [[nodiscard]] int region_of(Index tet) const;

  // contacts.cpp: laying, waking and dropping of shaft contacts.
  [[nodiscard]] Placement placement_of_contacts() const;
  void lay_marks(const Vec3& from, double from_xi, const MaterialPoint& from_at, StepReport& report);
  void lay_node_addition_on_faces(const Vec3& from, double from_xi, Index tet, StepReport& report);
  bool lay_mark(double xi, const Vec3& x, const MaterialPoint& at, Placement placement, const Vec3& travel,
                StepReport& report);
  [[nodiscard]] bool follows_from(int point, std::size_t marks) const;
  void wake_and_drop(StepReport& report);
  [[nodiscard]] double passed_by(const Grip& grip) const;
  void share_length();
  [[nodiscard]] bool has_left(bool drawn_out) const;
  void finish_insertion(StepReport& report);
  void settle_in_air(StepReport& report);

  // viscosity.cpp: what the tissue remembers of earlier forces.
  void gather_filtered_forces();
  void remember();
  void leave_memory_behind(double part);
  void relax();
  void forget_tissue();

  void note_use();
  void sub_step(const Pose& pose, double h, StepReport& report);
  void summarise(StepReport& report) const;
  [[nodiscard]] bool in_tissue(const Vec3& x) const;
  [[nodiscard]] std::optional<Vec3> surface_behind(const Vec3& tip_now) const;
  [[nodiscard]] Vec3 hand_force() const;
  static void add_event(StepReport& report, InsertionEventKind kind, int region,
                        double force_N = std::numeric_limits<double>::quiet_NaN());
  [[nodiscard]] double force_at_break() const;
};

}  // namespace stylet
