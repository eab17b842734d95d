// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/insertion.hpp"

#include "coupling/balance/lone_balance.hpp"
#include "coupling/balance/needle_bundle.hpp"
#include "coupling/needle_in_tissue.hpp"
#include "coupling/paper/staggered_balance.hpp"
#include "coupling/room_watch.hpp"
#include "stylet/coupling/near_field/near_field_compliance.hpp"
#include "stylet/coupling/paper/inverse_compliance.hpp"
#include "stylet/coupling/track_compliance.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <utility>

namespace stylet {

namespace {
/// Largest number of sub-steps in a step. Raised, faster motions are followed and the longest step takes longer.
constexpr int kMaxSubSteps = 64;
/// A sub-step without a balance is repeated in this many parts, each with its part of the base's motion, and so is each
/// part. Raised, a needle that snaps is followed in fewer rounds, and more parts are taken than are needed.
constexpr int kParts = 4;
/// How often a sub-step is divided. With the staggered solver, whose balances take long, only once. Raised, balances
/// are found for shorter parts, and a step without any takes longer.
constexpr int kMostLevels = 3;
/// [mm] Distance of a bent shaft from its axis that is rarely exceeded. Raised, a needle that is rolled takes more
/// sub-steps.
constexpr double kBent_mm = 10.0;
/// Largest number of Newton steps for a needle in the air. Raised, a needle that does not settle costs more.
constexpr int kMostInAir = 50;
/// [N] Out-of-balance moment over the needle's length below which a needle in the air has settled.
constexpr double kSettled_N = 1e-10;
/// Softness of the lateral hold of a tip whose hold the shaft has taken over, over the tissue's own compliance. Raised,
/// it bears less across the needle, and a matrix is outdated when the needle turns a little.
constexpr double kNotHeld = 1e3;

std::unique_ptr<ContactCompliance> engine_of(const InsertionTissue& tissue, const CouplingSettings& settings,
                                             int capacity) {
  using Engine = CouplingSettings::Engine;
  if (settings.engine == Engine::condensed) {
    using Method = CouplingSettings::Method;
    const bool interpolates = settings.method == Method::near_field || settings.method == Method::embedded;
    return std::make_unique<TrackCompliance>(tissue.store, *tissue.locator, capacity, interpolates ? 0 : capacity);
  }
  const auto engine =
      settings.engine == Engine::bcs ? paper::DenseInverse::Engine::bcs : paper::DenseInverse::Engine::woodbury;
  const bool move_nodes = settings.method == CouplingSettings::Method::node_repositioning;
  return std::make_unique<paper::InverseCompliance>(tissue.store->shared_tissue(), *tissue.locator, tissue.inverse,
                                                    engine, move_nodes, capacity);
}

/// Largest number of points with a contact or a memory: an insertion may begin while the tissue still has the memory of
/// the one before.
int most_points(const CouplingSettings& settings) {
  return settings.creep.is_any() ? most_shaft_contacts(settings) + settings.capacity : most_shaft_contacts(settings);
}

/// Without a mesh kernel, the near-field method starts with an empty one, which prepare() fills.
InsertionTissue with_kernel(InsertionTissue tissue, const CouplingSettings& settings) {
  if (settings.method == CouplingSettings::Method::near_field && !tissue.kernel)
    tissue.kernel = std::make_shared<MeshKernel>(tissue.store->shared_tissue(), tissue.locator->topology());
  return tissue;
}

std::unique_ptr<ContactCompliance> make_compliance(const InsertionTissue& tissue, const CouplingSettings& settings,
                                                   int capacity) {
  auto engine = engine_of(tissue, settings, capacity);
  if (settings.method != CouplingSettings::Method::near_field) return engine;
  const NeedleKernel needle{settings.needle_radius_mm, settings.spacing_mm};
  std::vector<double> stiffening_MPa;
  if (knows_stiffening(settings)) {
    for (const RegionLaws& laws : tissue.laws) stiffening_MPa.push_back(laws.stiffening_MPa);
  }
  return std::make_unique<NearFieldCompliance>(std::move(engine), tissue.store->shared_tissue(), tissue.kernel, needle,
                                               capacity, std::move(stiffening_MPa), settings.creep.is_any(),
                                               tissue.spread);
}
}  // namespace

/// The parts of an insertion, and the order in which they act in a sub-step. docs/architecture.md draws them.
struct Insertion::Parts {
  Parts(InsertionTissue mesh_, std::unique_ptr<Needle> needle_, const CouplingSettings& settings_);

