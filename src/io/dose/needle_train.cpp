// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/needle_train.hpp"

#include "detail/text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stylet::detail {

Result<std::vector<double>> seeds_of_train(const std::string& train, const TrainLengths& lengths,
                                           const std::string& where) {
  constexpr double most_spacers = 50;
  std::vector<double> seeds;
  double end_mm = 0.0;
  int position = 0;
  for (const std::string_view part : split(train, '-')) {
    ++position;
    const std::string element = trimmed(part);
    if (element == "S" || element == "s") {
      seeds.push_back(end_mm + 0.5 * lengths.seed_mm);
      end_mm += lengths.seed_mm;
      continue;
    }
    const auto spacers = to_number(element);
    if (!spacers || *spacers < 0 || *spacers > most_spacers || *spacers != std::floor(*spacers)) {
      return input_error(where,
                         fmt::format("element {} of the train '{}' is '{}'; S or a whole number of spacers is expected",
                                     position, train, element),
                         "Write the train from the tip on, such as S-1-S-2-S");
    }
    end_mm += *spacers * lengths.spacer_mm;
  }
  if (seeds.empty())
    return input_error(where, fmt::format("the train '{}' has no seed", train), "Write S for each seed, such as S-1-S");
  return seeds;
}

}  // namespace stylet::detail
