// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

namespace stylet {

/// What a balance of a sub-step may take before it is broken off, flagged; the next one goes on from there. So a step
/// of up to 40 contacts takes about a millisecond at the most, whatever becomes of it; with more it takes longer. It is
/// counted by what was done and not by a clock: a step is the same on every machine. The unit is about a microsecond of
/// the machine of docs/realtime.md, for needles of rods; docs/theory/coupling.md §4 has more.
class Effort {
 public:
  /// @param contacts tip included
  explicit Effort(int contacts)
      : square_(contacts * static_cast<double>(contacts)),
        left_(std::max(kLeast, 3.0 * tangent() + 6.0 * iteration())) {}

  /// An iteration with a tangent that is there already.
  [[nodiscard]] double iteration() const { return 10.0 + 0.015 * square_; }
  /// The effort that a new tangent of the needle, and the matrix made of it, add to an iteration.
  [[nodiscard]] double tangent() const { return needle() + matrix(); }
  /// The effort of each further solution, after states of contacts have changed.
  [[nodiscard]] double solution() const { return 2.0 + 0.02 * square_; }
  /// The parts of a tangent, each of which may be wanted more than once.
  [[nodiscard]] double needle() const { return 20.0 + 0.04 * square_; }
  [[nodiscard]] double matrix() const { return 5.0 + 0.045 * square_; }
  /// The matrix with springs at all contacts.
  [[nodiscard]] double matrix_on_all_springs() const { return 3.0 * matrix(); }

  [[nodiscard]] bool allows(double more) const { return more <= left_; }
  void spend(double some) { left_ -= some; }
  void end() { ended_ = true; }
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  /// Effort that balances of up to some 40 contacts may take. Three tangents always: with fewer a needle that bows or
  /// snaps is not followed.
  static constexpr double kLeast = 700.0;

  double square_;
  double left_;
  bool ended_ = false;
};

}  // namespace stylet
