// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "assembly.hpp"

#include <vector>

namespace stylet::detail {

/// Several loads side by side, or the displacements by them: one row for each free degree of freedom, so that one pass
/// over the stiffness serves all of them.
inline constexpr int kSideBySide = 16;
template <class Scalar>
using Loads = Eigen::Matrix<Scalar, Eigen::Dynamic, kSideBySide, Eigen::RowMajor>;

/// The stiffness on the free degrees of freedom for products with loads, in single or double precision. A product in
/// single precision takes half the time.
template <class Scalar>
class BlockProduct {
 public:
  /// @param assembled outlives this
  explicit BlockProduct(const Assembled& assembled);

  /// Y ← K X
  /// @param Y (free × kSideBySide) output, of the size of X
  void multiply(const Loads<Scalar>& X, Loads<Scalar>& Y) const;

 private:
  const Assembled& assembled_;
  std::vector<float> values_;  ///< K's values in single precision; empty for double
};

}  // namespace stylet::detail
