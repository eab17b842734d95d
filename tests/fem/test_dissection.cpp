// SPDX-License-Identifier: GPL-3.0-or-later
// The order of elimination comes from METIS, which must leave the rest of the process alone.
#include "fem/ordering.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <numeric>
#include <thread>
#include <vector>

extern "C" void gk_errexit(int signal, const char* text, ...);

namespace stylet::detail {
namespace {

/// The pattern of a cube of m × m × m nodes, each joined to those around it; its lower triangle.
Eigen::SparseMatrix<double> grid(int m) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto number = [m](int x, int y, int z) { return x + m * (y + m * z); };
  const auto is_inside = [m](int k) { return k >= 0 && k < m; };
  for (int z = 0; z < m; ++z)
    for (int y = 0; y < m; ++y)
      for (int x = 0; x < m; ++x)
        for (int step = 0; step < 27; ++step) {
          const int X = x + step % 3 - 1, Y = y + step / 3 % 3 - 1, Z = z + step / 9 - 1;
          if (!is_inside(X) || !is_inside(Y) || !is_inside(Z) || number(X, Y, Z) < number(x, y, z)) continue;
          entries.emplace_back(number(X, Y, Z), number(x, y, z), 1.0);
        }
  Eigen::SparseMatrix<double> pattern(m * m * m, m * m * m);
  pattern.setFromTriplets(entries.begin(), entries.end());
  return pattern;
}

struct Common : cholmod_common {
  Common() : cholmod_common() { cholmod_start(this); }
  ~Common() { cholmod_finish(this); }
};

std::vector<int> order_of(const Eigen::SparseMatrix<double>& pattern) {
  Common common;
  return elimination_order(pattern, {}, common);
}

TEST(Dissection, is_that_of_cholmod) {
  for (const int m : {1, 2, 3, 6, 13}) {
    const Eigen::SparseMatrix<double> pattern = grid(m);
    Common common;
    cholmod_sparse seen = view(pattern, CHOLMOD_PATTERN);
    std::vector<int> expected(static_cast<std::size_t>(pattern.cols()));
    ASSERT_TRUE(cholmod_metis(&seen, nullptr, 0, 0, expected.data(), &common));
    EXPECT_EQ(nested_dissection(seen, common), expected) << m;
  }
}

TEST(Dissection, orders_each_node_once) {
  std::vector<int> order = order_of(grid(7));
  std::sort(order.begin(), order.end());
  std::vector<int> all(343);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(order, all);
}

TEST(Dissection, leaves_the_signals_of_the_process_alone) {
  const auto handler_of = [](int signal) {
    struct sigaction now {};
    sigaction(signal, nullptr, &now);
    return now.sa_handler;
  };
  const auto term = handler_of(SIGTERM), abort = handler_of(SIGABRT);
  const Eigen::SparseMatrix<double> pattern = grid(20);
  std::atomic<bool> is_done = false;
  std::jthread worker([&] {
    EXPECT_EQ(order_of(pattern).size(), 8000u);
    is_done = true;
  });
  while (!is_done) {
    ASSERT_EQ(handler_of(SIGTERM), term);
    ASSERT_EQ(handler_of(SIGABRT), abort);
  }
}

TEST(Dissection, without_memory_says_so) {
  const Eigen::SparseMatrix<double> pattern = grid(10);
  Common common;
  common.print = 0;
  const auto usual = SuiteSparse_config.malloc_func;
  SuiteSparse_config.malloc_func = [](std::size_t bytes) { return bytes < 400'000 ? std::malloc(bytes) : nullptr; };
  const std::vector<int> order = elimination_order(pattern, {}, common);
  SuiteSparse_config.malloc_func = usual;
  EXPECT_TRUE(order.empty());
  EXPECT_EQ(common.status, CHOLMOD_OUT_OF_MEMORY);
}

TEST(DissectionDeathTest, errors_of_somebody_elses_metis_are_as_before) {
  EXPECT_EXIT(gk_errexit(SIGABRT, "%d bytes", 7), testing::KilledBySignal(SIGABRT), "7 bytes");
}

}  // namespace
}  // namespace stylet::detail