  Result<int> add_needle(std::unique_ptr<Needle> needle);
  Result<> take_up(int number);
  void place(const Pose& pose);
  Step step(const Pose& pose, double dt);
  void sub_step(const Pose& pose, double h, Step& step);
  /// @return false where the needle stays in the air
  bool enter(Step& step);
  bool find_balance(double h, bool may_give_up, Step& step);
  double end_balance(double h, bool on_bone, bool found, Step& step);
  bool move_on(const Pose& from, const Pose& to, double h, int level, Step& step);
  void end_move(double h, Step& step);
  void move_in_parts(const Pose& from, const Pose& to, double h, int level, Step& step);
  void finish_insertion(Step& step);
  void forget_tangents();
  void settle_in_air(Step& step);
  void summarise(Step& step) const;
  void share_length() { held->path.tip.hand_over(held->shaft.share_length(held->path.tracks.now)); }
  void make_balance();
  [[nodiscard]] bool rest_tip();
  void raise_tip();

  /// The forces of all contacts, and those of the held needle alone.
  [[nodiscard]] ContactForces forces() const { return {held->path.tip.force, held->shaft.all()}; }
  /// The same for those who look at them between steps.
  [[nodiscard]] ContactForces shown_forces() const {
    if (alone) alone->show();
    return forces();
  }
  [[nodiscard]] ContactForces own_forces() const { return {held->path.tip.force, std::as_const(held->shaft).own()}; }
  /// Whether another needle is in the tissue.
  [[nodiscard]] bool others_rest() const;
  [[nodiscard]] bool contact_waits() const;
  [[nodiscard]] NeedleWhereabouts whereabouts() const;
  /// The held needle, together with the needles at rest that have contacts.
  [[nodiscard]] Needle& needles_in_balance() const { return bundle ? *bundle : *held->needle; }

