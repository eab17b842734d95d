// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle_recorder.hpp"

#include <fmt/format.h>

namespace stylet {

void NeedleRecorder::add(const Simulation& simulation, const SeedWatch& seeds, double seconds) {
  record_.steps.push_back(simulation.last_step());
  record_.steps.back().step_us = 1e6 * seconds;
  const std::vector<std::size_t>& left = seeds.left();
  for (; seeds_left_ < left.size(); ++seeds_left_) {
    keep_shape(simulation, simulation.insertion().held(), fmt::format("seed {} dropped", left[seeds_left_] + 1));
  }
}

void NeedleRecorder::keep_shape(const Simulation& simulation, int needle, std::string when) {
  const Needle& shaft = simulation.insertion().needle(needle);
  NeedleShape shape;
  shape.when = std::move(when);
  shape.time_s = simulation.time_s();
  if (!record_.steps.empty()) shape.base_depth_mm = record_.steps.back().base_depth_mm;
  for (int k = 0; k < kNeedleShapePoints; ++k)
    shape.points_mm.push_back(shaft.point(shaft.length() * k / (kNeedleShapePoints - 1)));
  record_.shapes.push_back(std::move(shape));
}

}  // namespace stylet
