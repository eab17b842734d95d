// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace stylet {

/// The stiffness S of needle and tissue at the base, as the motion s of each step and the change y of the hand's force
/// in it show it (BaseFollower). Rotations are multiplied by a lever to be lengths, torques divided by it to be forces.
class SeenStiffness {
 public:
  using Vec6 = Eigen::Matrix<double, 6, 1>;
  using Mat6 = Eigen::Matrix<double, 6, 6>;

  /// Forgets S.
  void reset() { S_.setZero(); }
  /// The next step is the first one after a pause.
  void begin();
  /// Corrects S. @param s [mm] motion of the last step @param y [N] change of the force in it
  /// @param coupling [N/mm] stiffness of the virtual coupling, against which small ones are negligible
  void learn(const Vec6& s, const Vec6& y, double coupling);

  /// [N/mm]
  [[nodiscard]] const Mat6& S() const { return S_; }
  /// [mm] φ s, the expected sliding
  [[nodiscard]] const Vec6& sliding() const { return sliding_; }

 private:
  bool stiffen(const Vec6& s, const Vec6& y, double coupling);

  Mat6 S_ = Mat6::Zero();
  Vec6 s_before_ = Vec6::Zero();  ///< s of the step before
  Vec6 y_before_ = Vec6::Zero();  ///< y of the step before
  Vec6 sliding_ = Vec6::Zero();
};

}  // namespace stylet
