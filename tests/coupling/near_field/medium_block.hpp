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

/// Fat between muscle and gland, as thick as a few needle diameters and often one element thick; all nodes of its
/// elements are on one of the two interfaces.
struct ThinLayer : MediumBlock {
  static constexpr double kThickness = 6.0;
  explicit ThinLayer(int cells, const std::vector<NeedleWay>& ways = {})
      : MediumBlock({.cells = cells,
                     .jitter = 0.0,
                     .regions = {"muscle", "fat", "gland"},
                     .region_at = [](const Vec3& x) { return x.z() < 0.0          ? 0
                                                             : x.z() < kThickness ? 1
                                                                                  : 2; },
                     .materials = {{0.025, 0.45}, {0.002, 0.45}, {0.03, 0.45}},
                     .faces_at_z = {0.0, kThickness},
                     .element = ways.empty() ? Element::p1 : Element::nodal_pressure,
                     .ways = ways}) {}
};

}  // namespace stylet::test
