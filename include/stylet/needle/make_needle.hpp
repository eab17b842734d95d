// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/needle.hpp"
#include "stylet/needle/section.hpp"

#include <span>
#include <string>

namespace stylet {

/// Names of the needle models, the default first: beam, springs, tet.
[[nodiscard]] std::span<const std::string> needle_models();

/// Number of elements, rods or segments that brings a 200 mm needle of the model within 0.2 % of theory at the least
/// cost; an input error for an unknown model, with the nearest name there is.
[[nodiscard]] Result<int> default_needle_elements(const std::string& model);

/// A straight needle of the model named.
/// @param elements number of elements, rods or segments; 0 = the model's own default
/// @param load_capacity largest number of loads in any call
/// @return input error for an unknown model, and for what the model cannot be built from
Result<std::unique_ptr<Needle>> make_needle(const std::string& model, const NeedleSection& section, int elements,
                                            int load_capacity);

}  // namespace stylet
