// SPDX-License-Identifier: GPL-3.0-or-later
#include "block_product.hpp"

#include "core/for_processors.hpp"

#include <cassert>

namespace stylet::detail {
namespace {

using dense::Four;
using dense::four;

/// Columns that one pass takes: six sums, two numbers of X and a factor stay in registers.
constexpr int kAtOnce = 8;
static_assert(kSideBySide % kAtOnce == 0);

/// Three rows of Y. K is symmetric, so the three columns of a node in K are its rows.
/// @param values (3 × 3 count) rows of K @param nodes (count) the nodes that they multiply
STYLET_FOR_PROCESSORS
void multiply_rows(double* y, const double* values, const int* nodes, Eigen::Index count, const double* X) {
  for (int first = 0; first < kSideBySide; first += kAtOnce) {
    Four sum[3][2] = {};
    for (Eigen::Index i = 0; i < count; ++i) {
      const double* x = X + 3 * kSideBySide * static_cast<Eigen::Index>(nodes[i]) + first;
      const double* block = values + 3 * i;
      for (int k = 0; k < 3; ++k) {
        const Four left = four(x + kSideBySide * k);
        const Four right = four(x + kSideBySide * k + 4);
        for (int j = 0; j < 3; ++j) {
          const double factor = block[3 * j * count + k];
          sum[j][0] += left * factor;
          sum[j][1] += right * factor;
        }
      }
    }
    for (int j = 0; j < 3; ++j) {
      four(y + kSideBySide * j + first) = sum[j][0];
      four(y + kSideBySide * j + first + 4) = sum[j][1];
    }
  }
}

}  // namespace

void multiply(const Assembled& assembled, const Loads& X, Loads& Y) {
  assert(X.rows() == assembled.K.cols() && Y.rows() == X.rows());
  const int* const begin = assembled.pattern.outerIndexPtr();
  const int* const nodes = assembled.pattern.innerIndexPtr();
  for (Eigen::Index node = 0; node < assembled.pattern.cols(); ++node) {
    const Eigen::Index first = begin[node];
    multiply_rows(Y.data() + 3 * kSideBySide * node, assembled.K.valuePtr() + 9 * first, nodes + first,
                  begin[node + 1] - first, X.data());
  }
}

}  // namespace stylet::detail
