// SPDX-License-Identifier: GPL-3.0-or-later
// Source models in JSON (docs/formats.md).
#include "dose/dose_parsers.hpp"
#include "dose/json_object.hpp"
#include "reading/ask.hpp"
#include "reading/tasks.hpp"
#include "stylet/io/dose_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace stylet {

namespace {

using detail::JsonObject;

const std::vector<std::string> kSourceKeys{"format",
                                           "version",
                                           "name",
                                           "title",
                                           "isotope",
                                           "citation",
                                           "half_life_days",
                                           "dose_rate_constant",
                                           "active_length_mm",
                                           "outer_length_mm",
                                           "outer_diameter_mm",
                                           "g",
                                           "F",
                                           "phi_an"};

/// Reads the values of F: a list of rows, one for each angle, with null where there is no value.
Result<> take_F(const JsonObject& object, SourceModel& source) {
  const auto rows = static_cast<Eigen::Index>(source.F_theta_deg.size());
  const auto columns = static_cast<Eigen::Index>(source.F_r_mm.size());
  const auto wrong = [&](const std::string& what) {
    return input_error(
        object.place("values"), what,
        fmt::format("Give {} rows (one for each angle) of {} numbers (one for each radius)", rows, columns));
  };
  if (!object.has("values") || !object.at("values").is_array() ||
      object.at("values").size() != static_cast<std::size_t>(rows))
    return wrong("the table does not have one row for each angle");
  source.F.resize(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    const auto& row = object.at("values")[static_cast<std::size_t>(i)];
    if (!row.is_array() || row.size() != static_cast<std::size_t>(columns))
      return wrong(fmt::format("row {} does not have one number for each radius", i + 1));
    for (Eigen::Index j = 0; j < columns; ++j) {
      const auto& value = row[static_cast<std::size_t>(j)];
      if (!value.is_null() && !value.is_number())
        return wrong(fmt::format("row {} has a value that is no number", i + 1));
      source.F(i, j) = value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
    }
  }
  return Ok{};
}

/// Publications give radii in cm; a table of g that ends at 15 or below and has 1 at 1 is one that was not converted.
Result<> check_radii(const SourceModel& source, const std::string& file) {
  if (source.g.empty() || source.g.size() != source.g_r_mm.size()) return Ok{};
  if (*std::max_element(source.g_r_mm.begin(), source.g_r_mm.end()) > 15.0) return Ok{};
  for (std::size_t k = 0; k < source.g.size(); ++k) {
    if (std::abs(source.g_r_mm[k] - 1.0) > 1e-9 || std::abs(source.g[k] - 1.0) > 1e-3) continue;
    return input_error(
        file + ", 'g'",
        fmt::format("the radii end at {:g}, and g is 1 at 1; they seem to be in cm", source.g_r_mm.back()),
        "Give all radii in mm (g is 1 at 10 mm)");
  }
  return Ok{};
}

}  // namespace

Result<SourceModel> read_source_model(const std::filesystem::path& path) {
  return detail::ask(detail::kSourceModel, path);
}

Result<SourceModel> detail::parse_source_model(const std::filesystem::path& path) {
  const std::string file = path.string();
  const Result<nlohmann::json> json = detail::read_json(path, "stylet-source", 1);
  if (!json) return json.error();
  const JsonObject object(*json, file);
  if (Result<> keys = object.check_keys(kSourceKeys); !keys) return keys.error();
  SourceModel source;
  for (const auto& [key, text] : {std::pair("name", &source.name), std::pair("title", &source.title),
                                  std::pair("isotope", &source.isotope), std::pair("citation", &source.citation)}) {
    if (Result<> taken = object.take(key, *text); !taken) return taken.error();
  }
  for (const auto& [key, number] :
       {std::pair("half_life_days", &source.half_life_days),
        std::pair("dose_rate_constant", &source.dose_rate_constant),
        std::pair("active_length_mm", &source.active_length_mm), std::pair("outer_length_mm", &source.outer_length_mm),
        std::pair("outer_diameter_mm", &source.outer_diameter_mm)}) {
    if (Result<> taken = object.take(key, *number); !taken) return taken.error();
  }
  if (source.name.empty()) source.name = path.stem().string();
  for (const char* needed : {"g", "F"}) {
    if (!object.has(needed))
      return input_error(file, fmt::format("the table '{}' is missing", needed),
                         "Add it as docs/formats.md describes it");
  }
  const JsonObject g(object.at("g"), file + ", 'g'");
  const JsonObject F(object.at("F"), file + ", 'F'");
  const std::vector<std::string> g_keys{"r_mm", "g_L"}, F_keys{"r_mm", "theta_deg", "values"},
      phi_keys{"r_mm", "values"};
  for (const Result<>& step :
       {g.check_keys(g_keys), g.take("r_mm", source.g_r_mm), g.take("g_L", source.g), F.check_keys(F_keys),
        F.take("r_mm", source.F_r_mm), F.take("theta_deg", source.F_theta_deg)}) {
    if (!step) return step.error();
  }
  if (Result<> taken = take_F(F, source); !taken) return taken.error();
  if (object.has("phi_an")) {
    const JsonObject phi(object.at("phi_an"), file + ", 'phi_an'");
    for (const Result<>& step :
         {phi.check_keys(phi_keys), phi.take("r_mm", source.phi_r_mm), phi.take("values", source.phi)}) {
      if (!step) return step.error();
    }
  }
  if (Result<> radii = check_radii(source, file); !radii) return radii.error();
  if (Result<> good = check_source(source, file); !good) return good.error();
  return source;
}

}  // namespace stylet
