// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary.hpp"
#include "handles.hpp"
#include "realtime/thread_setup.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace stylet::rt {
namespace {

static_assert(sizeof(stylet_rt_options) == 16);
static_assert(sizeof(stylet_rt_pose) == 56);
static_assert(sizeof(stylet_rt_result) == 200);

static_assert(STYLET_RT_NOT_CONVERGED == Step::not_converged);
static_assert(STYLET_RT_CONTACT_CYCLING == Step::contact_cycling);
static_assert(STYLET_RT_COMPLIANCE_MISSING == Step::compliance_missing);
static_assert(STYLET_RT_OUT_OF_CONTACTS == Step::out_of_contacts);
static_assert(STYLET_RT_TOO_FAST == Step::too_fast);
static_assert(STYLET_RT_INVALID_INPUT == Step::invalid_input);
static_assert(STYLET_RT_NO_CONTACT_INSIDE == Step::no_contact_inside);
static_assert(STYLET_RT_UNUSABLE_LAW == Step::unusable_law);

static_assert(STYLET_RT_TIP_AIR == static_cast<int>(TipState::air));
static_assert(STYLET_RT_TIP_PRESSING == static_cast<int>(TipState::pressing));
static_assert(STYLET_RT_TIP_CUTTING == static_cast<int>(TipState::cutting));
static_assert(STYLET_RT_TIP_IN_TRACK == static_cast<int>(TipState::in_track));
static_assert(STYLET_RT_TIP_BONE == static_cast<int>(TipState::bone));
static_assert(STYLET_RT_TIP_EXITED == static_cast<int>(TipState::exited));

constexpr uint32_t kKnownFlags = STYLET_RT_KEEP_DENORMALS | STYLET_RT_WORKER;
constexpr double kShortest_s = 1e-9;
constexpr double kLongest_s = 1.0;
constexpr double kOffUnit = 1e-3;
/// Quaternions whose length differs from 1 by at most this are not normalised, so that all bits are kept.
constexpr double kRounding = 1e-14;

void copy(const Vec3& from, double* to) noexcept { std::copy_n(from.data(), 3, to); }

/// Converts a pose; empty if it is invalid.
std::optional<Pose> pose_of(const stylet_rt_pose& given) noexcept {
  Pose pose;
  pose.origin = Vec3(given.position_mm);
  pose.rotation = Eigen::Quaterniond(given.rotation[0], given.rotation[1], given.rotation[2], given.rotation[3]);
  const double length = pose.rotation.norm();
  // Written so that NaN fails the comparison.
  if (!pose.origin.allFinite() || !(std::abs(length - 1.0) <= kOffUnit)) return std::nullopt;
  if (std::abs(length - 1.0) > kRounding) pose.rotation.coeffs() /= length;
  return pose;
}

void write(const stylet_rt_sim& sim, stylet_rt_result& out) noexcept {
  const Step& record = sim.simulation.last_step();
  const Step& report = sim.simulation.last_step();
  out.time_s = record.time_s;
  out.base_depth_mm = record.base_depth_mm;
  copy(report.hand_force_N, out.hand_force_N);
  copy(report.torque_Nmm, out.hand_torque_Nmm);
  out.force_axial_N = record.force_axial_N;
  out.force_lateral_N = record.force_lateral_N;
  out.force_sagittal_N = record.force_sagittal_N;
  copy(report.guide_force_N, out.guide_force_N);
  copy(sim.simulation.insertion().needle().base().origin, out.base_mm);
  copy(record.tip_mm, out.tip_mm);
  out.inserted_mm = report.inserted_mm;
  out.sliding_share = report.sliding_share;
  out.flags = report.flags;
  out.tip_state = static_cast<int32_t>(record.tip_state);
  out.contacts = record.contacts;
  out.sticking = record.sticking;
  out.iterations = record.iterations;
  out.events = static_cast<int32_t>(sim.simulation.new_events().size());
}

/// The number of the planned insertion at whose start the held needle was last placed.
std::size_t& insertion_of(stylet_rt_sim& sim) noexcept {
  return sim.insertions[static_cast<std::size_t>(sim.simulation.insertion().held())];
}

void place(stylet_rt_sim& sim, std::size_t insertion) {
  const PlannedInsertion& plan = sim.model->insertions()[insertion];
  sim.simulation.place(plan);
  insertion_of(sim) = insertion;
}

/// Whether the simulation has a needle, which has been taken up at some time.
bool has(const stylet_rt_sim* sim, int32_t needle) noexcept {
  return sim != nullptr && needle >= 0 && needle < sim->simulation.insertion().needles();
}

bool planned(const Model& model, int32_t insertion) noexcept {
  return insertion >= 0 && static_cast<std::size_t>(insertion) < model.insertions().size();
}

}  // namespace
}  // namespace stylet::rt

