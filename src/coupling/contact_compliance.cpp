// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/contact_compliance.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace stylet {

const char* to_string(RemeshEvent::Kind kind) {
  switch (kind) {
    case RemeshEvent::Kind::added_inside:
      return "added_inside";
    case RemeshEvent::Kind::added_on_face:
      return "added_on_face";
    case RemeshEvent::Kind::repositioned:
      return "repositioned";
  }
  return "unknown";
}

const char* to_string(RemeshEvent::Refused refused) {
  switch (refused) {
    case RemeshEvent::Refused::no:
      return "";
    case RemeshEvent::Refused::boundary:
      return "boundary";
    case RemeshEvent::Refused::fixed:
      return "fixed";
    case RemeshEvent::Refused::held:
      return "held";
    case RemeshEvent::Refused::contacts:
      return "contacts";
    case RemeshEvent::Refused::inverts:
      return "inverts";
  }
  return "unknown";
}

double ContactCompliance::independence(int c, std::span<const int> others) const {
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3 * kNeighbours, 3 * kNeighbours>;
  using Tall = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, 3 * kNeighbours, 3>;
  const int count = std::min<int>(static_cast<int>(others.size()), kNeighbours);
  Mat3 own = (*this)(c, c);
  const double scale = own.trace() / 3.0;
  if (scale <= 0.0) return 0.0;
  if (count > 0) {
    Small held(3 * count, 3 * count);
    Tall across(3 * count, 3);
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        held.block<3, 3>(3 * i, 3 * j) =
            (*this)(others[static_cast<std::size_t>(i)], others[static_cast<std::size_t>(j)]);
      }
      across.block<3, 3>(3 * i, 0) = (*this)(others[static_cast<std::size_t>(i)], c);
    }
    held.diagonal().array() += 1e-12 * scale;
    const Eigen::LLT<Small> llt(held);
    if (llt.info() != Eigen::Success) return 0.0;
    const Tall solved = llt.solve(across);
    own.noalias() -= across.transpose() * solved;
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(own, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()[0] / scale;
}

}  // namespace stylet
