// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of the displayed tissue right beside the needle.
#include "box_patient.hpp"
#include "stylet/sim/display_field.hpp"
#include "stylet/sim/display_near_field.hpp"
#include "stylet/sim/simulation.hpp"

#include <optional>

using namespace stylet;
using namespace stylet::test;

namespace {

constexpr double kStep_mm = 0.1;

std::shared_ptr<const Model> soft_skin() {
  static const std::shared_ptr<const Model> model = [] {
    Scenario s = box_scenario();
    s.tissue_model.preset = TissuePreset::linear;  // stiffening tissue is drawn less accurately: docs/dev/notes.md
    s.insertions[0].depth_mm = 40.0;
    return compiled(s);
  }();
  return model;
}

std::shared_ptr<const Model> creeping_skin() {
  Scenario s = box_scenario();
  s.insertions[0].depth_mm = 40.0;
  s.tissue_model.creep = 3.0;
  s.tissue_model.creep_s = 0.3;
  return compiled(s);
}

/// A needle that is pushed along its planned path.
struct Pushed {
  std::shared_ptr<const Model> model;
  Simulation simulation{model};
  const PlannedInsertion& plan = model->insertions()[0];
  Pose base = plan.motion.at(0.0);

  explicit Pushed(std::shared_ptr<const Model> model_ = soft_skin()) : model(std::move(model_)) {
    simulation.place(base, plan.entry, plan.direction);
  }
  const Step& push() {
    base.origin += kStep_mm * plan.direction;
    simulation.prepare();
    return simulation.step(base, 4e-3);
  }
  void push_to(double depth_mm) {
    while (simulation.last_step().base_depth_mm < depth_mm) push();
  }
};

/// The outer surface as a display draws it, refined along the needle's way.
struct DrawnSkin {
  std::shared_ptr<const Model> model;
  FineSurface surface;
  std::shared_ptr<const DisplayField> field;
  DisplayField::Load load;
  DisplayNearField near;
  std::vector<Index> nodes;
  Eigen::Matrix3Xf u;

  explicit DrawnSkin(const std::shared_ptr<const Model>& model_)
      : model(model_),
        surface(refined(*model_)),
        field(*DisplayField::prepare(model_)),
        load(field->make_load()),
        near(model_, surface.points) {
    for (Index n = 0; n < model->mesh().node_count(); ++n) nodes.push_back(n);
  }
  static FineSurface refined(const Model& model) {
    std::vector<std::array<Index, 3>> triangles;
    for (const Face& face : model.topology().boundary) triangles.push_back(face.nodes);
    const PlannedInsertion& plan = model.insertions()[0];
    const LineSegment way{plan.entry - 5.0 * plan.direction, plan.entry + 30.0 * plan.direction};
    std::vector<int> patch(triangles.size(), 0);
    return refine_surface(model.mesh().nodes, std::move(triangles), std::move(patch), std::span(&way, 1));
  }
  void show(std::span<const TissueForce> forces, bool with_near_field = true) {
    field->set(forces, load);
    u.resize(3, static_cast<Eigen::Index>(surface.points.size()));
    field->displacement(nodes, load, u.leftCols(static_cast<Eigen::Index>(nodes.size())));
    for (std::size_t p = nodes.size(); p < surface.points.size(); ++p) {
      auto there = u.col(static_cast<Eigen::Index>(p));
      there.setZero();
      for (std::size_t k = 0; k < 3 && surface.points[p].node[k] >= 0; ++k)
        there += static_cast<float>(surface.points[p].weight[k]) * u.col(surface.points[p].node[k]);
    }
    near.set(forces);
    if (with_near_field) near.add(u);
  }
  /// Drawn position of the surface's material point at x [mm].
  [[nodiscard]] std::optional<Vec3> drawn(const Vec3& x) const {
    for (const auto& t : surface.triangles) {
      const auto at = [&](std::size_t k) { return surface.positions[static_cast<std::size_t>(t[k])]; };
      const Vec3 normal = (at(1) - at(0)).cross(at(2) - at(0));
      if (std::abs((x - at(0)).dot(normal.normalized())) > 1e-6) continue;
      Vec3 weights;
      for (std::size_t k = 0; k < 3; ++k)
        weights[static_cast<Eigen::Index>(k)] =
            (at((k + 1) % 3) - x).cross(at((k + 2) % 3) - x).dot(normal) / normal.squaredNorm();
      if (weights.minCoeff() < -1e-6) continue;
      Vec3 place = x;
      for (std::size_t k = 0; k < 3; ++k) place += weights[static_cast<Eigen::Index>(k)] * u.col(t[k]).cast<double>();
      return place;
    }
    return std::nullopt;
  }
};

}  // namespace

