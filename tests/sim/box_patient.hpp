// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/box_mesh.hpp"
#include "stylet/sim/prediction.hpp"
#include "stylet/sim/run.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace stylet::test {

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

#define EXPECT_SAYS(message, part) EXPECT_TRUE(stylet::test::contains(message, part)) << (message)

/// A cubic patient with edges of 60 mm: perineal skin at z = 0, gland in the middle, pubic arch anterior (−y).
inline TetMesh box_patient(bool with_arch = true) {
  TetMesh mesh = box_mesh({-30, -30, 0}, {30, 30, 60}, {6, 6, 6});
  assign_regions(mesh, {"body", "prostate", "pubic_arch"}, [=](const Vec3& x) {
    if (with_arch && x.y() < -20 && x.z() > 20 && x.z() < 50) return 2;
    return (x - Vec3(0, 5, 32)).norm() < 17 ? 1 : 0;
  });
  if (!with_arch) mesh.regions.pop_back();
  return mesh;
}

/// A short scenario with one needle beside the gland's centre. The sides are held, so that the body is firm.
inline Scenario box_scenario() {
  Scenario s;
  s.name = "box";
  s.patient.source = "box";
  s.fixed.outer = OuterSupport::sides;
  s.needle.length_mm = 120.0;
  s.run.dt_ms = 4.0;
  s.insertions.resize(1);
  s.insertions[0].entry_mm = {4.0, 7.0, -20.0};
  s.insertions[0].speed_mm_per_s = 40.0;
  s.insertions[0].retract_speed_mm_per_s = 40.0;
  s.insertions[0].dwell_s = 0.1;
  return s;
}

/// The compiled model; an error fails and stops the test.
inline std::shared_ptr<const Model> compiled(const Scenario& scenario, TetMesh mesh = box_patient(),
                                             const std::vector<std::vector<MotionSample>>& motions = {}) {
  auto model = Model::compile(scenario, std::move(mesh), "case.toml", motions);
  if (!model) throw std::runtime_error(model.error().message());
  return *model;
}

/// The error of a scenario that cannot be compiled.
inline Error refused(const Scenario& scenario, TetMesh mesh = box_patient(),
                     const std::vector<std::vector<MotionSample>>& motions = {}) {
  const auto model = Model::compile(scenario, std::move(mesh), "case.toml", motions);
  EXPECT_FALSE(model.ok()) << "was not refused";
  if (model) return {};
  EXPECT_EQ(model.error().kind, ErrorKind::input);
  EXPECT_FALSE(model.error().cure.empty());
  return model.error();
}

/// Keeps all steps and frames of a run.
struct Kept final : RunObserver {
  std::vector<Step> steps;
  std::vector<Frame> frames;
  Result<> on_step(const Step& step) override {
    steps.push_back(step);
    return Ok{};
  }
  Result<> on_frame(const Frame& frame) override {
    frames.push_back(frame);
    return Ok{};
  }
};

/// A model, run to its end, with all results.
struct Finished {
  std::shared_ptr<const Model> model;
  Kept kept;
  Summary summary;

  explicit Finished(std::shared_ptr<const Model> model_) : model(std::move(model_)) {
    static KnownTargets targets;
    const auto result = run(model, kept, targets);
    if (!result) throw std::runtime_error(result.error().message());
    summary = *result;
  }

  [[nodiscard]] const Event* event(EventKind kind, const std::string& region = {}) const {
    for (const Event& e : summary.events) {
      if (e.kind == kind && (region.empty() || e.region == region)) return &e;
    }
    return nullptr;
  }
  [[nodiscard]] const Frame* frame(const std::string& label) const {
    for (const Frame& f : kept.frames) {
      if (f.label == label) return &f;
    }
    return nullptr;
  }
};

}  // namespace stylet::test
