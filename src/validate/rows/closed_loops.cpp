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
Result<std::shared_ptr<const Model>> block_of(TissuePreset preset, bool bevelled) {
  Block block;
  block.direction = {0.05, 0.1, 1.0};
  block.scenario.tissue_model.preset = preset;
  if (bevelled) block.scenario.needle.bevel_deg = kBevel_deg;
  return block.compile();
}

/// The demo patient with the demo's needle and template.
Result<std::shared_ptr<const Model>> demo() {
  auto meshed = mesh_demo(kDemoNodes, {});
  if (!meshed) return meshed.error();
  return Model::compile(demo_scenario(), std::move(meshed->mesh), "demo");
}

Result<Finding> closed_loops(Context& context) {
  std::vector<std::shared_ptr<const Model>> scenes;
  for (const auto& scene : {block_of(TissuePreset::linear, false), block_of(TissuePreset::linear, true),
                            block_of(TissuePreset::typical, true), demo()}) {
    if (!scene) return scene.error();
    scenes.push_back(*scene);
  }
  Finding finding;
  Curve bounds{.label = "given back", .x = {}, .y = {}, .kind = Curve::Kind::points};
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
      "{} random loops of push and pull, sideways, lever and roll, 20 to 55 mm deep, by turns in a block of linear "
      "tissue with a symmetric tip and with a bevel of {:g}°, in a block of tissue that stiffens and creeps, and in "
      "the "
      "demo’s patient on {} nodes. Each is passed {} times and the last passage counts, when cutting is over and "
      "contacts stick "
      "and slide alike each time; what tissue and needle store more or less at its end, at most {:.2g} % of the work "
      "put "
      "in, is accounted for (otherwise up to {:.2g} % would seem given back). Work of force and torque by the "
      "trapezoidal "
      "rule in {} steps; with half as many the share changes by up to {:.2g} percentage points, and that change is "
      "added "
      "to each value. The loop that loses most loses {:.0f} % of what is put in.",
      kLoops, kBevel_deg, kDemoNodes, kPassages, 100.0 * stored, 100.0 * unaccounted, 2 * kSteps, 100.0 * error,
      -100.0 * least);
  finding.why_missed = flagged ? "A step did not converge, or was flagged otherwise." : "";
  finding.plot = {.x_label = "size of the loop (1: some 3 mm, 3° and 90° of roll)",
                  .y_label = "given back [% of the work put in]",
                  .log_x = true,
                  .curves = {std::move(bounds)}};
  return finding;
}

}  // namespace

std::vector<RowSpec> closed_loop_rows() {
  return {
      {"closed_loops", Group::analysis, "A hand that leads the needle around closed loops gets no energy out of it",
       "dissipation ≥ 0", "% of work put in", Accepted::at_most(0.1), false, closed_loops},
  };
}

}  // namespace stylet::validate
