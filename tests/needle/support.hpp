// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/beam.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace stylet::test {

/// Length [mm] and bending stiffness [N mm²] of the default needle.
inline constexpr double kLength = 200.0;
inline constexpr double kEI = 15722.0;

/// [mm] Length of the needles whose derivatives are tested.
inline constexpr double kShort = 120.0;

/// Rotation of a base whose axes differ from the patient's axes.
inline Mat3 tilted() { return Eigen::AngleAxisd(0.7, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix(); }

inline std::unique_ptr<BeamNeedle> beam(int elements = 24, const NeedleSection& section = {}, int capacity = 64) {
  auto built = BeamNeedle::build(section, elements, capacity);
  EXPECT_TRUE(built.ok()) << (built.ok() ? "" : built.error().message());
  return std::move(built).value();
}

/// Brings the needle to equilibrium from its current shape.
inline int settle(Needle& needle, std::span<const PointLoad> loads, double tolerance_Nmm = 1e-9) {
  const auto iterations = find_equilibrium(needle, loads, tolerance_Nmm);
  EXPECT_TRUE(iterations.ok()) << (iterations.ok() ? "" : iterations.error().message());
  return iterations.ok() ? *iterations : -1;
}

/// Tangent compliance [mm/N] at the current shape.
inline MatX compliance_of(Needle& needle, std::span<const PointLoad> loads) {
  const auto size = 3 * static_cast<Eigen::Index>(loads.size());
  MatX compliance(size, size);
  VecX free(size);
  needle.linearise(loads, compliance, free);
  return compliance;
}

}  // namespace stylet::test