void expect_what_the_model_displaces(const std::shared_ptr<const Model>& model) {
  Pushed needle(model);
  std::vector<SurfacePoint> points;
  std::vector<Index> nodes;
  for (Index n = 0; n < needle.model->mesh().node_count(); ++n) {
    points.push_back({{n, -1, -1}, {1.0, 0.0, 0.0}});
    nodes.push_back(n);
  }
  DisplayNearField near(needle.model, points);
  ASSERT_GT(near.points(), 20u);
  const auto field = DisplayField::prepare(needle.model);
  ASSERT_TRUE(field.ok());
  auto load = (*field)->make_load();
  Eigen::Matrix3Xf u(3, static_cast<Eigen::Index>(nodes.size()));
  double most = 0.0;
  for (double depth = 4.0; depth < 36.0; depth += 4.0) {
    needle.push_to(depth);
    const auto forces = needle.simulation.insertion().tissue_forces();
    (*field)->set(forces, load);
    (*field)->displacement(nodes, load, u);
    const Eigen::Matrix3Xf of_mesh = u;
    near.set(forces);
    near.add(u);
    most = std::max(most, static_cast<double>((u - of_mesh).colwise().norm().maxCoeff()));
    const VecX expected = needle.simulation.insertion().displacement();
    ASSERT_LT((u.cast<double>() - expected.reshaped(3, u.cols())).colwise().norm().maxCoeff(),
              1e-4 * expected.reshaped(3, u.cols()).colwise().norm().maxCoeff())
        << depth << " mm deep";
  }
  EXPECT_GT(most, 0.05) << "else nothing was added";
}

TEST(DisplayNearField, with_the_field_of_the_mesh_is_what_the_model_displaces) {
  expect_what_the_model_displaces(soft_skin());
}

TEST(DisplayNearField, with_the_field_of_the_mesh_is_what_a_model_that_creeps_displaces) {
  expect_what_the_model_displaces(creeping_skin());
}

TEST(DisplayNearField, the_skin_is_drawn_at_the_tip_that_presses_on_it_until_it_breaks) {
  Pushed needle;
  DrawnSkin skin(needle.model);
  int pictures = 0;
  double deepest = 0.0;
  double worst = 0.0;
  double worst_of_mesh = 0.0;
  std::optional<double> pressed;  // depth of the dent in the last picture before the break
  const Step* record = &needle.push();
  while (record->tip_state == TipState::air) record = &needle.push();
  while (record->tip_state == TipState::pressing) {
    const Vec3 entry = needle.simulation.insertion().track().entry;
    const auto forces = needle.simulation.insertion().tissue_forces();
    skin.show(forces, false);
    worst_of_mesh = std::max(worst_of_mesh, (*skin.drawn(entry) - record->tip_mm).norm());
    skin.show(forces);
    const auto drawn = skin.drawn(entry);
    ASSERT_TRUE(drawn);
    worst = std::max(worst, (*drawn - record->tip_mm).norm());
    deepest = std::max(deepest, record->base_depth_mm);
    pressed = (*drawn - entry).dot(needle.plan.direction);
    ++pictures;
    record = &needle.push();
  }
  EXPECT_GT(pictures, 20);
  EXPECT_GT(deepest, 3.0) << "it hardly dents";
  EXPECT_LT(worst, 0.5);
  EXPECT_GT(worst_of_mesh, 1.0) << "the mesh alone would do";

  // After the break, the skin goes back.
  ASSERT_TRUE(pressed);
  const Vec3 entry = needle.simulation.insertion().track().entry;
  needle.push_to(deepest + 6.0);
  skin.show(needle.simulation.insertion().tissue_forces());
  EXPECT_LT((*skin.drawn(entry) - entry).dot(needle.plan.direction), 0.6 * *pressed);
}

TEST(DisplayNearField, forces_that_stay_and_forces_that_move_are_told_apart) {
  Pushed needle;
  needle.push_to(25.0);
  DrawnSkin skin(needle.model);
  const auto first = needle.simulation.insertion().tissue_forces();
  needle.push_to(31.0);
  auto second = needle.simulation.insertion().tissue_forces();
  DisplayNearField fresh(needle.model, skin.surface.points);
  const auto shown = [&](DisplayNearField& near, std::span<const TissueForce> forces) {
    Eigen::Matrix3Xf u = Eigen::Matrix3Xf::Zero(3, static_cast<Eigen::Index>(skin.surface.points.size()));
    near.set(forces);
    near.add(u);
    return u;
  };
  (void)shown(skin.near, first);
  // Another order, and below two forces fewer, as when contacts lose their force.
  std::reverse(second.begin(), second.end());
  (void)shown(skin.near, std::span(second).subspan(2));
  const Eigen::Matrix3Xf after_others = shown(skin.near, second);
  EXPECT_LT((after_others - shown(fresh, second)).cwiseAbs().maxCoeff(), 1e-5F);
  EXPECT_GT(after_others.cwiseAbs().maxCoeff(), 0.01F);
  EXPECT_TRUE(shown(skin.near, {}).isZero(0.0F)) << "the needle is out";
}
