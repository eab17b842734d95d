// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/remesh_cost.hpp"

#include "coupling/hat_stiffness.hpp"
#include "fem/blas_threads.hpp"
#include "needle_way.hpp"
#include "stylet/coupling/paper/dense_inverse.hpp"
#include "stylet/coupling/track_compliance.hpp"
#include "stylet/measure/timing.hpp"

#include <cblas.h>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

namespace stylet::measure {

namespace {

RemeshCost::Times times(const std::vector<double>& seconds) {
  if (seconds.empty()) return {};
  return {median(seconds), *std::max_element(seconds.begin(), seconds.end())};
}

/// Times the changes along one way through the tissue, round by round, with all methods in turn.
class Trial {
 public:
  Trial(const NeedleWay& way, const RemeshCostOptions& options, std::vector<AddedNode> nodes)
      : way_(way),
        tissue_(way.store->tissue()),
        placement_(options.placement),
        nodes_(std::move(nodes)),
        ours_(way.store, *way.locator, static_cast<int>(nodes_.size())),
        woodbury_(paper::DenseInverse::Engine::woodbury, way.inverse, static_cast<int>(nodes_.size())),
        bcs_(paper::DenseInverse::Engine::bcs, way.inverse, static_cast<int>(nodes_.size())) {}

  void round_of_ours() {
    ours_.reset();
    Index hint = nodes_.front().at.tet;
    for (const AddedNode& node : nodes_) {
      seconds_["ours"].push_back(cpu_seconds([&] {
        const auto at = way_.locator->find(node.x, hint, node.travel);
        ours_.add(*at, node.x, placement_, node.travel);
        hint = at->tet;
      }));
    }
  }

  /// As round_of_ours(), but an update of the full inverse before each event removes all other data from the caches.
  void round_of_ours_cold() {
    ours_.reset();
    woodbury_.reset();
    Index hint = nodes_.front().at.tet;
    for (const AddedNode& node : nodes_) {
      const MatX change = stiffness_change(tissue_, node);
      woodbury_.append_node();
      woodbury_.change(node.dofs, change);
      seconds_["cold"].push_back(cpu_seconds([&] {
        const auto at = way_.locator->find(node.x, hint, node.travel);
        ours_.add(*at, node.x, placement_, node.travel);
        hint = at->tet;
      }));
    }
  }

  void round_of_woodbury() { round_of(woodbury_, seconds_["woodbury"], &seconds_["woodbury_update"]); }
  void round_of_bcs() { round_of(bcs_, seconds_["bcs"], nullptr); }

  /// Times the lemma on the whole matrix, and the rank-k update of one triangle by BLAS.
  void round_of_matrices() {
    const Eigen::Index old = way_.inverse->rows();
    const Eigen::Index size = old + 3 * static_cast<Eigen::Index>(nodes_.size());
    const double delta = way_.inverse->diagonal().mean();
    MatX M = MatX::Zero(size, size);
    M.topLeftCorner(old, old) = *way_.inverse;
    MatX other = M;
    Eigen::Index N = old;
    for (const AddedNode& node : nodes_) {
      M.diagonal().segment<3>(N).setConstant(delta);
      N += 3;
      MatX change = stiffness_change(tissue_, node);
      change.diagonal().tail<3>().array() -= 1.0 / delta;
      seconds_["full"].push_back(
          cpu_seconds([&] { paper::update_by_woodbury<double>(M.topLeftCorner(N, N), node.dofs, change); }));
      const auto k = static_cast<Eigen::Index>(node.dofs.size());
      const MatX columns = M.topLeftCorner(N, k);
      seconds_["rank"].push_back(cpu_seconds([&] {
        cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, static_cast<int>(N), static_cast<int>(k), -1.0,
                    columns.data(), static_cast<int>(N), 1.0, other.data(), static_cast<int>(size));
      }));
    }
    full_error_ = (M.bottomRightCorner(size - old, size - old) - ours()).cwiseAbs().maxCoeff() / scale();
  }

