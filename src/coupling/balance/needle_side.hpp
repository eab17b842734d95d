// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/dense_kernels.hpp"
#include "coupling/balance/grip_matrix.hpp"

#include <cstdint>
#include <utility>

namespace stylet {

/// The needle's side of the contact equations: the motion of its points at the contacts under pushes there, with the
/// lent springs. Three rows for each contact, LPS, the tip first. Nothing allocates after construction.
class NeedleSide {
 public:
  /// @param most largest number of contacts, tip included
  explicit NeedleSide(int most)
      : free(VecX::Zero(3 * static_cast<Eigen::Index>(most))), spring(static_cast<std::size_t>(most)) {
    const Eigen::Index n = 3 * static_cast<Eigen::Index>(most);
    N = MatX::Zero(dense::column_length(n), n);
  }

  MatX N;                          ///< [mm/N] compliance, both triangles; its leading rows and columns are in use
  VecX free;                       ///< [mm] motion with unchanged pushes
  std::vector<LentSpring> spring;  ///< (contacts) at the tip in all directions, with `along` zero
  bool supported = false;          ///< whether springs are lent to any needle
  bool own_supported = false;      ///< whether springs are lent to the needle that the hand moves
  int count = 0;                   ///< number of contacts, tip included
  std::uint64_t made_for = 0;      ///< RestingGrips::version() for which the matrix of this side was made

  [[nodiscard]] Eigen::Index rows() const { return 3 * static_cast<Eigen::Index>(count); }
  /// [mm/N] (3 count × 3 count)
  [[nodiscard]] auto compliance() { return N.topLeftCorner(rows(), rows()); }
  /// [mm] (3 count)
  [[nodiscard]] auto motion() { return free.head(rows()); }
  /// Work space for the rows of a contact that is to be added: motion of its point by each push [mm/N] (3 × 3 count +
  /// 3).
  [[nodiscard]] auto next_rows() { return N.block(rows(), 0, 3, rows() + 3); }
  /// Adds the contact whose rows are in next_rows(). No spring is lent at it.
  void add_contact() {
    const Eigen::Index before = rows();
    N.block(0, before, before, 3) = N.block(before, 0, 3, before).transpose();
    spring[static_cast<std::size_t>(count)] = {};
    ++count;
  }

  [[nodiscard]] bool lends_at_tip() const { return supported && spring.front().stiffness > 0.0; }
  /// The springs at the shaft contacts; empty where no springs are lent.
  [[nodiscard]] std::span<const LentSpring> shaft_springs() const {
    return supported ? std::span(spring).subspan(1, static_cast<std::size_t>(count - 1))
                     : std::span<const LentSpring>();
  }
};

}  // namespace stylet
