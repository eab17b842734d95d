// SPDX-License-Identifier: GPL-3.0-or-later
// The patient of a picture under a probe that presses.
#include "stylet/patient/imaged_patient.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet {
namespace {

constexpr double kLift_mm = 8.0;

/// The demo patient with a probe. @param settings further settings
ImagedPatient probed(std::vector<std::string> settings = {}) {
  settings.insert(settings.begin(), {"mesh.nodes=3000", "probe.kind=\"biplane\"", "probe.lift_mm=8"});
  auto patient = imaged_patient(STYLET_SCENARIOS "/demo.toml", settings, {});
  EXPECT_TRUE(patient.ok()) << patient.error().message();
  return std::move(*patient);
}

const ImagedPatient& lifted() {
  static const ImagedPatient patient = probed();
  return patient;
}

/// The note that says that the probe does not press; empty if there is none.
std::string complaint(const ImagedPatient& patient) {
  for (const std::string& note : patient.notes)
    if (note.find("The probe does not press") != std::string::npos) return note;
  return {};
}

Vec3 mean_motion(const ImagedPatient& patient, const Moment& moment, int region) {
  Vec3 sum = Vec3::Zero();
  double corners = 0.0;
  for (std::size_t t = 0; t < patient.mesh.tets.size(); ++t) {
    if (patient.mesh.tet_region[t] != region) continue;
    for (const Index node : patient.mesh.tets[t]) sum += moment.displacement.col(node).cast<double>();
    corners += 4.0;
  }
  return sum / corners;
}

/// The place of an area of the rectal wall: the mean of its material points, which the nodes of the mesh carry.
Vec3 place_of(const ImagedPatient& patient, const Moment& moment, const WallPoint& area) {
  Vec3 place = Vec3::Zero();
  for (const auto& [node, share] : area.weights)
    place +=
        share * (patient.mesh.nodes[static_cast<std::size_t>(node)] + moment.displacement.col(node).cast<double>());
  return place;
}

/// How deep the middle of a flat face lies in a round probe that touches its corners: L²/8R, with the longest edge L of
/// the faces of an area.
double cut_by_faces_mm(const ImagedPatient& patient, const WallPoint& area, double radius_mm) {
  double longest = 0.0;
  for (const auto& [at, share] : area.pieces) {
    const auto& nodes = patient.mesh.tets[static_cast<std::size_t>(at.tet)];
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (at.weights[static_cast<Eigen::Index>(i)] == 0.0 || at.weights[static_cast<Eigen::Index>(j)] == 0.0)
          continue;
        longest = std::max(longest, (patient.mesh.nodes[static_cast<std::size_t>(nodes[i])] -
                                     patient.mesh.nodes[static_cast<std::size_t>(nodes[j])])
                                        .norm());
      }
    }
  }
  return longest * longest / (8.0 * radius_mm);
}

}  // namespace

TEST(PressedPatient, wall_at_the_array_lies_on_the_probe) {
  const ImagedPatient& patient = lifted();
  ASSERT_TRUE(patient.probe);
  const Moment moment = pressed(patient, patient.scenario.probe);
  PatientProbe& probe = patient.probe->probe();
  const ProbePlace place = probe.place(patient.scenario.probe);
  const Capsule surface = capsule_of(place);
  const Vec3 array = place.origin_mm + place.radius_mm * place.axes.col(1);  // on the side of the gland
  double nearest_mm = std::numeric_limits<double>::infinity();
  double gap_mm = 0.0;
  for (const WallPoint& area : probe.wall().points) {
    const Vec3 at = place_of(patient, moment, area);
    // The contact is that of quadratic elements; the faces of a picture are flat.
    EXPECT_GT(surface.nearest(at).mm, -0.3 - cut_by_faces_mm(patient, area, place.radius_mm)) << "deep in the probe";
    if ((at - array).norm() > nearest_mm) continue;
    nearest_mm = (at - array).norm();
    gap_mm = surface.nearest(at).mm;
  }
  EXPECT_LT(nearest_mm, 5.0);
  EXPECT_NEAR(gap_mm, 0.0, 0.3);
  // The probe is lifted by more than that, so the wall was elsewhere before.
  double before_mm = std::numeric_limits<double>::infinity();
  for (const WallPoint& area : probe.wall().points)
    before_mm = std::min(before_mm, surface.nearest(place_of(patient, patient.moment, area)).mm);
  EXPECT_LT(before_mm, -0.5 * kLift_mm);
}

