// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace stylet {

/// A part of the body that a file of a prostate implant does not need, by the name of a structure.
enum class BodyPart {
  none,    ///< anything else, also the organs of the male pelvis
  other,   ///< outside of the pelvis: heart, lung, breast, brain, eye, spinal cord, liver, knee, …
  female,  ///< of the female pelvis: uterus, cervix, vagina, ovary
};

/// Recognises the name of a structure by its words, with or without a side: "Lung_L", "LungLt", "Herz", "Poumon droit".
/// The names are English, German, French, Italian, Spanish, Chinese, Japanese and Russian.
BodyPart body_part(std::string_view name);

}  // namespace stylet
