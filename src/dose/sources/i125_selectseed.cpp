// SPDX-License-Identifier: GPL-3.0-or-later
// Nucletron/Elekta selectSeed 130.002: Karaiskos et al. 2001, Med Phys 28:1753; the consensus of TG-43U1S2 (2017) has a
// slightly different Λ.
#include "dose/sources/tables.hpp"

namespace stylet::dose::sources {

SourceModel i125_selectseed() {
  SourceModel s;
  s.name = "i125_selectseed";
  s.title = "Nucletron/Elekta selectSeed 130.002";
  s.isotope = "I-125";
  s.half_life_days = 59.4;
  s.dose_rate_constant = 0.954;
  s.active_length_mm = 3.4;
  s.outer_length_mm = 4.5;
  s.outer_diameter_mm = 0.8;
  s.citation = "Karaiskos et al. 2001, Med Phys 28:1753; the consensus of TG-43U1S2 (2017) has a slightly different Λ";
  s.g_r_mm = {1.0, 1.5, 2.5, 5.0, 7.5, 10, 15.0, 20, 30, 40, 50, 60, 70, 80, 90, 100};
  s.g = {1.042, 1.062, 1.085, 1.078, 1.044,  1,      0.907,  0.808,
         0.627, 0.477, 0.357, 0.265, 0.1963, 0.1442, 0.1058, 0.0776};
  s.F_r_mm = {1.0, 2.0, 5.0, 7.0, 10.0, 20.0, 30.0, 50.0, 70.0, 100.0};
  s.F_theta_deg = {0, 2, 5, 7, 10, 15, 20, 25, 30, 40, 50, 60, 70, 80, 90};
  // One row for each angle, one column for each radius.
  s.F = table(s.F_theta_deg.size(),
              {kNone, kNone, 0.203, 0.247, 0.29,  0.387, 0.463, 0.551, 0.598, 0.64,  kNone, kNone, 0.214, 0.26,  0.325,
               0.462, 0.535, 0.601, 0.638, 0.667, kNone, kNone, 0.33,  0.378, 0.423, 0.509, 0.561, 0.624, 0.659, 0.682,
               kNone, kNone, 0.367, 0.396, 0.436, 0.527, 0.575, 0.639, 0.679, 0.69,  kNone, kNone, 0.414, 0.448, 0.49,
               0.572, 0.621, 0.675, 0.7,   0.723, kNone, kNone, 0.531, 0.555, 0.588, 0.652, 0.688, 0.725, 0.751, 0.771,
               kNone, 1.03,  0.637, 0.649, 0.671, 0.721, 0.749, 0.779, 0.79,  0.807, 1.294, 1.007, 0.72,  0.723, 0.741,
               0.778, 0.797, 0.821, 0.83,  0.85,  1.127, 0.962, 0.79,  0.784, 0.794, 0.824, 0.839, 0.858, 0.862, 0.875,
               1.038, 0.944, 0.899, 0.882, 0.882, 0.895, 0.904, 0.912, 0.921, 0.923, 1.01,  0.967, 0.97,  0.953, 0.949,
               0.952, 0.954, 0.956, 0.96,  0.959, 1.002, 0.982, 1.003, 1,     0.997, 0.99,  0.99,  0.989, 0.989, 0.986,
               1,     0.992, 0.984, 1.014, 1.017, 1.018, 1.014, 1.013, 1.005, 1.005, 1,     0.997, 0.995, 0.994, 0.999,
               1.021, 1.019, 1.016, 1.017, 1.007, 1,     1,     1,     1,     1,     1,     1,     1,     1,     1});
  return s;
}

}  // namespace stylet::dose::sources
