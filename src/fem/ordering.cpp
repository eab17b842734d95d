// SPDX-License-Identifier: GPL-3.0-or-later
#include "ordering.hpp"

#include <cassert>
#include <mutex>

namespace stylet::detail {
namespace {

/// The pattern among some of the nodes, and the numbers of these nodes.
struct Part {
  Eigen::SparseMatrix<double> pattern;
  std::vector<int> nodes;
};

Part without(const Eigen::SparseMatrix<double>& nodes, std::span<const int> last) {
  const auto size = static_cast<int>(nodes.cols());
  std::vector<int> number(static_cast<std::size_t>(size), 0);
  for (const int node : last) number[node] = -1;
  Part part;
  for (int node = 0; node < size; ++node) {
    if (number[node] < 0) continue;
    number[node] = static_cast<int>(part.nodes.size());
    part.nodes.push_back(node);
  }
  const auto rest = static_cast<int>(part.nodes.size());
  part.pattern.resize(rest, rest);
  part.pattern.reserve(nodes.nonZeros());
  for (int column = 0; column < rest; ++column) {
    part.pattern.startVec(column);
    for (Eigen::SparseMatrix<double>::InnerIterator it(nodes, part.nodes[column]); it; ++it) {
      const int row = number[it.row()];
      if (row >= 0) part.pattern.insertBack(row, column) = 1.0;
    }
  }
  part.pattern.finalize();
  return part;
}

}  // namespace

cholmod_sparse view(const Eigen::SparseMatrix<double>& A, int xtype) {
  assert(A.isCompressed());
  cholmod_sparse out{};
  out.nrow = static_cast<size_t>(A.rows());
  out.ncol = static_cast<size_t>(A.cols());
  out.nzmax = static_cast<size_t>(A.nonZeros());
  out.p = const_cast<int*>(A.outerIndexPtr());  // CHOLMOD's interface has no const, but it only reads
  out.i = const_cast<int*>(A.innerIndexPtr());
  out.x = xtype == CHOLMOD_PATTERN ? nullptr : const_cast<double*>(A.valuePtr());
  out.stype = -1;  // symmetric: read the lower triangle
  out.itype = CHOLMOD_INT;
  out.xtype = xtype;
  out.dtype = CHOLMOD_DOUBLE;
  out.sorted = 1;
  out.packed = 1;
  return out;
}

std::vector<int> elimination_order(const Eigen::SparseMatrix<double>& nodes, std::span<const int> last,
                                   cholmod_common& common) {
  const Part rest = without(nodes, last);
  std::vector<int> order(rest.nodes.size());
  if (!order.empty()) {
    cholmod_sparse pattern = view(rest.pattern, CHOLMOD_PATTERN);
    // METIS draws from rand(), which all threads share: two orderings at the same time would disturb each other, and
    // the factor's last bits would differ from run to run.
    static std::mutex one_at_a_time;
    const std::scoped_lock lock(one_at_a_time);
    if (!cholmod_metis(&pattern, nullptr, 0, 1, order.data(), &common)) return {};
    for (int& node : order) node = rest.nodes[node];
  }
  order.insert(order.end(), last.begin(), last.end());

  // The ancestors of a node of `last` are all in `last`, so moving `last` to the end of the postorder still keeps every
  // descendant before its ancestors. The factor therefore has the same entries.
  const std::size_t size = order.size();
  std::vector<int> parent(size), post(size), count(size), first(size), level(size);
  cholmod_sparse pattern = view(nodes, CHOLMOD_PATTERN);
  if (!cholmod_analyze_ordering(&pattern, CHOLMOD_GIVEN, order.data(), nullptr, 0, parent.data(), post.data(),
                                count.data(), first.data(), level.data(), &common)) {
    return {};
  }
  std::vector<int> result;
  result.reserve(size);
  for (const int k : post) {
    if (static_cast<std::size_t>(k) < rest.nodes.size()) result.push_back(order[k]);
  }
  result.insert(result.end(), last.begin(), last.end());
  return result;
}

}  // namespace stylet::detail
