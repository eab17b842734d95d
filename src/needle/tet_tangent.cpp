// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/tet_tangent.hpp"

#include "needle/condense_columns.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace stylet::tet {

namespace {

/// The stiffness is made positive definite with this share of the material part, or this much more, and more, …
constexpr double kSmallestShift = 0.1;
constexpr double kGrowth = 4.0;
/// First unknown of the axis node in its layer's block.
constexpr int kAxis = 3 * kAxisNode;

/// A = L Lᵀ of a 3 × 3 matrix of which the lower triangle is read. @return false if it is not positive definite
bool cholesky(const Mat3& A, Mat3& L) {
  L.setZero();
  for (int j = 0; j < 3; ++j) {
    double pivot = A(j, j);
    for (int k = 0; k < j; ++k) pivot -= L(j, k) * L(j, k);
    if (!(pivot > 0.0) || !std::isfinite(pivot)) return false;
    L(j, j) = std::sqrt(pivot);
    for (int i = j + 1; i < 3; ++i) {
      double value = A(i, j);
      for (int k = 0; k < j; ++k) value -= L(i, k) * L(j, k);
      L(i, j) = value / L(j, j);
    }
  }
  return true;
}

/// A L⁻ᵀ
Mat3 over_transpose(Mat3 A, const Mat3& L) {
  A.col(0) /= L(0, 0);
  A.col(1) = (A.col(1) - L(1, 0) * A.col(0)) / L(1, 1);
  A.col(2) = (A.col(2) - L(2, 0) * A.col(0) - L(2, 1) * A.col(1)) / L(2, 2);
  return A;
}

}  // namespace

TetTangent::TetTangent(const TetShape& shape, int load_capacity)
    : segments_(shape.segments()),
      mesh_(shape.mesh()),
      stiffness_(static_cast<std::size_t>(segments_)),
      eliminated_(static_cast<std::size_t>(segments_ * mesh_.middle_nodes())),
      band_(segments_),
      gradient_(VecX::Zero(shape.displacement.size())),
      middle_(VecX::Zero(3 * segments_ * mesh_.middle_nodes())),
      z_(VecX::Zero(kBlock * segments_)),
      step_(VecX::Zero(kBlock * segments_)) {
  work_.setZero();
  for (int m = 0; m < mesh_.middle_nodes(); ++m) neighbours_.push_back(mesh_.neighbours_after(kFirstMiddle + m));
  reserve(load_capacity);
}

void TetTangent::reserve(Eigen::Index loads) {
  if (3 * loads <= Y_.cols()) return;
  Y_.setZero(kBlock * segments_, 3 * loads);
  force_.setZero(3 * loads);
  loads_.reserve(static_cast<std::size_t>(loads));
}

bool TetTangent::assemble(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                          std::span<const Mat3> springs, Indefinite otherwise) {
  if (assembled_ != shape.revision()) {  // not so when springs are lent after a first try without
    for (int k = 0; k < segments_; ++k) assemble_segment(shape, k);
    assembled_ = shape.revision();
  }
  assemble_loads(shape, base_rotation, loads);
  factorised_ = factorise_shifted(base_rotation, springs, otherwise);
  if (!factorised_) return false;
  reduce_gradient();
  band_.solve_lower(0, z_.data());
  const Mat3 to_base = base_rotation.transpose();
  for (std::size_t c = 0; c < loads_.size(); ++c) {
    const auto load = static_cast<Eigen::Index>(c);
    auto columns = Y_.middleCols<3>(3 * load);
    columns.setZero();
    for (int i = 0; i < AxisCurve::kReach; ++i) {
      const double w = loads_[c].value[i];
      if (w != 0.0) columns.middleRows<3>(kBlock * (loads_[c].first + i - 1) + kAxis) = w * to_base;
    }
    const auto first = static_cast<int>(start(load, load + 1) / kBlock);
    for (int j = 0; j < 3; ++j) band_.solve_lower(first, columns.col(j).data());
  }
  return true;
}

