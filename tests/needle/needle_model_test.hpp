// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/support.hpp"
#include "stylet/needle/make_needle.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace stylet::test {

/// A test that runs with each needle model, by name, with the model's default number of elements.
class NeedleModelTest : public testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] static const std::string& model() { return GetParam(); }
  [[nodiscard]] static int elements() { return default_needle_elements(model()).value(); }
  [[nodiscard]] static std::unique_ptr<Needle> make(int elements = 0, int capacity = 64) {
    auto built = make_needle(model(), {}, elements, capacity);
    EXPECT_TRUE(built.ok()) << (built.ok() ? "" : built.error().message());
    return std::move(built).value();
  }

  /// Largest out-of-balance moment [N mm] that rounding may leave with forces of about 1 N. The coupled solver asks for
  /// 1e-10 × force × length.
  [[nodiscard]] static double tolerance() { return model() == "tet" ? 1e-8 : 1e-9; }
  /// Brings the needle to equilibrium from its current shape.
  static int settle(Needle& needle, std::span<const PointLoad> loads) {
    return test::settle(needle, loads, tolerance());
  }

  /// Derivative of the equilibrium positions with respect to the loads [mm/N] (3w × 3w), from equilibria solved anew.
  static MatX compliance_by_differences(Needle& needle, const std::vector<PointLoad>& loads) {
    constexpr double h = 1e-4;
    const auto size = 3 * static_cast<Eigen::Index>(loads.size());
    MatX compliance = MatX::Zero(size, size);
    for (Eigen::Index column = 0; column < size; ++column) {
      for (const double sign : {1.0, -1.0}) {
        auto changed = loads;
        changed[static_cast<std::size_t>(column / 3)].force[column % 3] += sign * h;
        settle(needle, changed);
        for (std::size_t c = 0; c < loads.size(); ++c)
          compliance.col(column).segment<3>(3 * static_cast<Eigen::Index>(c)) +=
              sign * needle.point(loads[c].s) / (2 * h);
      }
    }
    return compliance;
  }
};

}  // namespace stylet::test

// NOLINTNEXTLINE(cppcoreguidelines-macro-usage): GoogleTest's own is a macro
#define STYLET_FOR_EVERY_NEEDLE_MODEL(suite)                                                                 \
  INSTANTIATE_TEST_SUITE_P(Models, suite, testing::ValuesIn(needle_models().begin(), needle_models().end()), \
                           [](const auto& tested) { return tested.param; })
