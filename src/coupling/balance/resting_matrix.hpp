// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "core/dense_kernels.hpp"
#include "coupling/balance/grip_matrix.hpp"

#include <span>
#include <vector>

namespace stylet {

/// The matrix B of the contacts of needles at rest (RestingGrips), with all of them sticking, or yielding less than
/// tissue and needle do. It is factorised once and used until the compliances change. Columns z have three rows for
/// each contact in LPS, the changes π of its pushes, and then two for each spring, the changes f of its forces. Nothing
/// allocates after construction.
class RestingMatrix {
 public:
  explicit RestingMatrix(int grips);

  [[nodiscard]] int count() const { return static_cast<int>(contacts_.size()); }
  /// Rows of all contacts, and of the springs.
  [[nodiscard]] Eigen::Index contact_rows() const { return 3 * static_cast<Eigen::Index>(contacts_.size()); }
  [[nodiscard]] Eigen::Index spring_rows() const { return grips_.spring_rows(); }
  [[nodiscard]] Eigen::Index rows() const { return contact_rows() + spring_rows(); }
  /// Largest number of rows.
  [[nodiscard]] static Eigen::Index most_rows(int grips) {
    return dense::column_length(5 * static_cast<Eigen::Index>(grips));
  }

  /// @param A, N [mm/N] compliances of tissue and needles @param springs one for each contact, or none
  /// @param yields one for each contact; a yield along the needle beyond its compliance is left out
  /// @return false where B is found singular
  [[nodiscard]] bool factorise(const Eigen::Ref<const MatX>& A, const Eigen::Ref<const MatX>& N,
                               std::span<const LentSpring> springs, std::span<const Yield> yields);
  [[nodiscard]] bool fits() const { return fits_; }
  void outdate() { fits_ = false; }

  /// D of a contact in B.
  [[nodiscard]] const Yield& yield(int grip) const { return at(grip).yield; }
  /// [mm/N] Compliance of needle and tissue at a contact, mean over the directions.
  [[nodiscard]] double compliance(int grip) const { return at(grip).compliance; }
  /// Whether B differs too much for use from the matrix with another D of a contact, its yield along the needle apart.
  [[nodiscard]] bool is_too_different(int grip, const Yield& now) const;
  /// Whether all rows of contacts move less force than this [N].
  [[nodiscard]] bool is_negligible(const Eigen::Ref<const VecX>& z, double force_N) const;

  // NOLINTBEGIN(performance-unnecessary-value-param): the results are written through their views
  /// Fills the springs' rows of a column for motions or displacements of the contacts, which are in its other rows.
  void fill_springs(Eigen::Ref<VecX> z) const { grips_.across(z.head(contact_rows()), z.tail(spring_rows())); }
  /// Y ← B⁻¹ Y, for at most GripMatrix::kMostColumns columns.
  void solve(Eigen::Ref<MatX> Y) {
    grips_.begin(Y);
    grips_.finish(Y);
  }
  /// The changes of the forces on the tissue, π + E f [N].
  void forces(const Eigen::Ref<const VecX>& z, Eigen::Ref<VecX> result) const {
    result = z.head(contact_rows());
    grips_.add_lent(z.tail(spring_rows()), result);
  }
  // NOLINTEND(performance-unnecessary-value-param)

 private:
  struct AtRest {
    Yield yield;
    double compliance = 0.0;
    Mat3 frame = Mat3::Identity();  ///< two directions across the needle, and the one along it, as columns
    Vec3 own = Vec3::Zero();        ///< [mm/N] displacement by the own unit force in these directions
  };
  [[nodiscard]] const AtRest& at(int grip) const { return contacts_[static_cast<std::size_t>(grip)]; }

  GripMatrix grips_;
  std::vector<AtRest> contacts_;
  std::vector<Yield> yields_;  ///< work space
  bool fits_ = false;
};

}  // namespace stylet