/// Blocks of the tangent of St. Venant–Kirchhoff's law between nodes a and b of an element, with G = F g:
///   V (λ G_a G_bᵀ + μ G_b G_aᵀ + μ (g_a·g_b) F Fᵀ)  +  V (g_a·S g_b) I
/// (material and geometric part, the former with what damping adds; Bonet & Wood, Nonlinear Continuum Mechanics for
/// Finite Element Analysis, 2008, §9.4).
void TetTangent::assemble_segment(const TetShape& shape, int segment) {
  SegmentStiffness& K = stiffness_[static_cast<std::size_t>(segment)];
  K.material.setZero();
  K.geometric.setZero();
  const double stiffer = 1.0 + shape.damping();
  for (int e = 0; e < static_cast<int>(mesh_.elements.size()); ++e) {
    const Element& element = shape.unloaded(segment, e);
    const Mat3& F = shape.element(segment, e).F;
    const Mat3& S = shape.element(segment, e).S;
    const double lambda = stiffer * element.volume * shape.lambda();
    const double mu = stiffer * element.volume * shape.mu();
    const Mat3 FFt = mu * F * F.transpose();
    std::array<Vec3, 4> G;
    std::array<Vec3, 4> Sg;
    for (int a = 0; a < 4; ++a) {
      G[a] = F * element.gradient[a];
      Sg[a] = element.volume * (S * element.gradient[a]);
    }
    for (int a = 0; a < 4; ++a) {
      for (int b = 0; b < 4; ++b) {
        const int i = element.node[a];
        const int j = element.node[b];
        if (j > i) continue;
        K.material.block<3, 3>(3 * i, 3 * j) += lambda * G[a] * G[b].transpose() + mu * G[b] * G[a].transpose() +
                                                element.gradient[a].dot(element.gradient[b]) * FFt;
        K.geometric(i, j) += element.gradient[a].dot(Sg[b]);
      }
    }
  }
}

void TetTangent::assemble_loads(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads) {
  reserve(static_cast<Eigen::Index>(loads.size()));
  loads_.clear();
  for (const PointLoad& load : loads) loads_.push_back(shape.curve().weights(load.s));
  assemble_gradient(shape, base_rotation, loads);
}

void TetTangent::assemble_gradient(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads) {
  gradient_ = shape.force();
  for (std::size_t c = 0; c < loads.size(); ++c) {
    force_.segment<3>(3 * static_cast<Eigen::Index>(c)) = loads[c].force;
    const AxisCurve::Weights w = shape.curve().weights(loads[c].s);
    const Vec3 force = base_rotation.transpose() * loads[c].force;
    for (int i = 0; i < AxisCurve::kReach; ++i) {
      if (w.value[i] != 0.0) gradient_.segment<3>(shape.axis_dof(w.first + i)) -= w.value[i] * force;
    }
  }
}

bool TetTangent::relax(const TetShape& shape, const Mat3& base_rotation, std::span<const PointLoad> loads,
                       Eigen::Ref<VecX> free) {
  if (!factorised_ || loads.size() > loads_.size()) return false;
  loads_.resize(loads.size());
  assemble_gradient(shape, base_rotation, loads);
  reduce_gradient();
  band_.solve_lower(0, z_.data());
  move_loads(free);
  return true;
}

bool TetTangent::factorise_shifted(const Mat3& base_rotation, std::span<const Mat3> springs, Indefinite otherwise) {
  const auto attempt = [&](double shift) {
    material_shift_ = shift;
    band_.clear();
    if (!springs.empty()) add_springs(base_rotation, springs);
    return factorise(shift);
  };
  if (attempt(0.0)) return true;
  if (otherwise == Indefinite::give_up) return false;
  // Beyond buckling. The first shift that works bounds the smallest eigenvalue; twice that shift leaves a margin.
  for (double shift = kSmallestShift; shift < 1e12; shift *= kGrowth) {
    if (attempt(shift) && attempt(2.0 * shift)) return true;
  }
  // Only reached when loads or shape are not finite.
  band_.clear();
  for (int k = 0; k < segments_; ++k) band_.at(k, k).setIdentity();
  for (Eliminated& node : eliminated_) {
    node.L.setIdentity();
    for (Mat3& coupling : node.coupling) coupling.setZero();
  }
  return true;
}

