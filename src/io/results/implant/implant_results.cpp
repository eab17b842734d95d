// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/implant_results.hpp"

#include "implant/found_csv.hpp"
#include "implant/implant_page.hpp"
#include "output_folder.hpp"
#include "stylet/io/dose_results.hpp"
#include "stylet/io/implant_record_io.hpp"

namespace stylet {

namespace fs = std::filesystem;

Result<> write_implant_results(const ImplantOutcome& outcome, const fs::path& folder, const Progress& progress) {
  auto page = results::implant_page(outcome);
  if (!page) return page.error();
  std::error_code ignored;
  fs::remove(folder / "summary.json", ignored);  // a folder that has it is complete
  if (auto done = write_dose_results(outcome.planned, folder / "planned", progress); !done) return done;
  if (auto done = write_dose_results(outcome.delivered, folder / "delivered", progress); !done) return done;
  std::vector<results::File> files{{"report.html", *std::move(page)}, {"seeds.csv", seeds_csv(outcome)}};
  if (outcome.found) {
    if (auto done = write_dose_results(outcome.found->dose, folder / "found", progress); !done) return done;
    files.push_back({"found.csv", found_csv(outcome.history, *outcome.found)});
  } else {
    if (auto removed = results::remove_earlier_found(folder); !removed) return removed;
  }
  if (auto done = write_implant_record(implant_record(outcome), folder / "run.h5"); !done) return done;
  files.push_back({"summary.json", implant_json(outcome)});
  return results::write_folder(files, folder);
}

}  // namespace stylet