TEST(PressedPatient, gland_goes_to_anterior) {
  const ImagedPatient& patient = lifted();
  const Moment moment = pressed(patient, patient.scenario.probe);
  ASSERT_FALSE(patient.gland_regions.empty());
  const Vec3 motion = mean_motion(patient, moment, patient.gland_regions.front());
  EXPECT_LT(motion.y(), -0.5);
  EXPECT_GT(motion.y(), -kLift_mm);
  ProbeSettings sunk = patient.scenario.probe;
  sunk.lift_mm = -4.0;
  const Vec3 less = mean_motion(patient, pressed(patient, sunk), patient.gland_regions.front());
  EXPECT_GT(less.y(), motion.y() + 0.5) << "a probe that sinks lets it come back";
}

TEST(PressedPatient, needles_and_seeds_go_with_their_material_points) {
  ImagedPatient patient = lifted();
  // A needle has moved everything by as much; the probe's motion belongs to the material points.
  const Vec3 by_needle(3.0, 0.0, -2.0);
  patient.moment.displacement.colwise() += by_needle.cast<float>();
  const Index node = patient.mesh.tets[static_cast<std::size_t>(
      std::find(patient.mesh.tet_region.begin(), patient.mesh.tet_region.end(), patient.gland_regions.front()) -
      patient.mesh.tet_region.begin())][0];
  const Vec3 now = patient.mesh.nodes[static_cast<std::size_t>(node)] + by_needle;
  patient.moment.seeds.push_back({.centre_mm = now, .axis = Vec3::UnitZ()});
  ShownNeedle needle = shown_needle(1.27, {});
  const Vec3 outside(0.0, 0.0, -500.0);
  needle.centreline_mm = {outside, now};
  patient.moment.needles.push_back(needle);
  const Moment moment = pressed(patient, patient.scenario.probe);
  const Vec3 moved = patient.mesh.nodes[static_cast<std::size_t>(node)] + moment.displacement.col(node).cast<double>();
  EXPECT_GT((moved - now).norm(), 0.5);
  EXPECT_LT((moment.seeds[0].centre_mm - moved).norm(), 0.01);
  EXPECT_LT((moment.needles[0].centreline_mm[1] - moved).norm(), 0.01);
  EXPECT_EQ(moment.needles[0].centreline_mm[0], outside);
}

TEST(PressedPatient, is_at_rest_without_a_probe_and_with_the_probe_of_the_contours) {
  for (const char* setting : {"probe.kind=\"none\"", "probe.in_contours=true"}) {
    const ImagedPatient patient = probed({"mesh.nodes=1500", setting});
    EXPECT_FALSE(patient.probe) << setting;
    EXPECT_EQ(complaint(patient), "") << setting;
    EXPECT_TRUE(pressed(patient, patient.scenario.probe).displacement.isZero(0.0F)) << setting;
  }
}

TEST(PressedPatient, that_nothing_holds_is_shown_at_rest_and_it_is_said_why) {
  const ImagedPatient patient = probed({"mesh.nodes=1500", "fixed.box_mm=[900, 900, 900, 901, 901, 901]"});
  EXPECT_FALSE(patient.probe);
  EXPECT_TRUE(pressed(patient, patient.scenario.probe).displacement.isZero(0.0F));
  EXPECT_NE(complaint(patient).find("fixed.box_mm"), std::string::npos) << complaint(patient);
}

}  // namespace stylet
