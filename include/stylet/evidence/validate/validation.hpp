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
  bool quick = false;               ///< only rows that take a few seconds at the most
  bool sensitivity = false;         ///< the study of parameters as well
  std::vector<std::string> only{};  ///< ids of rows, or "sensitivity"; empty: all
  std::filesystem::path data{};     ///< folder of the shared data
  std::string command{};            ///< what the page says it was made with
};

/// Rows and study, carried out.
struct Validation {
  ValidateOptions options;
  std::string version;
  double seconds = 0.0;  ///< wall clock
  std::vector<Row> rows;
  std::optional<Sensitivity> sensitivity;

  [[nodiscard]] int count(Verdict verdict) const;
};

/// All rows there are, group by group.
const std::vector<RowSpec>& all_rows();

/// Measures rows one after the other. A row that misses, is skipped or crashes stops nothing.
/// Errors: input, when `only` names an unknown row; failed, when the study of parameters fails.
Result<Validation> validate(const ValidateOptions& options, const Progress& progress = {});

/// The same with rows of one's own.
Result<Validation> validate(const std::vector<RowSpec>& rows, const ValidateOptions& options,
                            const Progress& progress = {});

/// rows[], missed, skipped, sensitivity, machine, … (docs/validation.md).
std::string validation_json(const Validation& validation);

/// The self-contained page. Errors: failed, when the program was built from files that do not belong together.
Result<std::string> validation_page(const Validation& validation);

/// Fills the folder: validate.html, validate.json, ID.csv for each row with curves, sensitivity.csv. A new folder
/// appears whole or not at all; in one that exists the files are replaced one by one, validate.json goes first and
/// comes last.
Result<> write_validation(const Validation& validation, const std::filesystem::path& folder);

}  // namespace stylet::validate