  InsertionTissue mesh;
  CouplingSettings settings;
  TissueResponse tissue;
  ComplianceSupply supply;
  std::vector<std::unique_ptr<NeedleInTissue>> needles;
  NeedleInTissue* held = nullptr;  ///< the needle that the hand moves
  std::unique_ptr<NeedleBundle> bundle;
  std::unique_ptr<Predictor> predictor;
  std::unique_ptr<BalanceSolver> balance;
  std::unique_ptr<LoneBalance> alone;  ///< of the held needle, where many contacts rest
  RoomWatch room;
  int first_level = 0;    ///< parts of this level are tried first in the next sub-step; 0: all of it
  int deepest_level = 0;  ///< the deepest level of this sub-step
};

namespace {
/// Pose of the base after `part` of `parts` equal parts of a motion; after the last part it is `to`, bit for bit.
Pose between(const Pose& from, const Pose& to, int part, int parts) {
  if (part == 0) return from;
  if (part == parts) return to;
  const double fraction = static_cast<double>(part) / parts;
  return {.origin = from.origin + fraction * (to.origin - from.origin),
          .rotation = from.rotation.slerp(fraction, to.rotation)};
}
}  // namespace

Insertion::Parts::Parts(InsertionTissue mesh_, std::unique_ptr<Needle> needle_, const CouplingSettings& settings_)
    : mesh(with_kernel(std::move(mesh_), settings_)),
      settings(settings_),
      tissue(make_compliance(mesh, settings, most_points(settings)), settings.creep, settings.needle_radius_mm,
             most_points(settings)),
      supply(mesh.store->shared_tissue(), settings.engine == CouplingSettings::Engine::condensed ? mesh.store : nullptr,
             settings.method == CouplingSettings::Method::near_field ? mesh.kernel : nullptr, *mesh.locator),
      room(settings, *mesh.store) {
  needles.push_back(std::make_unique<NeedleInTissue>(mesh, settings, std::move(needle_), tissue));
  held = needles.front().get();
  make_balance();
}

bool Insertion::Parts::others_rest() const {
  return std::any_of(needles.begin(), needles.end(),
                     [&](const auto& needle) { return needle.get() != held && !needle->in_air(); });
}

/// Makes predictor and solver anew for the held needle and the contacts of those at rest.
void Insertion::Parts::make_balance() {
  std::vector<NeedleBundle::AtRest> at_rest;
  for (const ShaftContact& contact : held->shaft.all().first(held->shaft.others())) {
    const auto of = std::find_if(needles.begin(), needles.end(),
                                 [&](const auto& needle) { return needle->needle.get() == contact.needle; });
    if (at_rest.empty() || at_rest.back().needle != contact.needle) at_rest.push_back({(*of)->needle.get(), 0});
    ++at_rest.back().contacts;
  }
  alone.reset();
  balance.reset();
  bundle.reset();
  if (!at_rest.empty()) bundle = std::make_unique<NeedleBundle>(*held->needle, at_rest, settings.capacity + 1);
  predictor = std::make_unique<Predictor>(needles_in_balance().state().size());
  const BalanceParts parts{.settings = settings,
                           .contacts = {needles_in_balance(), tissue, held->path.tip, held->shaft, bundle.get()},
                           .path = held->path,
                           .hand = held->hand,
                           .predictor = *predictor,
                           .most_contacts = static_cast<int>(held->shaft.others()) + settings.capacity};
  if (settings.solver == CouplingSettings::Solver::staggered) {
    balance = std::make_unique<paper::StaggeredBalance>(parts);
  } else {
    auto whole = std::make_unique<CoupledBalance>(parts);
    if (held->shaft.others() >= static_cast<std::size_t>(settings.follow_from)) {
      alone = std::make_unique<LoneBalance>(parts, *whole, *held->needle, most_points(settings) + 1);
    }
    balance = std::move(whole);
  }
}

Result<int> Insertion::Parts::add_needle(std::unique_ptr<Needle> needle) {
  const auto there = static_cast<int>(needles.size());
  if (there >= settings.needles)
    return failure("Insertion::add_needle", fmt::format("the tissue has room for {} needle(s)", there),
                   "Raise CouplingSettings::needles");
  if (settings.solver != CouplingSettings::Solver::coupled || settings.engine != CouplingSettings::Engine::condensed)
    return failure("Insertion::add_needle", "several needles in one tissue are not possible with these settings",
                   "Choose the coupled solver and the condensed engine");
  needles.push_back(std::make_unique<NeedleInTissue>(mesh, settings, std::move(needle), tissue));
  return there;
}

/// The held needle is about to rest: a contact of its own stands for its tip, if the tip presses.
/// @return false where there is no room for that contact
bool Insertion::Parts::rest_tip() {
  TipContact& tip = held->path.tip;
  held->tip_point = -1;
  if (!tip.holds()) {
    tissue.leave_behind(held->path.tracks.now, 1.0);
    return true;
  }
  const ContactCompliance::Added added = tissue.compliance().add(tip.cut.at(), tip.cut.x(), Placement::embedded);
  if (added.point < 0) return false;
  held->tip_point = added.point;
  tissue.set_place(added.point, {tip.cut.at(), Vec3::Zero()});
  tissue.lay_tip_down(added.point);
  const Needle& needle = *held->needle;
  ShaftContact contact;
  contact.needle = &needle;
  contact.point = added.point;
  contact.xi = held->path.tracks.now.end_xi;
  contact.s = contact.s_start = needle.length();
  contact.length = 1.0;
  contact.presses_only = true;
  contact.law = {.static_N_per_mm = tip.ahead.limit(),
                 .coulomb_N_per_mm = tip.ahead.cutting(),
                 .viscous_Ns_per_mm2 = settings.tip_viscosity_Ns_per_mm};
  contact.force = tip.force;
  contact.softness = tip.has_lateral_rows() ? tip.lateral_softness() : kNotHeld * tissue.own_yield(added.point);
  tip.force.setZero();
  held->shaft.add(contact);
  // The point's own compliance differs a little from the tip's. Its material place is chosen such that it lies where
  // the tip is.
  ShaftContact& laid = held->shaft.all().back();
  laid.x = needle.point(needle.length()) - tissue.displacement(laid.point, forces());
  return true;
}

/// The held needle has been taken up: its tip presses the tissue again.
void Insertion::Parts::raise_tip() {
  held->path.take_up();
  tissue.take_tip_up(held->tip_point, held->path.tracks.now.end_xi);
  if (held->tip_point < 0) return;
  const ShaftContact contact = held->shaft.all().back();
  held->shaft.remove_last();
  held->tip_point = -1;
  TipContact& tip = held->path.tip;
  using State = ShaftContact::State;
  if (contact.state == State::backward) {
    tip.set_state(TipContact::State::open);
    return;
  }
  tip.force = contact.force;
  tip.set_state(contact.state == State::forward ? TipContact::State::cut : TipContact::State::stick);
}

Result<> Insertion::Parts::take_up(int number) {
  if (number < 0 || number >= static_cast<int>(needles.size()))
    return failure("Insertion::take_up", fmt::format("there is no needle {}", number),
                   fmt::format("Give a number from 0 to {}", needles.size() - 1));
  NeedleInTissue* const next = needles[static_cast<std::size_t>(number)].get();
  if (next == held) return Ok{};
  if (alone) alone->settle();
  if (!rest_tip())
    return failure("Insertion::take_up", "there is no room for the contact of a tip that comes to rest",
                   "Raise CouplingSettings::capacity");
  alone.reset();  // it refers to the needle that comes to rest
  balance.reset();
  next->shaft.take_over(held->shaft);
  held = next;
  raise_tip();
  make_balance();
  room.forget();
  return Ok{};
}

/// The needle has one tangent, which the balance of all needles and that of the held one alone make anew in turn.
void Insertion::Parts::forget_tangents() {
  balance->forget_tangent();
  if (alone) alone->forget_tangent();
}

/// Solves for the needle's shape in the air, where only the guide bends it.
void Insertion::Parts::settle_in_air(Step& step) {
  MatX no_compliance(0, 0);
  VecX no_motion(0);
  for (int iteration = 0; held->needle->residual({}) > kSettled_N * held->needle->length(); ++iteration) {
    if (iteration == kMostInAir) {
      step.flags |= Step::not_converged;
      return;
    }
    forget_tangents();
    held->needle->linearise({}, no_compliance, no_motion);
    held->needle->advance({});
  }
}

/// The needle is out: the tissue is reset, or recovers from creep over time. The tracks are kept.
void Insertion::Parts::finish_insertion(Step& step) {
  held->path.finish();
  held->shaft.clear();
  balance->release();
  if (alone) alone->release();
  held->damping.forget();
  balance->damp(0.0);
  if (!others_rest()) tissue.let_go();
  held->needle->straighten();
  settle_in_air(step);
  held->path.come_out();
}

void Insertion::Parts::place(const Pose& pose) {
  Step unused;
  if (!held->path.in_air()) finish_insertion(unused);
  if (alone) alone->forget();
  if (tissue.is_relaxing()) tissue.reset();
  room.forget();
  forget_tangents();
  predictor->forget();
  held->base = pose;
  held->needle->set_base(pose);
  settle_in_air(unused);
  held->path.place_in_air(held->path.tip_now());
  held->path.events.forget();
}

/// Moves a needle in the air, and tests whether it meets the patient.
bool Insertion::Parts::enter(Step& step) {
  predictor->interrupt();
  if (alone) alone->interrupt();
  settle_in_air(step);
  const bool arrived = held->path.move_through_air(step);
  if (!held->path.in_air()) {
    share_length();
    return true;
  }
  if (!others_rest()) tissue.relax(forces());
  if (arrived) held->path.arrive(held->path.tip_now());
  return false;
}

/// Finds the balance of a sub-step, and lets the track grow by its cut.
/// @return false where there is no balance and the sub-step may be given up; everything but a surface that broke is
/// then restored to the start of the sub-step
bool Insertion::Parts::find_balance(double h, bool may_give_up, Step& step) {
  Effort effort(1 + static_cast<int>(held->shaft.count()), held->shaft.others() > 0);
  TipContact& tip = held->path.tip;
  const unsigned flags_before = std::exchange(step.flags, 0u);
  const bool on_bone = tip.is_on_bone();
  const bool steady = balance->solve(h, effort, step);
  const bool found = (step.flags & (Step::not_converged | Step::contact_cycling)) == 0;
  if (!found && may_give_up) {
    predictor->go_back(needles_in_balance(), tip, held->shaft.all());
    predictor->interrupt();
    step.flags = flags_before;
    return false;
  }
  const double cut = end_balance(h, on_bone, found, step);
  step.flags |= flags_before;
  predictor->end(cut, steady, needles_in_balance(), tip, held->shaft.all());
  if (alone) alone->balanced(h, found);
  return true;
}

/// Lets the track grow by the cut of a balance. @return its length [mm]
double Insertion::Parts::end_balance(double h, bool on_bone, bool found, Step& step) {
  TipContact& tip = held->path.tip;
  const double cut = tip.touches() ? tip.cut.advance() : 0.0;
  tip.cut_mm_per_s = cut / h;
  held->path.commit(step);
  held->damping.end(h, on_bone, found);
  return cut;
}

/// Moves the base from one pose to another in h seconds. @param level how often the sub-step has been divided
/// @return as find_balance()
bool Insertion::Parts::move_on(const Pose& from, const Pose& to, double h, int level, Step& step) {
  held->base = to;
  held->needle->set_base(to);
  tissue.begin(h);
  const double damping = held->damping.in_step(h, held->path.tip.is_on_bone(), level > 0) / h;
  if (alone && level == 0) {
    const bool on_bone = held->path.tip.is_on_bone();
    if (alone->solve(from, to, h, damping, step)) {
      alone->end(end_balance(h, on_bone, true, step));
      end_move(h, step);
      return true;
    }
  }
  if (alone && alone->gives_way()) {
    forget_tangents();
    predictor->interrupt();
  }
  balance->damp(damping);
  predictor->begin(from, to, needles_in_balance(), held->path.tip, held->shaft.all());
  balance->base_moved(predictor->last_motion());
  const int most_levels = settings.solver == CouplingSettings::Solver::staggered ? 1 : kMostLevels;
  if (!find_balance(h, level < most_levels, step)) return false;
  end_move(h, step);
  return true;
}

/// Contacts come and go after a balance, and the tissue remembers its forces.
void Insertion::Parts::end_move(double h, Step& step) {
  ContactStates::stick_where_slow(held->shaft.all(), h, settings.zero_band_mm_per_s);
  held->shaft.wake_and_drop(held->path.tracks.now, held->path.marks, held->path.tip.force, step);
  share_length();
  held->path.pass_open_end(forces(), step);
  tissue.end(forces(), held->path.tracks.now);
}

/// The same, as a whole or, where that has no balance, in parts. After a sub-step that needed parts the next one begins
/// with parts, one level less deep.
void Insertion::Parts::move_in_parts(const Pose& from, const Pose& to, double h, int level, Step& step) {
  if (level >= first_level && move_on(from, to, h, level, step)) {
    deepest_level = std::max(deepest_level, level);
    return;
  }
  for (int part = 1; part <= kParts; ++part)
    move_in_parts(between(from, to, part - 1, kParts), between(from, to, part, kParts), h / kParts, level + 1, step);
}

void Insertion::Parts::sub_step(const Pose& pose, double h, Step& step) {
  const Pose before = held->needle->base();
  held->hand.begin(own_forces(), held->damping.balanced());
  held->base = pose;
  held->needle->set_base(pose);
  tissue.begin(h);
  // Needles at rest have to be balanced even while the held needle is in the air: the tissue may have lost a needle, or
  // creep.
  if (held->in_air() && !enter(step) && !others_rest()) return;
  deepest_level = 0;
  balance->begin();
  move_in_parts(before, pose, h, 0, step);
  first_level = std::max(0, deepest_level - 1);
  const bool drawn_out = (pose.origin - before.origin).dot(pose.rotation * Vec3::UnitZ()) < 0.0;
  if (!held->in_air() && held->shaft.empty() && held->path.has_left(drawn_out)) finish_insertion(step);
}

Step Insertion::Parts::step(const Pose& pose, double dt) {
  Step step;
  held->path.events.forget();
  if (!pose.origin.allFinite() || !pose.rotation.coeffs().allFinite() || !(dt > 0.0) || !std::isfinite(dt)) {
    step.flags = Step::invalid_input;
    summarise(step);
    return step;
  }
  if (supply.awaits_step()) supply.serve(tissue.compliance(), whereabouts());
  const Pose from = held->base;
  // Motion of the shaft's points: tilting moves the whole needle, rolling moves only a bent needle.
  const double turn = 2.0 * std::acos(std::min(1.0, std::abs(from.rotation.dot(pose.rotation))));
  const double tilt = (pose.rotation * Vec3::UnitZ() - from.rotation * Vec3::UnitZ()).norm();
  const double way = (pose.origin - from.origin).norm() + tilt * held->needle->length() + turn * kBent_mm;
  int count = kMaxSubSteps;
  if (way <= kMaxSubSteps * settings.max_advance_mm) {
    count = std::max(1, static_cast<int>(std::ceil(way / settings.max_advance_mm)));
  } else {
    step.flags |= Step::too_fast;
  }
  for (int k = 1; k <= count; ++k) {
    const std::size_t before = tissue.compliance().remeshing().size();
    held->path.events.begin_sub_step(static_cast<double>(k) / count);
    sub_step(between(from, pose, k, count), dt / count, step);
    // Withdrawal resets all changes; a sub-step with a withdrawal creates no contact.
    const std::size_t after = tissue.compliance().remeshing().size();
    step.remeshings = after >= before ? step.remeshings + static_cast<int>(after - before) : 0;
  }
  room.note(held->shaft.own().size(), held->path.tracks.earlier().size());
  room.note_events(held->path.events.all().size());
  summarise(step);
  const bool explained = (step.flags & Step::compliance_missing) != 0;
  if (held->path.is_outside() && step.contacts == 0 && !explained && !held->path.lies_on_surface() &&
      held->path.in_tissue(step.tip_mm))
    step.flags |= Step::no_contact_inside;
  return step;
}

void Insertion::Parts::summarise(Step& step) const {
  const TipContact& tip = held->path.tip;
  const Vec3& at_base = held->base.origin;
  const double length = held->needle->length();
  step.base = held->base;
  step.tip_state = held->path.phase();
  step.tip_mm = held->needle->point(length);
  step.contacts = static_cast<int>(held->shaft.own().size()) + (tip.holds() ? 1 : 0);
  const PointLoad guide = held->needle->guide_load();
  step.guide_force_N = guide.force;
  step.hand_force_N = held->hand.now(own_forces());
  step.torque_Nmm = (held->needle->point(length) - at_base).cross(tip.force) -
                    (held->needle->point(guide.s) - at_base).cross(guide.force);
  double sliding = 0.0;
  double sliding_out = 0.0;
  for (const ShaftContact& contact : own_forces().shaft) {
    const double arc = paper::loaded_arc(settings, length, std::clamp(contact.s, 0.0, length));
    step.torque_Nmm += (held->needle->point(arc) - at_base).cross(contact.force);
    step.inserted_mm += contact.length;
    if (contact.sticks()) {
      ++step.sticking;
    } else {
      sliding += contact.length;
      if (contact.state == ShaftContact::State::backward) sliding_out += contact.length;
    }
  }
  if (tip.holds() && tip.state() == TipContact::State::stick) ++step.sticking;
  if (step.inserted_mm > 0.0) {
    step.sliding_share = sliding / step.inserted_mm;
    step.sliding_out_share = sliding_out / step.inserted_mm;
  }
}

/// Whether the next contact waits for its compliance.
bool Insertion::Parts::contact_waits() const {
  const std::vector<Track::Mark>& marks = held->path.tracks.now.marks;
  if (held->shaft.own().size() >= marks.size()) return false;
  const Track::Mark& next = marks[held->shaft.own().size()];
  return next.point < 0 && !tissue.compliance().available(next.at.tet);
}

/// Place where compliance is needed next: at the tip, then at the contact that waits behind the tip.
NeedleWhereabouts Insertion::Parts::whereabouts() const {
  if (held->path.tip.waits() || !contact_waits()) return held->path.whereabouts();
  const Track::Mark& next = held->path.tracks.now.marks[held->shaft.own().size()];
  return {next.x, held->needle->tangent(held->needle->length()), next.at.tet};
}

Insertion::Insertion(InsertionTissue tissue, std::unique_ptr<Needle> needle, const CouplingSettings& settings)
    : parts_(std::make_unique<Parts>(std::move(tissue), std::move(needle), settings)) {}
Insertion::~Insertion() = default;
Insertion::Insertion(Insertion&&) noexcept = default;
Insertion& Insertion::operator=(Insertion&&) noexcept = default;

Result<int> Insertion::add_needle(std::unique_ptr<Needle> needle) { return parts_->add_needle(std::move(needle)); }
Result<> Insertion::take_up(int needle) { return parts_->take_up(needle); }
int Insertion::needles() const { return static_cast<int>(parts_->needles.size()); }
int Insertion::held() const {
  const auto& all = parts_->needles;
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const auto& needle) { return needle.get() == parts_->held; });
  return static_cast<int>(at - all.begin());
}
const Needle& Insertion::needle(int number) const { return *parts_->needles[static_cast<std::size_t>(number)]->needle; }
const Track& Insertion::track(int number) const {
  return parts_->needles[static_cast<std::size_t>(number)]->path.tracks.now;
}
bool Insertion::in_tissue(int number) const { return !parts_->needles[static_cast<std::size_t>(number)]->in_air(); }

