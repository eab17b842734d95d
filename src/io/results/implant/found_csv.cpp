// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/found_csv.hpp"

#include "output_folder.hpp"
#include "stylet/io/implant_results.hpp"

#include <fmt/format.h>

#include <fstream>

namespace stylet {
namespace {

constexpr const char* kFoundCauses[] = {"bend", "motion", "relaxation", "strand", "release", "aim", "probe"};
static_assert(std::size(kFoundCauses) == kSeedCauses);

std::string three_fields(const Vec3& v) { return fmt::format(",{:.4f},{:.4f},{:.4f}", v.x(), v.y(), v.z()); }
std::string three_empty() { return ",,,"; }

/// The first line, by which a file of an earlier run is known from one of the user's.
std::string found_csv_header() {
  std::string text = "seed,needle,found,ambiguous";
  const auto three_columns = [&](const char* what) { text += fmt::format(",{0}_x_mm,{0}_y_mm,{0}_z_mm", what); };
  for (const char* what : {"planned", "dropped", "rest", "found", "error"}) three_columns(what);
  for (const char* cause : kFoundCauses) three_columns(cause);
  for (const char* what : {"remainder", "remainder_without_shift"}) three_columns(what);
  return text;
}

}  // namespace

Result<> results::remove_earlier_found(const std::filesystem::path& folder) {
  std::string first_line;
  std::ifstream stream(folder / "found.csv");
  std::getline(stream, first_line);
  stream.close();
  if (first_line == found_csv_header()) {
    if (auto removed = remove_earlier(folder / "found.csv"); !removed) return removed;
  }
  return remove_earlier(folder / "found" / "dose.json");
}

std::string found_csv(const ImplantHistory& history, const FoundImplant& found) {
  const FoundComparison& comparison = found.comparison;
  std::string text = found_csv_header() + "\n";
  std::vector<const MatchedSeed*> match_of(history.seeds.size(), nullptr);
  for (std::size_t k = 0; k < comparison.seeds.size(); ++k)
    match_of[comparison.matching.pairs[k].dropped] = &comparison.seeds[k];
  for (std::size_t k = 0; k < history.seeds.size(); ++k) {
    const SeedHistory& seed = history.seeds[k];
    const MatchedSeed* matched = match_of[k];
    text += fmt::format("{},{},{},{}", seed.number + 1, results::csv_text(history.needles[seed.needle].name),
                        matched ? fmt::format("{}", matched->found + 1) : "",
                        matched ? fmt::format("{:d}", matched->ambiguous) : "");
    text += three_fields(seed.planned_mm) + three_fields(seed.dropped_mm);
    text += seed.lost ? three_empty() : three_fields(seed.rest_mm);
    text +=
        matched ? three_fields(matched->found_mm) + three_fields(matched->error_mm()) : three_empty() + three_empty();
    for (std::size_t cause = 0; cause < kSeedCauses; ++cause)
      text += seed.lost ? three_empty() : three_fields(seed.cause_mm[cause]);
    text += matched ? three_fields(matched->remainder_mm) +
                          three_fields(matched->remainder_mm - comparison.matching.shift_mm)
                    : three_empty() + three_empty();
    text += "\n";
  }
  for (const std::size_t k : comparison.matching.extra) {
    text += fmt::format(",,{},", k + 1) + three_empty() + three_empty() + three_empty();
    text += three_fields(found.seeds.seeds[k].at_mm);
    for (std::size_t empty = 0; empty < kSeedCauses + 3; ++empty) text += three_empty();
    text += "\n";
  }
  return text;
}

}  // namespace stylet
