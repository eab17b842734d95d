// SPDX-License-Identifier: GPL-3.0-or-later
// Amersham/GE OncoSeed 6711: Rivard et al. 2004 (TG-43U1), Med Phys 31:633.
#include "dose/sources/tables.hpp"

namespace stylet::dose::sources {

SourceModel i125_6711() {
  SourceModel s;
  s.name = "i125_6711";
  s.title = "Amersham/GE OncoSeed 6711";
  s.isotope = "I-125";
  s.half_life_days = 59.4;
  s.dose_rate_constant = 0.965;
  s.active_length_mm = 3.0;
  s.outer_length_mm = 4.5;
  s.outer_diameter_mm = 0.8;
  s.citation = "Rivard et al. 2004 (TG-43U1), Med Phys 31:633";
  s.g_r_mm = {1.0, 1.5, 2.5, 5.0, 7.5, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0, 100.0};
  s.g = {1.055, 1.078, 1.082, 1.071, 1.042, 1.0, 0.908, 0.814, 0.632, 0.496, 0.364, 0.27, 0.199, 0.148, 0.109, 0.0803};
  s.F_r_mm = {5.0, 10.0, 20.0, 30.0, 40.0, 50.0};
  s.F_theta_deg = {0.0, 5.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0};
  // One row for each angle, one column for each radius.
  s.F = table(s.F_theta_deg.size(),
              {0.333, 0.37,  0.442, 0.488, 0.52,  0.55,  0.4,   0.429, 0.497, 0.535, 0.561, 0.587, 0.519, 0.537,
               0.58,  0.609, 0.63,  0.645, 0.716, 0.705, 0.727, 0.743, 0.752, 0.76,  0.846, 0.834, 0.842, 0.846,
               0.848, 0.852, 0.926, 0.925, 0.926, 0.926, 0.928, 0.928, 0.972, 0.972, 0.97,  0.969, 0.969, 0.969,
               0.991, 0.991, 0.987, 0.987, 0.987, 0.987, 0.996, 0.996, 0.996, 0.995, 0.995, 0.995, 1.0,   1.0,
               1.0,   0.999, 0.999, 0.999, 1.0,   1.0,   1.0,   1.0,   1.0,   1.0});
  s.phi_r_mm = {5.0, 10.0, 20.0, 30.0, 40.0, 50.0};
  s.phi = {0.973, 0.944, 0.941, 0.942, 0.943, 0.944};
  return s;
}

}  // namespace stylet::dose::sources
