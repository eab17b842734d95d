// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/imaging/xray_materials.hpp"

#include "stylet/sim/supports.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace stylet {

namespace {

/// One line of a table of attenuation.
struct TabulatedAttenuation {
  double energy_keV, cm2_per_g;
};

// Mass attenuation coefficients of NIST Standard Reference Database 126: Hubbell, J. H. and Seltzer, S. M. (2004),
// Tables of X-Ray Mass Attenuation Coefficients (version 1.4), National Institute of Standards and Technology,
// doi:10.18434/T4D01F. Tissues are those of ICRU Report 44. Two lines with one energy are an absorption edge.
constexpr TabulatedAttenuation kWater[] = {{20, 0.8096}, {30, 0.3756}, {40, 0.2683},  {50, 0.2269},
                                           {60, 0.2059}, {80, 0.1837}, {100, 0.1707}, {150, 0.1505}};
constexpr TabulatedAttenuation kSoftTissue[] = {{20, 0.8230}, {30, 0.3790}, {40, 0.2688},  {50, 0.2264},
                                                {60, 0.2048}, {80, 0.1823}, {100, 0.1693}, {150, 0.1492}};
constexpr TabulatedAttenuation kMuscle[] = {{20, 0.8205}, {30, 0.3783}, {40, 0.2685},  {50, 0.2262},
                                            {60, 0.2048}, {80, 0.1823}, {100, 0.1693}, {150, 0.1492}};
constexpr TabulatedAttenuation kFatTissue[] = {{20, 0.5677}, {30, 0.3063}, {40, 0.2396},  {50, 0.2123},
                                               {60, 0.1974}, {80, 0.1800}, {100, 0.1688}, {150, 0.1500}};
constexpr TabulatedAttenuation kCorticalBone[] = {{20, 4.001},  {30, 1.331},  {40, 0.6655},  {50, 0.4242},
                                                  {60, 0.3148}, {80, 0.2229}, {100, 0.1855}, {150, 0.1480}};
constexpr TabulatedAttenuation kTitanium[] = {{20, 15.85},  {30, 4.972},  {40, 2.214},   {50, 1.213},
                                              {60, 0.7661}, {80, 0.4052}, {100, 0.2721}, {150, 0.1649}};
constexpr TabulatedAttenuation kIron[] = {{20, 25.68}, {30, 8.176},  {40, 3.629},   {50, 1.958},
                                          {60, 1.205}, {80, 0.5952}, {100, 0.3717}, {150, 0.1964}};
constexpr TabulatedAttenuation kSilver[] = {{20, 18.36}, {25.514, 9.527}, {25.514, 55.39}, {30, 36.68},  {40, 17.20},
                                            {50, 9.444}, {60, 5.766},     {80, 2.651},     {100, 1.470}, {150, 0.5426}};
constexpr TabulatedAttenuation kIodine[] = {{20, 25.43},  {30, 8.561},  {33.1694, 6.553}, {33.1694, 35.82},
                                            {40, 22.10},  {50, 12.32},  {60, 7.579},      {80, 3.510},
                                            {100, 1.942}, {150, 0.6978}};

std::span<const TabulatedAttenuation> table_of(XrayMaterial material) {
  switch (material) {
    case XrayMaterial::water:
      return kWater;
    case XrayMaterial::soft_tissue:
      return kSoftTissue;
    case XrayMaterial::muscle:
      return kMuscle;
    case XrayMaterial::fat:
      return kFatTissue;
    case XrayMaterial::cortical_bone:
      return kCorticalBone;
    case XrayMaterial::titanium:
      return kTitanium;
    case XrayMaterial::iron:
      return kIron;
    case XrayMaterial::silver:
      return kSilver;
    case XrayMaterial::iodine:
      return kIodine;
  }
  return kWater;
}

constexpr double kPerCmToPerMm = 0.1;

}  // namespace

double density_g_per_cm3(XrayMaterial material) {
  constexpr std::array kDensities{1.0, 1.06, 1.05, 0.95, 1.92, 4.54, 7.874, 10.50, 4.93};
  return kDensities.at(static_cast<std::size_t>(material));
}

double mass_attenuation_cm2_per_g(XrayMaterial material, double energy_keV) {
  const std::span<const TabulatedAttenuation> table = table_of(material);
  const auto above =
      std::upper_bound(table.begin(), table.end(), energy_keV,
                       [](double energy, const TabulatedAttenuation& line) { return energy < line.energy_keV; });
  if (above == table.begin()) return table.front().cm2_per_g;
  if (above == table.end()) return table.back().cm2_per_g;
  const TabulatedAttenuation& below = *std::prev(above);
  const double share = std::log(energy_keV / below.energy_keV) / std::log(above->energy_keV / below.energy_keV);
  return below.cm2_per_g * std::pow(above->cm2_per_g / below.cm2_per_g, share);
}

double attenuation_per_mm(XrayMaterial material, double energy_keV) {
  return kPerCmToPerMm * density_g_per_cm3(material) * mass_attenuation_cm2_per_g(material, energy_keV);
}

double contrast_per_mm(double iodine_mg_per_ml, double energy_keV) {
  const double iodine_g_per_cm3 = 1e-3 * iodine_mg_per_ml;
  return attenuation_per_mm(XrayMaterial::water, energy_keV) +
         kPerCmToPerMm * iodine_g_per_cm3 * mass_attenuation_cm2_per_g(XrayMaterial::iodine, energy_keV);
}

double spongy_bone_per_mm(double energy_keV) {
  constexpr double kMineralised = 0.25;
  return kMineralised * attenuation_per_mm(XrayMaterial::cortical_bone, energy_keV) +
         (1.0 - kMineralised) * attenuation_per_mm(XrayMaterial::fat, energy_keV);
}

double region_attenuation_per_mm(const std::string& region, const FluoroscopySettings& settings) {
  const double energy = settings.energy_keV;
  if (is_bone(region)) return spongy_bone_per_mm(energy);
  if (region == "bladder") return contrast_per_mm(settings.bladder_iodine_mg_per_ml, energy);
  if (region == "rectal_lumen") return attenuation_per_mm(XrayMaterial::water, energy);
  if (region.ends_with("_fat")) return attenuation_per_mm(XrayMaterial::fat, energy);
  const bool muscle = region == "body" || region == "levator" || region == "band";
  return attenuation_per_mm(muscle ? XrayMaterial::muscle : XrayMaterial::soft_tissue, energy);
}

}  // namespace stylet
