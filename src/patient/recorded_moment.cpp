// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/patient/recorded_moment.hpp"

#include "stylet/geom/locator.hpp"
#include "stylet/geom/topology.hpp"
#include "stylet/imaging/needle_field.hpp"
#include "stylet/io/scenario_io.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet {

namespace {

Eigen::Map<const Eigen::Matrix3Xd> columns(const Frame& frame) {
  return {frame.displacement.data(), 3, frame.displacement.size() / 3};
}

/// Displacement of a material point that the mesh represents.
Vec3 displacement_of(const TetMesh& mesh, const Eigen::Matrix3Xf& displacement, const MaterialPoint& at) {
  Vec3 u = Vec3::Zero();
  const auto& corners = mesh.tets[static_cast<std::size_t>(at.tet)];
  for (std::size_t k = 0; k < corners.size(); ++k)
    u += at.weights[static_cast<Eigen::Index>(k)] * displacement.col(corners[k]).cast<double>();
  return u;
}

/// The undeformed place of a point of the deformed patient, by fixed-point iteration; the point itself if it is outside
/// of the tissue.
Vec3 undeformed(const Locator& locator, const Eigen::Matrix3Xf& displacement, const Vec3& x) {
  Vec3 at = x;
  for (int k = 0; k < 20; ++k) {
    const auto found = locator.find(at);
    if (!found) return x;
    const Vec3 next = x - displacement_of(locator.mesh(), displacement, *found);
    const bool done = (next - at).norm() < 1e-4;
    at = 0.5 * (at + next);
    if (done) break;
  }
  return at;
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

/// The needle's forces on the tissue, at the undeformed places of the frame's contacts.
std::vector<ShownForce> forces_of(const RunRecording& recording, const Locator& locator, const Frame& frame,
                                  const Eigen::Matrix3Xf& displacement) {
  const auto scenario = parse_scenario(recording.info.scenario_text, "scenario");
  if (!scenario) return {};
  std::vector<ContactView> contacts = frame.contacts;
  std::sort(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) { return a.s < b.s; });
  const double radius = 0.5 * recording.info.needle_diameter_mm;
  std::vector<ShownForce> forces;
  std::vector<Vec3> now;
  for (const ContactView& contact : contacts) {
    const Vec3 at = undeformed(locator, displacement, contact.position);
    const auto found = locator.find(at);
    if (!found) continue;
    const auto region = static_cast<std::size_t>(recording.mesh.tet_region[static_cast<std::size_t>(found->tet)]);
    const TissueParameters tissue = tissue_of(*scenario, recording.mesh.regions[region]);
    ShownForce force;
    force.at_mm = at;
    force.force_N = contact.force;
    force.along = direction_near(frame.needle, contact.position);
    force.length_mm = contact.tip ? 0.0 : scenario->coupling.spacing_mm;
    force.epsilon_mm = std::sqrt(std::exp(1.0)) * radius;
    force.shear_MPa = 1e-3 * tissue.young_kPa / (2.0 * (1.0 + tissue.poisson));
    force.poisson = tissue.poisson;
    forces.push_back(force);
    now.push_back(contact.position);
  }
  // The forces move their own places further than the mesh shows.
  NeedleField field(recording.mesh);
  for (int k = 0; k < 8; ++k) {
    field.set(forces);
    for (std::size_t c = 0; c < forces.size(); ++c) {
      const auto at = locator.find(forces[c].at_mm);
      if (!at) continue;
      const Vec3 u =
          displacement_of(recording.mesh, displacement, *at) + field.beside_mesh(at->tet, at->weights, forces[c].at_mm);
      forces[c].at_mm = 0.5 * (forces[c].at_mm + now[c] - u);
    }
  }
  return forces;
}

/// The track of the needle beyond its tip, after it has been drawn back from the deepest frame until then.
void add_track(const RunRecording& recording, const Locator& locator, Moment& moment) {
  const auto& frames = recording.frames;
  const auto deepest = std::max_element(
      frames.begin(), frames.end(), [](const Frame& a, const Frame& b) { return a.base_depth_mm < b.base_depth_mm; });
  if (deepest == frames.end() || deepest->time_s >= moment.time_s || deepest->needle.size() < 2) return;
  const Eigen::Matrix3Xf then = columns(*deepest).cast<float>();
  ShownTrack track{{}, recording.info.needle_diameter_mm};
  const Vec3 tip = moment.needles.empty() ? deepest->needle.front() : moment.needles.front().centreline_mm.back();
  const Vec3 inwards = (deepest->needle.back() - deepest->needle.front()).normalized();
  for (const Vec3& point : deepest->needle) {
    const Vec3 at = undeformed(locator, then, point);
    const auto found = locator.find(at);
    if (!found) continue;
    const Vec3 here = at + displacement_of(recording.mesh, moment.displacement, *found);
    if (inwards.dot(here - tip) > 0.0) track.centreline_mm.push_back(here);
  }
  if (track.centreline_mm.size() >= 2) moment.tracks.push_back(std::move(track));
}

/// The seeds that are in the tissue at that moment, where the tissue has carried them.
void add_seeds(const RunRecording& recording, const Locator& locator, Moment& moment) {
  const RecordedImplant& implant = *recording.implant;
  for (const SeedHistory& seed : implant.seeds_after(implant.acts_until(moment.time_s))) {
    if (seed.lost) continue;
    ShownSeed shown{seed.rest_mm, seed.axis, implant.plan.seed_length_mm, implant.plan.seed_diameter_mm};
    if (const auto at = locator.find(seed.rest_mm))
      shown.centre_mm += displacement_of(recording.mesh, moment.displacement, *at);
    moment.seeds.push_back(shown);
  }
}

}  // namespace

Moment recorded_moment(const RunRecording& recording, double time_s) {
  Moment moment = moment_at_rest(recording.mesh);
  moment.time_s = time_s;
  const Topology topology(recording.mesh);
  const Locator locator(recording.mesh, topology);
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
    moment.forces = forces_of(recording, locator, share < 0.5 ? from : to, moment.displacement);
    add_track(recording, locator, moment);
  }
  if (recording.implant) add_seeds(recording, locator, moment);
  return moment;
}

double deepest_time_s(const RunRecording& recording) {
  const auto deepest =
      std::max_element(recording.frames.begin(), recording.frames.end(),
                       [](const Frame& a, const Frame& b) { return a.base_depth_mm < b.base_depth_mm; });
  return deepest == recording.frames.end() ? 0.0 : deepest->time_s;
}

}  // namespace stylet
