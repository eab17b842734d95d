// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/dense_kernels.hpp"
#include "coupling/balance/grip_matrix.hpp"

#include <utility>

namespace stylet {

/// The needle's side of the contact equations: how its points at the contacts move under pushes there, on the springs
/// that are lent to it. Three rows a contact, LPS, the tip first. Nothing allocates after construction.
class NeedleSide {
 public:
  /// @param most contacts, tip included
  explicit NeedleSide(int most)
      : free(VecX::Zero(3 * static_cast<Eigen::Index>(most))), spring(static_cast<std::size_t>(most)) {
    const Eigen::Index n = 3 * static_cast<Eigen::Index>(most);
    N = MatX::Zero(dense::column_length(n), n);
  }

  MatX N;                          ///< [mm/N] compliance, full; its leading rows and columns are in use
  VecX free;                       ///< [mm] motion under unchanged pushes
  std::vector<LentSpring> spring;  ///< at the tip in all directions: `along` is zero
  bool supported = false;          ///< springs are lent
  int count = 0;                   ///< contacts that it is of, tip included

  [[nodiscard]] Eigen::Index rows() const { return 3 * static_cast<Eigen::Index>(count); }
  /// [mm/N] (3 count × 3 count)
  [[nodiscard]] auto compliance() { return N.topLeftCorner(rows(), rows()); }
  /// [mm] (3 count)
  [[nodiscard]] auto motion() { return free.head(rows()); }
  /// Room for the rows of a contact that is to be added: the motion of its point by each push [mm/N] (3 × 3 count + 3).
  [[nodiscard]] auto next_rows() { return N.block(rows(), 0, 3, rows() + 3); }
  /// Adds the contact whose rows are in next_rows(). No spring is lent at it.
  void add_contact() {
    const Eigen::Index before = rows();
    N.block(0, before, before, 3) = N.block(before, 0, 3, before).transpose();
    spring[static_cast<std::size_t>(count)] = {};
    ++count;
  }

  [[nodiscard]] bool lends_at_tip() const { return supported && spring.front().stiffness > 0.0; }
  /// Springs at the contacts of the shaft; none where none is lent.
  [[nodiscard]] std::span<const LentSpring> shaft_springs() const {
    return supported ? std::span(spring).subspan(1, static_cast<std::size_t>(count - 1))
                     : std::span<const LentSpring>();
  }
};

}  // namespace stylet
