// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

namespace stylet {

/// What a balance may take before it is broken off, so that no step is late whatever becomes of it: the next one goes
/// on from there. It is counted by what was done and not by a clock, so a step is the same on every machine. The unit
/// is about a microsecond of the machine of docs/realtime.md; where the costs come from is in docs/theory/coupling.md
/// §4.
class Effort {
 public:
  /// @param contacts tip included
  explicit Effort(int contacts)
      : square_(contacts * static_cast<double>(contacts)),
        left_(std::max(kMost, 3.0 * tangent() + 6.0 * iteration())) {}

  /// All of an iteration but the next two, …
  [[nodiscard]] double iteration() const { return 10.0 + 0.015 * square_; }
  /// … a new tangent of the needle and the matrix made of it, …
  [[nodiscard]] double tangent() const { return needle() + matrix(); }
  /// … and further solutions, after states have changed.
  [[nodiscard]] double solution() const { return 2.0 + 0.02 * square_; }
  /// The parts of a tangent, each of which may be wanted more than once.
  [[nodiscard]] double needle() const { return 20.0 + 0.04 * square_; }
  [[nodiscard]] double matrix() const { return 5.0 + 0.045 * square_; }
  /// The matrix with springs at all contacts.
  [[nodiscard]] double matrix_on_all_springs() const { return 3.0 * matrix(); }

  [[nodiscard]] bool allows(double more) const { return more <= left_; }
  void spend(double some) { left_ -= some; }

 private:
  /// A balance of 40 contacts has 700 microseconds, of more the time for three tangents: with fewer a needle that bows
  /// or snaps is not followed.
  static constexpr double kMost = 700.0;

  double square_;
  double left_;
};

}  // namespace stylet
