// SPDX-License-Identifier: GPL-3.0-or-later
// Parts that a program brings in place of those of the scenario: a law of cutting, a needle.
#include "box_patient.hpp"

#include "stylet/needle/make_needle.hpp"
#include "stylet/sim/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

using namespace stylet;
using namespace stylet::test;

namespace {

/// A law given as a function.
class Given final : public CuttingModel {
 public:
  explicit Given(std::function<Law(const Tip&)> law) : law_(std::move(law)) {}
  [[nodiscard]] std::string name() const override { return "given"; }
  [[nodiscard]] Law law(const Tip& tip) const override { return law_(tip); }

 private:
  std::function<Law(const Tip&)> law_;
};

std::shared_ptr<const Model> with_law(const std::shared_ptr<const Model>& model,
                                      std::function<CuttingModel::Law(const CuttingModel::Tip&)> law) {
  return model->with({.cutting = std::make_shared<Given>(std::move(law))}).value();
}

CuttingModel::Law built_in(const CuttingModel::Tip& tip) { return {tip.cutting_N, tip.viscosity_Ns_per_mm}; }

std::shared_ptr<const Model> with_needle(const std::shared_ptr<const Model>& model) {
  return model
      ->with({.needle = [](const NeedleSection& section, int loads) { return make_needle("beam", section, 0, loads); }})
      .value();
}

/// The model that most tests change a part of, compiled once.
const std::shared_ptr<const Model>& plain_model() {
  static const std::shared_ptr<const Model> model = compiled(box_scenario());
  return model;
}

/// The steps of the planned insertion until the needle turns back.
std::vector<Step> pushed_in(const std::shared_ptr<const Model>& model) {
  Simulation simulation(model);
  const PlannedInsertion& plan = model->insertions().front();
  simulation.place(plan.motion.at(0.0), plan.entry, plan.direction);
  const double dt = 1e-3 * model->scenario().run.dt_ms;
  std::vector<Step> steps;
  for (int k = 1; k * dt < plan.motion.duration_s(); ++k) {
    simulation.prepare();
    steps.push_back(simulation.step(plan.motion.at(k * dt), dt));
    if (steps.size() > 1 && steps.back().base_depth_mm < steps[steps.size() - 2].base_depth_mm) break;
  }
  return steps;
}

const std::vector<Step>& plain_steps() {
  static const std::vector<Step> steps = pushed_in(plain_model());
  return steps;
}

void expect_plain_forces(const std::vector<Step>& steps) {
  const std::vector<Step>& plain = plain_steps();
  ASSERT_EQ(steps.size(), plain.size());
  for (std::size_t k = 0; k < steps.size(); ++k) {
    ASSERT_EQ(steps[k].hand_force_N, plain[k].hand_force_N) << "step " << k;
    ASSERT_EQ(steps[k].tip_mm, plain[k].tip_mm) << "step " << k;
  }
}

TEST(OwnCuttingLaw, that_gives_the_built_in_numbers_changes_no_bit) {
  expect_plain_forces(pushed_in(with_law(plain_model(), built_in)));
}

TEST(OwnCuttingLaw, is_asked_in_the_region_and_at_the_place_of_the_tip) {
  const auto& model = plain_model();
  std::vector<CuttingModel::Tip> asked;
  pushed_in(with_law(model, [&](const CuttingModel::Tip& tip) {
    asked.push_back(tip);
    return built_in(tip);
  }));
  ASSERT_FALSE(asked.empty());
  double fastest = 0.0;
  for (const CuttingModel::Tip& tip : asked) {
    ASSERT_GE(tip.region, 0);
    EXPECT_EQ(tip.cutting_N, model->laws()[static_cast<std::size_t>(tip.region)].cutting_N);
    EXPECT_EQ(tip.viscosity_Ns_per_mm, model->coupling().tip_viscosity_Ns_per_mm);
    // The tip may lie on the border to the next region: the tissue on one of its sides is the one that is cut.
    const auto is_at = [&](double beyond_mm) {
      const auto at = model->locator().find(tip.at_mm + beyond_mm * model->insertions().front().direction);
      return at && model->mesh().tet_region[static_cast<std::size_t>(at->tet)] == tip.region;
    };
    EXPECT_TRUE(is_at(-1e-6) || is_at(1e-6)) << tip.region << " at " << tip.at_mm.transpose();
    fastest = std::max(fastest, tip.cut_mm_per_s);
  }
  EXPECT_GT(fastest, 30.0) << "the base moves at 40 mm/s";
}

// A tip that cuts with the speed v bears C + η v, and the law is told in the next sub-step what v was.
TEST(OwnCuttingLaw, is_the_axial_force_of_a_tip_that_cuts) {
  constexpr double kC_N = 0.9;
  constexpr double kEta_Ns_per_mm = 0.02;
  const auto& model = plain_model();
  std::optional<double> cut_mm_per_s;  // of the last step, as the first call in the next one has it
  Simulation simulation(with_law(model, [&](const CuttingModel::Tip& tip) {
    if (!cut_mm_per_s) cut_mm_per_s = tip.cut_mm_per_s;
    return CuttingModel::Law{kC_N, kEta_Ns_per_mm};
  }));
  const PlannedInsertion& plan = model->insertions().front();
  simulation.place(plan.motion.at(0.0), plan.entry, plan.direction);
  const double dt = 1e-3 * model->scenario().run.dt_ms;  // the base moves by less than one sub-step allows
  std::optional<double> force_N;                         // of the last step
  int compared = 0;
  for (int k = 1; k * dt < plan.motion.duration_s(); ++k) {
    simulation.prepare();
    cut_mm_per_s.reset();
    const Step& step = simulation.step(plan.motion.at(k * dt), dt);
    if (force_N && cut_mm_per_s) {
      EXPECT_NEAR(*force_N, kC_N + kEta_Ns_per_mm * *cut_mm_per_s, 1e-6) << "before step " << k;
      ++compared;
    }
    force_N.reset();
    if (step.tip_state != TipState::cutting || !simulation.new_events().empty() || step.flags != 0) continue;
    const Needle& needle = simulation.insertion().needle();
    for (const ContactState& contact : simulation.insertion().contacts())
      if (contact.tip) force_N = contact.force.dot(needle.tangent(needle.length()));
  }
  EXPECT_GT(compared, 50);
}

TEST(OwnCuttingLaw, that_gives_no_usable_number_is_flagged_and_the_built_in_law_used) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  int calls = 0;
  const std::vector<Step> steps = pushed_in(with_law(plain_model(), [&](const CuttingModel::Tip& tip) {
    switch (++calls % 3) {
      case 0:
        return CuttingModel::Law{nan, tip.viscosity_Ns_per_mm};
      case 1:
        return CuttingModel::Law{-1.0, tip.viscosity_Ns_per_mm};
      default:
        return CuttingModel::Law{tip.cutting_N, std::numeric_limits<double>::infinity()};
    }
  }));
  expect_plain_forces(steps);
  const auto flagged = std::count_if(steps.begin(), steps.end(),
                                     [](const Step& step) { return (step.flags & Step::unusable_law) != 0; });
  EXPECT_GT(flagged, 100);
}

