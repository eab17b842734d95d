// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/realtime/seen_stiffness.hpp"

#include <algorithm>

namespace stylet {

namespace {

/// Share by which S approaches the stiffness of a softer body per step. It decreases from 1000 N/mm of bone to nothing
/// within 40 steps, but is kept while friction alternates between sticking and sliding.
constexpr double kShrink = 0.2;
/// [mm] Smaller motions are ignored, since they give no information about stiffness.
constexpr double kStill_mm = 1e-9;
/// If a body is stiffer than S by more than this factor (at 2 the step would become unstable), S takes its stiffness in
/// all directions.
constexpr double kSurprise = 1.5;
/// A motion that changes by less than this share is steady.
constexpr double kUneven = 0.02;
/// Stiffness below this share of the coupling's is negligible.
constexpr double kNegligible = 1e-9;
/// [N/mm] Upper bound of S; a body of this stiffness does not move.
constexpr double kStiffest = 1e6;

}  // namespace

void SeenStiffness::begin() {
  s_before_.setZero();
  y_before_.setZero();
  sliding_.setZero();
}

/// If motion s and change of force y show a much stiffer body than S, sets S to that stiffness in all directions.
/// @return whether it did
bool SeenStiffness::stiffen(const Vec6& s, const Vec6& y, double coupling) {
  const double sy = s.dot(y);
  if (sy <= std::max(kSurprise * s.dot(S_ * s), kNegligible * coupling * s.squaredNorm())) return false;
  S_ = std::min(y.squaredNorm() / sy, kStiffest) * Mat6::Identity();
  return true;
}

void SeenStiffness::learn(const Vec6& s, const Vec6& y, double coupling) {
  const Vec6 ds = s - s_before_;
  const Vec6 dy = y - y_before_;
  s_before_ = s;
  y_before_ = y;
  sliding_.setZero();
  if (s.norm() < kStill_mm) return;
  // While the body slides, the total motion shows a low stiffness, but differences between steps show the real one.
  const bool stiffer = stiffen(s, y, coupling) || (ds.norm() > kUneven * s.norm() && stiffen(ds, dy, coupling));
  // Work below this is negligible against the coupling; without the limit a shrinking S would lead to division by zero.
  const double nothing = kNegligible * coupling * s.squaredNorm();
  const double sy = s.dot(y);
  const Vec6 Ss = S_ * s;
  const double sSs = s.dot(Ss);
  const double sliding = sSs > nothing ? std::clamp(1.0 - sy / sSs, 0.0, 1.0) : 0.0;
  if (!stiffer) {
    const double share = sy > sSs ? 1.0 : kShrink;
    if (sy > nothing) S_.noalias() += share * std::min(1.0 / sy, kStiffest / y.squaredNorm()) * y * y.transpose();
    if (sSs > nothing) S_.noalias() -= share / sSs * Ss * Ss.transpose();
  }
  sliding_ = sliding * s;
}

}  // namespace stylet
