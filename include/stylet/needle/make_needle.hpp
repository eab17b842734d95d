// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/needle.hpp"
#include "stylet/needle/section.hpp"

#include <span>
#include <string>

namespace stylet {

/// Names of the needle models; the first one, "beam", is the default. The others are "springs" and "tet".
[[nodiscard]] std::span<const std::string> needle_models();

/// Default number of elements, rods or segments of a model: the cheapest one with which a 200 mm needle agrees with
/// theory within 0.2 %.
/// @return an input error for an unknown model, with the nearest known name
[[nodiscard]] Result<int> default_needle_elements(const std::string& model);

/// Builds a needle of the given model.
/// @param elements number of elements, rods or segments; 0 = the default of the model
/// @param load_capacity largest number of loads in any call
/// @return an input error for an unknown model, and for values from which the model cannot be built
Result<std::unique_ptr<Needle>> make_needle(const std::string& model, const NeedleSection& section, int elements,
                                            int load_capacity);

}  // namespace stylet
