// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/seed_rows.hpp"
#include "record/csv.hpp"
#include "stylet/io/implant_results.hpp"

namespace stylet {

std::string seeds_csv(const ImplantOutcome& outcome) {
  results::SeedRow example;
  example.implant = implant_of(outcome.history.seeds);
  std::string text = record::csv_header(example) + "\n";
  for (const SeedHistory& seed : outcome.history.seeds)
    text += record::csv_line(results::row_of_seed(seed, outcome), results::four_decimals) + "\n";
  return text;
}

}  // namespace stylet
