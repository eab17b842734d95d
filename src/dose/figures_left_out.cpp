// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/dose_evaluation.hpp"

#include <fmt/format.h>

#include <array>

namespace stylet {

std::vector<std::string> figures_left_out(const std::vector<StructureDose>& structures) {
  constexpr std::array kVolumes_cc{2.0, 1.0, 0.1};
  std::vector<std::string> sentences;
  for (const StructureDose& structure : structures) {
    std::string names;
    for (const double cc : kVolumes_cc) {
      if (!(structure.dvh.volume_cc() < cc)) continue;
      names += fmt::format("{}D{:g}cc", names.empty() ? "" : ", ", cc);
    }
    if (names.empty()) continue;
    sentences.push_back(
        fmt::format("'{}' has {:.2f} cc only, so it has no {}.", structure.name, structure.dvh.volume_cc(), names));
  }
  return sentences;
}

}  // namespace stylet
