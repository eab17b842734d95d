// SPDX-License-Identifier: GPL-3.0-or-later
#include "insertion_parts.hpp"
#include "stylet/coupling/near_field/near_field_compliance.hpp"
#include "stylet/coupling/paper/inverse_compliance.hpp"
#include "stylet/coupling/track_compliance.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <utility>

namespace stylet {

namespace {
constexpr int kMaxSubSteps = 64;
constexpr int kMostSurfaces = 4;  ///< met in one sub-step
constexpr std::size_t kOldTracks = 64;
constexpr double kBent_mm = 10.0;  ///< a bent shaft is rarely further from its axis

std::unique_ptr<ContactCompliance> engine_of(const InsertionTissue& tissue, const CouplingSettings& settings,
                                             int capacity) {
  using Engine = CouplingSettings::Engine;
  if (settings.engine == Engine::condensed)
    return std::make_unique<TrackCompliance>(tissue.store, *tissue.locator, capacity);
  const auto engine =
      settings.engine == Engine::bcs ? paper::DenseInverse::Engine::bcs : paper::DenseInverse::Engine::woodbury;
  const bool move_nodes = settings.method == CouplingSettings::Method::node_repositioning;
  return std::make_unique<paper::InverseCompliance>(tissue.store->shared_tissue(), *tissue.locator, tissue.inverse,
                                                    engine, move_nodes, capacity);
}

/// Points the tissue may be held at or remember: an insertion may begin before the tissue has forgotten the one before.
int most_points(const CouplingSettings& settings) {
  return settings.relaxation_s > 0.0 ? 2 * settings.capacity : settings.capacity;
}

/// Without a kernel of the mesh the near field starts with an empty one, which prepare() fills.
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
  return std::make_unique<NearFieldCompliance>(std::move(engine), tissue.store->shared_tissue(), tissue.kernel, needle,
                                               capacity);
}
}  // namespace

Insertion::Parts::Parts(InsertionTissue tissue_, std::unique_ptr<Needle> needle_, const CouplingSettings& settings_)
    : tissue(with_kernel(std::move(tissue_), settings_)),
      needle(std::move(needle_)),
      settings(settings_),
      owned_compliance(make_compliance(tissue, settings_, most_points(settings_))),
      compliance(*owned_compliance),
      supply(tissue.store->shared_tissue(),
             settings_.engine == CouplingSettings::Engine::condensed ? tissue.store : nullptr,
             settings_.method == CouplingSettings::Method::near_field ? tissue.kernel : nullptr, *tissue.locator),
      memory(settings_.relaxation_s, most_points(settings_) + 1),
      system(settings_.capacity + 1) {
  const auto capacity = static_cast<std::size_t>(settings.capacity);
  track.marks.reserve(capacity);
  old_tracks.resize(kOldTracks);
  for (Track& old : old_tracks) old.marks.reserve(capacity);
  grips.reserve(capacity);
  loads.reserve(capacity + 1);
  shaft.resize(capacity + 1, Vec3::Zero());
  past.resize(capacity + 1, Vec3::Zero());
  springs.resize(capacity + 1, Mat3::Zero());
  system_points.reserve(capacity + 1);
  preparation.points.reserve(capacity + 1);
  tip_slope = MatX::Zero(3 * (settings.capacity + 1), 3);
  kept.needle = shape_start = needle->state();
  shape_gained = shape_more = VecX::Zero(shape_start.size());
  kept.grips.resize(capacity);
  forces = MatX::Zero(3, most_points(settings) + 1);
  point_at.resize(static_cast<std::size_t>(most_points(settings)) + 1);
  point_along.resize(point_at.size(), Vec3::Zero());
  nodes_at_start = tissue.store->stored_nodes();
  capacities.contacts.room = settings.capacity;
  capacities.spare_nodes.room = settings.spare_nodes;
  capacities.tracks.room = static_cast<int>(kOldTracks);
  capacities.events.room = static_cast<int>(StepReport{}.event.size());
  if (settings.solver == CouplingSettings::Solver::staggered)
    staggered = std::make_unique<paper::Staggered>(settings.capacity + 1, needle->state().size());
}

void Insertion::Parts::add_event(StepReport& report, InsertionEventKind kind, int region, double force_N) {
  if (report.events == static_cast<int>(report.event.size())) return;
  report.event[static_cast<std::size_t>(report.events++)] = {kind, region, force_N};
}