TEST(OwnNeedle, of_the_models_own_kind_changes_no_bit) { expect_plain_forces(pushed_in(with_needle(plain_model()))); }

TEST(OwnNeedle, of_another_length_is_refused_with_both_lengths) {
  const auto model = plain_model()->with({.needle = [](NeedleSection section, int loads) {
    section.length_mm += 10.0;
    return make_needle("beam", section, 0, loads);
  }});
  ASSERT_FALSE(model.ok());
  EXPECT_SAYS(model.error().message(), "130 mm");
  EXPECT_SAYS(model.error().message(), "needle.length_mm is 120");
}

TEST(OwnNeedle, that_cannot_be_made_is_the_makers_error) {
  const auto model = plain_model()->with({.needle = [](const NeedleSection&, int) -> Result<std::unique_ptr<Needle>> {
    return input_error("my needle", "no steel", "Buy some");
  }});
  ASSERT_FALSE(model.ok());
  EXPECT_SAYS(model.error().message(), "no steel");
}

TEST(OwnParts, are_named_in_warnings_and_in_the_reports_parameters) {
  const auto model = plain_model()
                         ->with({.needle = [](const NeedleSection& section,
                                              int loads) { return make_needle("springs", section, 0, loads); },
                                 .cutting = std::make_shared<Given>(built_in)})
                         .value();
  std::string warnings;
  for (const std::string& warning : model->warnings()) warnings += warning + "\n";
  EXPECT_SAYS(warnings, "\"springs\"");
  EXPECT_SAYS(warnings, "\"given\"");
  std::string parameters;
  for (const ParameterRow& row : model->info().parameters) parameters += row.name + " " + row.value + "\n";
  EXPECT_SAYS(parameters, "needle.model springs");
  EXPECT_SAYS(parameters, "law of cutting given");
  EXPECT_EQ(plain_model()->warnings().size() + 2, model->warnings().size()) << "the first model stays as it was";
}

}  // namespace
