// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/scenario.hpp"

#include "room_for_probe.hpp"

#include <span>
#include <string_view>

namespace stylet {

namespace {

struct Row {
  std::string_view region;
  double young_kPa, poisson, stiffening, cutting_N, puncture_N, static_N_per_m, coulomb_N_per_m;
  std::string_view source;
};

constexpr std::string_view kBone = "bone; held, so its modulus has no effect";

// The defaults of the presets typical, firm and soft: forces as measured in patients and cadavers. The dent under the
// tip stiffens, so that these forces cause dents of plausible depth. The moduli are instantaneous, as a fast load meets
// them; the delayed moduli are a quarter of them (docs/parameters.md).
constexpr std::string_view kGland =
    "E fitted, with the creep to a quarter, around 30.8 kPa benign and 64.1 kPa cancer in vivo (Shoji 2018); cutting "
    "of the order of 1 N (van Gerwen 2012); capsule and friction fitted to a peak of 6 N for 18 gauge (Podder 2006, "
    "not verified)";
constexpr std::string_view kFat =
    "E fitted to a gland that moves by millimetres, within the 1-10 kPa of fat; cutting and friction stated, less than "
    "muscle's";
constexpr Row kMeasured[] = {
    {"body", 70, 0.45, 2, 1.0, 2.8, 60, 45,
     "E of perineal muscle at rest, 50-100 kPa; skin 2.75-2.80 N and friction of 35-59 N/m in fresh cadaver "
     "(10.1089/end.2016.0342); cutting 0.95 N, median of 99 studies (van Gerwen 2012)"},
    {"prostate", 60, 0.45, 2, 1.5, 4.3, 60, 45, kGland},
    {"peripheral_zone", 60, 0.45, 2, 1.5, 4.3, 60, 45, kGland},
    {"transition_zone", 60, 0.45, 2, 1.5, 4.3, 60, 45, kGland},
    {"central_zone", 60, 0.45, 2, 1.5, 4.3, 60, 45, kGland},
    {"anterior_stroma", 60, 0.45, 2, 1.5, 4.3, 60, 45, kGland},
    {"urethra", 20, 0.45, 2, 0.5, 0.0, 60, 45, "stated, no measurement known: softer than the gland, no capsule"},
    {"bladder", 8, 0.45, 2, 0.2, 0.5, 20, 15, "stated: wall and filling as one"},
    {"rectum", 15, 0.45, 2, 0.35, 1.0, 20, 15, "stated: wall, or wall and filling as one"},
    {"rectal_lumen", 2, 0.45, 2, 0.02, 0.0, 20, 15, "stated: what fills the rectum"},
    {"seminal_vesicles", 20, 0.45, 2, 0.5, 0.0, 60, 45, "stated, no measurement known"},
    {"periprostatic_fat", 4.0, 0.45, 2, 0.1, 0.0, 20, 15, kFat},
    {"ischiorectal_fat", 4.0, 0.45, 2, 0.1, 0.0, 20, 15, kFat},
    {"levator", 50, 0.45, 2, 1.0, 0.0, 60, 45,
     "E fitted, with the creep to a quarter, around 24.7 kPa at rest (shear wave); cutting 0.95 N, median of 99 "
     "studies (van Gerwen 2012); friction as the body's"},
    {"subcutaneous_fat", 60, 0.45, 2, 0.3, 2.8, 60, 45,
     "skin and the fat under it as one, E fitted to a dent of at most 12 mm; skin 2.75-2.80 N and friction of 35-59 "
     "N/m in fresh cadaver (10.1089/end.2016.0342)"},
    {"band", 40, 0.45, 2, 1.0, 0.0, 60, 45,
     "fitted to a gland that moves by millimetres (Goksel 2005 names the ligament, without a value)"},
    {"pubic_arch", 1e5, 0.3, 0, 10.0, 0.0, 60, 45, kBone},
    {"femur_left", 1e5, 0.3, 0, 10.0, 0.0, 60, 45, kBone},
    {"femur_right", 1e5, 0.3, 0, 10.0, 0.0, 60, 45, kBone},
};

// The defaults of the preset linear: moduli as measured, and forces chosen such that a surface tents by 5 to 20 mm
// before it breaks and the cutting lag is at most 5 mm.
constexpr std::string_view kLinearGland =
    "E 30.8 kPa benign, 64.1 kPa cancer in vivo (Shoji 2018); capsule and cutting force of the order of 1 N (van "
    "Gerwen 2012)";
constexpr Row kLinear[] = {
    {"body", 60, 0.45, 0, 0.35, 1.0, 18, 11,
     "perineal muscle at rest, 50-100 kPa; puncture 1.22 N and cutting 0.95 N are the medians of 99 studies (van "
     "Gerwen 2012)"},
    {"prostate", 40, 0.45, 0, 0.25, 0.6, 18, 11, kLinearGland},
    {"peripheral_zone", 40, 0.45, 0, 0.25, 0.6, 18, 11, kLinearGland},
    {"transition_zone", 40, 0.45, 0, 0.25, 0.6, 18, 11, kLinearGland},
    {"central_zone", 40, 0.45, 0, 0.25, 0.6, 18, 11, kLinearGland},
    {"anterior_stroma", 40, 0.45, 0, 0.25, 0.6, 18, 11, kLinearGland},
    {"urethra", 30, 0.45, 0, 0.2, 0.0, 18, 11, "stated, no measurement known: softer than the gland, no capsule"},
    {"bladder", 20, 0.45, 0, 0.15, 0.5, 18, 11, "stated: wall and filling as one, 10-100 kPa"},
    {"rectum", 20, 0.45, 0, 0.15, 0.5, 18, 11, "stated: wall and filling as one, 10-100 kPa"},
    {"rectal_lumen", 1, 0.45, 0, 0.01, 0.0, 18, 11, "stated: what fills the rectum"},
    {"seminal_vesicles", 20, 0.45, 0, 0.15, 0.0, 18, 11, "stated, no measurement known"},
    {"periprostatic_fat", 4, 0.45, 0, 0.03, 0.0, 18, 11, "stated: fat, 1-10 kPa"},
    {"ischiorectal_fat", 4, 0.45, 0, 0.03, 0.0, 18, 11, "stated: fat, 1-10 kPa"},
    {"levator", 25, 0.45, 0, 0.2, 0.0, 18, 11, "E 24.7 kPa at rest, shear wave; cutting stated"},
    {"subcutaneous_fat", 60, 0.45, 0, 0.35, 1.0, 18, 11, "as the body's: skin and the fat under it as one"},
    {"band", 300, 0.45, 0, 0.6, 0.0, 18, 11,
     "stated: ligament, several times stiffer than the gland (Goksel 2005 names it, without a value)"},
    {"pubic_arch", 1e5, 0.3, 0, 10.0, 0.0, 18, 11, kBone},
    {"femur_left", 1e5, 0.3, 0, 10.0, 0.0, 18, 11, kBone},
    {"femur_right", 1e5, 0.3, 0, 10.0, 0.0, 18, 11, kBone},
};

std::span<const Row> rows_of(TissuePreset preset) {
  return preset == TissuePreset::linear ? std::span<const Row>(kLinear) : std::span<const Row>(kMeasured);
}

/// The factor by which a preset multiplies the moduli of soft tissue. Published moduli differ by similar factors
/// between studies: 24.7 ± 4.5 kPa in muscle, 30.8 to 64.1 kPa in the gland, 1 to 10 kPa in fat.
double moduli_factor(TissuePreset preset) {
  constexpr double kFirmer = 1.6;
  if (preset == TissuePreset::firm) return kFirmer;
  return preset == TissuePreset::soft ? 1.0 / kFirmer : 1.0;
}

}  // namespace

std::vector<std::string> known_tissues() {
  std::vector<std::string> names;
  for (const Row& row : kMeasured) names.emplace_back(row.region);
  return names;
}

bool is_surrounding(const std::string& region) {
  return region == "body" || region == "levator" || region.ends_with("_fat");
}

TissueParameters default_tissue(const std::string& region, TissuePreset preset) {
  // Planning volumes and unnamed labels of a mask represent the gland.
  const bool planned = region == "ctv" || region == "target" || region == "ptv" || region == "gtv";
  const std::string_view name = planned || region.starts_with("label_") ? "prostate" : std::string_view(region);
  const std::span<const Row> rows = rows_of(preset);
  const Row* row = rows.data();  // the body's
  for (const Row& candidate : rows) {
    if (candidate.region == name) row = &candidate;
  }
  const bool bone = row->source == kBone;
  TissueParameters p;
  p.young_kPa = row->young_kPa * (bone ? 1.0 : moduli_factor(preset));
  p.poisson = row->poisson;
  p.stiffening = row->stiffening;
  p.cutting_N = row->cutting_N;
  p.puncture_N = row->puncture_N;
  p.friction_static_N_per_m = row->static_N_per_m;
  p.friction_coulomb_N_per_m = row->coulomb_N_per_m;
  p.friction_viscous_Ns_per_m2 = 250.0;
  p.source = row->source;
  p.echo = default_echo(region);
  if (bone) return p;
  if (preset == TissuePreset::linear) {
    p.source += "; friction of bovine liver (Okamura 2004: D 18, C 11 N/m, b 212-293 N s/m2)";
    return p;
  }
  p.source +=
      "; stiffening that of a hyperelastic solid under a punch (docs/theory/stiffening.md); growth of friction with "
      "speed from bovine liver (Okamura 2004)";
  if (preset != TissuePreset::typical)
    p.source += preset == TissuePreset::firm ? "; E times 1.6 by the preset \"firm\""
                                             : "; E divided by 1.6 by the preset \"soft\"";
  return p;
}

void make_room_for_probe(TissueParameters& inside) {
  inside.young_kPa = 0.5;
  inside.poisson = 0.1;
  inside.stiffening = 0.0;
  inside.cutting_N = 0.004;  // with this modulus the lag of the cut stays within millimetres
  inside.puncture_N = 0.0;
  inside.source =
      "stated: around a probe the lumen holds gel and gas, which give way and flow off; other values as without a "
      "probe";
}

TissueParameters tissue_of(const Scenario& scenario, const std::string& region) {
  const auto given = scenario.tissue.find(region);
  if (given != scenario.tissue.end()) return given->second;
  TissueParameters tissue = default_tissue(region, scenario.tissue_model.preset);
  if (region == "rectal_lumen" && scenario.probe.kind != ProbeKind::none) make_room_for_probe(tissue);
  return tissue;
}

double creep_of(const Scenario& scenario) {
  constexpr double kCreep = 4.0;
  return scenario.tissue_model.creep.value_or(scenario.tissue_model.preset == TissuePreset::linear ? 1.0 : kCreep);
}

}  // namespace stylet
