// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/evidence/reproduce/figure5.hpp"

#include "fem/blas_threads.hpp"
#include "plane_tissue.hpp"
#include "stylet/coupling/paper/inverse_updates.hpp"
#include "stylet/measure/remesh_cost.hpp"
#include "stylet/measure/timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace stylet::reproduce {

namespace {

constexpr int kMostRepeats = 400;
constexpr int kFewestRepeats = 3;

/// The addition of a node to a tissue of about `dim` degrees of freedom: the initial matrices of all methods and the
/// expected result.
struct Problem {
  explicit Problem(int dim) {
    const int deep = std::max(2, static_cast<int>(std::lround(std::sqrt(0.5 * dim))));
    const int across = std::max(2, static_cast<int>(std::lround(0.5 * dim / deep)) - 1);
    PlaneTissue tissue = plane_tissue(deep, across);
    before = stiffness(tissue);
    paper::invert(before);
    change = add_node_in_the_middle(tissue);
    after = stiffness(tissue);
    expected = after;
    paper::invert(expected);
  }

  MatX before;    ///< K⁻¹ before
  MatX after;     ///< K after
  MatX expected;  ///< K⁻¹ after
  StiffnessChange change;
};

/// One method for the new inverse. `start` fills the matrix; `work` updates it and is timed.
struct Method {
  const char* name;
  double Figure5Row::*median_s;
  std::function<void(MatX&)> start;
  std::function<void(MatX&)> work;
  bool lower_only = false;
  std::vector<double> seconds{};
};

std::vector<Method> methods(const Problem& p) {
  const Eigen::Index old = p.before.rows();
  const Eigen::Index N = p.after.rows();
  // The lemma needs an invertible matrix, so the new node starts on springs whose compliance is the mean of the others.
  // The change removes these springs.
  const double delta = p.before.diagonal().mean();
  MatX without_springs = p.change.values;
  for (std::size_t i = 0; i < p.change.dofs.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (p.change.dofs[i] >= old) without_springs(k, k) -= 1.0 / delta;
  }
  const auto bordered = [&p, old, N](MatX& M, double diagonal) {
    M = MatX::Zero(N, N);
    M.topLeftCorner(old, old) = p.before;
    M.diagonal().tail(N - old).setConstant(diagonal);
  };
  const auto on_springs = [bordered, delta](MatX& M) { bordered(M, delta); };
  return {{"inverse from scratch", &Figure5Row::inverse_s, [&p](MatX& M) { M = p.after; },
           [](MatX& M) { paper::invert(M); }},
          {"boundary condition switches", &Figure5Row::bcs_s, [bordered](MatX& M) { bordered(M, 0.0); },
           [&p, old](MatX& M) { paper::update_by_switches<double>(M, p.change.dofs, p.change.values, old); }},
          {"Woodbury", &Figure5Row::woodbury_s, on_springs,
           [&p, without_springs](MatX& M) { paper::update_by_woodbury<double>(M, p.change.dofs, without_springs); }},
          {"Woodbury on one triangle", &Figure5Row::woodbury_symmetric_s, on_springs,
           [&p, without_springs](MatX& M) { paper::update_by_woodbury_symmetric(M, p.change.dofs, without_springs); },
           true}};
}

double error_of(const MatX& M, const MatX& expected, bool lower_only) {
  const MatX difference = (M - expected).cwiseAbs();
  const double largest =
      lower_only ? MatX(difference.triangularView<Eigen::Lower>()).maxCoeff() : difference.maxCoeff();
  return largest / expected.cwiseAbs().maxCoeff();
}

}  // namespace

Result<std::vector<Figure5Row>> measure_figure5(const std::vector<int>& dims, double seconds_per_size,
                                                const Progress& progress) {
  const detail::OneBlasThread one_thread;
  std::vector<Figure5Row> rows;
  for (const int dim : dims) {
    report(progress, "figure 5, changing the inverse",
           static_cast<double>(rows.size()) / static_cast<double>(dims.size()));
    const Problem problem(std::clamp(dim, 30, 5000));
    Figure5Row row;
    row.dim = static_cast<int>(problem.after.rows());
    row.change = static_cast<int>(problem.change.dofs.size());
    std::vector<Method> all = methods(problem);
    const double started = measure::thread_cpu_s();
    MatX M;
    for (row.repeats = 0; row.repeats < kMostRepeats; ++row.repeats) {
      if (row.repeats >= kFewestRepeats && measure::thread_cpu_s() - started > seconds_per_size) break;
      for (Method& method : all) {
        method.start(M);
        method.seconds.push_back(measure::cpu_seconds([&] { method.work(M); }));
        const double error = error_of(M, problem.expected, method.lower_only);
        row.largest_error = std::max(row.largest_error, error);
        if (!(error <= measure::kLargestDifference)) {
          return failure("figure 5",
                         fmt::format("{} at order {} is off by {:.1e} of the largest entry of the inverse", method.name,
                                     row.dim, error),
                         "Check the BLAS and LAPACK installed; the library's own tests cover this");
        }
      }
    }
    for (const Method& method : all) row.*method.median_s = measure::median(method.seconds);
    row.added = row.dim - static_cast<int>(problem.before.rows());
    const measure::CountedCost counted = measure::count_operations(row.dim, row.change, row.added);
    row.bcs_multiplications = counted.switches;
    row.woodbury_multiplications = counted.woodbury;
    rows.push_back(row);
  }
  report(progress, "figure 5, changing the inverse", 1.0);
  return rows;
}

std::vector<int> figure5_dims(bool quick) {
  if (quick) return {50, 100, 200, 400, 800};
  return {50, 100, 200, 300, 500, 700, 1000, 1300, 1600, 2000};
}

}  // namespace stylet::reproduce
