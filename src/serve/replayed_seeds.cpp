// SPDX-License-Identifier: GPL-3.0-or-later
#include "replayed_seeds.hpp"

#include "stylet/geom/topology.hpp"

namespace stylet::serve {

ReplayedSeeds::ReplayedSeeds(const Replay& replay) : replay_(replay) {
  const TetMesh& mesh = replay.recording().mesh;
  const Topology topology(mesh);
  const Locator locator(mesh, topology);
  for (const SeedAct& act : recorded().acts) at_.push_back(locator.find(act.seed.rest_mm).value_or(MaterialPoint{}));
}

std::optional<LiveImplant> ReplayedSeeds::news() {
  const RecordedImplant& implant = recorded();
  const std::size_t acts = implant.acts_until(replay_.time_s());
  ImplantTally tally = implant.plan.before;
  TallyOfNeedle of_needle;
  for (const Event& event : replay_.recording().events)
    if (event.time_s <= replay_.time_s()) of_needle.add(event, tally);
  if (acts_ == acts && tally == tally_) return std::nullopt;
  acts_ = acts;
  tally_ = tally;
  there_ = implant.acts_of_seeds(acts);
  LiveImplant now;
  now.seeds = implant.seeds_after(acts);
  now.planned_seeds = implant.plan.seeds.size();
  now.tally = tally;
  if (const auto dose = implant.dose_after(static_cast<std::int64_t>(acts))) now.now = ImplantScore{*dose};
  if (const auto dose = implant.dose_after(RecordedScore::kOfPlan)) now.planned = ImplantScore{*dose};
  return now;
}

LiveSeeds ReplayedSeeds::places() const {
  const TetMesh& mesh = replay_.recording().mesh;
  LiveSeeds seeds;
  for (const std::size_t k : there_) {
    Vec3 now = recorded().acts[k].seed.rest_mm;
    for (Eigen::Index corner = 0; corner < 4 && at_[k].tet >= 0; ++corner) {
      const Index node = mesh.tets[static_cast<std::size_t>(at_[k].tet)][static_cast<std::size_t>(corner)];
      now += at_[k].weights[corner] * replay_.displacement(node);
    }
    seeds.now_mm.push_back(now);
  }
  return seeds;
}

}  // namespace stylet::serve