using namespace stylet::rt;

stylet_rt_sim::stylet_rt_sim(std::shared_ptr<const stylet::Model> model_, std::uint32_t flags_, int needles)
    : model(std::move(model_)),
      simulation(model, needles),
      flags(flags_),
      insertions(static_cast<std::size_t>(needles), 0),
      contacts(static_cast<std::size_t>(model->coupling().capacity) + 1) {}

void stylet_rt_sim::start_worker() {
  if ((flags & STYLET_RT_WORKER) != 0)
    worker = std::make_unique<stylet::ComplianceWorker>(simulation.supply(), simulation.supply_settings());
}

extern "C" {

stylet_rt_status stylet_rt_sim_create(const stylet_rt_model* model, const stylet_rt_options* options,
                                      stylet_rt_sim** sim, char* error, size_t error_size) noexcept {
  ErrorText text(error, error_size);
  if (sim == nullptr) return text.bad_argument("stylet_rt_sim_create: the argument sim is null");
  *sim = nullptr;
  if (model == nullptr) return text.bad_argument("stylet_rt_sim_create: the model is null");
  stylet_rt_options chosen = {};
  if (options != nullptr) {
    if (options->struct_size != sizeof chosen) {
      return text.bad_argument(
          "stylet_rt_sim_create: options.struct_size is not known to this library. Set it to "
          "sizeof(stylet_rt_options), and use header and library of the same version");
    }
    chosen = *options;
  }
  if ((chosen.flags & ~kKnownFlags) != 0 || chosen.needles > STYLET_RT_MAX_NEEDLES)
    return text.bad_argument(
        "stylet_rt_sim_create: options has unknown flags, or more needles than STYLET_RT_MAX_NEEDLES. Set the "
        "structure "
        "to zero before you fill it in");
  if (!planned(*model->model, chosen.insertion))
    return text.bad_argument(
        "stylet_rt_sim_create: options.insertion is not the number of one of the model's insertions");
  return guarded(text, [&]() -> stylet_rt_status {
    auto made =
        std::make_unique<stylet_rt_sim>(model->model, chosen.flags, std::max(1, static_cast<int>(chosen.needles)));
    place(*made, static_cast<std::size_t>(chosen.insertion));
    made->start_worker();
    *sim = made.release();
    return STYLET_RT_OK;
  });
}

void stylet_rt_sim_destroy(stylet_rt_sim* sim) noexcept { delete sim; }

stylet_rt_status stylet_rt_sim_place(stylet_rt_sim* sim, int32_t insertion) noexcept {
  if (sim == nullptr || !planned(*sim->model, insertion)) return STYLET_RT_BAD_ARGUMENT;
  return guarded([&]() -> stylet_rt_status {
    place(*sim, static_cast<std::size_t>(insertion));
    return STYLET_RT_OK;
  });
}

stylet_rt_status stylet_rt_sim_take_up(stylet_rt_sim* sim, int32_t needle, int32_t insertion, char* error,
                                       size_t error_size) noexcept {
  ErrorText text(error, error_size);
  if (sim == nullptr) return text.bad_argument("stylet_rt_sim_take_up: the simulation is null");
  const int there = sim->simulation.insertion().needles();
  if (needle < 0 || static_cast<std::size_t>(needle) >= sim->insertions.size())
    return text.bad_argument(
        "stylet_rt_sim_take_up: the simulation has no needle of this number. Raise stylet_rt_options.needles");
  if (needle > there)
    return text.bad_argument(
        "stylet_rt_sim_take_up: a needle before this one has not been taken up. Take needles up in the order of their "
        "numbers");
  if (needle == there && !planned(*sim->model, insertion))
    return text.bad_argument("stylet_rt_sim_take_up: insertion is not the number of one of the model's insertions");
  return guarded(text, [&]() -> stylet_rt_status {
    sim->worker.reset();  // it reads the compliance, which gets or loses a point
    const auto taken = sim->simulation.take_up(needle);
    if (taken.ok() && needle == there) place(*sim, static_cast<std::size_t>(insertion));
    sim->start_worker();
    return taken.ok() ? STYLET_RT_OK : text.of(taken.error());
  });
}

int32_t stylet_rt_sim_held(const stylet_rt_sim* sim) noexcept {
  return sim == nullptr ? -1 : sim->simulation.insertion().held();
}

stylet_rt_status stylet_rt_sim_hub_force(const stylet_rt_sim* sim, int32_t needle, double* force_N) noexcept {
  if (!has(sim, needle) || force_N == nullptr) return STYLET_RT_BAD_ARGUMENT;
  copy(sim->simulation.insertion().hand_force_on(needle), force_N);
  return STYLET_RT_OK;
}

stylet_rt_status stylet_rt_sim_planned_base(const stylet_rt_sim* sim, double time_s, stylet_rt_pose* base) noexcept {
  if (sim == nullptr || base == nullptr || !std::isfinite(time_s)) return STYLET_RT_BAD_ARGUMENT;
  const auto held = static_cast<std::size_t>(sim->simulation.insertion().held());
  const stylet::Pose pose = sim->model->insertions()[sim->insertions[held]].motion.at(time_s);
  copy(pose.origin, base->position_mm);
  base->rotation[0] = pose.rotation.w();
  base->rotation[1] = pose.rotation.x();
  base->rotation[2] = pose.rotation.y();
  base->rotation[3] = pose.rotation.z();
  return STYLET_RT_OK;
}

stylet_rt_status stylet_rt_sim_step(stylet_rt_sim* sim, const stylet_rt_pose* base, double dt_s,
                                    stylet_rt_result* result) noexcept {
  if (sim == nullptr || base == nullptr) return STYLET_RT_BAD_ARGUMENT;
  const std::optional<stylet::Pose> pose = pose_of(*base);
  if (!pose || !(dt_s >= kShortest_s && dt_s <= kLongest_s)) {
    if (result != nullptr) {
      write(*sim, *result);
      result->flags |= STYLET_RT_INVALID_INPUT;
      result->events = 0;
    }
    return STYLET_RT_BAD_ARGUMENT;
  }
  return guarded([&]() -> stylet_rt_status {
    std::optional<stylet::FlushDenormals> flush;
    if ((sim->flags & STYLET_RT_KEEP_DENORMALS) == 0) flush.emplace();
    sim->simulation.step(*pose, dt_s);
    if (result != nullptr) write(*sim, *result);
    return STYLET_RT_OK;
  });
}

stylet_rt_status stylet_rt_sim_read_result(const stylet_rt_sim* sim, stylet_rt_result* result) noexcept {
  if (sim == nullptr || result == nullptr) return STYLET_RT_BAD_ARGUMENT;
  write(*sim, *result);
  return STYLET_RT_OK;
}

stylet_rt_status stylet_rt_sim_prepare(stylet_rt_sim* sim, char* error, size_t error_size) noexcept {
  ErrorText text(error, error_size);
  if (sim == nullptr) return text.bad_argument("stylet_rt_sim_prepare: the simulation is null");
  return guarded(text, [&]() -> stylet_rt_status {
    sim->simulation.prepare();
    return STYLET_RT_OK;
  });
}

}  // extern "C"
