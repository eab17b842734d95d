// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <cstdint>
#include <span>

/// The methods of Goksel et al. 2005: a full dense inverse of the stiffness, changed in place when the mesh changes.
namespace stylet::paper {

/// A number that counts the multiplications made with it. Running an algorithm on it gives the cost of the algorithm.
struct Counted {
  double value = 0.0;

  Counted() = default;
  Counted(double v) : value(v) {}  // NOLINT(google-explicit-constructor): must mix with literals as double does

  static inline std::uint64_t multiplications = 0;  ///< multiplications and divisions since the last reset
  static void reset() { multiplications = 0; }

  friend Counted operator+(Counted a, Counted b) { return {a.value + b.value}; }
  friend Counted operator-(Counted a, Counted b) { return {a.value - b.value}; }
  friend Counted operator-(Counted a) { return {-a.value}; }
  friend Counted operator*(Counted a, Counted b) { return ++multiplications, Counted{a.value * b.value}; }
  friend Counted operator/(Counted a, Counted b) { return ++multiplications, Counted{a.value / b.value}; }
  Counted& operator+=(Counted b) { return *this = *this + b; }
  Counted& operator-=(Counted b) { return *this = *this - b; }
  Counted& operator*=(Counted b) { return *this = *this * b; }
  Counted& operator/=(Counted b) { return *this = *this / b; }
  friend bool operator==(Counted a, Counted b) { return a.value == b.value; }
  friend bool operator<(Counted a, Counted b) { return a.value < b.value; }
  friend bool operator>(Counted a, Counted b) { return a.value > b.value; }
};

}  // namespace stylet::paper

namespace Eigen {
template <>
struct NumTraits<stylet::paper::Counted> : NumTraits<double> {
  using Real = stylet::paper::Counted;
  using NonInteger = stylet::paper::Counted;
  using Nested = stylet::paper::Counted;
};
}  // namespace Eigen

namespace stylet::paper {

template <class Scalar>
using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
/// A matrix, or the leading part of a matrix with room to grow.
template <class Scalar>
using MatrixRef = Eigen::Ref<Matrix<Scalar>, 0, Eigen::OuterStride<>>;

/// Boundary condition switch: in x = M y the known and the unknown of degree of freedom i change places (displacement
/// control becomes force control, or back). It is the principal pivot transform
///   M ← M − (1/m_ii)(c_i + e_i)(r_i − e_i)ᵀ,
/// with column c_i, row r_i and unit vector e_i. N² + N multiplications. @cite Goksel2005 eq. 2, up to its sign
/// convention
/// @param M (N × N)
/// @param left, right work space (N)
template <class Scalar>
void switch_axis(MatrixRef<Scalar> M, Eigen::Index i, std::span<Scalar> left, std::span<Scalar> right);

/// K⁻¹ ← (K + V ΔK Vᵀ)⁻¹ by boundary condition switches: every degree of freedom involved is switched to displacement
/// control, ΔK is added to the block of their forces, and they are switched back: 2 k (N² + N) multiplications. New
/// degrees of freedom (rows and columns of zeros) start under displacement control and are only switched back.
/// @param inverse (N × N) both triangles
/// @param dofs (k) rows of the inverse that ΔK belongs to, each once
/// @param change ΔK [N/mm] (k × k), symmetric
/// @param first_new rows from here on are new; they are zero in `inverse`
template <class Scalar>
void update_by_switches(MatrixRef<Scalar> inverse, std::span<const Index> dofs, const Matrix<Scalar>& change,
                        Eigen::Index first_new);

/// K⁻¹ ← (K + V ΔK Vᵀ)⁻¹ = K⁻¹ − K⁻¹V ΔK (I + VᵀK⁻¹V ΔK)⁻¹ VᵀK⁻¹ by the matrix inversion lemma (Woodbury), with the
/// small matrix inverted by elimination: k N² + k² N + 3 k³ multiplications. New degrees of freedom must have a large
/// diagonal entry in `inverse`; @see DenseInverse for a choice that makes the result exact.
/// @return condition number of the small matrix in the 1-norm; infinite when it is singular (`inverse` is left
/// unchanged)
template <class Scalar>
double update_by_woodbury(MatrixRef<Scalar> inverse, std::span<const Index> dofs, const Matrix<Scalar>& change);

/// The same on the lower triangle only, a strip of columns at a time: half of the multiplications and of the memory
/// traffic. Entries above the diagonal are invalid afterwards.
double update_by_woodbury_symmetric(MatrixRef<double> inverse, std::span<const Index> dofs, const MatX& change);

/// Inverts a symmetric positive definite matrix (LAPACK dpotrf, dpotri); writes both triangles.
/// @return false when the matrix is not positive definite; K is then destroyed
bool invert(MatX& K);

/// Costs of the updates by the paper, in multiplications and divisions, for N unknowns of which k are involved.
/// @cite Goksel2005
inline double cost_of_switches(double N, double k) { return 2.0 * k * N * N; }
inline double cost_of_woodbury(double N, double k) { return k * N * N + k * k * N + 2.0 * k * k * k; }

}  // namespace stylet::paper
