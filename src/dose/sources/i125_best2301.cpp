// SPDX-License-Identifier: GPL-3.0-or-later
// Best 2301: Rivard et al. 2004 (TG-43U1), Med Phys 31:633.
// The active length of 4.0 mm is that of TG-43U1; it follows from its pair of g_P and g_L as well.
#include "dose/sources/tables.hpp"

namespace stylet::dose::sources {

SourceModel i125_best2301() {
  SourceModel s;
  s.name = "i125_best2301";
  s.title = "Best 2301";
  s.isotope = "I-125";
  s.half_life_days = 59.4;
  s.dose_rate_constant = 1.018;
  s.active_length_mm = 4.0;
  s.outer_length_mm = 4.5;
  s.outer_diameter_mm = 0.8;
  s.citation = "Rivard et al. 2004 (TG-43U1), Med Phys 31:633";
  s.g_r_mm = {1.0, 1.5, 2.5, 5.0, 7.5, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0, 100.0};
  s.g = {1.033, 1.029, 1.027, 1.028, 1.03, 1.0, 0.938, 0.866, 0.707, 0.555, 0.427, 0.32, 0.248, 0.187, 0.142, 0.103};
  s.F_r_mm = {10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0};
  s.F_theta_deg = {0.0, 5.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0};
  // One row for each angle, one column for each radius.
  s.F = table(
      s.F_theta_deg.size(),
      {0.367, 0.454, 0.922, 0.902, 0.894, 0.893, 0.858, 0.724, 0.72,  0.726, 0.738, 0.753, 0.771, 0.8,   0.653, 0.671,
       0.699, 0.727, 0.732, 0.764, 0.782, 0.785, 0.794, 0.809, 0.814, 0.825, 0.852, 0.821, 0.9,   0.89,  0.885, 0.892,
       0.899, 0.915, 0.873, 0.982, 0.954, 0.947, 0.939, 0.943, 0.976, 0.937, 1.014, 0.992, 0.985, 0.991, 0.997, 0.989,
       0.961, 1.03,  1.01,  1.009, 1.007, 1.01,  1.019, 1.002, 1.036, 1.026, 1.016, 1.023, 1.011, 1.035, 1.01,  1.01,
       1.03,  1.019, 1.017, 1.01,  1.02,  1.005, 1.0,   1.0,   1.0,   1.0,   1.0,   1.0,   1.0});
  return s;
}

}  // namespace stylet::dose::sources
