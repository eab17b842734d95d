// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/types.hpp"

#include <cstdint>
#include <span>

/// The methods of Goksel et al. 2005: a full dense inverse of the stiffness, changed in place when the mesh changes.
namespace stylet::paper {

/// A number that counts what is done with it. Running an algorithm on it shows what the algorithm costs.
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
/// A matrix, or the leading part of one with room to grow.
template <class Scalar>
using MatrixRef = Eigen::Ref<Matrix<Scalar>, 0, Eigen::OuterStride<>>;

/// Boundary condition switch: in x = M y the knowns and unknowns of degree of freedom i change places (a
/// displacement-controlled one becomes force-controlled, or back). The principal pivot transform
///   M ← M − (1/m_ii)(c_i + e_i)(r_i − e_i)ᵀ,
/// c_i column, r_i row, e_i unit vector. N² + N multiplications. @cite Goksel2005 eq. 2, up to its sign convention
/// @param M (N × N)
/// @param left, right scratch (N)
template <class Scalar>
void switch_axis(MatrixRef<Scalar> M, Eigen::Index i, std::span<Scalar> left, std::span<Scalar> right);

/// K⁻¹ ← (K + V ΔK Vᵀ)⁻¹ by boundary condition switches on every degree of freedom involved: switched to
/// displacement control, ΔK added to the block of their forces, switched back: 2 k (N² + N) multiplications.
/// New degrees of freedom (rows and columns of zeros) come in under displacement control and are only switched back.
/// @param inverse (N × N) both triangles
/// @param dofs (k) rows of the inverse that ΔK belongs to, each once
/// @param change ΔK [N/mm] (k × k), symmetric
/// @param first_new rows from here on are new: zero in `inverse`
template <class Scalar>
void update_by_switches(MatrixRef<Scalar> inverse, std::span<const Index> dofs, const Matrix<Scalar>& change,
                        Eigen::Index first_new);

/// K⁻¹ ← (K + V ΔK Vᵀ)⁻¹ = K⁻¹ − K⁻¹V ΔK (I + VᵀK⁻¹V ΔK)⁻¹ VᵀK⁻¹ by the matrix inversion lemma (Woodbury), the small
/// matrix inverted by elimination: k N² + k² N + 3 k³ multiplications. New degrees of freedom must stand in `inverse`
/// with a large diagonal; @see DenseInverse for a choice that makes it exact.
/// @return condition number of the small matrix in the 1-norm; infinite when it is singular (inverse left as it was)
template <class Scalar>
double update_by_woodbury(MatrixRef<Scalar> inverse, std::span<const Index> dofs, const Matrix<Scalar>& change);

/// The same on the lower triangle only, a strip of columns at a time: half of the multiplications and of the memory
/// traffic. What lies above the diagonal is not to be read afterwards.
double update_by_woodbury_symmetric(MatrixRef<double> inverse, std::span<const Index> dofs, const MatX& change);

/// Inverse of a symmetric positive definite matrix from scratch (LAPACK dpotrf, dpotri), both triangles.
/// @return false when it is not positive definite; K is destroyed
bool invert(MatX& K);

/// What the paper says the updates cost, in multiplications and divisions, for N unknowns of which k are involved.
/// @cite Goksel2005
inline double cost_of_switches(double N, double k) { return 2.0 * k * N * N; }
inline double cost_of_woodbury(double N, double k) { return k * N * N + k * k * N + 2.0 * k * k * k; }

}  // namespace stylet::paper