/// Nothing but a guide bends the needle in the air.
void Insertion::Parts::settle_in_air(StepReport& report) {
  constexpr int enough = 50;
  constexpr double tolerance_N = 1e-10;
  for (int iteration = 0; needle->residual({}) > tolerance_N * length(); ++iteration) {
    if (iteration == enough) {
      report.flags |= StepReport::not_converged;
      return;
    }
    tangent_fits = false;
    needle->linearise({}, system.N.topLeftCorner(0, 0), system.free.head(0));
    needle->advance({});
  }
}

/// Whether a point of the tissue at rest is inside of it; a tip at its surface is not.
bool Insertion::Parts::in_tissue(const Vec3& x) const {
  constexpr double at_surface_mm = 1e-6;
  return tissue.locator->find(x - at_surface_mm * needle->tangent(length())).has_value();
}

/// Where the way back along a straight needle from a tip inside the tissue comes out of it, if that is no further than
/// its diameter.
std::optional<Vec3> Insertion::Parts::surface_behind(const Vec3& tip_now) const {
  if (!in_tissue(tip_now)) return std::nullopt;
  const Vec3 from = needle->point(0.0);
  const auto crossing = tissue.locator->first_entry(from, tip_now);
  if (!crossing) return std::nullopt;
  const Vec3 surface = from + crossing->t * (tip_now - from);
  return (tip_now - surface).norm() <= settings.merge_mm ? std::optional(surface) : std::nullopt;
}

/// Whether the insertion is over: the needle holds no tissue, and its tip has come back out of it, or was moved out of
/// the mouth of its track sideways. On curved or tilted skin a tip beside its entry may be behind it and yet in the
/// tissue, and a needle that is drawn out is in its track until it is out, however far its hand is beside it.
bool Insertion::Parts::has_left(bool drawn_out) const {
  if (!grips.empty() || tip_holds()) return false;
  const Vec3 t = needle->tangent(length());
  const Vec3 from_entry = needle->point(length()) - track.entry;
  const double deep = t.dot(from_entry);
  const double beside = (from_entry - deep * t).norm();
  const bool beside_mouth = deep < settings.spacing_mm && beside > settings.join_mm && phase != TipPhase::exited;
  if (beside_mouth && !drawn_out) return true;
  return (deep < 0.0 || beside_mouth) && !in_tissue(needle->point(length()));
}

/// The needle is out: the tissue model is what it was before the first contact, or goes back to it as it relaxes. The
/// tracks stay known.
void Insertion::Parts::finish_insertion(StepReport& report) {
  leave_memory_behind(1.0);
  if (track.end_xi > 0.0) {
    if (joined >= 0) {  // needle after needle beside the one before would lead the hole across the skin
      begin_at(old_tracks[static_cast<std::size_t>(joined)].entry);
    } else {
      if (old_count < old_tracks.size()) {
        ++old_count;
      } else {  // no room: the oldest is forgotten
        std::rotate(old_tracks.begin(), old_tracks.begin() + 1, old_tracks.end());
      }
    }
    std::swap(old_tracks[joined >= 0 ? static_cast<std::size_t>(joined) : old_count - 1], track);
  }
  track.marks.clear();
  track.end_xi = 0.0;
  track.open = false;
  joined = -1;
  grips.clear();
  system.supported = false;  // in air a needle needs no springs
  supported_for = 0;
  forget_preparation();
  forget_entry();
  balanced = true;
  rescue_s = on_bone_for = 0.0;
  damp_needle(0.0);
  if (tip.at.tet >= 0) point_at[ContactCompliance::kTip] = tip.at;
  tip = Tip{};
  relaxing = memory.on();
  if (!relaxing) forget_tissue();
  needle->straighten();
  settle_in_air(report);
  phase = TipPhase::air;
  air_tip = needle->point(length());
  // It left its track sideways: it is to meet the surface where its shaft does, unless it is so far inside by now that
  // this would be a blow. A bowed needle swings that far when it slips off.
  if (const auto surface = surface_behind(air_tip)) air_tip = *surface;
  add_event(report, InsertionEventKind::withdrawn, -1);
}

