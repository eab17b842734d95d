// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/imaging_settings.hpp"

#include <string>

namespace stylet {

/// The materials of X-ray pictures.
enum class XrayMaterial { water, soft_tissue, muscle, fat, cortical_bone, titanium, iron, silver, iodine };

/// Density of a material [g/cm³], as in the tables that give its attenuation.
double density_g_per_cm3(XrayMaterial material);

/// Mass attenuation coefficient μ/ρ [cm²/g], coherent scattering included, interpolated in log-log between the
/// tabulated energies; absorption edges are kept. Energies outside 20…150 keV get the value at the end of the table.
/// @param energy_keV of the photons
/// Source: Hubbell and Seltzer, NIST Standard Reference Database 126 (doi:10.18434/T4D01F); tissues of ICRU Report 44.
double mass_attenuation_cm2_per_g(XrayMaterial material, double energy_keV);

/// Linear attenuation coefficient μ of a material with its own density [1/mm].
double attenuation_per_mm(XrayMaterial material, double energy_keV);

/// Linear attenuation coefficient of water with iodine [1/mm].
/// @param iodine_mg_per_ml mass of iodine in a volume of solution
double contrast_per_mm(double iodine_mg_per_ml, double energy_keV);

/// Linear attenuation coefficient of the inside of a bone [1/mm]: a quarter is mineralised bone, the rest marrow, which
/// is taken as fat. Its cortex is kCortex_mm thick.
double spongy_bone_per_mm(double energy_keV);

/// Thickness of the cortex of pelvic bones [mm].
/// Source: 1.41 ± 0.49 mm in one pelvis (Anderson et al., J Biomech Eng 2005, 127:364).
inline constexpr double kCortex_mm = 1.4;

/// Linear attenuation coefficient of a region [1/mm].
/// @param region canonical name; unknown names are soft tissue
double region_attenuation_per_mm(const std::string& region, const FluoroscopySettings& settings);

}  // namespace stylet
