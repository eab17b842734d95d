// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/fem/tissue.hpp"
#include "stylet/geom/subdivision.hpp"

#include <memory>
#include <span>

namespace stylet {

namespace detail {
class Discretisation;
}

/// How far forces on single material points move a volume of tissue on average. By Betti's reciprocity
///   (1/V) ∫_V u dV = Σ_c w(X_c)ᵀ f_c,
/// w being what a uniform body force on that volume, 1/V in each direction, does where the forces act. Unlike u, which
/// is singular at the forces, w is smooth: a mesh that cannot represent the field of a needle gives its mean well.
class MeanDisplacement {
 public:
  /// What w is solved with.
  enum class Accuracy {
    of_the_tissue,     ///< the tissue's own mesh, elements and factor
    quadratic,         ///< quadratic elements on its mesh
    quadratic_halved,  ///< quadratic elements on its mesh with every edge halved
  };

  /// Takes seconds but for Accuracy::of_the_tissue, which has its factor already.
  /// @param tissue its mesh outlives this
  /// @param regions whose elements make the volume; the mean is zero where there are none
  static Result<MeanDisplacement> solve(const Tissue& tissue, std::span<const int> regions, Accuracy accuracy,
                                        const Progress& progress = {});

  MeanDisplacement(MeanDisplacement&&) noexcept;
  MeanDisplacement& operator=(MeanDisplacement&&) noexcept;
  ~MeanDisplacement();

  /// w(X)ᵀ: mean displacement per force there [mm/N], LPS.
  [[nodiscard]] Mat3 per_force(const MaterialPoint& at) const;

 private:
  MeanDisplacement(const TetMesh& mesh, Element element, std::unique_ptr<Subdivision> halved);

  std::unique_ptr<Subdivision> halved_;  ///< where w lives on that
  std::unique_ptr<detail::Discretisation> discretisation_;
  MatX w_;  ///< [mm/N] (3 × displacement nodes, one column for each direction of the mean)
};

}  // namespace stylet