void Insertion::place(const Pose& base) { parts_->place(base); }
void Insertion::place_guide(const Vec3& hole, const Vec3& axis) { parts_->held->needle->place_guide(hole, axis); }
Step Insertion::step(const Pose& base, double dt) { return parts_->step(base, dt); }
std::span<const InsertionEvent> Insertion::events() const { return parts_->held->path.events.all(); }

void Insertion::prepare(double radius_mm) {
  Parts& p = *parts_;
  const bool waits = p.held->path.tip.waits() || p.contact_waits() || p.held->path.awaits_entry();
  if (!waits && p.room.is_complete_near(p.held->path.tip_now(), 0.25 * radius_mm)) return;
  p.supply.work_through(p.tissue.compliance(), p.whereabouts(),
                        {.radius_mm = radius_mm, .ahead_mm = 0.0, .spare_nodes = p.settings.spare_nodes});
  p.room.note(p.held->shaft.own().size(), p.held->path.tracks.earlier().size());
  p.room.complete_at(p.held->path.tip_now());
}

const ComplianceStore& Insertion::store() const { return *parts_->mesh.store; }
ComplianceSupply& Insertion::supply() { return parts_->supply; }
const Needle& Insertion::needle() const { return *parts_->held->needle; }
const ContactCompliance& Insertion::compliance() const { return std::as_const(parts_->tissue).compliance(); }
const CouplingSettings& Insertion::settings() const { return parts_->settings; }
const CapacityUses& Insertion::capacities() const { return parts_->room.uses(); }
const Track& Insertion::track() const { return parts_->held->path.tracks.now; }
std::span<const Track> Insertion::old_tracks() const { return parts_->held->path.tracks.earlier(); }

