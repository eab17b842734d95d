// SPDX-License-Identifier: GPL-3.0-or-later
// Parts that a program brings in place of those of the scenario: a law of cutting, a needle.
#include "box_patient.hpp"

#include "stylet/needle/make_needle.hpp"
#include "stylet/sim/hole_map.hpp"

#include <cmath>
#include <functional>
#include <limits>

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

void expect_same_forces(const Finished& a, const Finished& b) {
  ASSERT_EQ(a.kept.steps.size(), b.kept.steps.size());
  for (std::size_t k = 0; k < a.kept.steps.size(); ++k) {
    ASSERT_EQ(a.kept.steps[k].hand_force_N, b.kept.steps[k].hand_force_N) << "step " << k;
    ASSERT_EQ(a.kept.steps[k].tip_mm, b.kept.steps[k].tip_mm) << "step " << k;
  }
}

const Finished& standard() {
  static const Finished run(compiled(box_scenario()));
  return run;
}

TEST(OwnCuttingLaw, that_gives_the_built_in_numbers_changes_no_bit) {
  expect_same_forces(Finished(with_law(standard().model, built_in)), standard());
}

TEST(OwnCuttingLaw, is_asked_in_the_region_and_at_the_place_of_the_tip) {
  const auto model = compiled(box_scenario());
  std::vector<CuttingModel::Tip> asked;
  const Finished run(with_law(model, [&](const CuttingModel::Tip& tip) {
    asked.push_back(tip);
    return built_in(tip);
  }));
  ASSERT_FALSE(asked.empty());
  double fastest = 0.0;
  for (const CuttingModel::Tip& tip : asked) {
    ASSERT_GE(tip.region, 0);
    EXPECT_EQ(tip.cutting_N, model->laws()[static_cast<std::size_t>(tip.region)].cutting_N);
    EXPECT_EQ(tip.viscosity_Ns_per_mm, model->coupling().tip_viscosity_Ns_per_mm);
    // On the border between two regions the one behind it counts, which a small step forward tells.
    const auto at = model->locator().find(tip.at_mm + 1e-6 * model->insertions().front().direction);
    if (at) EXPECT_EQ(tip.region, model->mesh().tet_region[static_cast<std::size_t>(at->tet)]) << tip.at_mm.transpose();
    fastest = std::max(fastest, tip.cut_mm_per_s);
  }
  EXPECT_GT(fastest, 30.0) << "the base moves at 40 mm/s";
}

// A tip that cuts steadily with the speed v bears C + η v, whoever says what C and η are.
TEST(OwnCuttingLaw, is_what_a_steadily_cutting_tip_bears) {
  constexpr double kC_N = 0.9;
  constexpr double kEta_Ns_per_mm = 0.02;
  const auto model = compiled(box_scenario());
  Simulation simulation(with_law(model, [](const CuttingModel::Tip&) {
    return CuttingModel::Law{kC_N, kEta_Ns_per_mm};
  }));
  const PlannedInsertion& plan = model->insertions().front();
  simulation.place(plan.motion.at(0.0), plan.entry, plan.direction);
  const double dt = 1e-3 * model->scenario().run.dt_ms;
  double before_mm = 0.0;
  int compared = 0;
  for (int k = 1; k * dt < plan.motion.duration_s(); ++k) {
    simulation.prepare();
    const Step& step = simulation.step(plan.motion.at(k * dt), dt);
    const double tip_mm = (step.tip_mm - plan.entry).dot(plan.direction);
    if (step.tip_state == TipState::cutting && simulation.new_events().empty()) {
      for (const ContactState& contact : simulation.insertion().contacts()) {
        if (!contact.tip) continue;
        // The speed in the undeformed tissue is the cut's own; in space the tip moves nearly as fast.
        const double speed = (tip_mm - before_mm) / dt;
        EXPECT_NEAR(contact.force.dot(plan.direction), kC_N + kEta_Ns_per_mm * speed, 0.25);
        EXPECT_GE(contact.force.dot(plan.direction), kC_N - 1e-6);
        ++compared;
      }
    }
    before_mm = tip_mm;
  }
  EXPECT_GT(compared, 50);
}

TEST(OwnCuttingLaw, that_gives_no_usable_number_is_flagged_and_the_built_in_law_used) {
  for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Finished run(with_law(standard().model, [=](const CuttingModel::Tip& tip) {
      return CuttingModel::Law{bad, tip.viscosity_Ns_per_mm};
    }));
    expect_same_forces(run, standard());
    EXPECT_TRUE(std::any_of(run.kept.steps.begin(), run.kept.steps.end(),
                            [](const Step& step) { return (step.flags & Step::invalid_input) != 0; }));
  }
}

TEST(OwnNeedle, of_the_models_own_kind_changes_no_bit) {
  expect_same_forces(Finished(with_needle(standard().model)), standard());
}

TEST(OwnNeedle, of_another_length_is_refused_with_both_lengths) {
  const auto model = standard().model->with({.needle = [](NeedleSection section, int loads) {
    section.length_mm += 10.0;
    return make_needle("beam", section, 0, loads);
  }});
  ASSERT_FALSE(model.ok());
  EXPECT_SAYS(model.error().message(), "130 mm");
  EXPECT_SAYS(model.error().message(), "needle.length_mm is 120");
}

TEST(OwnNeedle, that_cannot_be_made_is_the_makers_error) {
  const auto model =
      standard().model->with({.needle = [](const NeedleSection&, int) -> Result<std::unique_ptr<Needle>> {
        return input_error("my needle", "no steel", "Buy some");
      }});
  ASSERT_FALSE(model.ok());
  EXPECT_SAYS(model.error().message(), "no steel");
}

TEST(OwnParts, are_named_in_warnings_and_in_the_reports_parameters) {
  const auto model = standard()
                         .model
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
  EXPECT_EQ(standard().model->warnings().size() + 2, model->warnings().size()) << "the first model stays as it was";
}

}  // namespace
