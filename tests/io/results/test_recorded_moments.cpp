// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of recorded moments: the tissue beside the needle is where the model has it.
#include "sim/box_patient.hpp"

#include "stylet/imaging/ultrasound_scanner.hpp"
#include "stylet/io/recorded_moments.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/sim/simulation.hpp"

#include <limits>

using namespace stylet;
using namespace stylet::test;

namespace {

/// A needle that is pushed into the box, and the recording of its last moment.
struct Pushed {
  std::shared_ptr<const Model> model;
  Simulation simulation;
  RunRecording recording;

  explicit Pushed(double depth_mm) : model(scenario_model()), simulation(model) {
    const PlannedInsertion& plan = model->insertions()[0];
    Pose base = plan.motion.at(0.0);
    simulation.place(base, plan.entry, plan.direction);
    while (simulation.last_step().base_depth_mm < depth_mm) {
      base.origin += 0.1 * plan.direction;
      simulation.prepare();
      simulation.step(base, 4e-3);
    }
    recording.info = model->info(0);
    recording.info.scenario_text = to_toml(model->scenario());
    recording.mesh = model->mesh();
    recording.frames.push_back(simulation.frame("deepest"));
  }
  static std::shared_ptr<const Model> scenario_model() {
    Scenario s = box_scenario();
    s.tissue_model.preset = TissuePreset::linear;
    s.insertions[0].depth_mm = 45.0;
    return compiled(s);
  }
};

/// The place of a material point in the picture, found among the picture's samples: the deepest bit of the promise.
Vec3 place_in_picture(const UltrasoundScanner& scanner, const UltrasoundBeams& beams, const Vec3& material) {
  double nearest = std::numeric_limits<double>::infinity();
  Vec3 place = Vec3::Zero();
  for (int line = 0; line < beams.lines; ++line) {
    for (int s = 0; s < beams.samples; ++s) {
      const double distance = (scanner.material_mm(line, s) - material).norm();
      if (!(distance < nearest)) continue;
      nearest = distance;
      place = beams.point_mm(line, s * beams.sample_mm);
    }
  }
  return place;
}

struct Errors {
  double largest_mm = 0.0;
  int beads = 0;
};

/// Beads on both sides of the needle, in the plane through it: the largest distance of their places in the picture from
/// their places in the model.
Errors bead_errors(bool with_forces) {
  Pushed pushed(30.0);
  Moment moment = RecordedMoments(pushed.recording).at(1e9);
  if (!with_forces) moment.forces.clear();
  const PlannedInsertion& plan = pushed.model->insertions()[0];
  UltrasoundSettings settings;
  settings.lines = 400;
  settings.samples = 400;
  const TetMesh& mesh = pushed.model->mesh();
  const std::vector<TissueEcho> echoes(mesh.regions.size());
  auto scanner = UltrasoundScanner::create(mesh, echoes, settings, {.anatomy = false, .artefacts = false});
  EXPECT_TRUE(scanner.ok());
  UltrasoundBeams beams;  // in the plane x = 4 mm, through the needle
  beams.sector = false;
  beams.across = Vec3::UnitZ();
  beams.ahead = Vec3::UnitY();
  beams.surface_mm = 0.0;
  beams.lines = settings.lines;
  beams.samples = settings.samples;
  beams.step = 0.1;
  beams.first = 0.0;
  beams.sample_mm = 0.08;
  Errors errors;
  for (const double side_mm : {-5.0, -3.0, -1.0, 1.0, 3.0, 5.0}) {
    for (const double z : {8.0, 12.0, 16.0, 20.0}) {
      const Vec3 material(plan.entry.x(), plan.entry.y() + side_mm, z);
      const auto at = pushed.model->locator().find(material);
      if (!at) continue;
      const auto u = pushed.simulation.displacement_at(*at, material);
      if (!u) continue;
      const Vec3 expected = material + u->whole;
      beams.origin_mm = {expected.x(), plan.entry.y() - 16.0, 0.0};
      scanner->scan(moment, beams);
      const double error = (place_in_picture(*scanner, beams, material) - expected).norm();
      errors.largest_mm = std::max(errors.largest_mm, error);
      ++errors.beads;
    }
  }
  return errors;
}

TEST(RecordedMoments, shows_twenty_beads_beside_the_needle_where_the_model_has_them) {
  const Errors errors = bead_errors(true);
  EXPECT_GE(errors.beads, 20);
  EXPECT_LE(errors.largest_mm, 0.3);
}

TEST(RecordedMoments, needs_the_needles_forces_for_that) {
  // The elements of 10 mm cannot show the needle's drag.
  EXPECT_GT(bead_errors(false).largest_mm, 0.3);
}

TEST(RecordedMoments, has_the_track_of_a_needle_that_was_drawn_back) {
  Pushed pushed(30.0);
  Frame back = pushed.recording.frames.front();
  back.time_s += 1.0;
  back.base_depth_mm -= 15.0;
  const Vec3 direction = pushed.model->insertions()[0].direction;
  for (Vec3& point : back.needle) point -= 15.0 * direction;
  back.contacts.clear();
  pushed.recording.frames.push_back(back);
  EXPECT_TRUE(RecordedMoments(pushed.recording).at(pushed.recording.frames.front().time_s).tracks.empty());
  const Moment after = RecordedMoments(pushed.recording).at(1e9);
  ASSERT_EQ(after.tracks.size(), 1U);
  const auto& track = after.tracks.front().centreline_mm;
  EXPECT_NEAR((track.back() - track.front()).norm(), 15.0, 2.0);
}

}  // namespace