std::vector<ContactState> Insertion::contacts() const {
  std::vector<ContactState> result(parts_->held->shaft.own().size() + 1);
  result.resize(contacts(result));
  return result;
}

std::size_t Insertion::contacts(std::span<ContactState> out) const {
  const Parts& p = *parts_;
  const TipContact& tip = p.held->path.tip;
  std::size_t count = 0;
  if (tip.holds() && !out.empty()) {
    const Vec3 at = tip.cut.x() + p.tissue.displacement(ContactCompliance::kTip, p.shown_forces());
    out[count++] = {at, tip.force, p.held->needle->length(), 0.0, tip.state() == TipContact::State::stick, true};
  }
  for (const ShaftContact& contact : p.own_forces().shaft) {
    if (count == out.size()) break;
    const Vec3 at = contact.x + p.tissue.displacement(contact.point, p.shown_forces());
    out[count++] = {at, contact.force, contact.s, contact.length, contact.sticks(), false};
  }
  return count;
}

std::vector<ContactState> Insertion::contacts_of(int needle) const {
  const Parts& p = *parts_;
  const NeedleInTissue& of = *p.needles[static_cast<std::size_t>(needle)];
  if (&of == p.held) return contacts();
  std::vector<ContactState> result;
  for (const ShaftContact& contact : p.shown_forces().shaft) {
    if (contact.needle != of.needle.get()) continue;
    const Vec3 at = contact.x + p.tissue.displacement(contact.point, p.shown_forces());
    result.push_back({at, contact.force, contact.s, contact.length, contact.sticks(), contact.presses_only});
  }
  return result;
}

