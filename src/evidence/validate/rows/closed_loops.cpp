// SPDX-License-Identifier: GPL-3.0-or-later
// A hand moves a needle in tissue around closed loops. It must not gain energy.
#include "../hand_loops.hpp"
#include "../rows.hpp"
#include "../scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace stylet::validate {

namespace {

constexpr unsigned kLoops = 48;
constexpr int kPassages = 3;
constexpr int kSteps = 500;
constexpr double kBevel_deg = 20.0;
constexpr int kDemoNodes = 2000;

/// The block, with a symmetric or a bevelled tip.
std::shared_ptr<const Model> block_of(TissuePreset preset, bool bevelled) {
  Block block;
  block.direction = {0.05, 0.1, 1.0};
  block.scenario.tissue_model.preset = preset;
  if (bevelled) block.scenario.needle.bevel_deg = kBevel_deg;
  return need(block.compile());
}

/// The demo patient with the demo's needle and template.
std::shared_ptr<const Model> demo() {
  auto meshed = need(measure::mesh_demo(kDemoNodes, {}));
  return need(Model::compile(measure::demo_scenario(), std::move(meshed.mesh), "demo"));
}

Finding closed_loops(Context& context) {
  const std::array scenes{block_of(TissuePreset::linear, false), block_of(TissuePreset::linear, true),
                          block_of(TissuePreset::typical, true), demo()};
  Finding finding;
  Curve bounds{.label = "energy gained", .kind = Curve::Kind::points};
  double most = -1.0, least = 1.0, error = 0.0, stored = 0.0, unaccounted = 0.0;
  bool flagged = false;
  for (unsigned number = 0; number < kLoops; ++number) {
    report(context.progress(), "closed loops", static_cast<double>(number) / kLoops);
    const HandLoop loop(number);
    const auto& model = scenes[number % scenes.size()];
    const HandWork coarse = pass_loop(model, loop, kPassages, kSteps);
    const HandWork fine = pass_loop(model, loop, kPassages, 2 * kSteps);
    const double changed = std::abs(fine.given_back() - coarse.given_back());
    most = worse(fine.given_back() + changed, most);
    least = std::min(least, fine.given_back());
    error = worse(changed, error);
    stored = worse(std::abs(fine.stored) / fine.put_in, stored);
    unaccounted = std::max(unaccounted, -fine.net / fine.put_in);
    flagged = flagged || fine.flags != 0 || coarse.flags != 0;
    bounds.add(loop.size(), 100.0 * (fine.given_back() + changed));
  }
  finding.value = flagged ? std::numeric_limits<double>::quiet_NaN() : 100.0 * worse(most, 0.0);
  finding.note = fmt::format(
      "{} random closed loops of the hand with push and pull, sideways motion, tilt and roll, 20 to 55 mm deep. They "
      "are made in turn in a block of linear tissue with a symmetric tip and with a bevel of {:g}°, in a block of "
      "tissue that stiffens and creeps, and in the demo patient with {} nodes. Each loop is passed {} times and the "
      "last passage counts, because nothing is cut in it and contacts stick and slip in the same way each time. The "
      "change of the energy stored in tissue and needle, at most {:.2g} % of the work of the hand, is taken into "
      "account (otherwise up to {:.2g} % would seem to be gained). The work of force and torque is computed with the "
      "trapezoidal rule in {} steps. With half as many steps the result changes by up to {:.2g} percentage points, and "
      "this change is added to each value. The largest loss in a loop is {:.0f} % of the work of the hand.",
      kLoops, kBevel_deg, kDemoNodes, kPassages, 100.0 * stored, 100.0 * unaccounted, 2 * kSteps, 100.0 * error,
      -100.0 * least);
  finding.why_missed = flagged ? "A step did not converge, or had another flag." : "";
  finding.plot = {.x_label = "size of the loop (1: about 3 mm, 3° and 90° of roll)",
                  .y_label = "energy gained [% of the work of the hand]",
                  .log_x = true,
                  .curves = {std::move(bounds)}};
  return finding;
}

}  // namespace

std::vector<RowSpec> closed_loop_rows() {
  return {
      {"closed_loops", Group::analysis, "A hand that moves the needle around closed loops gains no energy",
       "dissipation ≥ 0", "% of the hand’s work", Accepted::at_most(0.1), false, closed_loops},
  };
}

}  // namespace stylet::validate
