// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/section.hpp"

#include "needle/number_text.hpp"

#include <cmath>
#include <numbers>
#include <string>

namespace stylet {

namespace {

constexpr double kSteelYoung_MPa = 210e3;
constexpr double kLargestBow = 0.1;  ///< largest bow / length
constexpr int kFewestElements = 4;
constexpr int kMostElements = 500;

}  // namespace

Result<> check_needle(const NeedleSection& section, int elements, int load_capacity) {
  if (!is_positive(section.length_mm)) return not_positive("length", "mm", section.length_mm);
  if (!is_positive(section.outer_diameter_mm)) return not_positive("outer diameter", "mm", section.outer_diameter_mm);
  if (!is_positive(section.bending_stiffness_Nmm2)) {
    return not_positive("bending stiffness", "N mm²", section.bending_stiffness_Nmm2);
  }
  if (!is_positive(section.torsion_stiffness_Nmm2)) {
    return not_positive("torsion stiffness", "N mm²", section.torsion_stiffness_Nmm2);
  }
  const double solid = kSteelYoung_MPa * std::numbers::pi * std::pow(section.outer_diameter_mm, 4) / 64.0;
  if (section.bending_stiffness_Nmm2 > 1.1 * solid) {
    return input_error("needle, bending stiffness",
                       number_text(section.bending_stiffness_Nmm2) + " N mm², but a solid steel rod of " +
                           number_text(section.outer_diameter_mm) + " mm has " + number_text(std::round(solid)) +
                           " N mm² (E = 210 GPa), and no needle is stiffer",
                       "Check the units (N mm²) and the outer diameter (mm)");
  }
  const double largest_bow = kLargestBow * section.length_mm;
  if (!(section.bow_mm >= 0.0 && section.bow_mm <= largest_bow)) {
    return input_error(
        "needle, bow",
        number_text(section.bow_mm) + " mm, expected 0 … " + number_text(largest_bow) + " mm, a tenth of the length",
        "Give the tip's distance from the axis of the unloaded needle; give its side as bow_deg");
  }
  if (!std::isfinite(section.bow_deg)) {
    return input_error("needle, direction of the bow", "it is not a finite number", "Give an angle in degrees");
  }
  if (elements < kFewestElements || elements > kMostElements) {
    return input_error("needle, elements", std::to_string(elements) + ", expected 4…500",
                       "Use 24, with which a 200 mm needle is accurate to 0.1 %");
  }
  if (load_capacity < 1) {
    return input_error("needle, load capacity", std::to_string(load_capacity) + ", expected at least 1",
                       "Give the largest number of loads of any call");
  }
  return Ok{};
}

}  // namespace stylet
