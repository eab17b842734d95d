// SPDX-License-Identifier: GPL-3.0-or-later
#include "ordering.hpp"

#include <metis.h>

#include <cassert>
#include <csetjmp>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <mutex>
#include <numeric>
#include <type_traits>

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

/// The postorder of the elimination tree: positions in `order`; empty on failure.
std::vector<int> postorder(cholmod_sparse& pattern, std::vector<int> order, cholmod_common& common) {
  const std::size_t size = order.size();
  std::vector<int> parent(size), post(size), count(size), first(size), level(size);
  if (!cholmod_analyze_ordering(&pattern, CHOLMOD_GIVEN, order.data(), nullptr, 0, parent.data(), post.data(),
                                count.data(), first.data(), level.data(), &common)) {
    return {};
  }
  return post;
}

static_assert(std::is_same_v<idx_t, int>, "METIS and CHOLMOD must have the same integers");

thread_local std::jmp_buf* way_out = nullptr;  ///< out of a call of METIS, for a thread that is in one

struct Graph {
  int size = 0;
  int* begin = nullptr;
  int* neighbours = nullptr;
};

/// Returns false if METIS got no memory. What it had until then is lost.
bool dissect(const Graph& graph, int* order, int* position) {
  std::jmp_buf here;
  if (setjmp(here) != 0) {  // NOLINT(cert-err52-cpp): METIS is in C, and knows no other way
    way_out = nullptr;
    return false;
  }
  way_out = &here;
  int sizes[1];
  const int done =
      METIS_NodeNDP(graph.size, graph.begin, graph.neighbours, nullptr, 1, nullptr, order, position, sizes);
  way_out = nullptr;
  return done == METIS_OK;
}

/// Whether METIS will get the memory that it needs, by the bound of CHOLMOD.
bool has_memory_for(const Graph& graph, cholmod_common& common) {
  const std::size_t needed =
      10 * static_cast<std::size_t>(graph.begin[graph.size]) + 50 * static_cast<std::size_t>(graph.size) + 4096;
  void* const block = cholmod_malloc(needed, sizeof(idx_t), &common);
  if (block == nullptr) return false;
  cholmod_free(needed, sizeof(idx_t), block, &common);
  return true;
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

std::vector<int> nested_dissection(cholmod_sparse& pattern, cholmod_common& common) {
  struct Copy {
    cholmod_common& common;
    cholmod_sparse* of;
    ~Copy() { cholmod_free_sparse(&of, &common); }
  } both{common, cholmod_copy(&pattern, 0, -1, &common)};  // both triangles, without values and diagonal
  if (both.of == nullptr) return {};
  const Graph graph{static_cast<int>(pattern.nrow), static_cast<int*>(both.of->p), static_cast<int*>(both.of->i)};
  std::vector<int> order(pattern.nrow), position(pattern.nrow);
  if (graph.begin[graph.size] == 0) {  // METIS refuses a graph without edges
    std::iota(order.begin(), order.end(), 0);
    return order;
  }
  if (!has_memory_for(graph, common)) return {};
  // METIS draws from rand(), which all threads share: two orderings at the same time would disturb each other, and
  // the factor's last bits would differ from run to run.
  static std::mutex one_at_a_time;
  const std::scoped_lock lock(one_at_a_time);
  if (dissect(graph, order.data(), position.data())) return order;
  common.status = CHOLMOD_OUT_OF_MEMORY;
  return {};
}

std::vector<int> elimination_order(const Eigen::SparseMatrix<double>& nodes, std::span<const int> last,
                                   cholmod_common& common) {
  const Part rest = without(nodes, last);
  std::vector<int> order;
  if (!rest.nodes.empty()) {
    cholmod_sparse pattern = view(rest.pattern, CHOLMOD_PATTERN);
    const std::vector<int> dissected = nested_dissection(pattern, common);
    if (dissected.empty()) return {};
    for (const int k : postorder(pattern, dissected, common)) order.push_back(rest.nodes[dissected[k]]);
    if (order.empty()) return {};
  }
  order.insert(order.end(), last.begin(), last.end());

  // The ancestors of a node of `last` are all in `last`, so moving `last` to the end of the postorder still keeps every
  // descendant before its ancestors. The factor therefore has the same entries.
  cholmod_sparse pattern = view(nodes, CHOLMOD_PATTERN);
  const std::vector<int> post = postorder(pattern, order, common);
  if (post.empty()) return {};
  std::vector<int> result;
  result.reserve(order.size());
  for (const int k : post) {
    if (static_cast<std::size_t>(k) < rest.nodes.size()) result.push_back(order[k]);
  }
  result.insert(result.end(), last.begin(), last.end());
  return result;
}

}  // namespace stylet::detail

/// Takes the place of METIS's own function, which METIS calls where it gets no memory, and which ends the program.
extern "C" [[gnu::visibility("default")]] void gk_errexit(int signal, const char* text, ...) {
  if (stylet::detail::way_out != nullptr) std::longjmp(*stylet::detail::way_out, 1);
  // Of another user of METIS in this program, who gets what METIS would have done.
  std::va_list more;
  va_start(more, text);
  (void)std::vfprintf(stderr, text, more);
  va_end(more);
  (void)std::fputc('\n', stderr);
  (void)std::raise(signal);
}
