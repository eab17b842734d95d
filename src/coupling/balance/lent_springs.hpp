// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <span>
#include <vector>

namespace stylet {

/// A lent spring: acts on the needle at a contact, across the needle: G = k (I − t tᵀ).
struct LentSpring {
  Vec3 along = Vec3::UnitZ();  ///< t, unit vector in LPS; zero: all directions, at the tip only
  double stiffness = 0.0;      ///< k [N/mm]; 0: no spring

  [[nodiscard]] Mat3 matrix() const { return stiffness * (Mat3::Identity() - along * along.transpose()); }
};

/// The springs that are lent to the needle at its shaft contacts, each in two directions E across the needle:
/// G = k E Eᵀ. They are numbered from the base on; contacts without a spring have no number. Nothing allocates after
/// construction.
class LentSprings {
 public:
  /// @param most_grips largest number of contacts, and so of springs
  explicit LentSprings(int most_grips);

  /// Replaces all springs. @param springs one for each contact, or empty; springs of stiffness 0 are left out
  void take(std::span<const LentSpring> springs);

  [[nodiscard]] int count() const { return static_cast<int>(springs_.size()); }
  /// Number of unknown spring forces: two for each spring.
  [[nodiscard]] Eigen::Index rows() const { return 2 * static_cast<Eigen::Index>(springs_.size()); }

  /// Number of the contact that a spring acts on; ascending.
  [[nodiscard]] int grip(int spring) const { return at(spring).grip; }
  /// E of a spring: unit vectors in LPS, perpendicular to its direction and to each other.
  [[nodiscard]] const Eigen::Matrix<double, 3, 2>& directions(int spring) const { return at(spring).directions; }
  /// 1/k of a spring [mm/N].
  [[nodiscard]] double flexibility(int spring) const { return at(spring).flexibility; }
  /// Whether all springs act on the first `grips` contacts.
  [[nodiscard]] bool are_among_first(int grips) const { return springs_.empty() || springs_.back().grip < grips; }

  /// Components of the contacts' vectors along the springs' directions, Eᵀ y.
  /// @param y (3 for each contact) LPS @param along (2 for each spring) written
  void across(const Eigen::Ref<const VecX>& y, Eigen::Ref<VecX> along) const;
  /// Adds the springs' forces to the contacts' vectors, y += E f.
  /// @param f (2 for each spring) [N] @param y (3 for each contact) LPS
  void add_forces(const Eigen::Ref<const VecX>& f, Eigen::Ref<VecX> y) const;

 private:
  struct Spring {
    int grip = 0;
    Eigen::Matrix<double, 3, 2> directions = Eigen::Matrix<double, 3, 2>::Zero();
    double flexibility = 0.0;
  };
  [[nodiscard]] const Spring& at(int spring) const { return springs_[static_cast<std::size_t>(spring)]; }

  std::vector<Spring> springs_;
};

}  // namespace stylet
