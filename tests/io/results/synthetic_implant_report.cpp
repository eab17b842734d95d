// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the result folder of an invented implant, for work on the report of stylet implant; with found seeds,
// compensation and span if all is asked for:
//   synthetic_implant_report OUT/ [all]
#include "synthetic_implant.hpp"

#include <cstdio>
#include <string_view>

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: synthetic_implant_report OUT/ [all]\n");
    return 2;
  }
  stylet::ImplantOutcome outcome = stylet::testing::synthetic_implant(1.0, 0.5);
  if (argc > 2 && std::string_view(argv[2]) == "all") {
    stylet::testing::add_invented_found_seeds(outcome);
    outcome.spans = {{"tissue firm", outcome.history, outcome.delivered},
                     {"tissue soft", outcome.history, outcome.delivered}};
    for (stylet::SeedHistory& seed : outcome.spans[0].history.seeds) seed.rest_mm -= 0.4 * seed.error_mm();
    for (stylet::SeedHistory& seed : outcome.spans[1].history.seeds) seed.rest_mm += 0.5 * seed.error_mm();
    outcome.before = outcome.spans[1];
  }
  const auto done = stylet::write_implant_results(outcome, argv[1]);
  if (!done) std::fprintf(stderr, "%s\n", done.error().message().c_str());
  return done ? 0 : 1;
}