  /// Times the assembly of K with all added nodes and its inversion from scratch.
  void round_of_inverse() {
    const Eigen::Index old = way_.inverse->rows();
    const Eigen::Index size = old + 3 * static_cast<Eigen::Index>(nodes_.size());
    MatX K(size, size);
    seconds_["inverse"].push_back(cpu_seconds([&] {
      K.setZero();
      K.topLeftCorner(old, old) = MatX(tissue_.stiffness());
      for (const AddedNode& node : nodes_) {
        const MatX change = stiffness_change(tissue_, node);
        for (std::size_t i = 0; i < node.dofs.size(); ++i)
          for (std::size_t j = 0; j < node.dofs.size(); ++j)
            K(node.dofs[i], node.dofs[j]) += change(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
      paper::invert(K);
    }));
    inverse_error_ = (K.bottomRightCorner(size - old, size - old) - ours()).cwiseAbs().maxCoeff() / scale();
  }

  /// Times the computation of stiffnesses alone. It is repeated many times, because the clock is too coarse for it.
  void round_of_stiffness() {
    constexpr int times_over = 200;
    for (const AddedNode& node : nodes_) {
      double sum = 0.0;
      seconds_["stiffness"].push_back(cpu_seconds([&] {
                                        for (int i = 0; i < times_over; ++i)
                                          sum += stiffness_change(tissue_, node)(0, 0);
                                      }) /
                                      times_over);
      const auto& element = node.change.before.front();
      const Material& material =
          tissue_.material(tissue_.mesh().tet_region[static_cast<std::size_t>(element.base_tet)]);
      Vec4 weights = element.weights(node.x).cwiseMax(0.01);
      seconds_["hat"].push_back(cpu_seconds([&] {
                                  for (int i = 0; i < times_over; ++i) {
                                    weights[0] +=
                                        1e-9;  // so that the compiler cannot move the computation out of the loop
                                    sum += hat_stiffness(element.gradients, element.volume, material, weights)(0, 0);
                                  }
                                }) /
                                times_over);
      kept_ += sum;
    }
  }

  [[nodiscard]] RemeshCost cost() {
    RemeshCost cost;
    cost.nodes = tissue_.mesh().node_count();
    cost.dofs = tissue_.free_dofs();
    cost.events = static_cast<int>(nodes_.size());
    for (const AddedNode& node : nodes_) cost.change = std::max(cost.change, static_cast<int>(node.dofs.size()));
    cost.ours = times(seconds_["ours"]);
    cost.ours_cold = times(seconds_["cold"]);
    cost.woodbury = times(seconds_["woodbury"]);
    cost.woodbury_full = times(seconds_["full"]);
    cost.bcs = times(seconds_["bcs"]);
    cost.inverse = times(seconds_["inverse"]);
    cost.rank_update = times(seconds_["rank"]);
    cost.stiffness = times(seconds_["stiffness"]);
    cost.hat = times(seconds_["hat"]);
    cost.woodbury_update_s = median(seconds_["woodbury_update"]);
    cost.largest_error = std::max({full_error_, inverse_error_, error_of(woodbury_), error_of(bcs_)});
    return cost;
  }

 private:
  void round_of(paper::DenseInverse& inverse, std::vector<double>& whole_s, std::vector<double>* update_s) {
    inverse.reset();
    Index hint = nodes_.front().at.tet;
    for (const AddedNode& node : nodes_) {
      const double started = thread_cpu_s();
      const auto at = way_.locator->find(node.x, hint, node.travel);
      hint = at->tet;
      const MatX change = stiffness_change(tissue_, node);
      inverse.append_node();
      const double located = thread_cpu_s();
      inverse.change(node.dofs, change);
      const double ended = thread_cpu_s();
      whole_s.push_back(ended - started);
      if (update_s != nullptr) update_s->push_back(ended - located);
    }
  }

  /// Compliance among the added nodes [mm/N] by the default's method.
  [[nodiscard]] MatX ours() const {
    const auto size = 3 * static_cast<Eigen::Index>(nodes_.size());
    return ours_.matrix().block(3, 3, size, size);  // the tip comes first
  }
  [[nodiscard]] double scale() const { return ours().cwiseAbs().maxCoeff(); }

  [[nodiscard]] double error_of(const paper::DenseInverse& inverse) const {
    const auto size = 3 * static_cast<Index>(nodes_.size());
    const Index old = inverse.dofs() - size;
    const MatX expected = ours();
    double worst = 0.0;
    if (old < tissue_.free_dofs()) return worst;  // this method was not run
    for (Index i = 0; i < size; ++i)
      for (Index j = 0; j < size; ++j) worst = std::max(worst, std::abs(inverse(old + i, old + j) - expected(i, j)));
    return worst / scale();
  }

  const NeedleWay& way_;
  const Tissue& tissue_;
  Placement placement_;
  std::vector<AddedNode> nodes_;
  TrackCompliance ours_;
  paper::DenseInverse woodbury_;
  paper::DenseInverse bcs_;
  std::map<std::string_view, std::vector<double>> seconds_;  ///< [s] of each method, one per event and round
  double full_error_ = 0.0;
  double inverse_error_ = 0.0;
  double kept_ = 0.0;  ///< uses the results of the timed loops, so that the compiler does not remove them
};

}  // namespace

Result<RemeshCost> measure_remeshing(const NeedleWay& way, const RemeshCostOptions& options, const Progress& progress) {
  const detail::OneBlasThread one_thread;
  std::vector<AddedNode> nodes = nodes_along(way, options);
  if (nodes.empty()) {
    return failure("measuring the change of the mesh", "no node can be added on the needle's path",
                   "Choose a path through the tissue");
  }
  Trial trial(way, options, std::move(nodes));
  for (int round = 0; round < options.rounds; ++round) {
    report(progress, "timing changes of the mesh", static_cast<double>(round) / options.rounds);
    trial.round_of_ours();
    trial.round_of_ours_cold();
    trial.round_of_woodbury();
    trial.round_of_matrices();
    if (round < options.bcs_rounds) trial.round_of_bcs();
    if (round < options.inverse_rounds) trial.round_of_inverse();
    if (round == 0) trial.round_of_stiffness();
  }
  report(progress, "timing changes of the mesh", 1.0);
  RemeshCost cost = trial.cost();
  if (!(cost.largest_error <= kLargestDifference)) {
    return failure("measuring the change of the mesh",
                   fmt::format("the methods' compliances differ by {:.1e}", cost.largest_error),
                   "Check the BLAS and LAPACK installed; the library's own tests cover this");
  }
  return cost;
}

CountedCost count_operations(int N, int k, int added) {
  using paper::Counted;
  // Diagonal matrices suffice, because the number of operations does not depend on the values.
  std::vector<Index> dofs;
  const Index old = N - added;
  for (Index i = 0; i < k - added; ++i) dofs.push_back(i * (old / std::max(1, k - added)));
  for (Index i = old; i < N; ++i) dofs.push_back(i);
  paper::Matrix<Counted> change = paper::Matrix<Counted>::Constant(k, k, Counted(0.0));
  for (int i = 0; i < k; ++i) change(i, i) = 0.5;
  const auto identity = [N] {
    paper::Matrix<Counted> M = paper::Matrix<Counted>::Constant(N, N, Counted(0.0));
    for (int i = 0; i < N; ++i) M(i, i) = 1.0;
    return M;
  };
  CountedCost cost;
  paper::Matrix<Counted> M = identity();
  for (Index i = old; i < N; ++i) M(i, i) = 0.0;  // the new degrees of freedom are not in the inverse yet
  Counted::reset();
  paper::update_by_switches<Counted>(M, dofs, change, old);
  cost.switches = static_cast<double>(Counted::multiplications);
  M = identity();
  Counted::reset();
  paper::update_by_woodbury<Counted>(M, dofs, change);
  cost.woodbury = static_cast<double>(Counted::multiplications);
  return cost;
}

}  // namespace stylet::measure
