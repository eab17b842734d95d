// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/plausible_size.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace stylet {

namespace {

// A patient between knee and navel, or a phantom, has a size between these; a unit that gives such a size is named.
constexpr double kUsualLow_mm = 25.0;
constexpr double kUsualHigh_mm = 1500.0;

struct Unit {
  double mm;
  const char* name;
};
constexpr std::array kUnits{Unit{1.0, "millimetres"}, Unit{1000.0, "metres"}, Unit{10.0, "centimetres"},
                            Unit{0.001, "micrometres"}};

}  // namespace

Result<> check_size(double extent_mm, const std::string& where, const std::string& what, double unit_mm,
                    double smallest_mm) {
  if (!std::isfinite(extent_mm) || (extent_mm >= smallest_mm && extent_mm <= kLargestPatient_mm)) return Ok{};
  const double in_file = extent_mm / unit_mm;
  std::string guess = unit_mm == 1.0 ? "; its coordinates are probably not in mm" : "";
  std::string unit = "S";
  for (const Unit& candidate : kUnits) {
    const double size = in_file * candidate.mm;
    if (candidate.mm == unit_mm || size < kUsualLow_mm || size > kUsualHigh_mm) continue;
    guess = fmt::format("; its coordinates are probably in {}{}", candidate.name, unit_mm == 1.0 ? ", not in mm" : "");
    unit = fmt::format("{:g}", candidate.mm);
    break;
  }
  const std::string taken = unit_mm == 1.0 ? "" : fmt::format(" with a unit of {:g} mm", unit_mm);
  const std::string explained = unit == "S" ? ", S being the mm of a unit in the file" : "";
  return input_error(where,
                     fmt::format("{} is {:.4g} mm across{}, {:g} to {:g} mm is expected{}", what, extent_mm, taken,
                                 smallest_mm, kLargestPatient_mm, guess),
                     fmt::format("State the unit: patient.scale = {} in a scenario, --scale {} for info and mesh{}",
                                 unit, unit, explained));
}

}  // namespace stylet
