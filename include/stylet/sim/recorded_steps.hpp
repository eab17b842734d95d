// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/recording.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stylet {

// Largest differences that is_at_rest() accepts between two steps of a needle at rest. Such steps differ only by
// rounding, about 1e-15; the limits are below the tolerance of the balance between needle and tissue.
inline constexpr double kRestForce_N = 1e-7;     ///< difference of a force component
inline constexpr double kRestTorque_Nmm = 1e-5;  ///< difference of the torque
inline constexpr double kRestPlace_mm = 1e-7;    ///< difference of the tip's position

/// Whether a step repeats an earlier one: dt and base are equal bit for bit, tip state, flags and numbers of contacts
/// are equal, and forces, torque and tip differ by at most kRestForce_N, kRestTorque_Nmm and kRestPlace_mm.
bool is_at_rest(const Step& earlier, const Step& step);

/// All steps of a recording in their order, including the steps at rest, for which there is no record but only their
/// number (Step::rest_steps).
class RecordedSteps {
 public:
  /// @param records must outlive this
  explicit RecordedSteps(std::span<const Step> records);

  [[nodiscard]] std::int64_t count() const { return ends_.empty() ? 0 : ends_.back(); }
  /// @param step from 0; must be below count()
  /// @return the step's record; for a step at rest the record before it, with the step's own time
  [[nodiscard]] Step at(std::int64_t step) const;
  /// Whether a step has a record of its own.
  [[nodiscard]] bool is_recorded(std::int64_t step) const;
  /// Number of the last step at or before a time; −1 before the first step.
  [[nodiscard]] std::int64_t last_at(double time_s) const;

 private:
  std::span<const Step> records_;
  std::vector<std::int64_t> ends_;  ///< for each record: number of steps up to and including it
};

/// The records, with the last step of each rest inserted behind the record that the rest follows, so that a curve drawn
/// through them is level during the rest.
std::vector<Step> with_ends_of_rests(std::span<const Step> records);

}  // namespace stylet
