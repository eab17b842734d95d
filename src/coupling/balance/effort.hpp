// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <limits>

namespace stylet {

/// The effort that a balance may take before it is broken off and flagged; the next balance continues from there. A
/// step with up to 40 contacts takes at most about a millisecond, whatever happens in it; with more contacts it takes
/// longer, as does a cut of several legs, each of which ends with a balance of its own. Operations are counted instead
/// of timed, so that a step is the same on every machine. The unit is about a microsecond on the machine of
/// docs/realtime.md, for needles of rods; docs/theory/balance.md gives the counts.
///
/// With needles at rest only the numbers of iterations bound a balance: many of their contacts may begin or end to slip
/// in one step, and balances that are broken off step after step lose the motion of the gland
/// (docs/theory/several_needles.md).
class Effort {
 public:
  /// @param contacts tip included @param others_rest whether some of them belong to needles at rest
  explicit Effort(int contacts, bool others_rest = false)
      : square_(contacts * static_cast<double>(contacts)),
        all_(others_rest ? std::numeric_limits<double>::infinity()
                         : std::max(kLeast, 3.0 * tangent() + 6.0 * iteration())),
        left_(all_) {}

  /// Effort of an iteration with an existing tangent.
  [[nodiscard]] double iteration() const { return 10.0 + 0.015 * square_; }
  /// Additional effort of an iteration that makes a new tangent of the needle and its matrix.
  [[nodiscard]] double tangent() const { return needle() + matrix(); }
  /// Effort of each further solution after contacts have changed their states.
  [[nodiscard]] double solution() const { return 2.0 + 0.02 * square_; }
  /// Effort of the two parts of a tangent, each of which may be needed more than once.
  [[nodiscard]] double needle() const { return 20.0 + 0.04 * square_; }
  [[nodiscard]] double matrix() const { return 5.0 + 0.045 * square_; }
  /// Effort of the matrix with springs at all contacts.
  [[nodiscard]] double matrix_on_all_springs() const { return 3.0 * matrix(); }

  [[nodiscard]] bool allows(double more) const { return more <= left_; }
  void spend(double some) { left_ -= some; }
  /// Begins anew: another balance is sought in the same sub-step.
  void renew() { left_ = all_; }
  void end() { ended_ = true; }
  [[nodiscard]] bool ended() const { return ended_; }

 private:
  /// Least allowance, for balances with up to about 40 contacts. Three tangents are always allowed: with fewer, the
  /// solver cannot follow a needle that bows or snaps.
  static constexpr double kLeast = 700.0;

  double square_;
  double all_;
  double left_;
  bool ended_ = false;
};

}  // namespace stylet
