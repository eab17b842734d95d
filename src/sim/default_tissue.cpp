// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/scenario.hpp"

#include <string_view>

namespace stylet {

namespace {

struct Row {
  std::string_view region;
  double young_kPa, poisson, cutting_N, puncture_N;
  std::string_view source;
};

// Moduli and forces are chosen together so that a surface tents by 5 to 20 mm before it breaks and the cut lags behind
// the tip by at most 5 mm (F (1−ν²) / 2RE for a flat punch of the needle's radius); see docs/parameters.md.
constexpr std::string_view kGland =
    "E 30.8 kPa benign, 64.1 kPa cancer in vivo (Shoji 2018); capsule and cutting force of the order of 1 N (van "
    "Gerwen 2012)";
constexpr Row kRows[] = {
    {"body", 60, 0.45, 0.35, 1.0,
     "perineal muscle at rest, 50-100 kPa; puncture 1.22 N and cutting 0.95 N are the medians of 99 studies (van "
     "Gerwen 2012)"},
    {"prostate", 40, 0.45, 0.25, 0.6, kGland},
    {"peripheral_zone", 40, 0.45, 0.25, 0.6, kGland},
    {"transition_zone", 40, 0.45, 0.25, 0.6, kGland},
    {"central_zone", 40, 0.45, 0.25, 0.6, kGland},
    {"anterior_stroma", 40, 0.45, 0.25, 0.6, kGland},
    {"urethra", 30, 0.45, 0.2, 0.0, "stated, no measurement known: softer than the gland, no capsule"},
    {"bladder", 20, 0.45, 0.15, 0.5, "stated: wall and filling as one, 10-100 kPa"},
    {"rectum", 20, 0.45, 0.15, 0.5, "stated: wall and filling as one, 10-100 kPa"},
    {"periprostatic_fat", 2, 0.45, 0.1, 0.0, "stated: fat, 1-10 kPa"},
    {"levator", 25, 0.45, 1.0, 0.0, "E 24.7 kPa at rest, shear wave; cutting of the order of 1 N (van Gerwen 2012)"},
    {"ischiorectal_fat", 2, 0.45, 0.1, 0.0, "stated: fat, 1-10 kPa"},
    {"subcutaneous_fat", 10, 0.45, 0.3, 2.8,
     "skin 2.75-2.80 N in fresh cadaver (10.1089/end.2016.0342); modulus stated"},
    {"rectal_lumen", 1, 0.45, 0.05, 0.0, "stated: what fills the rectum"},
    {"seminal_vesicles", 20, 0.45, 0.15, 0.0, "stated, no measurement known"},
    {"band", 300, 0.45, 0.6, 0.0,
     "stated: ligament, several times stiffer than the gland (Goksel 2005 names it, without a value)"},
    {"pubic_arch", 1e5, 0.3, 10.0, 0.0, "bone; held, so its modulus has no effect"},
    {"femur_left", 1e5, 0.3, 10.0, 0.0, "bone; held, so its modulus has no effect"},
    {"femur_right", 1e5, 0.3, 10.0, 0.0, "bone; held, so its modulus has no effect"},
};

}  // namespace

std::vector<std::string> known_tissues() {
  std::vector<std::string> names;
  for (const Row& row : kRows) names.emplace_back(row.region);
  return names;
}

bool is_surrounding(const std::string& region) {
  return region == "body" || region == "levator" || region.ends_with("_fat");
}

TissueParameters default_tissue(const std::string& region) {
  const Row* row = &kRows[0];
  for (const Row& candidate : kRows) {
    if (candidate.region == region) row = &candidate;
  }
  // Planning volumes and unnamed labels of a mask stand for the gland.
  const bool planned = region == "ctv" || region == "target" || region == "ptv" || region == "gtv";
  if (planned || region.rfind("label_", 0) == 0) row = &kRows[1];
  TissueParameters p;
  p.young_kPa = row->young_kPa;
  p.poisson = row->poisson;
  p.cutting_N = row->cutting_N;
  p.puncture_N = row->puncture_N;
  p.friction_static_N_per_m = 18.0;
  p.friction_coulomb_N_per_m = 11.0;
  p.friction_viscous_Ns_per_m2 = 250.0;
  p.source = std::string(row->source) + "; friction of bovine liver (Okamura 2004: D 18, C 11 N/m, b 212-293 N s/m2)";
  return p;
}

}  // namespace stylet
