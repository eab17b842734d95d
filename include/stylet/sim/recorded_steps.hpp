// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/sim/recording.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stylet {

/// Results of a needle at rest are the same but for what rounding does to them, some 1e-15. So much they may differ,
/// which is below what the balance of needle and tissue is found to.
inline constexpr double kRestForce_N = 1e-7;
inline constexpr double kRestTorque_Nmm = 1e-5;
inline constexpr double kRestPlace_mm = 1e-7;  ///< of the tip

/// Whether a step comes to what an earlier one did: it was given the same dt and base, bit for bit, and its forces, its
/// torque and its tip differ by no more than is rest; states and numbers of contacts are equal.
bool is_at_rest(const Step& earlier, const Step& step);

/// The steps that the records of a recording stand for, with those at rest (Step::rest_steps), in their order.
class RecordedSteps {
 public:
  /// @param records must outlive this
  explicit RecordedSteps(std::span<const Step> records);

  [[nodiscard]] std::int64_t count() const { return ends_.empty() ? 0 : ends_.back(); }
  /// @param step from 0; must be below count()
  /// @return of a step at rest: the record before with the step's own time
  [[nodiscard]] Step at(std::int64_t step) const;
  /// Whether a step has a record of its own.
  [[nodiscard]] bool is_recorded(std::int64_t step) const;
  /// The last step at or before a time; −1 before the first.
  [[nodiscard]] std::int64_t last_at(double time_s) const;

 private:
  std::span<const Step> records_;
  std::vector<std::int64_t> ends_;  ///< of each record: steps up to it, with itself
};

/// The records, and behind each that a rest follows the last step of that rest: a curve through them is level there.
std::vector<Step> with_ends_of_rests(std::span<const Step> records);

}  // namespace stylet
