// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/needle.hpp"
#include "stylet/needle/section.hpp"

namespace stylet {

/// The needle of Goksel et al. 2005: a bar of linear tetrahedra with quadratic (Green–Lagrange) strain and the St.
/// Venant–Kirchhoff law, total Lagrangian. Its square section is as wide as the needle; Poisson's ratio is 0.3, as of
/// steel.
///
/// Such tetrahedra bend far too stiffly, so Young's modulus is calibrated in build(): one linear solve makes the
/// deflection of the tip under a lateral force equal to theory, L³/3EI. The torsion stiffness follows from the section
/// and differs from that of NeedleSection (7 % above it with the default numbers). The bar stretches a little
/// (axial_stiffness()). The centreline is a smooth curve through the nodes on the axis; loads act on these nodes with
/// the curve's weights.
///
/// state() is the displacement of the nodes [mm] in base axes. residual() is the largest of two values: over the
/// cross-sections, the moment about the centre of the section of all out-of-balance forces beyond it; over the nodes,
/// out-of-balance force × segment length. Beyond the buckling load, a multiple of the material part of the tangent is
/// added to keep it positive definite.
/// @cite Goksel2005
class TetNeedle final : public Needle {
 public:
  enum class Segment {
    symmetric,   ///< 24 tetrahedra around the centres of body and faces: equally stiff in both bending planes and in
                 ///< both senses
    asymmetric,  ///< 12 tetrahedra, every prism cut in the same way: deflects sideways; shows the effect of missing
                 ///< symmetry
  };

  /// Builds a needle; errors are those of check_needle().
  /// @param segments number of segments along the needle, 4…500; with few segments the axial stiffness grows with the
  ///   square of their number
  /// @param load_capacity largest number of loads in any call
  static Result<std::unique_ptr<TetNeedle>> build(const NeedleSection& section, int segments, int load_capacity,
                                                  Segment segment = Segment::symmetric);
  ~TetNeedle() override;

  /// Bending stiffness of the tetrahedra / theory, if their modulus were 12 EI / width⁴.
  [[nodiscard]] double stiffening() const;
  [[nodiscard]] double young_modulus() const;    ///< [MPa] calibrated: 12 EI / width⁴ / stiffening()
  [[nodiscard]] double axial_stiffness() const;  ///< [N/mm] of the straight needle, from base to tip

  [[nodiscard]] double length() const override;
  [[nodiscard]] std::string model() const override { return "tet"; }
  void set_base(const Pose& base) override;
  [[nodiscard]] const Pose& base() const override;
  [[nodiscard]] Vec3 point(double s) const override;
  [[nodiscard]] Vec3 tangent(double s) const override;
  bool linearise(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free,
                 std::span<const Mat3> springs = {}, Indefinite otherwise = Indefinite::shift) override;
  bool relax(std::span<const PointLoad> loads, Eigen::Ref<VecX> free) override;
  void advance(std::span<const PointLoad> loads) override;
  [[nodiscard]] double residual(std::span<const PointLoad> loads) override;
  void damp(double ratio) override;
  void straighten() override;
  [[nodiscard]] double energy() const override;
  [[nodiscard]] Eigen::Ref<const VecX> state() const override;
  void set_state(const Eigen::Ref<const VecX>& state) override;

 private:
  struct Parts;
  explicit TetNeedle(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet
