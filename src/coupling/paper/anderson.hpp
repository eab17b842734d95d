// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

namespace stylet::paper {

/// Anderson's acceleration of a fixed-point iteration x ← g(x): the next x is the combination of the last results whose
/// combined change is least. Near a solution it converges like GMRES, without a relaxation factor. Nothing allocates
/// after construction. @cite Walker2011 (Anderson acceleration for fixed-point iterations, SIAM J Numer Anal 49)
class Anderson {
 public:
  explicit Anderson(Eigen::Index size);

  /// Discards earlier iterations: the function has changed.
  void restart() { count_ = 0; }

  /// The next x.
  /// @param x argument of the last iteration
  /// @param g g(x); overwritten
  void accelerate(const Eigen::Ref<const VecX>& x, Eigen::Ref<VecX> g);

 private:
  static constexpr int kDepth = 8;
  int count_ = 0;  ///< number of results since restart()
  MatX changes_;   ///< (size × depth) differences of g(x) − x from one iteration to the next
  MatX results_;   ///< (size × depth) differences of g(x)
  VecX change_;    ///< the last g(x) − x
  VecX result_;    ///< the last g(x)
};

}  // namespace stylet::paper
