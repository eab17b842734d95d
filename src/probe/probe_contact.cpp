// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/probe/probe_contact.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {

namespace {

constexpr double kGapError_mm = 0.002;  // of the gap at the moved points
constexpr int kMostLinearisations = 30;
constexpr double kSweepError_mm = 5e-4;  // change of a gap by the last sweep
constexpr int kMostSweeps = 60;
constexpr double kNear_mm = 1.0;  // points farther away are not in the linear problem

}  // namespace

ProbeContact::ProbeContact(std::shared_ptr<const WallCompliance> wall) : wall_(std::move(wall)) {
  const int w = wall_->count();
  lambda_ = VecX::Zero(w);
  gap_ = VecX::Zero(w);
  normal_ = Eigen::Matrix3Xd::Zero(3, w);
  for (int i = 0; i < w; ++i) normal_.col(i) = wall_->points[static_cast<std::size_t>(i)].outward;
  surface_normal_ = normal_;
  moved_ = VecX::Zero(3 * w);
  linear_.compliance = MatX::Zero(w, w);
  linear_.gap = VecX::Zero(w);
  linear_.points.resize(static_cast<std::size_t>(w));
  held_ = Eigen::Matrix3Xd::Zero(3, w);
}

/// Displacement of the points under the forces.
void ProbeContact::move_points() {
  moved_.setZero();
  for (int i = 0; i < wall_->count(); ++i) {
    if (lambda_[i] <= 0.0) continue;
    const Vec3 f = lambda_[i] * normal_.col(i);
    moved_ += wall_->among.col(3 * i) * f.x();
    moved_ += wall_->among.col(3 * i + 1) * f.y();
    moved_ += wall_->among.col(3 * i + 2) * f.z();
  }
}

/// Gaps and normals at the moved points. @return largest error of the contact conditions [mm]
double ProbeContact::find_gaps(const Capsule& probe) {
  double error = 0.0;
  for (int i = 0; i < wall_->count(); ++i) {
    const WallPoint& point = wall_->points[static_cast<std::size_t>(i)];
    const Vec3 place = point.position_mm + displacement_of_point(i);
    const Capsule::Gap gap = probe.gap(place, point.outward);
    gap_[i] = gap.mm;
    surface_normal_.col(i) = gap.normal;
    error = std::max(error, lambda_[i] > 0.0 ? std::abs(gap_[i]) : -gap_[i]);
  }
  return error;
}

/// The linear problem of the points that are near or loaded.
void ProbeContact::linearise() {
  normal_ = surface_normal_;
  linear_.count = 0;
  for (int i = 0; i < wall_->count(); ++i) {
    if (gap_[i] < kNear_mm || lambda_[i] > 0.0) linear_.points[static_cast<std::size_t>(linear_.count++)] = i;
  }
  for (int b = 0; b < linear_.count; ++b) {
    const int j = linear_.points[static_cast<std::size_t>(b)];
    for (int a = 0; a <= b; ++a) {
      const int i = linear_.points[static_cast<std::size_t>(a)];
      const double value = normal_.col(i).dot(wall_->among.block<3, 3>(3 * i, 3 * j) * normal_.col(j));
      linear_.compliance(a, b) = value;
      linear_.compliance(b, a) = value;
    }
  }
  // Gap at the current forces, along the new normals.
  for (int a = 0; a < linear_.count; ++a) {
    const int i = linear_.points[static_cast<std::size_t>(a)];
    double gap = gap_[i] - normal_.col(i).dot(moved_.segment<3>(3 * i));
    for (int b = 0; b < linear_.count; ++b)
      gap += linear_.compliance(b, a) * lambda_[linear_.points[static_cast<std::size_t>(b)]];
    linear_.gap[a] = gap;
  }
}

int ProbeContact::sweep() {
  const int count = linear_.count;
  int sweeps = 0;
  double change = 1.0;
  while (change > kSweepError_mm && sweeps < kMostSweeps) {
    change = 0.0;
    ++sweeps;
    for (int a = 0; a < count; ++a) {
      double& force = lambda_[linear_.points[static_cast<std::size_t>(a)]];
      const double own = linear_.compliance(a, a);
      const double next = std::max(0.0, force - linear_.gap[a] / own);
      const double step = next - force;
      if (step == 0.0) continue;
      force = next;
      change = std::max(change, std::abs(step) * own);
      linear_.gap.head(count) += step * linear_.compliance.col(a).head(count);
    }
  }
  return sweeps;
}

ProbePress ProbeContact::press(const Capsule& probe) {
  ProbePress press;
  double error = 0.0;
  move_points();  // under the last forces along the last normals
  for (;;) {
    error = find_gaps(probe);
    if (error < kGapError_mm || press.linearisations == kMostLinearisations) break;
    linearise();
    press.sweeps += sweep();
    ++press.linearisations;
    move_points();
  }
  for (int i = 0; i < wall_->count(); ++i) {
    const WallPoint& point = wall_->points[static_cast<std::size_t>(i)];
    press.penetration_mm = std::max(press.penetration_mm, -gap_[i]);
    if (lambda_[i] <= 0.0) continue;
    ++press.touching;
    press.distance_mm = std::max(press.distance_mm, gap_[i]);
    const Vec3 force = -lambda_[i] * normal_.col(i);
    press.force_N += force;
    press.moment_Nmm += (point.position_mm + displacement_of_point(i) - probe.centre_mm).cross(force);
  }
  return press;
}

void ProbeContact::release() {
  lambda_.setZero();
  moved_.setZero();
}

void ProbeContact::set_reference(const Capsule& probe) {
  release();
  press(probe);
  for (int i = 0; i < wall_->count(); ++i) held_.col(i) = lambda_[i] * normal_.col(i);
}

Eigen::Vector3f ProbeContact::load(int point) const {
  return (lambda_[point] * normal_.col(point) - held_.col(point)).cast<float>();
}

void ProbeContact::displacement(Eigen::Ref<Eigen::Matrix3Xf> out) const {
  // In blocks of nodes whose displacements stay in the processor's cache.
  constexpr Eigen::Index kNodesAtOnce = 1024;
  const Eigen::Index nodes = wall_->nodes.rows() / 3;
  for (Eigen::Index first = 0; first < nodes; first += kNodesAtOnce) {
    const Eigen::Index count = std::min(kNodesAtOnce, nodes - first);
    Eigen::Map<Eigen::VectorXf> u(out.data() + 3 * first, 3 * count);
    u.setZero();
    for (int i = 0; i < wall_->count(); ++i) {
      const Eigen::Vector3f f = load(i);
      if (f.isZero(0.0F)) continue;
      u.noalias() += wall_->nodes.block(3 * first, 3 * i, 3 * count, 3).lazyProduct(f);
    }
  }
}

void ProbeContact::displacement(std::span<const Index> nodes, Eigen::Ref<Eigen::Matrix3Xf> out) const {
  out.leftCols(static_cast<Eigen::Index>(nodes.size())).setZero();
  for (int i = 0; i < wall_->count(); ++i) {
    const Eigen::Vector3f f = load(i);
    if (f.isZero(0.0F)) continue;
    for (std::size_t k = 0; k < nodes.size(); ++k)
      out.col(static_cast<Eigen::Index>(k)) += wall_->nodes.block<3, 3>(3 * Eigen::Index{nodes[k]}, 3 * i) * f;
  }
}

}  // namespace stylet
