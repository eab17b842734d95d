// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/fem/tissue.hpp"

#include <array>
#include <memory>
#include <vector>

namespace stylet {

/// The planned straight way of a needle through the tissue.
struct NeedleWay {
  Vec3 entry = Vec3::Zero();       ///< [mm] LPS, a point on the skin
  Vec3 direction = Vec3::UnitZ();  ///< unit vector, pointing inwards
  double length_mm = 0.0;          ///< length of the way from the entry
};

/// The wide part of the compliance along planned paths of needles: displacement at one place per force at another,
/// where both are averaged over the same density, about ten millimetres wide, around their place. Unlike K⁻¹ between
/// points it hardly depends on the mesh.
///
/// With W_k the nodal loads of a unit force that is spread around sample k of a way,
///   F(x, y) = Σ_k Σ_l a_k(x) a_l(y) M(k,l),    M(k,l) = W_k K⁻¹ W_lᵀ,
/// where the weights a interpolate cubically between the samples. F is therefore positive semidefinite for any places,
/// also for those of several needles: between different ways M is computed on the mesh itself, and along each way on
/// elements that are more yielding. docs/theory/near_field.md, section 3.
class SpreadCompliance {
 public:
  /// [mm] Radius ε of the Kelvinlet that F equals in a medium without surfaces. The density around each place is that
  /// of a Kelvinlet with the radius ε · 105π/512, because averaging a Kelvinlet over its own density multiplies the
  /// displacement at its centre by 105π/512.
  static constexpr double kSpread_mm = 10.0;

  /// Solves for M. On meshes of up to 45,000 nodes, elements near a way are made quadratic for M along this way.
  /// @param tissue used only during the call
  /// @param ways at least one way
  /// @return errors are those of Tissue::build()
  static Result<SpreadCompliance> solve(const Tissue& tissue, const std::vector<NeedleWay>& ways,
                                        const Progress& progress = {});

  /// Restores a SpreadCompliance from the matrix() of another one for the same ways.
  /// @return null when the size of the matrix does not fit the ways, or it has nothing between different ways
  static std::shared_ptr<const SpreadCompliance> of(const std::vector<NeedleWay>& ways, MatX matrix);

  /// Interpolation weights of a place between the samples of a way.
  struct Place {
    std::array<int, 4> sample{};
    std::array<double, 4> weight{};
    /// Validity of F at the place: 1 near the way, 0 far from it, smooth in between.
    double known = 0.0;
  };
  /// Interpolation weights at x [mm] LPS.
  /// @param way number of the way along which the needle goes
  [[nodiscard]] Place place(const Vec3& x, int way = 0) const;

  /// Number of the way that passes nearest to x [mm] LPS.
  [[nodiscard]] int way_near(const Vec3& x) const;

  /// F [mm/N] between two places, each on a way: displacement at `at` per force at `on`. Does not allocate.
  [[nodiscard]] Mat3 operator()(const Place& at, const Place& on) const;

  /// Displacements of all samples per force at one place, for F between this place and many others: at() interpolates
  /// between them with a quarter of the products of operator(). Neither allocates, unless the size changes.
  /// @param under (3 samples × 3) [mm/N] overwritten
  void press(const Place& on, MatX& under) const;
  /// F [mm/N]: displacement at a place per the force that `under` is for.
  [[nodiscard]] static Mat3 at(const Place& place, const MatX& under);

  /// M [mm/N] (3 samples × 3 samples); samples are ordered by way, and along each way from the skin inwards. The block
  /// of a way does not depend on which others are planned.
  [[nodiscard]] const MatX& matrix() const { return matrix_; }

 private:
  struct Line {
    NeedleWay way;
    int first = 0;  ///< number of the first sample
    int count = 0;
    /// [mm] distance from the entry to the point of the line that is nearest to x.
    [[nodiscard]] double along(const Vec3& x) const;
    [[nodiscard]] double distance(const Vec3& x) const;  ///< [mm] distance of x from the line
  };
  /// M for the samples of one line.
  static Result<MatX> solve(const Tissue& tissue, const Line& line);
  void solve_between_lines(const Tissue& tissue);
  static std::vector<Line> lines_of(const std::vector<NeedleWay>& ways);

  std::vector<Line> lines_;
  MatX matrix_;
};

}  // namespace stylet
