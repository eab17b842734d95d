// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/implant_results.hpp"

#include "implant/implant_page.hpp"
#include "output_folder.hpp"
#include "stylet/io/dose_results.hpp"

namespace stylet {

namespace fs = std::filesystem;

Result<> write_implant_results(const ImplantOutcome& outcome, const fs::path& folder, const Progress& progress) {
  auto page = results::implant_page(outcome);
  if (!page) return page.error();
  std::error_code ignored;
  fs::remove(folder / "summary.json", ignored);  // a folder that has it is complete
  if (auto done = write_dose_results(outcome.planned, folder / "planned", progress); !done) return done;
  if (auto done = write_dose_results(outcome.delivered, folder / "delivered", progress); !done) return done;
  return results::write_folder(
      {{"report.html", *std::move(page)}, {"seeds.csv", seeds_csv(outcome)}, {"summary.json", implant_json(outcome)}},
      folder);
}

}  // namespace stylet
