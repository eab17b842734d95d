// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/dose_results.hpp"

#include "dose/dose_page.hpp"
#include "output_folder.hpp"
#include "stylet/io/dose_io.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <exception>
#include <fstream>
#include <iterator>

namespace stylet {
namespace fs = std::filesystem;

namespace {

/// The bytes of dose.nrrd: they are written into a hidden file beside the results, which is removed again.
Result<std::string> nrrd_bytes(const DoseGrid& grid, const fs::path& beside) {
  const fs::path hidden = beside / fmt::format(".dose.{}.nrrd", ::getpid());
  std::error_code ignored;
  auto done = write_dose_nrrd(grid, hidden);
  if (!done) {
    fs::remove(hidden, ignored);
    return done.error();
  }
  std::ifstream file(hidden, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  const bool whole = file.good() || file.eof();
  fs::remove(hidden, ignored);
  if (!whole || bytes.empty()) return results::write_error(hidden, "it could not be read again");
  return bytes;
}

Result<> write_all_results(const DoseEvaluation& evaluation, const fs::path& folder, const Progress& progress) {
  const fs::path place = folder.has_filename() ? folder : folder.parent_path();
  std::error_code code;
  const fs::path beside = fs::exists(place, code)   ? place
                          : place.has_parent_path() ? place.parent_path()
                                                    : fs::path(".");
  if (auto ready = results::prepare_folder(beside); !ready) return ready;
  report(progress, "dose grid", 0.0);
  auto nrrd = nrrd_bytes(evaluation.grid, beside);
  if (!nrrd) return nrrd.error();
  report(progress, "report", 0.0);
  auto page = results::dose_page(evaluation);
  if (!page) return page.error();
  auto done = results::write_folder({{"report.html", std::move(*page)},
                                     {"dvh.csv", dvh_csv(evaluation)},
                                     {"dose.nrrd", std::move(*nrrd)},
                                     {"dose.json", dose_json(evaluation)}},
                                    place);
  if (done) report(progress, "report", 1.0);
  return done;
}

}  // namespace

Result<> write_dose_results(const DoseEvaluation& evaluation, const fs::path& folder, const Progress& progress) {
  try {
    return write_all_results(evaluation, folder, progress);
  } catch (const std::exception& e) {
    return failure(folder.string(), fmt::format("cannot be written: {}", e.what()),
                   "Close other programs or use a coarser dose grid, then run again");
  }
}

}  // namespace stylet