Vec3 Insertion::hand_force_on(int needle) const {
  const Parts& p = *parts_;
  const NeedleInTissue& of = *p.needles[static_cast<std::size_t>(needle)];
  Vec3 force = of.path.tip.force - of.needle->guide_load().force;
  for (const ShaftContact& contact : p.shown_forces().shaft) {
    if (contact.needle == of.needle.get()) force += contact.force;
  }
  return force;
}

ContactCompliance::Nodes Insertion::nodes() const {
  return compliance().nodes(parts_->tissue.present_forces(parts_->shown_forces()));
}

ContactCompliance::Moment Insertion::moment() const {
  const ContactForces forces = parts_->shown_forces();
  const MatX lasting = settings().creep.is_any() ? parts_->tissue.lasting_forces(forces) : MatX(3, 0);
  return compliance().moment(parts_->tissue.present_forces(forces), lasting);
}

VecX Insertion::displacement() const { return moment().displacement; }

VecX Insertion::mesh_displacement() const {
  return compliance().mesh_displacement(parts_->tissue.all_forces(parts_->shown_forces()));
}

std::optional<Insertion::PointDisplacement> Insertion::displacement_at(const MaterialPoint& at, const Vec3& x) {
  TissueResponse& tissue = parts_->tissue;
  // A point without force, which is taken away again, is displaced as the material is.
  const ContactCompliance::Added added = tissue.compliance().add(at, x, Placement::embedded);
  if (added.point < 0) return std::nullopt;
  const ContactForces forces = parts_->shown_forces();
  const PointDisplacement u{tissue.displacement(added.point, forces), tissue.lasting_displacement(added.point, forces)};
  tissue.compliance().remove_last_embedded();
  return u;
}

