// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/section.hpp"

#include <cmath>
#include <numbers>
#include <string>

namespace stylet {

namespace {

constexpr double kSteelYoung_MPa = 210e3;
constexpr int kFewestElements = 4;
constexpr int kMostElements = 500;

std::string number(double value) {
  std::string text = std::to_string(value);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return text;
}

Error not_positive(const char* name, const char* unit, double value) {
  return input_error(std::string("needle, ") + name, number(value) + " " + unit + ", expected a finite number above 0",
                     std::string("Give the needle's ") + name + " in " + unit);
}

bool positive(double value) { return std::isfinite(value) && value > 0.0; }

}  // namespace

Result<> check_needle(const NeedleSection& section, int elements, int load_capacity) {
  if (!positive(section.length_mm)) return not_positive("length", "mm", section.length_mm);
  if (!positive(section.outer_diameter_mm)) return not_positive("outer diameter", "mm", section.outer_diameter_mm);
  if (!positive(section.bending_stiffness_Nmm2)) {
    return not_positive("bending stiffness", "N mm²", section.bending_stiffness_Nmm2);
  }
  if (!positive(section.torsion_stiffness_Nmm2)) {
    return not_positive("torsion stiffness", "N mm²", section.torsion_stiffness_Nmm2);
  }
  const double solid = kSteelYoung_MPa * std::numbers::pi * std::pow(section.outer_diameter_mm, 4) / 64.0;
  if (section.bending_stiffness_Nmm2 > 1.1 * solid) {
    return input_error("needle, bending stiffness",
                       number(section.bending_stiffness_Nmm2) + " N mm², but a solid steel rod of " +
                           number(section.outer_diameter_mm) + " mm has " + number(std::round(solid)) +
                           " N mm² (E = 210 GPa), and no needle is stiffer",
                       "Check the units (N mm²) and the outer diameter (mm)");
  }
  if (elements < kFewestElements || elements > kMostElements) {
    return input_error("needle, elements", std::to_string(elements) + ", expected 4…500",
                       "24 elements follow a 200 mm needle to 0.1 %");
  }
  if (load_capacity < 1) {
    return input_error("needle, load capacity", std::to_string(load_capacity) + ", expected at least 1",
                       "Give the largest number of loads of any call");
  }
  return Ok{};
}

}  // namespace stylet
