// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/imaging_settings.hpp"

#include <string_view>

namespace stylet {

namespace {

struct EchoRow {
  std::string_view region;
  double echo_dB, attenuation_dB_per_cm_MHz;
  std::string_view source;
};

// The first row is that of unknown regions.
constexpr EchoRow kEchoes[] = {
    {"body", -4, 0.75, "echo stated; attenuation between fat, 0.63, and muscle, 0.96"},
    {"prostate", 0, 0.5, "reference of the echo; attenuation of soft tissue"},
    {"peripheral_zone", 0, 0.5, "reference of the echo; attenuation of soft tissue"},
    {"transition_zone", -6, 0.5, "echo stated: darker than the peripheral zone; attenuation of soft tissue"},
    {"central_zone", -3, 0.5, "echo stated; attenuation of soft tissue"},
    {"anterior_stroma", -9, 1.0, "echo stated; attenuation of muscle, 0.96-1.4"},
    {"urethra", -14, 0.5, "echo stated: dark; attenuation of soft tissue"},
    {"bladder", -60, 0.002, "echo stated: fluid; attenuation of water"},
    {"rectum", -12, 1.0, "echo stated: dark muscularis; attenuation of muscle, 0.96-1.4"},
    {"rectal_lumen", -40, 0.002, "echo stated: gel or water around the probe; attenuation of water"},
    {"seminal_vesicles", -14, 0.5, "echo stated: dark; attenuation of soft tissue"},
    {"periprostatic_fat", 2, 0.63, "echo stated; attenuation of fat"},
    {"ischiorectal_fat", 2, 0.63, "echo stated; attenuation of fat"},
    {"levator", -10, 1.2, "echo stated; attenuation of muscle, 0.96-1.4"},
    {"subcutaneous_fat", 3, 0.63, "echo stated; attenuation of fat"},
    {"band", 0, 1.0, "echo stated; attenuation of muscle, 0.96-1.4"},
    {"pubic_arch", 6, 15, "echo stated; attenuation of bone"},
    {"femur_left", 6, 15, "echo stated; attenuation of bone"},
    {"femur_right", 6, 15, "echo stated; attenuation of bone"},
};

}  // namespace

TissueEcho default_echo(const std::string& region) {
  const bool planned = region == "ctv" || region == "target" || region == "ptv" || region == "gtv";
  const std::string_view name = planned || region.starts_with("label_") ? "prostate" : std::string_view(region);
  const EchoRow* row = kEchoes;
  for (const EchoRow& candidate : kEchoes) {
    if (candidate.region == name) row = &candidate;
  }
  return {row->echo_dB, row->attenuation_dB_per_cm_MHz, std::string(row->source)};
}

}  // namespace stylet
