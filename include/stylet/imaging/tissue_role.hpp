// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace stylet {

/// Kind of tissue of a region, as ultrasound distinguishes it.
enum class TissueRole { soft, gland, zone, urethra, fluid, lumen, rectal_wall, fat, muscle, bone };

/// The kind of tissue of a region by its canonical name.
inline TissueRole tissue_role(const std::string& region) {
  if (region == "prostate" || region == "ctv" || region == "target" || region == "ptv" || region == "gtv" ||
      region.starts_with("label_"))
    return TissueRole::gland;
  if (region == "peripheral_zone" || region == "transition_zone" || region == "central_zone" ||
      region == "anterior_stroma")
    return TissueRole::zone;
  if (region == "urethra") return TissueRole::urethra;
  if (region == "bladder") return TissueRole::fluid;
  if (region == "rectal_lumen") return TissueRole::lumen;
  if (region == "rectum") return TissueRole::rectal_wall;
  if (region.ends_with("fat")) return TissueRole::fat;
  if (region == "levator") return TissueRole::muscle;
  if (region == "pubic_arch" || region.starts_with("femur")) return TissueRole::bone;
  return TissueRole::soft;
}

/// Whether the role is a part of the prostate gland without its urethra.
inline bool is_gland(TissueRole role) { return role == TissueRole::gland || role == TissueRole::zone; }

}  // namespace stylet
