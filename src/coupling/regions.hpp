// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/insertion.hpp"

namespace stylet {

/// Region of an element; −1 for element −1, which stands for the outside of the patient.
inline int region_of(const InsertionTissue& tissue, Index tet) {
  return tet < 0 ? -1 : tissue.locator->mesh().tet_region[static_cast<std::size_t>(tet)];
}

}  // namespace stylet
