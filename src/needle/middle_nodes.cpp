// SPDX-License-Identifier: GPL-3.0-or-later
#include "needle/middle_nodes.hpp"

#include <cmath>

namespace stylet::tet {

namespace {

/// Factorises A = L Lᵀ for a 3 × 3 matrix, of which the lower triangle is read. @return false if A is not positive
/// definite
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

/// Returns A L⁻ᵀ.
Mat3 over_transpose(Mat3 A, const Mat3& L) {
  A.col(0) /= L(0, 0);
  A.col(1) = (A.col(1) - L(1, 0) * A.col(0)) / L(1, 1);
  A.col(2) = (A.col(2) - L(2, 0) * A.col(0) - L(2, 1) * A.col(1)) / L(2, 2);
  return A;
}

}  // namespace

MiddleNodes::MiddleNodes(const SegmentMesh& mesh, int segments)
    : segments_(segments),
      eliminated_(static_cast<std::size_t>(segments * mesh.middle_nodes())),
      reduced_(VecX::Zero(3 * segments * mesh.middle_nodes())) {
  work_.setZero();
  for (int m = 0; m < mesh.middle_nodes(); ++m) neighbours_.push_back(mesh.neighbours_after(kFirstMiddle + m));
}

bool MiddleNodes::eliminate(int segment, const SegmentStiffness& K, double shift) {
  const int nodes = kFirstMiddle + count();
  work_ = (1.0 + shift) * K.material;
  for (int j = 0; j < nodes; ++j) {
    for (int i = j; i < nodes; ++i) {
      for (int d = 0; d < 3; ++d) work_(3 * i + d, 3 * j + d) += K.geometric(i, j);
    }
  }
  for (int m = 0; m < count(); ++m) {
    const int node = kFirstMiddle + m;
    const auto& neighbours = neighbours_[static_cast<std::size_t>(m)];
    Eliminated& out = eliminated_[static_cast<std::size_t>(segment * count() + m)];
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

void MiddleNodes::disconnect() {
  for (Eliminated& node : eliminated_) {
    node.L.setIdentity();
    for (Mat3& coupling : node.coupling) coupling.setZero();
  }
}

void MiddleNodes::reduce(const VecX& gradient, VecX& layers) {
  const int middle = count();
  for (int k = 0; k < segments_; ++k)
    layers.segment<kBlock>(kBlock * k) = gradient.segment<kBlock>(unknowns() * k + 3 * middle);
  for (int k = 0; k < segments_; ++k) {
    reduced_.segment(3 * middle * k, 3 * middle) = gradient.segment(unknowns() * k, 3 * middle);
    for (int m = 0; m < middle; ++m) {
      const Eliminated& out = eliminated(k, m);
      const auto& neighbours = neighbours_[static_cast<std::size_t>(m)];
      auto y = reduced_.segment<3>(3 * (middle * k + m));
      out.L.triangularView<Eigen::Lower>().solveInPlace(y);
      for (std::size_t i = 0; i < neighbours.size(); ++i) {
        const int q = neighbours[i];
        const Vec3 share = out.coupling[i] * y;
        if (q >= kFirstMiddle) {
          reduced_.segment<3>(3 * (middle * k + q - kFirstMiddle)) -= share;
        } else if (kBlock * k + 3 * (q - kLayerNodes) >= 0) {  // the clamped layer has no unknowns
          layers.segment<3>(kBlock * k + 3 * (q - kLayerNodes)) -= share;
        }
      }
    }
  }
}

void MiddleNodes::move(const VecX& layers, VecX& displacement) const {
  const int middle = count();
  for (int k = 0; k < segments_; ++k) {
    displacement.segment<kBlock>(unknowns() * k + 3 * middle) += layers.segment<kBlock>(kBlock * k);
    std::array<Vec3, kMostNodes> moved;
    for (int m = middle - 1; m >= 0; --m) {
      const Eliminated& out = eliminated(k, m);
      const auto& neighbours = neighbours_[static_cast<std::size_t>(m)];
      Vec3 y = -reduced_.segment<3>(3 * (middle * k + m));
      for (std::size_t i = 0; i < neighbours.size(); ++i) {
        const int q = neighbours[i];
        if (q >= kFirstMiddle) {
          y -= out.coupling[i].transpose() * moved[q];
        } else if (kBlock * k + 3 * (q - kLayerNodes) >= 0) {
          y -= out.coupling[i].transpose() * layers.segment<3>(kBlock * k + 3 * (q - kLayerNodes));
        }
      }
      out.L.triangularView<Eigen::Lower>().transpose().solveInPlace(y);
      moved[kFirstMiddle + m] = y;
      displacement.segment<3>(unknowns() * k + 3 * m) += y;
    }
  }
}

}  // namespace stylet::tet
