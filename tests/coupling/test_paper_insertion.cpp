// SPDX-License-Identifier: GPL-3.0-or-later
// Whole insertions by the methods of Goksel et al. 2005, compared with the default methods.
#include "needle_in_block.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>

using namespace stylet;
using stylet::test::BlockOptions;
using stylet::test::NeedleInBlock;

namespace {

using Settings = CouplingSettings;

struct Course {
  std::vector<double> force;
  std::vector<Vec3> contacts;
  unsigned flags = 0;
  std::vector<RemeshEvent> remeshing;
  double peak = 0.0;
};

/// @param gland an organ on the path; nodes of its surface must not be moved
Course insertion_and_retraction(const Settings& coupling, bool gland = true) {
  BlockOptions options;
  if (!gland) options.region_at = [](const Vec3&) { return 0; };
  options.cells = {9, 9, 9};
  options.coupling = coupling;
  NeedleInBlock run(options);
  run.aim({4.0, 11.0, 0}, Vec3(0.2, -0.33, 1.0));
  Course course;
  const auto note = [&] {
    for (const ContactState& contact : run.insertion->contacts()) course.contacts.push_back(contact.force);
  };
  run.go(20.0);
  note();
  run.go(42.0);
  note();
  const auto changes = run.insertion->compliance().remeshing();
  course.remeshing.assign(changes.begin(), changes.end());
  run.go(40.0);
  note();
  run.go(-3.0, 40.0);
  EXPECT_EQ(run.insertion->displacement().cwiseAbs().maxCoeff(), 0.0);  // after withdrawal the tissue is reset
  EXPECT_TRUE(run.insertion->compliance().remeshing().empty());
  course.force = run.forces;
  course.flags = run.flags;
  course.peak = run.peak();
  return course;
}

double largest_difference(const Course& a, const Course& b) {
  double largest = 0.0;
  EXPECT_EQ(a.force.size(), b.force.size());
  EXPECT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t k = 0; k < std::min(a.force.size(), b.force.size()); ++k)
    largest = std::max(largest, std::abs(a.force[k] - b.force[k]));
  for (std::size_t k = 0; k < std::min(a.contacts.size(), b.contacts.size()); ++k)
    largest = std::max(largest, (a.contacts[k] - b.contacts[k]).norm());
  return largest;
}

}  // namespace

TEST(PaperInsertion, engines_give_the_same_forces_over_a_whole_insertion_and_retraction) {
  for (const auto rule : {Settings::Rule::interior, Settings::Rule::paper}) {
    Settings settings;
    settings.method = Settings::Method::node_addition;
    settings.rule = rule;
    const Course condensed = insertion_and_retraction(settings);
    EXPECT_GT(condensed.remeshing.size(), 2u);
    for (const auto engine : {Settings::Engine::bcs, Settings::Engine::woodbury}) {
      settings.engine = engine;
      const Course whole = insertion_and_retraction(settings);
      EXPECT_LT(largest_difference(whole, condensed), 1e-6 * condensed.peak);
      ASSERT_EQ(whole.remeshing.size(), condensed.remeshing.size());
      for (std::size_t k = 0; k < whole.remeshing.size(); ++k) {
        EXPECT_EQ(whole.remeshing[k].dimension, condensed.remeshing[k].dimension);
        EXPECT_EQ(whole.remeshing[k].kind, condensed.remeshing[k].kind);
      }
    }
  }
}

TEST(PaperInsertion, embedded_contacts_are_the_same_with_a_full_inverse) {
  Settings settings;
  settings.method = Settings::Method::embedded;
  const Course condensed = insertion_and_retraction(settings);
  settings.engine = Settings::Engine::woodbury;
  EXPECT_LT(largest_difference(insertion_and_retraction(settings), condensed), 1e-6 * condensed.peak);
}

TEST(PaperInsertion, repositioning_moves_nodes_to_the_needle_and_leaves_its_contacts_independent) {
  int moved = 0;
  for (const bool soft : {false, true}) {
    BlockOptions options;
    options.cells = soft ? std::array{7, 7, 7} : std::array{12, 12, 12};
    options.coupling.spacing_mm = soft ? 4.0 : 2.0;
    if (soft) options.materials = {{0.003, 0.45}, {0.002, 0.45}};
    options.coupling.method = Settings::Method::node_repositioning;
    options.coupling.engine = Settings::Engine::woodbury;
    NeedleInBlock run(options);
    run.aim({4.0, 11.0, 0}, Vec3(0.2, -0.33, 1.0));
    double largest = 0.0;
    for (double depth = 0.0; depth <= 36.0; depth += 1.0) {
      run.go(depth, 50.0);
      for (const ContactState& contact : run.insertion->contacts()) largest = std::max(largest, contact.force.norm());
    }
    EXPECT_EQ(run.flags, 0u);
    EXPECT_LT(largest, 1.2 * run.peak());  // linearly dependent neighbours would push with tens of newtons
    const ContactCompliance& compliance = run.insertion->compliance();
    const Eigen::Index held = 3 * (compliance.points() - 1);
    const MatX A = compliance.matrix().block(3, 3, held, held);
    EXPECT_GT(A.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), 5e-4 * A.trace() / static_cast<double>(held));
    for (const RemeshEvent& event : compliance.remeshing()) {
      if (event.kind != RemeshEvent::Kind::repositioned) continue;
      ++moved;
      EXPECT_LT(event.moved_mm, soft ? 14.3 : 8.4);  // the nearest node is closer than an edge
    }
  }
  EXPECT_GT(moved, 1);
}

TEST(PaperInsertion, repositioning_gives_the_same_forces_with_either_engine) {
  Settings settings;
  settings.method = Settings::Method::node_repositioning;
  settings.engine = Settings::Engine::bcs;
  const Course bcs = insertion_and_retraction(settings, false);
  settings.engine = Settings::Engine::woodbury;
  const Course woodbury = insertion_and_retraction(settings, false);
  EXPECT_LT(largest_difference(bcs, woodbury), 1e-6 * bcs.peak);
  EXPECT_TRUE(std::any_of(bcs.remeshing.begin(), bcs.remeshing.end(),
                          [](const RemeshEvent& e) { return e.kind == RemeshEvent::Kind::repositioned; }));
  // A needle at the same depth has forces of the same size, whatever changes of the mesh were made.
  const Course addition = insertion_and_retraction({}, false);
  EXPECT_GT(bcs.peak, 0.5 * addition.peak);
  EXPECT_LT(bcs.peak, 2.0 * addition.peak);
}

TEST(PaperInsertion, needle_and_tissue_in_turn_come_to_the_same_forces_as_the_coupled_solve) {
  Settings settings;
  const Course coupled = insertion_and_retraction(settings);
  EXPECT_EQ(coupled.flags, 0u);
  EXPECT_GT(coupled.peak, 0.97);  // pressed beyond the buckling load of the needle alone
  settings.solver = Settings::Solver::staggered;
  const Course staggered = insertion_and_retraction(settings);
  EXPECT_EQ(staggered.flags, 0u);
  EXPECT_LT(largest_difference(staggered, coupled), 1e-6 * coupled.peak);
}
