// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/recorded_moments.hpp"

#include "stylet/geom/displaced.hpp"
#include "stylet/imaging/needle_field.hpp"
#include "stylet/io/scenario_io.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet {

namespace {

Eigen::Map<const Eigen::Matrix3Xd> nodal(const Frame& frame) {
  return {frame.displacement.data(), 3, frame.displacement.size() / 3};
}

/// The frame in which the needle is deepest; the end if there are no frames.
std::vector<Frame>::const_iterator deepest_of(const std::vector<Frame>& frames) {
  return std::max_element(frames.begin(), frames.end(),
                          [](const Frame& a, const Frame& b) { return a.base_depth_mm < b.base_depth_mm; });
}

/// The direction of the needle nearest to a point.
Vec3 direction_near(const std::vector<Vec3>& centreline, const Vec3& x) {
  Vec3 direction = Vec3::UnitZ();
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k + 1 < centreline.size(); ++k) {
    const double distance = (0.5 * (centreline[k] + centreline[k + 1]) - x).norm();
    if (distance >= nearest || centreline[k] == centreline[k + 1]) continue;
    nearest = distance;
    direction = (centreline[k + 1] - centreline[k]).normalized();
  }
  return direction;
}

}  // namespace

RecordedMoments::RecordedMoments(const RunRecording& recording)
    : recording_(recording), topology_(recording.mesh), locator_(recording.mesh, topology_) {
  if (auto scenario = parse_scenario(recording.info.scenario_text, "scenario")) scenario_ = *std::move(scenario);
}

/// The needle's forces on the tissue, at the undeformed places of the frame's contacts.
std::vector<ShownForce> RecordedMoments::forces_of(const Frame& frame, const Eigen::Matrix3Xf& displacement) const {
  if (!scenario_) return {};
  std::vector<ContactView> contacts = frame.contacts;
  std::sort(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) { return a.s < b.s; });
  const double radius = 0.5 * recording_.info.needle_diameter_mm;
  std::vector<ShownForce> forces;
  std::vector<Vec3> now;
  for (const ContactView& contact : contacts) {
    const Vec3 at = undeformed(locator_, displacement, contact.position);
    const auto found = locator_.find(at);
    if (!found) continue;
    const auto region = static_cast<std::size_t>(recording_.mesh.tet_region[static_cast<std::size_t>(found->tet)]);
    const TissueParameters tissue = tissue_of(*scenario_, recording_.mesh.regions[region]);
    ShownForce force;
    force.at_mm = at;
    force.force_N = contact.force;
    force.along = direction_near(frame.needle, contact.position);
    force.length_mm = contact.tip ? 0.0 : scenario_->coupling.spacing_mm;
    force.epsilon_mm = std::sqrt(std::exp(1.0)) * radius;
    force.shear_MPa = 1e-3 * tissue.young_kPa / (2.0 * (1.0 + tissue.poisson));
    force.poisson = tissue.poisson;
    forces.push_back(force);
    now.push_back(contact.position);
  }
  // The forces move their own places further than the mesh shows.
  NeedleField field(recording_.mesh);
  for (int k = 0; k < 8; ++k) {
    field.set(forces);
    for (std::size_t c = 0; c < forces.size(); ++c) {
      const auto at = locator_.find(forces[c].at_mm);
      if (!at) continue;
      const Vec3 u = displacement_of(recording_.mesh, displacement, *at) +
                     field.beside_mesh(at->tet, at->weights, forces[c].at_mm);
      forces[c].at_mm = 0.5 * (forces[c].at_mm + now[c] - u);
    }
  }
  return forces;
}

