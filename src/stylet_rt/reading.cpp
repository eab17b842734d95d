// SPDX-License-Identifier: GPL-3.0-or-later
#include "boundary.hpp"
#include "handles.hpp"

#include <algorithm>

namespace {

using stylet::EventKind;

static_assert(sizeof(stylet_rt_contact) == 72);
static_assert(sizeof(stylet_rt_event) == 32);
static_assert(sizeof(stylet_rt_capacity) == 8);

static_assert(STYLET_RT_EVENT_SKIN_CONTACT == static_cast<int>(EventKind::skin_contact));
static_assert(STYLET_RT_EVENT_PUNCTURE == static_cast<int>(EventKind::puncture));
static_assert(STYLET_RT_EVENT_REGION_ENTERED == static_cast<int>(EventKind::region_entered));
static_assert(STYLET_RT_EVENT_RETRACTION_START == static_cast<int>(EventKind::retraction_start));
static_assert(STYLET_RT_EVENT_SLIP_START == static_cast<int>(EventKind::slip_start));
static_assert(STYLET_RT_EVENT_WITHDRAWN == static_cast<int>(EventKind::withdrawn));
static_assert(STYLET_RT_EVENT_BONE_CONTACT == static_cast<int>(EventKind::bone_contact));
static_assert(STYLET_RT_EVENT_EXITED == static_cast<int>(EventKind::exited));
static_assert(STYLET_RT_EVENT_RE_ENTERED == static_cast<int>(EventKind::re_entered));
static_assert(STYLET_RT_EVENT_GRAZED == static_cast<int>(EventKind::grazed));

int32_t number_of(const std::vector<std::string>& regions, const std::string& name) noexcept {
  const auto found = std::find(regions.begin(), regions.end(), name);
  return found == regions.end() ? -1 : static_cast<int32_t>(found - regions.begin());
}

const stylet::CapacityUse* use_of(const stylet::CapacityUses& uses, int32_t which) noexcept {
  switch (which) {
    case STYLET_RT_CAPACITY_CONTACTS:
      return &uses.contacts;
    case STYLET_RT_CAPACITY_SPARE_NODES:
      return &uses.spare_nodes;
    case STYLET_RT_CAPACITY_TRACKS:
      return &uses.tracks;
    case STYLET_RT_CAPACITY_EVENTS:
      return &uses.events;
    default:
      return nullptr;
  }
}

}  // namespace

using stylet::rt::guarded;

extern "C" {

stylet_rt_status stylet_rt_sim_read_contacts(stylet_rt_sim* sim, stylet_rt_contact* contacts, size_t room,
                                             size_t* count) noexcept {
  if (sim == nullptr || count == nullptr || (contacts == nullptr && room > 0)) return STYLET_RT_BAD_ARGUMENT;
  return guarded([&]() -> stylet_rt_status {
    const std::size_t found = sim->simulation.insertion().contacts(sim->contacts);
    for (std::size_t k = 0; k < std::min(found, room); ++k) {
      const stylet::ContactState& contact = sim->contacts[k];
      std::copy_n(contact.position.data(), 3, contacts[k].position_mm);
      std::copy_n(contact.force.data(), 3, contacts[k].force_N);
      contacts[k].s_mm = contact.s;
      contacts[k].length_mm = contact.length;
      contacts[k].sticking = contact.sticking ? 1 : 0;
      contacts[k].tip = contact.tip ? 1 : 0;
    }
    *count = found;
    return STYLET_RT_OK;
  });
}

stylet_rt_status stylet_rt_sim_read_needle(const stylet_rt_sim* sim, double* points_mm, size_t points) noexcept {
  return stylet_rt_sim_read_needle_of(sim, stylet_rt_sim_held(sim), points_mm, points);
}

stylet_rt_status stylet_rt_sim_read_needle_of(const stylet_rt_sim* sim, int32_t number, double* points_mm,
                                              size_t points) noexcept {
  if (sim == nullptr || points_mm == nullptr || points < 2) return STYLET_RT_BAD_ARGUMENT;
  if (number < 0 || number >= sim->simulation.insertion().needles()) return STYLET_RT_BAD_ARGUMENT;
  return guarded([&]() -> stylet_rt_status {
    const stylet::Needle& needle = sim->simulation.insertion().needle(number);
    const auto last = static_cast<double>(points - 1);
    for (std::size_t k = 0; k < points; ++k) {
      const stylet::Vec3 point = needle.point(needle.length() * static_cast<double>(k) / last);
      std::copy_n(point.data(), 3, points_mm + 3 * k);
    }
    return STYLET_RT_OK;
  });
}

stylet_rt_status stylet_rt_sim_read_events(const stylet_rt_sim* sim, stylet_rt_event* events, size_t room,
                                           size_t* count) noexcept {
  if (sim == nullptr || count == nullptr || (events == nullptr && room > 0)) return STYLET_RT_BAD_ARGUMENT;
  const std::vector<std::string>& regions = sim->model->mesh().regions;
  const auto found = sim->simulation.new_events();
  for (std::size_t k = 0; k < std::min(found.size(), room); ++k) {
    const stylet::Event& event = found[k];
    events[k] = {event.time_s, event.depth_mm, event.force_N, static_cast<int32_t>(event.kind),
                 number_of(regions, event.region)};
  }
  *count = found.size();
  return STYLET_RT_OK;
}

stylet_rt_status stylet_rt_sim_read_capacity(const stylet_rt_sim* sim, int32_t which,
                                             stylet_rt_capacity* capacity) noexcept {
  if (sim == nullptr || capacity == nullptr) return STYLET_RT_BAD_ARGUMENT;
  const stylet::CapacityUse* use = use_of(sim->simulation.insertion().capacities(), which);
  if (use == nullptr) return STYLET_RT_BAD_ARGUMENT;
  *capacity = {use->most, use->room};
  return STYLET_RT_OK;
}

}  // extern "C"
