// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <string>
#include <vector>

namespace stylet {

/// The TG-43 data of one model of brachytherapy source, as tables of a publication give them. Lengths are in mm, where
/// publications have cm. A table need not reach as far as it is read: Tg43 says how it continues.
struct SourceModel {
  std::string name;                 ///< short name in lower case, e.g. "i125_6711"
  std::string title;                ///< manufacturer and model
  std::string isotope;              ///< e.g. "I-125"
  std::string citation;             ///< publication of the data
  double half_life_days = 0.0;      ///< [d]
  double dose_rate_constant = 0.0;  ///< Λ [cGy/(h U)], in water, 10 mm from the centre on the transverse axis
  double active_length_mm = 0.0;    ///< L of the line source, for the geometry function; 0: a point source
  double outer_length_mm = 0.0;     ///< length of the capsule
  double outer_diameter_mm = 0.0;   ///< diameter of the capsule

  std::vector<double> g_r_mm;  ///< (k) ascending radii of the radial dose function
  std::vector<double> g;       ///< (k) g_L, for the line source; 1 at 10 mm

  std::vector<double> F_r_mm;       ///< (m) ascending radii of the 2D anisotropy function
  std::vector<double> F_theta_deg;  ///< (n) ascending angles from the source's axis: 0 … 90, or 0 … 180
  MatX F;                           ///< (n × m) NaN where the publication has no value, within the capsule

  std::vector<double> phi_r_mm;  ///< radii of the 1D anisotropy function; empty: it is computed from F
  std::vector<double> phi;       ///< φ_an at these radii
};

/// Checks that a source model can be used. Errors: a quantity that is not finite or not positive, tables whose sizes
/// differ, radii or angles that do not ascend, angles outside 0 … 180, a g that
/// does not reach 10 mm, a value of F that is neither positive nor NaN, a
/// row or column of F without any value.
/// @param where name of the source or of its file, for the message
Result<> check_source(const SourceModel& source, const std::string& where);

}  // namespace stylet