/// The track of the needle beyond its tip, after it has been drawn back from the deepest frame until then.
void RecordedMoments::add_track(Moment& moment) const {
  const auto& frames = recording_.frames;
  const auto deepest = deepest_of(frames);
  if (deepest == frames.end() || deepest->time_s >= moment.time_s || deepest->needle.size() < 2) return;
  const Eigen::Matrix3Xf then = nodal(*deepest).cast<float>();
  ShownTrack track{{}, recording_.info.needle_diameter_mm};
  const Vec3 tip = moment.needles.empty() ? deepest->needle.front() : moment.needles.front().centreline_mm.back();
  const Vec3 inwards = (deepest->needle.back() - deepest->needle.front()).normalized();
  for (const Vec3& point : deepest->needle) {
    const Vec3 at = undeformed(locator_, then, point);
    const auto found = locator_.find(at);
    if (!found) continue;
    const Vec3 here = at + displacement_of(recording_.mesh, moment.displacement, *found);
    if (inwards.dot(here - tip) > 0.0) track.centreline_mm.push_back(here);
  }
  if (track.centreline_mm.size() >= 2) moment.tracks.push_back(std::move(track));
}

/// The seeds that are in the tissue at that moment, where the tissue has carried them.
void RecordedMoments::add_seeds(Moment& moment) const {
  const RecordedImplant& implant = *recording_.implant;
  std::optional<std::size_t> last_needle;
  for (const SeedHistory& seed : implant.seeds_after(implant.acts_until(moment.time_s))) {
    if (seed.lost) continue;
    ShownSeed shown{seed.rest_mm, seed.axis, implant.plan.seed_length_mm, implant.plan.seed_diameter_mm};
    if (const auto at = locator_.find(seed.rest_mm))
      shown.centre_mm += displacement_of(recording_.mesh, moment.displacement, *at);
    join_to_last(moment.seeds, scenario_ && scenario_->seed.stranded && seed.needle == last_needle);
    last_needle = seed.needle;
    moment.seeds.push_back(shown);
  }
}

Moment RecordedMoments::at(double time_s) const {
  Moment moment = moment_at_rest(recording_.mesh);
  moment.time_s = time_s;
  const auto& frames = recording_.frames;
  const auto after =
      std::find_if(frames.begin(), frames.end(), [&](const Frame& frame) { return frame.time_s > time_s; });
  if (after != frames.begin()) {
    const Frame& from = *std::prev(after);
    const Frame& to = after == frames.end() ? from : *after;
    const double length_s = to.time_s - from.time_s;
    const double share = length_s > 0.0 ? (time_s - from.time_s) / length_s : 0.0;
    moment.displacement = ((1.0 - share) * nodal(from) + share * nodal(to)).cast<float>();
    ShownNeedle needle = shown_needle(recording_.info.needle_diameter_mm,
                                      scenario_ ? scenario_->needle.lumen_diameter_mm : std::nullopt);
    needle.centreline_mm = from.needle;
    for (std::size_t k = 0; k < std::min(from.needle.size(), to.needle.size()); ++k)
      needle.centreline_mm[k] = (1.0 - share) * from.needle[k] + share * to.needle[k];
    if (needle.centreline_mm.size() >= 2) moment.needles.push_back(std::move(needle));
    moment.forces = forces_of(share < 0.5 ? from : to, moment.displacement);
    add_track(moment);
  }
  if (recording_.implant) add_seeds(moment);
  return moment;
}

std::optional<ProbeSettings> RecordedMoments::probe_at(double time_s) const {
  if (!scenario_ || scenario_->probe.kind == ProbeKind::none) return std::nullopt;
  const auto& moves = recording_.probe_moves;
  const auto next =
      std::find_if(moves.begin(), moves.end(), [&](const ProbeMove& move) { return move.time_s > time_s; });
  if (next != moves.begin()) return std::prev(next)->probe;
  return moves.empty() ? scenario_->probe : moves.front().probe;
}

double RecordedMoments::deepest_s() const {
  const auto deepest = deepest_of(recording_.frames);
  return deepest == recording_.frames.end() ? 0.0 : deepest->time_s;
}

}  // namespace stylet