void Insertion::Parts::sub_step(const Pose& pose, double h, StepReport& report) {
  const Pose before = needle->base();
  hand_start = hand_force();
  needle->set_base(pose);
  memory.begin(h);
  if (phase == TipPhase::air) {
    steady = false;
    settle_in_air(report);
    const Vec3 now = needle->point(length());
    const bool settled = enter(air_tip, now, report);
    if (phase == TipPhase::air) {
      relax();
      if (settled) air_tip = now;
      return;
    }
    share_length();
  }
  keep_start();
  damp_needle(damping_s(h) / h);
  expect(before, pose);
  steady = settings.solver == CouplingSettings::Solver::coupled;
  bool broke = false;
  int surfaces = 0;
  Effort effort(load_count());
  double cut = 0.0;
  const unsigned flags_before = std::exchange(report.flags, 0u);
  do {
    if (settings.solver == CouplingSettings::Solver::staggered) {
      solve_staggered(h, report);
    } else {
      solve_equilibrium(h, effort, report);
    }
    // What is held by a surface for the rest of a sub-step pushes it on; viscous tissue resists that at once, and with
    // more than the surface bears.
    const bool met = memory.on() && tip.touching && tip.blocked;
    cut = tip.touching ? tip.advance : 0.0;
    going_on = false;
    commit_tip(report);
    broke = met && tip.touching && tip.force.norm() > tip.limit;
  } while (broke && ++surfaces < kMostSurfaces);
  balanced = (report.flags & StepReport::not_converged) == 0;
  report.flags |= flags_before;
  keep_gains(cut);
  for (Grip& grip : grips) {
    const double speed = std::abs(grip.slid) / h;
    if (grip.state != Grip::State::stick && speed < settings.zero_band_mm_per_s) grip.state = Grip::State::stick;
  }
  wake_and_drop(report);

  const Vec3 tip_now = needle->point(length());
  const Vec3 t = needle->tangent(length());
  if (track.open) {
    // The end of an open track is a hole in the far surface: behind it the tip is in the track, beyond it in the air.
    const Vec3 shift = tissue_displacement(ContactCompliance::kTip);
    const double ahead = t.dot(track.end + shift - tip_now);
    const Vec3 now = tip_now - shift;
    if (ahead > 0.0 && phase == TipPhase::exited) {
      phase = TipPhase::in_track;
      forget_entry();
      add_event(report, InsertionEventKind::re_entered, region_of(track.end_at.tet));
    } else if (ahead <= 0.0 && phase == TipPhase::in_track) {
      phase = TipPhase::exited;
      add_event(report, InsertionEventKind::exited, region_of(track.end_at.tet));
    }
    if (phase != TipPhase::exited || enter(air_tip, now, report)) air_tip = now;
  }
  remember();
  const bool drawn_out = (pose.origin - before.origin).dot(pose.rotation * Vec3::UnitZ()) < 0.0;
  if (has_left(drawn_out)) finish_insertion(report);
}

void Insertion::Parts::note_use() {
  capacities.contacts.note(static_cast<int>(grips.size()));
  capacities.spare_nodes.note(static_cast<int>(tissue.store->stored_nodes() - nodes_at_start));
  capacities.tracks.note(static_cast<int>(old_count));
}

Vec3 Insertion::Parts::hand_force() const {
  Vec3 force = tip.force - needle->guide_load().force;
  for (const Grip& grip : grips) force += grip.force;
  return force;
}

void Insertion::Parts::summarise(StepReport& report) const {
  report.tip = phase;
  report.tip_position = needle->point(length());
  report.contacts = static_cast<int>(grips.size()) + (tip_holds() ? 1 : 0);
  const PointLoad guide = needle->guide_load();
  report.guide_force = guide.force;
  report.hand_force = hand_force();
  report.hand_torque = (needle->point(length()) - base.origin).cross(tip.force) -
                       (needle->point(guide.s) - base.origin).cross(guide.force);
  double sliding = 0.0;
  double sliding_out = 0.0;
  for (const Grip& grip : grips) {
    report.hand_torque +=
        (needle->point(loaded_arc(std::clamp(grip.s, 0.0, length()))) - base.origin).cross(grip.force);
    report.inserted_mm += grip.length;
    if (grip.state == Grip::State::stick) {
      ++report.sticking;
    } else {
      sliding += grip.length;
      if (grip.state == Grip::State::backward) sliding_out += grip.length;
    }
  }
  if (tip_holds() && tip.state == Tip::State::stick) ++report.sticking;
  if (report.inserted_mm > 0.0) {
    report.sliding_share = sliding / report.inserted_mm;
    report.sliding_out_share = sliding_out / report.inserted_mm;
  }
}

Insertion::Insertion(InsertionTissue tissue, std::unique_ptr<Needle> needle, const CouplingSettings& settings)
    : parts_(std::make_unique<Parts>(std::move(tissue), std::move(needle), settings)) {}
Insertion::~Insertion() = default;
Insertion::Insertion(Insertion&&) noexcept = default;
Insertion& Insertion::operator=(Insertion&&) noexcept = default;

