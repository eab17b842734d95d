// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/evidence/validate/row.hpp"
#include "stylet/evidence/validate/sensitivity.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace stylet::validate {

struct ValidateOptions {
  bool quick = false;               ///< measures only rows that take a few seconds at most
  bool sensitivity = false;         ///< also runs the sensitivity study of the parameters
  std::vector<std::string> only{};  ///< ids of the rows to measure, or "sensitivity"; empty: all rows
  std::filesystem::path data{};     ///< folder of the shared data
  std::string command{};            ///< command line, shown on the page
};

/// The measured rows and the sensitivity study.
struct Validation {
  ValidateOptions options;
  std::string version;
  double seconds = 0.0;  ///< wall clock
  std::vector<Row> rows;
  std::optional<Sensitivity> sensitivity;

  [[nodiscard]] int count(Verdict verdict) const;
};

/// All rows, group by group.
const std::vector<RowSpec>& all_rows();

/// Measures rows one after the other. It continues after a row that is missed, skipped or crashes.
/// Errors: input, when `only` has an unknown id; failed, when the sensitivity study fails.
Result<Validation> validate(const ValidateOptions& options, const Progress& progress = {});

/// The same with the given rows.
Result<Validation> validate(const std::vector<RowSpec>& rows, const ValidateOptions& options,
                            const Progress& progress = {});

/// JSON with the keys rows[], missed, skipped, sensitivity, machine, … (docs/validation.md).
std::string validation_json(const Validation& validation);

/// The self-contained HTML page. Errors: failed, when the embedded template does not fit the program.
Result<std::string> validation_page(const Validation& validation);

/// Writes validate.html, validate.json, ID.csv for each row with curves, and sensitivity.csv into a folder. A new
/// folder appears complete or not at all. In an existing folder the files are replaced one by one: validate.json is
/// removed first and written last, so that it exists only with complete results.
Result<> write_validation(const Validation& validation, const std::filesystem::path& folder);

}  // namespace stylet::validate
