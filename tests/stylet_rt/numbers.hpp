// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/simulation.hpp"

#include <vector>

namespace stylet::test {

/// All numbers of a planned insertion that the C interface provides, computed with the C++ interface: after every step
/// the result, the contacts, the centreline in 33 points and the events. test_stylet_rt.c collects them in the same
/// order.
inline std::vector<double> numbers_of(Simulation& simulation, std::size_t insertion) {
  const PlannedInsertion& plan = simulation.model().insertions()[insertion];
  const double dt = 1e-3 * simulation.model().scenario().run.dt_ms;
  std::vector<double> numbers;
  const auto add = [&](const Vec3& v) { numbers.insert(numbers.end(), v.data(), v.data() + 3); };
  simulation.place(plan.motion.at(0.0), plan.entry, plan.direction);
  for (int k = 1; k * dt < plan.motion.duration_s(); ++k) {
    const Step& record = simulation.step(plan.motion.at(k * dt), dt);
    const Step& report = simulation.last_step();
    const Needle& needle = simulation.insertion().needle();
    numbers.insert(numbers.end(), {record.time_s, record.base_depth_mm});
    add(report.hand_force_N);
    add(report.torque_Nmm);
    numbers.insert(numbers.end(), {record.force_axial_N, record.force_lateral_N, record.force_sagittal_N});
    add(report.guide_force_N);
    add(needle.base().origin);
    add(record.tip_mm);
    numbers.insert(numbers.end(), {report.inserted_mm, report.sliding_share});
    for (const int x : {static_cast<int>(report.flags), static_cast<int>(record.tip_state), record.contacts,
                        record.sticking, record.iterations})
      numbers.push_back(x);
    for (const ContactState& contact : simulation.insertion().contacts()) {
      add(contact.position);
      add(contact.force);
      numbers.insert(numbers.end(), {contact.s, contact.length, contact.sticking ? 1.0 : 0.0, contact.tip ? 1.0 : 0.0});
    }
    for (int p = 0; p < 33; ++p) add(needle.point(needle.length() * p / 32.0));
    for (const Event& event : simulation.new_events()) {
      const auto& regions = simulation.model().mesh().regions;
      double region = -1.0;
      for (std::size_t r = 0; r < regions.size(); ++r) {
        if (regions[r] == event.region) region = static_cast<double>(r);
      }
      numbers.insert(numbers.end(), {event.time_s, event.depth_mm, event.force_N,
                                     static_cast<double>(static_cast<int>(event.kind)), region});
    }
  }
  return numbers;
}

}  // namespace stylet::test
