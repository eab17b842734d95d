// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/found_csv.hpp"

#include "implant/seed_rows.hpp"
#include "output_folder.hpp"
#include "record/csv.hpp"

#include <fstream>

namespace stylet {

Result<> results::remove_earlier_found(const std::filesystem::path& folder) {
  std::string first_line;
  std::ifstream stream(folder / "found.csv");
  std::getline(stream, first_line);
  stream.close();
  if (first_line == record::csv_header<FoundRow>()) {  // by which it is known from a file of the user
    if (auto removed = remove_earlier(folder / "found.csv"); !removed) return removed;
  }
  return remove_earlier(folder / "found" / "dose.json");
}

std::string found_csv(const ImplantHistory& history, const FoundImplant& found) {
  using results::FoundRow;
  const FoundComparison& comparison = found.comparison;
  std::vector<const MatchedSeed*> match_of(history.seeds.size(), nullptr);
  for (std::size_t k = 0; k < comparison.seeds.size(); ++k)
    match_of[comparison.matching.pairs[k].dropped] = &comparison.seeds[k];
  std::vector<FoundRow> rows;
  for (std::size_t k = 0; k < history.seeds.size(); ++k)
    rows.push_back(results::row_of_found(history.seeds[k], match_of[k], history, comparison));
  for (const std::size_t k : comparison.matching.extra) {
    FoundRow& row = rows.emplace_back();
    row.found = k;
    row.found_mm = found.seeds.seeds[k].at_mm;
  }
  std::string text = record::csv_header<FoundRow>() + "\n";
  for (const FoundRow& row : rows) text += record::csv_line(row, results::four_decimals) + "\n";
  return text;
}

}  // namespace stylet
