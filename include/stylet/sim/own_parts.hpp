// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/cutting_model.hpp"
#include "stylet/needle/needle.hpp"
#include "stylet/needle/section.hpp"

#include <functional>
#include <memory>

namespace stylet {

/// Makes a needle in its stress-free shape. It is called once for each simulation, in the thread that makes it.
/// The arguments are the section that the scenario's [needle] table describes, whose length the needle must have, and
/// the largest number of point loads in any call of the needle.
using NeedleMaker = std::function<Result<std::unique_ptr<Needle>>(const NeedleSection& section, int load_capacity)>;

/// Parts that a C++ program supplies in place of the built-in parts that the scenario selects (Model::with()).
struct OwnParts {
  NeedleMaker needle;                           ///< empty: the needle model that the key needle.model selects
  std::shared_ptr<const CuttingModel> cutting;  ///< null: the built-in law of cutting
  [[nodiscard]] bool is_any() const { return needle || cutting; }
};

}  // namespace stylet
