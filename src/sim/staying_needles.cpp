// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/staying_needles.hpp"

#include "base_steps.hpp"

#include "stylet/core/flush_denormals.hpp"

#include <fmt/format.h>

namespace stylet {

namespace {

/// Puts the needle that the hand holds in, to its full depth, and waits as its plan says.
Result<std::vector<std::string>> put_in(Simulation& simulation, const PlannedInsertion& insertion) {
  const BaseSteps motion = planned_steps(simulation.model(), insertion);
  StepRemarks watch;
  simulation.place(insertion);
  const auto add = [&](long, const Step&, double) -> Result<> {
    watch.add(simulation);
    return Ok{};
  };
  if (Result<> done = drive(simulation, motion, motion.count, add); !done) return done.error();
  std::vector<std::string> remarks = watch.sentences();
  for (std::string& remark : remarks) remark = fmt::format("Needle in place, {}: {}", insertion.name, remark);
  return remarks;
}

}  // namespace

int needles_of(const Model& model) { return static_cast<int>(model.staying().size()) + 1; }

Result<std::vector<std::string>> put_in_staying_needles(Simulation& simulation, const Progress& progress) {
  const std::vector<PlannedInsertion>& staying = simulation.model().staying();
  std::vector<std::string> remarks;
  if (staying.empty()) return remarks;
  const FlushDenormals flush;  // as the insertions
  for (std::size_t k = 0; k < staying.size(); ++k) {
    report(progress, "needle in place, " + staying[k].name,
           static_cast<double>(k) / static_cast<double>(staying.size()));
    if (Result<> taken = simulation.take_up(static_cast<int>(k)); !taken) return taken.error();
    const auto of_needle = put_in(simulation, staying[k]);
    if (!of_needle) return of_needle.error();
    remarks.insert(remarks.end(), of_needle->begin(), of_needle->end());
  }
  if (Result<> taken = simulation.take_up(static_cast<int>(staying.size())); !taken) return taken.error();
  simulation.start_clock();
  simulation.place(simulation.model().insertions().front());
  return remarks;
}

}  // namespace stylet
