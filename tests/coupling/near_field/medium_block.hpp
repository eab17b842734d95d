// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "evidence/validate/medium_block.hpp"
#include "stylet/coupling/near_field/half_space.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace stylet::test {

/// A validate::MediumBlock that is built by the constructor.
struct MediumBlock : validate::MediumBlock {
  explicit MediumBlock(const Options& options) : validate::MediumBlock(validate::MediumBlock::build(options).value()) {}
};

/// A validate::NeedleLine that is built by the constructor.
struct NeedleLine : validate::NeedleLine {
  /// @param unbounded whether the held faces move as in an unbounded medium
  NeedleLine(validate::MediumBlock& block, double spacing_mm, const Vec3& along, bool unbounded)
      : validate::NeedleLine(build(block, {.spacing_mm = spacing_mm, .direction = along, .unbounded = unbounded})) {}
};

}  // namespace stylet::test
