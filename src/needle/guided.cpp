// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/guided.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace stylet {

namespace {
constexpr int kMostRounds = 60;
/// A hole bears the shaft with a stiffness that turns as the shaft runs along its edge: a tangent with an older one
/// serves as long as it differs by no more than this part.
constexpr double kTurned = 0.02;
constexpr double kOnPlane_mm = 1e-13;
/// A shaft more oblique to the hole's axis than this does not run through it (cosine).
constexpr double kMostOblique = 0.1;
}  // namespace

GuidedNeedle::GuidedNeedle(std::unique_ptr<Needle> inner, const GuideHole& hole, int load_capacity)
    : inner_(std::move(inner)), hole_(hole) {
  const auto loads = static_cast<std::size_t>(load_capacity) + 1;
  loads_.reserve(loads);
  springs_.reserve(loads);
  const auto size = 3 * static_cast<Eigen::Index>(loads);
  N_.setZero(size, size);
  prepared_N_ = N_;
  free_.setZero(size);
}

void GuidedNeedle::place_guide(const Vec3& hole, const Vec3& axis) {
  placed_ = true;
  centre_ = hole;
  axis_ = axis.normalized();
  meet();
}

PointLoad GuidedNeedle::guide_load() const { return {meeting_.s, meeting_.force}; }

double GuidedNeedle::offset() const { return meeting_.offset.norm(); }

/// Arc length where the shaft crosses the plane, by Newton's method kept between bounds.
bool GuidedNeedle::find_crossing() {
  const auto before_plane = [this](double s) { return axis_.dot(centre_ - inner_->point(s)); };
  double low = 0.0;
  double high = length();
  if (before_plane(low) < 0.0 || before_plane(high) > 0.0) return false;
  double s = std::clamp(meeting_.s, low, high);
  for (int round = 0; round < kMostRounds; ++round) {
    const AxisPlace at = inner_->place(s);
    const double ahead = axis_.dot(centre_ - at.point);
    if (std::abs(ahead) < kOnPlane_mm) break;
    (ahead > 0.0 ? low : high) = s;
    double next = s + ahead / axis_.dot(at.tangent);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == s) break;
    s = next;
  }
  meeting_.s = s;
  return true;
}

void GuidedNeedle::meet() {
  const double s = meeting_.s;
  meeting_ = {};
  meeting_.s = s;
  if (!placed_ || !find_crossing()) return;
  const auto [point, t] = inner_->place(meeting_.s);
  const double cosine = axis_.dot(t);
  if (cosine < kMostOblique) return;
  meeting_.crosses = true;
  const Vec3 away = point - centre_;
  meeting_.offset = away - axis_ * axis_.dot(away);
  const double d = meeting_.offset.norm();
  meeting_.beyond = std::max(0.0, d - hole_.clearance_mm);
  if (!holds()) return;

  const Vec3 e = d > 0.0 ? Vec3(meeting_.offset / d) : Vec3(Vec3::Zero());
  const double across = d > 0.0 ? meeting_.beyond / d : 1.0;  // stiffness square to e, over that along it
  const Mat3 in_plane = Mat3::Identity() - axis_ * axis_.transpose();
  const Mat3 H = hole_.stiffness_N_per_mm * (across * in_plane + (1.0 - across) * e * e.transpose());
  const Mat3 P = Mat3::Identity() - t * axis_.transpose() / cosine;
  meeting_.force = -hole_.stiffness_N_per_mm * meeting_.beyond * (P.transpose() * e);
  meeting_.stiffness = P.transpose() * H * P;
}

/// The hole comes first: loads are added and forgotten at the other end.
std::span<const PointLoad> GuidedNeedle::with_guide(std::span<const PointLoad> loads, const PointLoad& guide) const {
  loads_.assign(1, guide);
  loads_.insert(loads_.end(), loads.begin(), loads.end());
  return loads_;
}

