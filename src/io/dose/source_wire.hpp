// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/source_model.hpp"

namespace stylet::detail {

// Serialisation from the reading program (detail/wire.hpp).
void fields(auto& wire, SourceModel& s) {
  auto rows = s.F.rows(), columns = s.F.cols();
  std::vector<double> F(s.F.data(), s.F.data() + s.F.size());
  wire(s.name, s.title, s.isotope, s.citation, s.half_life_days, s.dose_rate_constant, s.active_length_mm,
       s.outer_length_mm, s.outer_diameter_mm, s.g_r_mm, s.g, s.F_r_mm, s.F_theta_deg, s.phi_r_mm, s.phi);
  wire(rows, columns, F);
  s.F = Eigen::Map<const MatX>(F.data(), rows, columns);
}

}  // namespace stylet::detail
