// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/needle.hpp"

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace stylet {

namespace {

/// The shape at the start of an iteration. Measures the change of potential energy from it, without the rounding error
/// that large coordinates would cause.
class Potential {
 public:
  Potential(const Needle& needle, std::span<const PointLoad> loads)
      : loads_(loads), points_(loads.size()), energy_(needle.energy()) {
    for (std::size_t c = 0; c < loads.size(); ++c) points_[c] = needle.point(loads[c].s);
  }

  struct Change {
    double value = 0.0;     ///< [N mm]
    double rounding = 0.0;  ///< [N mm] smaller changes are not significant
  };
  [[nodiscard]] Change to(const Needle& needle) const {
    const double energy = needle.energy();
    double work = 0.0;
    double size = energy + energy_;
    for (std::size_t c = 0; c < loads_.size(); ++c) {
      const Vec3 point = needle.point(loads_[c].s);
      work += loads_[c].force.dot(point - points_[c]);
      size += loads_[c].force.norm() * (point.norm() + points_[c].norm());
    }
    return {energy - energy_ - work, 8.0 * std::numeric_limits<double>::epsilon() * size};
  }

 private:
  std::span<const PointLoad> loads_;
  std::vector<Vec3> points_;
  double energy_;
};

}  // namespace

Result<int> find_equilibrium(Needle& needle, std::span<const PointLoad> loads, double tolerance_Nmm,
                             int max_iterations) {
  const auto size = 3 * static_cast<Eigen::Index>(loads.size());
  MatX compliance(size, size);
  VecX free(size);
  double residual = needle.residual(loads);
  for (int iteration = 0; iteration <= max_iterations; ++iteration) {
    if (residual <= tolerance_Nmm) return iteration;
    if (iteration == max_iterations || !std::isfinite(residual)) break;
    const Potential potential(needle, loads);
    const VecX before = needle.state();
    needle.linearise(loads, compliance, free);
    needle.advance(loads);
    const VecX step = needle.state() - before;
    bool accepted = false;
    for (double fraction = 1.0; fraction > 1e-9; fraction *= 0.5) {
      if (fraction < 1.0) needle.set_state(before + fraction * step);
      const auto change = potential.to(needle);
      const double next = needle.residual(loads);
      if (change.value < -change.rounding || (change.value <= change.rounding && next < residual)) {
        residual = next;
        accepted = true;
        break;
      }
    }
    if (!accepted) {
      needle.set_state(before);
      break;
    }
  }
  return failure("needle equilibrium",
                 "an out-of-balance moment of " + std::to_string(residual) + " N mm is left, expected at most " +
                     std::to_string(tolerance_Nmm) + " N mm",
                 "Apply the loads in smaller steps, allow more iterations, or loosen the tolerance");
}

}  // namespace stylet
