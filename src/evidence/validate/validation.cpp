// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/evidence/validate/validation.hpp"

#include "stylet/core/nearest_name.hpp"
#include "stylet/core/version.hpp"
#include "stylet/evidence/validate/context.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

namespace stylet::validate {

namespace {

constexpr const char* kSensitivity = "sensitivity";

Result<> check_ids(const std::vector<RowSpec>& rows, const std::vector<std::string>& only) {
  std::vector<std::string> known;
  for (const RowSpec& row : rows) known.push_back(row.id);
  known.emplace_back(kSensitivity);
  for (const std::string& id : only) {
    if (std::find(known.begin(), known.end(), id) != known.end()) continue;
    const std::string near = nearest_name(id, known);
    return input_error("--only", fmt::format("there is no row '{}'", id),
                       near.empty() ? "Print all rows with --list" : fmt::format("Did you mean '{}'?", near));
  }
  return Ok{};
}

}  // namespace

int Validation::count(Verdict verdict) const {
  return static_cast<int>(
      std::count_if(rows.begin(), rows.end(), [&](const Row& row) { return row.verdict == verdict; }));
}

Result<Validation> validate(const std::vector<RowSpec>& rows, const ValidateOptions& options,
                            const Progress& progress) {
  if (auto known = check_ids(rows, options.only); !known) return known.error();
  const auto asked = [&](const std::string& id) {
    return std::find(options.only.begin(), options.only.end(), id) != options.only.end();
  };
  Validation out;
  out.options = options;
  out.version = version();
  const auto started = std::chrono::steady_clock::now();

  std::vector<const RowSpec*> chosen;
  for (const RowSpec& row : rows) {
    // A row that is named with --only is measured even with --quick.
    if (options.only.empty() ? row.quick || !options.quick : asked(row.id)) chosen.push_back(&row);
  }
  // The stages that a row reports are shown after the row's number.
  std::string stage;
  double done = 0.0;
  const auto inner = [&](std::string_view what, double) { report(progress, fmt::format("{}: {}", stage, what), done); };
  Context context(options.quick, options.data, progress ? Progress(inner) : Progress{});
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    stage = fmt::format("row {} of {}, {}", i + 1, chosen.size(), chosen[i]->id);
    done = static_cast<double>(i) / static_cast<double>(chosen.size());
    report(progress, stage, done);
    out.rows.push_back(measure(*chosen[i], context));
  }
  if (options.sensitivity || asked(kSensitivity)) {
    auto study = measure_sensitivity(options.quick, progress);
    if (!study) return study.error();
    out.sensitivity = std::move(*study);
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  return out;
}

Result<Validation> validate(const ValidateOptions& options, const Progress& progress) {
  return validate(all_rows(), options, progress);
}

}  // namespace stylet::validate
