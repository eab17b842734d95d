// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/recorded_moment.hpp"

#include "stylet/geom/locator.hpp"
#include "stylet/geom/topology.hpp"

#include <algorithm>

namespace stylet {

namespace {

Eigen::Map<const Eigen::Matrix3Xd> columns(const Frame& frame) {
  return {frame.displacement.data(), 3, frame.displacement.size() / 3};
}

/// The seeds that are in the tissue at that moment, where the tissue has carried them.
void add_seeds(const RunRecording& recording, Moment& moment) {
  const RecordedImplant& implant = *recording.implant;
  const Topology topology(recording.mesh);
  const Locator locator(recording.mesh, topology);
  for (const SeedHistory& seed : implant.seeds_after(implant.acts_until(moment.time_s))) {
    if (seed.lost) continue;
    ShownSeed shown{seed.rest_mm, seed.axis, implant.plan.seed_length_mm, implant.plan.seed_diameter_mm};
    if (const auto at = locator.find(seed.rest_mm)) {
      const auto& corners = recording.mesh.tets[static_cast<std::size_t>(at->tet)];
      for (std::size_t k = 0; k < corners.size(); ++k) {
        const double weight = at->weights[static_cast<Eigen::Index>(k)];
        shown.centre_mm += weight * moment.displacement.col(corners[k]).cast<double>();
      }
    }
    moment.seeds.push_back(shown);
  }
}

}  // namespace

Moment recorded_moment(const RunRecording& recording, double time_s) {
  Moment moment = moment_at_rest(recording.mesh);
  moment.time_s = time_s;
  const auto& frames = recording.frames;
  const auto after =
      std::find_if(frames.begin(), frames.end(), [&](const Frame& frame) { return frame.time_s > time_s; });
  if (after != frames.begin()) {
    const Frame& from = *std::prev(after);
    const Frame& to = after == frames.end() ? from : *after;
    const double length_s = to.time_s - from.time_s;
    const double share = length_s > 0.0 ? (time_s - from.time_s) / length_s : 0.0;
    moment.displacement = ((1.0 - share) * columns(from) + share * columns(to)).cast<float>();
    ShownNeedle needle{from.needle, recording.info.needle_diameter_mm};
    for (std::size_t k = 0; k < std::min(from.needle.size(), to.needle.size()); ++k)
      needle.centreline_mm[k] = (1.0 - share) * from.needle[k] + share * to.needle[k];
    if (needle.centreline_mm.size() >= 2) moment.needles.push_back(std::move(needle));
  }
  if (recording.implant) add_seeds(recording, moment);
  return moment;
}

double deepest_time_s(const RunRecording& recording) {
  const auto deepest =
      std::max_element(recording.frames.begin(), recording.frames.end(),
                       [](const Frame& a, const Frame& b) { return a.base_depth_mm < b.base_depth_mm; });
  return deepest == recording.frames.end() ? 0.0 : deepest->time_s;
}

}  // namespace stylet