std::vector<TissueForce> Insertion::tissue_forces() const {
  std::vector<TissueForce> result(static_cast<std::size_t>(compliance().points()));
  result.resize(tissue_forces(result));
  return result;
}

std::size_t Insertion::tissue_forces(std::span<TissueForce> out) const {
  const Parts& p = *parts_;
  const MaterialPoint tip = p.held->path.tip.cut.at();
  std::size_t count = 0;
  for (int point = 0; point < compliance().points(); ++point) {
    const Vec3 lasting = p.tissue.lasting_force(point, p.shown_forces());
    const Vec3 force = p.tissue.present_force(point, p.shown_forces()) + lasting;
    if (force.isZero(0.0) && lasting.isZero(0.0)) continue;
    const TissueResponse::Place& place = p.tissue.place(point);
    const bool at_tip = point == ContactCompliance::kTip && tip.tet >= 0;
    if (count < out.size())
      out[count] = {at_tip ? tip : place.at, force, place.along, lasting, compliance().softness(point)};
    ++count;
  }
  return count;
}

double Insertion::compliance_condition() const {
  const Parts& p = *parts_;
  std::vector<Eigen::Index> rows;
  const auto take = [&](int point) {
    for (Eigen::Index k = 0; k < 3; ++k) rows.push_back(3 * point + k);
  };
  if (p.held->path.tip.holds()) take(ContactCompliance::kTip);
  for (const ShaftContact& contact : p.held->shaft.all()) take(contact.point);
  if (rows.empty()) return 1.0;
  const MatX A = compliance().matrix()(rows, rows);
  const Eigen::SelfAdjointEigenSolver<MatX> eigen(A, Eigen::EigenvaluesOnly);
  const VecX& values = eigen.eigenvalues();
  return values[0] > 0.0 ? values[values.size() - 1] / values[0] : std::numeric_limits<double>::infinity();
}

double Insertion::tissue_energy() const { return parts_->tissue.energy(parts_->shown_forces()); }

}  // namespace stylet
