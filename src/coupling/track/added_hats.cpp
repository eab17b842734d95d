// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/track/added_hats.hpp"

#include "core/dense_kernels.hpp"

#include <Eigen/LU>

namespace stylet {

AddedHats::AddedHats(int observables, int capacity)
    : capacity_(capacity),
      known_(static_cast<std::size_t>(observables), 0),
      hat_(static_cast<std::size_t>(observables * capacity), 0.0),
      z_(static_cast<std::size_t>(observables * capacity)),
      passed_on_(static_cast<std::size_t>(capacity * capacity)),
      amplitude_(static_cast<std::size_t>(capacity)) {
  splits_.reserve(static_cast<std::size_t>(capacity));
}

void AddedHats::reset() {
  splits_.clear();
  any_border_ = false;
  std::fill(known_.begin(), known_.end(), 0);
}

void AddedHats::add_inside(const Mat3& stiffness) {
  splits_.push_back({.flexibility = stiffness.inverse(), .inside = true});
}

void AddedHats::add_bordered(std::span<const Border> border) {
  const int p = count();
  for (int q = 0; q < p; ++q) {
    Mat3 sum = Mat3::Zero();
    for (const Border& at_vertex : border) sum.noalias() += z(at_vertex.vertex, q).transpose() * at_vertex.k;
    passed_on_[at(p, q)].noalias() = flexibility(q) * sum;
  }
  splits_.emplace_back();
  any_border_ = true;
}

void AddedHats::complete(std::span<const Border> border, const Mat3& stiffness) {
  // The new hat vanishes at the vertices, so z_p = −Σ_j A_{p−1}(i,j) k_jp there, and s_p = k_pp + Σ_i k_ipᵀ z_p(i).
  Mat3 s = stiffness;
  for (const Border& at_vertex : border) s.noalias() += at_vertex.k.transpose() * z(at_vertex.vertex, count() - 1);
  const Mat3 inverse = s.inverse();
  splits_.back().flexibility = 0.5 * (inverse + inverse.transpose());  // keeps it symmetric in spite of rounding
}

void AddedHats::clear(int observable) {
  std::fill_n(hat_.begin() + static_cast<std::ptrdiff_t>(at(observable, 0)), capacity_, 0.0);
  known_[static_cast<std::size_t>(observable)] = 0;
}

void AddedHats::add_hats(int observable, int from, double weight) {
  for (int p = 0; p < count(); ++p) hat_[at(observable, p)] += weight * hat_[at(from, p)];
}

void AddedHats::extend_z(int observable, const Mat3& base) {
  const int p = known(observable);
  Mat3 value = hat_[at(observable, p)] * Mat3::Identity() - base;
  if (!inside(p)) {
    const auto earlier = static_cast<std::size_t>(p);
    value -= dense::sum_of_products({&z_[at(observable, 0)], earlier}, {&passed_on_[at(p, 0)], earlier});
  }
  z_[at(observable, p)] = value;
  known_[static_cast<std::size_t>(observable)] = p + 1;
}

void AddedHats::copy_z(int from, int to) {
  std::copy_n(&z_[at(from, 0)], known(from), &z_[at(to, 0)]);
  known_[static_cast<std::size_t>(to)] = known(from);
}

Mat3 AddedHats::interpolated(int split, Mat3 sum, std::span<const int> from, std::span<const double> weights) const {
  for (std::size_t i = 0; i < from.size(); ++i) sum += weights[i] * z(from[i], split);
  return sum;
}

void AddedHats::interpolate_z(int observable, int split, double own, std::span<const int> from,
                              std::span<const double> weights) {
  z_[at(observable, split)] = interpolated(split, own * Mat3::Identity(), from, weights);
  known_[static_cast<std::size_t>(observable)] = split + 1;
}

Mat3 AddedHats::compliance(int a, int b, const Mat3& base) const {
  Mat3 sum = base;
  for (int p = 0; p < count(); ++p) {
    if (!inside(p)) {
      sum.noalias() += z(a, p) * amplitude(b, p);
    } else if (const double product = hat_[at(a, p)] * hat_[at(b, p)]; product != 0.0) {
      sum += product * flexibility(p);
    }
  }
  return sum;
}

void AddedHats::load(int observable) {
  for (int p = 0; p < count(); ++p) amplitude_[static_cast<std::size_t>(p)] = amplitude(observable, p);
}

void AddedHats::load_beyond(int observable, std::span<const int> from, std::span<const double> weights) {
  for (int p = 0; p < count(); ++p) {
    Mat3& amplitude_p = amplitude_[static_cast<std::size_t>(p)];
    if (inside(p)) {
      amplitude_p = amplitude(observable, p);
    } else {
      const Mat3 beyond = z(observable, p) - interpolated(p, Mat3::Zero(), from, weights);
      amplitude_p.noalias() = flexibility(p) * beyond.transpose();
    }
  }
}

Mat3 AddedHats::moved(int observable) const {
  const auto splits = splits_.size();
  // Where no split has a border, z_p = b_p I, and few b_p are not zero.
  if (any_border_) return dense::sum_of_products({&z(observable, 0), splits}, std::span(amplitude_).first(splits));
  Mat3 sum = Mat3::Zero();
  for (std::size_t p = 0; p < splits; ++p) {
    const double b = hat_[at(observable, static_cast<int>(p))];
    if (b != 0.0) sum += b * amplitude_[p];
  }
  return sum;
}

}  // namespace stylet
