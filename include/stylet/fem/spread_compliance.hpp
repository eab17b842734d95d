// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/fem/tissue.hpp"

#include <array>
#include <memory>
#include <vector>

namespace stylet {

/// A straight way through tissue that a needle is to go.
struct NeedleWay {
  Vec3 entry = Vec3::Zero();       ///< [mm] LPS, on the skin
  Vec3 direction = Vec3::UnitZ();  ///< unit
  double length_mm = 0.0;
};

/// How forces that are spread over some ten millimetres move the tissue along the ways of needles: the displacement at
/// one place per force at another, both averaged over the same density about their place. Unlike K⁻¹ between points it
/// hardly depends on the mesh.
///
/// With W_k the nodal loads that a unit force makes when it is spread about sample k of a way, it is
///   F(x, y) = Σ_k Σ_l a_k(x) a_l(y) M(k,l),    M(k,l) = W_k K⁻¹ W_lᵀ,
/// where a interpolates cubically between the samples. So F is positive for any places, whatever lies around them.
/// docs/theory/near_field.md, section 3.
class SpreadCompliance {
 public:
  /// [mm] ε of the Kelvinlet that F is in a medium without surfaces. The density about each place is that of a
  /// Kelvinlet 105π/512 times as wide: so much of the displacement at its middle is the mean over its own density.
  static constexpr double kSpread_mm = 10.0;

  /// Solves for M. Elements near the ways are made quadratic for it, on meshes of up to 45,000 nodes.
  /// @param tissue is not kept
  /// @param ways at least one
  /// Errors: those of Tissue::build().
  static Result<SpreadCompliance> solve(const Tissue& tissue, const std::vector<NeedleWay>& ways,
                                        const Progress& progress = {});

  /// With what matrix() of another said for the same ways. @return null where it has not as many rows as the ways have
  static std::shared_ptr<const SpreadCompliance> of(const std::vector<NeedleWay>& ways, MatX matrix);

  /// Where a place lies among the samples.
  struct Place {
    std::array<int, 4> sample{};
    std::array<double, 4> weight{};
    /// How much F has to say there: 1 near the way, 0 far from it.
    double known = 0.0;
  };
  /// @param way number of the way that the needle goes
  [[nodiscard]] Place place(const Vec3& x, int way = 0) const;

  /// Number of the way that passes nearest to a place.
  [[nodiscard]] int way_near(const Vec3& x) const;

  /// F [mm/N] between two places on the same way. Does not allocate.
  [[nodiscard]] Mat3 operator()(const Place& at, const Place& on) const;

  /// M [mm/N] (3 samples × 3 samples), those of the first way first, from the skin inwards. Between samples of two ways
  /// it is zero: a needle goes one of them, and what it meets there does not depend on which others were planned.
  [[nodiscard]] const MatX& matrix() const { return matrix_; }

 private:
  struct Line {
    NeedleWay way;
    int first = 0;  ///< sample
    int count = 0;
    [[nodiscard]] double along(const Vec3& x) const;  ///< [mm] from the entry to the nearest place of the samples' line
    [[nodiscard]] double distance(const Vec3& x) const;  ///< [mm] from that line
  };
  /// M of one line.
  static Result<MatX> solve(const Tissue& tissue, const Line& line);
  static std::vector<Line> lines_of(const std::vector<NeedleWay>& ways);

  std::vector<Line> lines_;
  MatX matrix_;
};

}  // namespace stylet