void Insertion::place(const Pose& base) {
  StepReport unused;
  if (parts_->phase != TipPhase::air) parts_->finish_insertion(unused);
  if (parts_->relaxing) parts_->forget_tissue();
  parts_->rows_complete_at.setConstant(std::numeric_limits<double>::infinity());
  parts_->forget_entry();
  parts_->tangent_fits = false;
  parts_->forget_preparation();
  parts_->last_way = parts_->last_cut = parts_->cut_more = 0.0;
  parts_->force_share = parts_->way_share = 0.0;
  parts_->last_motion.setZero();
  parts_->base = base;
  parts_->needle->set_base(base);
  parts_->settle_in_air(unused);
  parts_->air_tip = parts_->needle->point(parts_->length());
}

void Insertion::place_guide(const Vec3& hole, const Vec3& axis) { parts_->needle->place_guide(hole, axis); }

StepReport Insertion::step(const Pose& base, double dt) {
  Parts& p = *parts_;
  StepReport report;
  if (!base.origin.allFinite() || !base.rotation.coeffs().allFinite() || !(dt > 0.0) || !std::isfinite(dt)) {
    report.flags = StepReport::invalid_input;
    p.summarise(report);
    return report;
  }
  if (p.supply.awaits_step()) p.supply.serve(p.compliance, p.whereabouts());
  const Pose from = p.base;
  // How far the shaft's points go: tilting swings the whole needle, rolling only what is bent.
  const double turn = 2.0 * std::acos(std::min(1.0, std::abs(from.rotation.dot(base.rotation))));
  const double tilt = (base.rotation * Vec3::UnitZ() - from.rotation * Vec3::UnitZ()).norm();
  const double way = (base.origin - from.origin).norm() + tilt * p.length() + turn * kBent_mm;
  int count = kMaxSubSteps;
  if (way <= kMaxSubSteps * p.settings.max_advance_mm) {
    count = std::max(1, static_cast<int>(std::ceil(way / p.settings.max_advance_mm)));
  } else {
    report.flags |= StepReport::too_fast;
  }
  for (int k = 1; k <= count; ++k) {
    const double fraction = static_cast<double>(k) / count;
    Pose pose = base;
    if (k < count) {
      pose.origin = from.origin + fraction * (base.origin - from.origin);
      pose.rotation = from.rotation.slerp(fraction, base.rotation);
    }
    p.base = pose;
    const std::size_t before = p.compliance.remeshing().size();
    p.sub_step(pose, dt / count, report);
    // Withdrawal forgets all changes; a sub-step that withdraws lays no contact.
    const std::size_t after = p.compliance.remeshing().size();
    report.remeshings = after >= before ? report.remeshings + static_cast<int>(after - before) : 0;
  }
  p.note_use();
  p.capacities.events.note(report.events);
  p.summarise(report);
  const bool outside = p.phase == TipPhase::air || p.phase == TipPhase::exited;  // as far as the model knows
  const bool explained = (report.flags & StepReport::compliance_missing) != 0;
  if (outside && report.contacts == 0 && !explained && p.in_tissue(report.tip_position))
    report.flags |= StepReport::no_contact_inside;
  return report;
}

/// The contact that comes next cannot be laid before its compliance has come.
bool Insertion::Parts::contact_waits() const {
  if (grips.size() >= track.marks.size()) return false;
  const Track::Mark& next = track.marks[grips.size()];
  return next.point < 0 && !compliance.available(next.at.tet);
}

/// Where compliance is needed next: at the tip, then at contacts that wait for it behind the tip.
NeedleWhereabouts Insertion::Parts::whereabouts() const {
  const Vec3 tangent = needle->tangent(length());
  if (!tip_waits() && contact_waits()) {
    const Track::Mark& next = track.marks[grips.size()];
    return {next.x, tangent, next.at.tet};
  }
  if (awaited_entry) return *awaited_entry;
  if (phase == TipPhase::air || phase == TipPhase::exited) return {air_tip, tangent, -1};
  return {tip.x, tip.state == Tip::State::cut ? tip.direction : tangent, tip.at.tet};
}

void Insertion::prepare(double radius_mm) {
  Parts& p = *parts_;
  const Vec3 tip = p.needle->point(p.length());
  const bool waits = p.tip_waits() || p.contact_waits() || p.awaited_entry.has_value();
  const bool as_left = p.tissue.store->arrived() == p.rows_arrived;
  if (!waits && as_left && (tip - p.rows_complete_at).norm() < 0.25 * radius_mm) return;
  p.supply.work_through(p.compliance, p.whereabouts(),
                        {.radius_mm = radius_mm, .ahead_mm = 0.0, .spare_nodes = p.settings.spare_nodes});
  p.note_use();
  p.rows_complete_at = tip;
  p.rows_arrived = p.tissue.store->arrived();
}

