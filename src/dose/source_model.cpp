// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/dose/source_model.hpp"

#include <cmath>
#include <cstdio>

namespace stylet {

namespace {

std::string text(double value) {
  char out[32];
  std::snprintf(out, sizeof out, "%g", value);
  return out;
}

/// Above these no source is: doses of such a source would not be finite, or mean nothing. Published sources have a
/// dose-rate constant of about 1 cGy/(h U), and functions of the order of 1.
constexpr double kMostHalfLife_days = 1e6;
constexpr double kMostRateConstant = 100.0;
constexpr double kMostOfFunction = 1000.0;  // g, F and phi_an
constexpr double kLongest_mm = 1000.0;

bool is_possible(double value, double most) { return value > 0.0 && value <= most; }

std::string expected(double most) { return ", expected a number above 0, at most " + text(most); }

Result<> check_positive(double value, double most, const std::string& where, const char* name, const char* cure) {
  if (is_possible(value, most)) return Ok{};
  return input_error(where + ", " + name, "it is " + text(value) + expected(most), cure);
}

/// Checks radii or angles.
Result<> check_ascending(const std::vector<double>& values, const std::string& where, const char* name, double from,
                         double to) {
  if (values.empty()) return input_error(where + ", " + name, "the table is empty", "Give at least one value");
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool in_range = std::isfinite(values[i]) && values[i] >= from && values[i] <= to;
    if (in_range && (i == 0 || values[i] > values[i - 1])) continue;
    return input_error(where + ", " + name,
                       "value " + std::to_string(i + 1) + " is " + text(values[i]) + ", expected ascending values " +
                           text(from) + " … " + text(to),
                       "Sort the table and check its unit");
  }
  return Ok{};
}

Result<> check_table(const std::vector<double>& radii, const std::vector<double>& values, const std::string& where,
                     const char* name) {
  if (auto good = check_ascending(radii, where, name, 0.0, 1e4); !good) return good;
  if (values.size() != radii.size()) {
    return input_error(where + ", " + name,
                       std::to_string(values.size()) + " values for " + std::to_string(radii.size()) + " radii",
                       "Give one value for each radius");
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!is_possible(values[i], kMostOfFunction)) {
      return input_error(where + ", " + name,
                         "at " + text(radii[i]) + " mm it is " + text(values[i]) + expected(kMostOfFunction),
                         "Correct the value, or leave the radius out");
    }
  }
  return Ok{};
}

Result<> check_anisotropy(const SourceModel& source, const std::string& where) {
  if (auto good = check_ascending(source.F_r_mm, where, "radii of F", 0.0, 1e4); !good) return good;
  if (auto good = check_ascending(source.F_theta_deg, where, "angles of F", 0.0, 180.0); !good) return good;
  const auto n = static_cast<Eigen::Index>(source.F_theta_deg.size());
  const auto m = static_cast<Eigen::Index>(source.F_r_mm.size());
  if (source.F.rows() != n || source.F.cols() != m) {
    return input_error(where + ", F",
                       "it has " + std::to_string(source.F.rows()) + " × " + std::to_string(source.F.cols()) +
                           " values for " + std::to_string(n) + " angles and " + std::to_string(m) + " radii",
                       "Give one row for each angle and one column for each radius");
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < m; ++j) {
      const double value = source.F(i, j);
      if (std::isnan(value) ? j + 1 < m : is_possible(value, kMostOfFunction)) continue;
      return input_error(where + ", F",
                         "at " + text(source.F_theta_deg[static_cast<std::size_t>(i)]) + " degrees and " +
                             text(source.F_r_mm[static_cast<std::size_t>(j)]) + " mm it is " + text(value) +
                             expected(kMostOfFunction),
                         "Correct the value; only radii below the largest may lack one");
    }
  }
  return Ok{};
}

}  // namespace

Result<> check_source(const SourceModel& source, const std::string& where) {
  if (auto good =
          check_positive(source.half_life_days, kMostHalfLife_days, where, "half-life", "Give the half-life in days");
      !good)
    return good;
  if (auto good = check_positive(source.dose_rate_constant, kMostRateConstant, where, "dose-rate constant",
                                 "Give the dose-rate constant in cGy/(h U)");
      !good)
    return good;
  if (!(source.active_length_mm >= 0.0 && source.active_length_mm <= kLongest_mm)) {
    return input_error(where + ", active length",
                       "it is " + text(source.active_length_mm) + " mm, expected 0 … " + text(kLongest_mm),
                       "Give the length of the line source in mm, or 0 for a point source");
  }
  if (auto good = check_table(source.g_r_mm, source.g, where, "g"); !good) return good;
  if (source.g_r_mm.back() < 10.0) {
    return input_error(where + ", g", "the last radius is " + text(source.g_r_mm.back()) + " mm, expected 10 or more",
                       "Give g at 10 mm, where it is 1, and beyond");
  }
  if (auto good = check_anisotropy(source, where); !good) return good;
  if (source.phi.empty() && source.phi_r_mm.empty()) return Ok{};
  return check_table(source.phi_r_mm, source.phi, where, "phi_an");
}

}  // namespace stylet