bool TetTangent::factorise(double shift) {
  const int nodes = static_cast<int>(mesh_.nodes.size());
  for (int k = 0; k < segments_; ++k) {
    const SegmentStiffness& K = stiffness_[static_cast<std::size_t>(k)];
    work_ = (1.0 + shift) * K.material;
    for (int j = 0; j < nodes; ++j) {
      for (int i = j; i < nodes; ++i) {
        for (int d = 0; d < 3; ++d) work_(3 * i + d, 3 * j + d) += K.geometric(i, j);
      }
    }
    if (!eliminate_middle(k)) return false;
    add_segment(k);
  }
  return band_.factorise();
}

bool TetTangent::eliminate_middle(int segment) {
  for (int m = 0; m < mesh_.middle_nodes(); ++m) {
    const int node = kFirstMiddle + m;
    const auto& neighbours = neighbours_[static_cast<std::size_t>(m)];
    Eliminated& out = eliminated_[static_cast<std::size_t>(segment * mesh_.middle_nodes() + m)];
    if (!cholesky(work_.block<3, 3>(3 * node, 3 * node), out.L)) return false;
    for (std::size_t i = 0; i < neighbours.size(); ++i) {
      const int q = neighbours[i];
      const Mat3 coupling =
          q > node ? Mat3(work_.block<3, 3>(3 * q, 3 * node)) : Mat3(work_.block<3, 3>(3 * node, 3 * q).transpose());
      out.coupling[i] = over_transpose(coupling, out.L);
      for (std::size_t j = 0; j <= i; ++j)
        work_.block<3, 3>(3 * q, 3 * neighbours[j]).noalias() -= out.coupling[i] * out.coupling[j].transpose();
    }
  }
  return true;
}

/// The segment's reduced stiffness into the blocks of its two layers; the clamped layer drops out.
void TetTangent::add_segment(int segment) {
  band_.at(segment, segment) += work_.block<kBlock, kBlock>(kBlock, kBlock);
  if (segment == 0) return;
  band_.at(segment, segment - 1) += work_.block<kBlock, kBlock>(kBlock, 0);
  band_.at(segment - 1, segment - 1) += work_.block<kBlock, kBlock>(0, 0);
}

/// The cubic through four layers ties layers three apart as soon as springs act on it.
void TetTangent::add_springs(const Mat3& base_rotation, std::span<const Mat3> springs) {
  assert(springs.size() == loads_.size());
  for (std::size_t c = 0; c < std::min(springs.size(), loads_.size()); ++c) {
    if (springs[c].isZero(0.0)) continue;
    const Mat3 G = base_rotation.transpose() * springs[c] * base_rotation;
    const AxisCurve::Weights& w = loads_[c];
    for (int i = 0; i < AxisCurve::kReach; ++i) {
      for (int j = 0; j <= i; ++j) {
        if (w.value[i] == 0.0 || w.value[j] == 0.0) continue;
        band_.at(w.first + i - 1, w.first + j - 1).block<3, 3>(kAxis, kAxis) += w.value[i] * w.value[j] * G;
      }
    }
  }
}

/// Forward substitution over the middle nodes: the gradient they leave to the layers, into z_.
void TetTangent::reduce_gradient() {
  const int middle = mesh_.middle_nodes();
  const Eigen::Index stride = 3 * (middle + kLayerNodes);
  for (int k = 0; k < segments_; ++k)
    z_.segment<kBlock>(kBlock * k) = gradient_.segment<kBlock>(stride * k + 3 * middle);
  for (int k = 0; k < segments_; ++k) {
    middle_.segment(3 * middle * k, 3 * middle) = gradient_.segment(stride * k, 3 * middle);
    for (int m = 0; m < middle; ++m) {
      const Eliminated& out = eliminated_[static_cast<std::size_t>(k * middle + m)];
      const auto& neighbours = neighbours_[static_cast<std::size_t>(m)];
      auto y = middle_.segment<3>(3 * (middle * k + m));
      out.L.triangularView<Eigen::Lower>().solveInPlace(y);
      for (std::size_t i = 0; i < neighbours.size(); ++i) {
        const int q = neighbours[i];
        const Vec3 share = out.coupling[i] * y;
        if (q >= kFirstMiddle) {
          middle_.segment<3>(3 * (middle * k + q - kFirstMiddle)) -= share;
        } else if (kBlock * k + 3 * (q - kLayerNodes) >= 0) {
          z_.segment<3>(kBlock * k + 3 * (q - kLayerNodes)) -= share;
        }
      }
    }
  }
}