/// @param springs one for each of the loads, or none
std::span<const Mat3> GuidedNeedle::with_guide(std::span<const Mat3> springs, std::size_t loads) {
  assert(springs.empty() || springs.size() == loads);
  springs_.assign(loads + 1, Mat3::Zero());
  springs_.front() = meeting_.stiffness;
  std::copy(springs.begin(), springs.end(), springs_.begin() + 1);
  return springs_;
}

bool GuidedNeedle::linearise(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free,
                             std::span<const Mat3> springs, Indefinite otherwise) {
  held_ = hold();
  if (!held_.on) return inner_->linearise(loads, compliance, free, springs, otherwise);
  const auto size = 3 * static_cast<Eigen::Index>(loads.size());
  const bool definite = inner_->linearise(with_guide(loads, held_.with), N_.topLeftCorner(size + 3, size + 3),
                                          free_.head(size + 3), with_guide(springs, loads.size()), otherwise);
  if (!definite && otherwise == Indefinite::give_up) return false;
  compliance = N_.block(3, 3, size, size);
  free = free_.segment(3, size);
  return definite;
}

bool GuidedNeedle::prepare(std::span<const PointLoad> loads, std::span<const Mat3> springs, Indefinite otherwise) {
  prepared_ = hold();
  if (!prepared_.on) return inner_->prepare(loads, springs, otherwise);
  return inner_->prepare(with_guide(loads, prepared_.with), with_guide(springs, loads.size()), otherwise);
}

bool GuidedNeedle::prepared_compliance(Eigen::Ref<MatX> compliance) {
  if (!prepared_.on) return inner_->prepared_compliance(compliance);
  const Eigen::Index size = compliance.rows();
  if (!inner_->prepared_compliance(prepared_N_.topLeftCorner(size + 3, size + 3))) return false;
  compliance = prepared_N_.block(3, 3, size, size);
  return true;
}

void GuidedNeedle::take_prepared() {
  inner_->take_prepared();
  held_ = prepared_;
}

bool GuidedNeedle::fits() const {
  if (held_.on != holds()) return false;
  return !held_.on || (meeting_.stiffness - held_.stiffness).norm() <= kTurned * held_.stiffness.norm();
}

bool GuidedNeedle::append(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance) {
  if (!fits()) return false;
  if (!held_.on) return inner_->append(loads, compliance);
  const auto size = 3 * static_cast<Eigen::Index>(loads.size());
  auto rows = N_.topLeftCorner(3, size + 3);
  if (!inner_->append(with_guide(loads, guide_load()), rows)) return false;
  compliance = rows.rightCols(size);
  return true;
}

bool GuidedNeedle::relax(std::span<const PointLoad> loads, Eigen::Ref<VecX> free) {
  if (!fits()) return false;
  if (!held_.on) return inner_->relax(loads, free);
  const auto size = 3 * static_cast<Eigen::Index>(loads.size());
  if (!inner_->relax(with_guide(loads, guide_load()), free_.head(size + 3))) return false;
  held_.with = guide_load();
  free = free_.segment(3, size);
  return true;
}

void GuidedNeedle::advance(std::span<const PointLoad> loads) {
  inner_->advance(held_.on ? with_guide(loads, held_.with) : loads);
  meet();
}

double GuidedNeedle::residual(std::span<const PointLoad> loads) const {
  return inner_->residual(holds() ? with_guide(loads, guide_load()) : loads);
}

void GuidedNeedle::set_base(const Pose& base) {
  inner_->set_base(base);
  meet();
}

void GuidedNeedle::straighten() {
  inner_->straighten();
  meet();
}

double GuidedNeedle::energy() const {
  return inner_->energy() + 0.5 * hole_.stiffness_N_per_mm * meeting_.beyond * meeting_.beyond;
}

void GuidedNeedle::set_state(const Eigen::Ref<const VecX>& state) {
  inner_->set_state(state);
  meet();
}

}  // namespace stylet
