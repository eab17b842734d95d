// SPDX-License-Identifier: GPL-3.0-or-later
#include "block_product.hpp"

#include "core/for_processors.hpp"

#include <cassert>
#include <type_traits>

namespace stylet::detail {
namespace {

using dense::Four;
using dense::four;
/// Eight numbers in one register of AVX, or two of SSE; they may lie at any address.
using Eight [[gnu::vector_size(32), gnu::aligned(4), gnu::may_alias]] = float;

STYLET_INLINE const Four& some(const double* at) { return four(at); }
STYLET_INLINE Four& some(double* at) { return four(at); }
STYLET_INLINE const Eight& some(const float* at) { return *reinterpret_cast<const Eight*>(at); }
STYLET_INLINE Eight& some(float* at) { return *reinterpret_cast<Eight*>(at); }

/// Three rows of Y. K is symmetric, so the three columns of a node in K are its rows.
/// @param values (3 × 3 count) rows of K @param nodes (count) the nodes that they multiply
template <class Scalar>
STYLET_INLINE void rows_of_product(Scalar* y, const Scalar* values, const int* nodes, Eigen::Index count,
                                   const Scalar* X) {
  using Some = std::conditional_t<std::is_same_v<Scalar, float>, Eight, Four>;
  constexpr int width = sizeof(Some) / sizeof(Scalar);
  // Columns that one pass takes: six sums, two numbers of X and a factor stay in registers.
  constexpr int at_once = 2 * width;
  static_assert(kSideBySide % at_once == 0);
  for (int first = 0; first < kSideBySide; first += at_once) {
    Some sum[3][2] = {};
    for (Eigen::Index i = 0; i < count; ++i) {
      const Scalar* x = X + 3 * kSideBySide * static_cast<Eigen::Index>(nodes[i]) + first;
      const Scalar* block = values + 3 * i;
      for (int k = 0; k < 3; ++k) {
        const Some left = some(x + kSideBySide * k);
        const Some right = some(x + kSideBySide * k + width);
        for (int j = 0; j < 3; ++j) {
          const Scalar factor = block[3 * j * count + k];
          sum[j][0] += left * factor;
          sum[j][1] += right * factor;
        }
      }
    }
    for (int j = 0; j < 3; ++j) {
      some(y + kSideBySide * j + first) = sum[j][0];
      some(y + kSideBySide * j + first + width) = sum[j][1];
    }
  }
}

STYLET_FOR_PROCESSORS
void multiply_rows(double* y, const double* values, const int* nodes, Eigen::Index count, const double* X) {
  rows_of_product(y, values, nodes, count, X);
}

STYLET_FOR_PROCESSORS
void multiply_rows(float* y, const float* values, const int* nodes, Eigen::Index count, const float* X) {
  rows_of_product(y, values, nodes, count, X);
}

}  // namespace

template <class Scalar>
BlockProduct<Scalar>::BlockProduct(const Assembled& assembled) : assembled_(assembled) {
  if constexpr (std::is_same_v<Scalar, float>) {
    const double* const values = assembled.K.valuePtr();
    values_.assign(values, values + assembled.K.nonZeros());
  }
}

template <class Scalar>
void BlockProduct<Scalar>::multiply(const Loads<Scalar>& X, Loads<Scalar>& Y) const {
  assert(X.rows() == assembled_.K.cols() && Y.rows() == X.rows());
  const int* const begin = assembled_.pattern.outerIndexPtr();
  const int* const nodes = assembled_.pattern.innerIndexPtr();
  const Scalar* values = nullptr;
  if constexpr (std::is_same_v<Scalar, float>) {
    values = values_.data();
  } else {
    values = assembled_.K.valuePtr();
  }
  for (Eigen::Index node = 0; node < assembled_.pattern.cols(); ++node) {
    const Eigen::Index first = begin[node];
    multiply_rows(Y.data() + 3 * kSideBySide * node, values + 9 * first, nodes + first, begin[node + 1] - first,
                  X.data());
  }
}

template class BlockProduct<float>;
template class BlockProduct<double>;

}  // namespace stylet::detail