Eigen::Index TetTangent::start(Eigen::Index first_load, Eigen::Index last_load) const {
  int first = segments_;
  for (Eigen::Index c = first_load; c < last_load; ++c) {
    const AxisCurve::Weights& w = loads_[static_cast<std::size_t>(c)];
    for (int i = 0; i < AxisCurve::kReach; ++i) {
      if (w.value[i] != 0.0) first = std::min(first, w.first + i - 1);
    }
  }
  return static_cast<Eigen::Index>(kBlock) * first;
}

void TetTangent::condense(Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free) const {
  condense_columns(
      Y_, 0, static_cast<Eigen::Index>(loads_.size()), [this](Eigen::Index a, Eigen::Index b) { return start(a, b); },
      compliance);
  move_loads(free);
}

void TetTangent::move_loads(Eigen::Ref<VecX>& free) const {
  condense_gradient(
      Y_, z_, static_cast<Eigen::Index>(loads_.size()), [this](Eigen::Index a, Eigen::Index b) { return start(a, b); },
      free);
}

void TetTangent::step(std::span<const PointLoad> loads, TetShape& shape) {
  assert(loads.size() == loads_.size());
  step_ = -z_;
  for (std::size_t c = 0; c < std::min(loads.size(), loads_.size()); ++c) {
    const auto i = 3 * static_cast<Eigen::Index>(c);
    const Vec3 change = loads[c].force - force_.segment<3>(i);
    step_.noalias() += Y_.middleCols<3>(i).lazyProduct(change);
  }
  band_.solve_upper(step_.data());
  const int middle = mesh_.middle_nodes();
  for (int k = 0; k < segments_; ++k) {
    shape.displacement.segment<kBlock>(shape.dof(k, kLayerNodes)) += step_.segment<kBlock>(kBlock * k);
    std::array<Vec3, kMostNodes> moved;
    for (int m = middle - 1; m >= 0; --m) {
      const Eliminated& out = eliminated_[static_cast<std::size_t>(k * middle + m)];
      const auto& neighbours = neighbours_[static_cast<std::size_t>(m)];
      Vec3 y = -middle_.segment<3>(3 * (middle * k + m));
      for (std::size_t i = 0; i < neighbours.size(); ++i) {
        const int q = neighbours[i];
        if (q >= kFirstMiddle) {
          y -= out.coupling[i].transpose() * moved[q];
        } else if (kBlock * k + 3 * (q - kLayerNodes) >= 0) {
          y -= out.coupling[i].transpose() * step_.segment<3>(kBlock * k + 3 * (q - kLayerNodes));
        }
      }
      out.L.triangularView<Eigen::Lower>().transpose().solveInPlace(y);
      moved[kFirstMiddle + m] = y;
      shape.displacement.segment<3>(shape.dof(k, kFirstMiddle + m)) += y;
    }
  }
}

MatX TetTangent::stiffness(const TetShape& shape) const {
  MatX full = MatX::Zero(gradient_.size(), gradient_.size());
  const int nodes = static_cast<int>(mesh_.nodes.size());
  for (int k = 0; k < segments_; ++k) {
    const SegmentStiffness& K = stiffness_[static_cast<std::size_t>(k)];
    for (int i = 0; i < nodes; ++i) {
      for (int j = 0; j <= i; ++j) {
        const Eigen::Index row = shape.dof(k, i);
        const Eigen::Index column = shape.dof(k, j);
        if (row < 0 || column < 0) continue;
        const Mat3 block = K.material.block<3, 3>(3 * i, 3 * j) + K.geometric(i, j) * Mat3::Identity();
        full.block<3, 3>(row, column) += block;
        if (i != j) full.block<3, 3>(column, row) += block.transpose();
      }
    }
  }
  return full;
}

}  // namespace stylet::tet
