// SPDX-License-Identifier: GPL-3.0-or-later
#include "element_size_search.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace stylet::meshing {
namespace {

constexpr double kGoodError = 0.015;     // relative error of the number of nodes with which the search ends
constexpr double kLargestError = 0.03;   // largest relative error that is accepted
constexpr double kLargestScale = 150;    // [mm] a larger scale has no effect
constexpr double kSmallestScale = 0.05;  // [mm]

struct Trial {
  double x;  // log scale
  double y;  // log (nodes / wanted)
};

/// The next log scale to try.
double next(const std::vector<Trial>& trials, int round) {
  const Trial* above = nullptr;  // trial with too many nodes and the largest scale
  const Trial* below = nullptr;  // trial with too few nodes and the smallest scale
  for (const Trial& t : trials) {
    if (t.y > 0 && (above == nullptr || t.x > above->x)) above = &t;
    if (t.y <= 0 && (below == nullptr || t.x < below->x)) below = &t;
  }
  const Trial& last = trials.back();
  if (above == nullptr || below == nullptr) {
    double slope = -2.5;
    if (trials.size() > 1) {
      const Trial& before = trials[trials.size() - 2];
      if (std::abs(last.x - before.x) > 1e-6) slope = std::clamp((last.y - before.y) / (last.x - before.x), -4.0, -0.7);
    }
    // Step a little further than the secant, so that the solution gets enclosed.
    return last.x - 1.15 * last.y / slope;
  }
  const double width = below->x - above->x;
  if (width > 0.004) {
    const double t = above->y / (above->y - below->y);
    // Interpolation converges slowly when the function has a step, so every third trial bisects.
    return above->x + width * (round % 3 == 2 ? 0.5 : std::clamp(t, 0.1, 0.9));
  }
  // Where noise or a step is in the way, try scales on either side, further out each time.
  const int k = round / 2 + 1;
  return 0.5 * (above->x + below->x) + (round % 2 == 0 ? 0.0037 : -0.0037) * k;
}

}  // namespace

Result<SizedMesh> find_element_size(const std::function<TetrahedraliserInput(double)>& input_for, Index wanted,
                                    double guess, const Progress& progress) {
  // Small meshes are noisy and cheap; large meshes are neither.
  const int most = std::clamp(100000 / std::max(wanted, 1), 10, 60);
  SizedMesh best;
  double best_error = HUGE_VAL;
  double fewest = HUGE_VAL;
  std::vector<Trial> trials;
  double x = std::log(std::clamp(guess, kSmallestScale, kLargestScale));
  for (int round = 0; round < most; ++round) {
    report(progress, "searching the element size", static_cast<double>(round) / most);
    const double scale = std::exp(x);
    auto t = std::make_unique<Tetrahedraliser>(input_for(scale));
    if (auto r = t->refine(); !r) return r.error();
    const double n = static_cast<double>(t->mesh().nodes.size());
    if (n < 4) {
      trials.push_back({x, -3.0});
      x = next(trials, round);
      continue;
    }
    fewest = std::min(fewest, n);
    const double error = n / wanted - 1;
    if (std::abs(error) < best_error) {
      best_error = std::abs(error);
      best = {std::move(t), scale};
    }
    if (best_error <= kGoodError || (best_error <= kLargestError && round >= most / 2)) break;
    trials.push_back({x, std::log(n / wanted)});
    if (error > 0 && x >= std::log(kLargestScale) - 1e-9) break;
    x = std::clamp(next(trials, round), std::log(kSmallestScale), std::log(kLargestScale));
  }
  if (best_error > kLargestError) {
    if (fewest > wanted) {
      return input_error("number of nodes",
                         fmt::format("{} nodes are wanted, but this anatomy needs about {:.0f}", wanted, fewest),
                         fmt::format("Ask for {:.0f} or more, or mesh fewer structures", 1.1 * fewest));
    }
    return failure(
        "mesher",
        fmt::format("no element size gives {} nodes; the nearest number differs by {:.1f} %", wanted, 100 * best_error),
        "Ask for a few more or fewer nodes");
  }
  return best;
}

}  // namespace stylet::meshing