const ComplianceStore& Insertion::store() const { return *parts_->tissue.store; }
ComplianceSupply& Insertion::supply() { return parts_->supply; }
const Needle& Insertion::needle() const { return *parts_->needle; }
const ContactCompliance& Insertion::compliance() const { return parts_->compliance; }
const CouplingSettings& Insertion::settings() const { return parts_->settings; }
void Insertion::observe_phases(PhaseObserver* observer) { parts_->phases = observer; }
const CapacityUses& Insertion::capacities() const { return parts_->capacities; }
const Track& Insertion::track() const { return parts_->track; }
std::span<const Track> Insertion::old_tracks() const { return {parts_->old_tracks.data(), parts_->old_count}; }

std::vector<ContactState> Insertion::contacts() const {
  std::vector<ContactState> result(parts_->grips.size() + 1);
  result.resize(contacts(result));
  return result;
}

std::size_t Insertion::contacts(std::span<ContactState> out) const {
  const Parts& p = *parts_;
  std::size_t count = 0;
  if (p.tip.touching && p.tip.state != Tip::State::open && !out.empty()) {
    out[count++] = {p.tip.x + p.tissue_displacement(ContactCompliance::kTip),
                    p.tip.force,
                    p.length(),
                    0.0,
                    p.tip.state == Tip::State::stick,
                    true};
  }
  for (const Grip& grip : p.grips) {
    if (count == out.size()) break;
    out[count++] = {grip.x + p.tissue_displacement(grip.point), grip.force, grip.s, grip.length,
                    grip.state == Grip::State::stick,           false};
  }
  return count;
}

ContactCompliance::Nodes Insertion::nodes() const {
  parts_->gather_forces();
  return parts_->compliance.nodes(parts_->forces.leftCols(parts_->compliance.points()));
}

VecX Insertion::displacement() const {
  parts_->gather_filtered_forces();
  return parts_->compliance.displacement(parts_->forces.leftCols(parts_->compliance.points()));
}

VecX Insertion::mesh_displacement() const {
  parts_->gather_filtered_forces();
  return parts_->compliance.mesh_displacement(parts_->forces.leftCols(parts_->compliance.points()));
}

std::vector<TissueForce> Insertion::tissue_forces() const {
  std::vector<TissueForce> result(static_cast<std::size_t>(parts_->compliance.points()));
  result.resize(tissue_forces(result));
  return result;
}

std::size_t Insertion::tissue_forces(std::span<TissueForce> out) const {
  Parts& p = *parts_;
  p.gather_filtered_forces();
  if (p.tip.at.tet >= 0) p.point_at[ContactCompliance::kTip] = p.tip.at;
  std::size_t count = 0;
  for (int point = 0; point < p.compliance.points(); ++point) {
    const Vec3 force = p.forces.col(point);
    if (force.isZero(0.0)) continue;
    const auto at = static_cast<std::size_t>(point);
    if (count < out.size()) out[count] = {p.point_at[at], force, p.point_along[at]};
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
  if (p.tip.touching && p.tip.state != Tip::State::open) take(ContactCompliance::kTip);
  for (const Grip& grip : p.grips) take(grip.point);
  if (rows.empty()) return 1.0;
  const MatX A = p.compliance.matrix()(rows, rows);
  const Eigen::SelfAdjointEigenSolver<MatX> eigen(A, Eigen::EigenvaluesOnly);
  const VecX& values = eigen.eigenvalues();
  return values[0] > 0.0 ? values[values.size() - 1] / values[0] : std::numeric_limits<double>::infinity();
}

double Insertion::tissue_energy() const {
  const Parts& p = *parts_;
  if (p.memory.on()) {
    parts_->gather_filtered_forces();
    double stored = 0.0;
    for (int point = 0; point < p.compliance.points(); ++point)
      stored += 0.5 * p.forces.col(point).dot(p.tissue_displacement(point));
    return stored;
  }
  double energy = 0.5 * p.tip.force.dot(p.tissue_displacement(ContactCompliance::kTip));
  for (const Grip& grip : p.grips) energy += 0.5 * grip.force.dot(p.tissue_displacement(grip.point));
  return energy;
}

}  // namespace stylet
