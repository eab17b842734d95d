// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/near_field/near_field_compliance.hpp"
#include "stylet/coupling/track_compliance.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace stylet::validate {

/// A cube of tissue of 100 mm around the origin, E = 10 kPa by default, with the quantities that checks of the near
/// field need.
struct MediumBlock {
  struct Options {
    int cells = 10;
    double poisson = 0.45;
    double jitter = 0.15;
    bool skin = false;  ///< true: the face z = −50 mm is free; false: all faces are held
    std::vector<std::string> regions{"body"};
    std::function<int(const Vec3&)> region_at = [](const Vec3&) { return 0; };
    std::vector<Material> materials{};  ///< empty: one material of 10 kPa
    /// [mm] planes onto which the nearest layers of nodes are moved, so that they can be interfaces.
    std::vector<double> faces_at_z{};
    std::function<bool(const Vec3&)> also_held = [](const Vec3&) { return false; };
    Element element = Element::p1;
    std::vector<NeedleWay>
        ways{};  ///< ways along which the wide part of the compliance comes from spread forces; may be empty
  };
  static constexpr double kHalf_mm = 50.0;
  static constexpr double kYoung_MPa = 0.01;

  /// Returns the errors of Tissue::build.
  static Result<MediumBlock> build(const Options& options);

  /// The material point at x. @param x inside the cube; otherwise throws std::bad_optional_access
  [[nodiscard]] MaterialPoint at(const Vec3& x) const;

  /// Computes the mesh's compliance around these points.
  void prepare_mesh(const std::vector<Vec3>& points) { store->add_nodes(corners_around(points)); }
  /// Computes the mesh's compliance and its kernel around these points.
  void prepare(const std::vector<Vec3>& points);

  [[nodiscard]] NearFieldCompliance compliance(const NeedleKernel& needle, int capacity) const;

  /// Reaction forces of the k held nodes to unit forces on the material point x [N/N] (3k × 3), node by node in the
  /// order of `fixed`. By reciprocity, moving the held nodes by U moves the point by −reactionsᵀ U.
  [[nodiscard]] MatX reactions(const Vec3& x) const;

  /// Displacement of the material point x when the held nodes move by `field` (3×3, a column per load).
  /// @param field (k) displacement of the held nodes per unit of each of three loads
  [[nodiscard]] Mat3 lift(const Vec3& x, const std::vector<Mat3>& field) const;

  /// Compliance of a needle's tip at x [mm/N].
  [[nodiscard]] Mat3 tip(const NeedleKernel& needle, const Vec3& x);

  /// Displacement of the material point `seen` per force of a tip at x [mm/N].
  [[nodiscard]] Mat3 tip_moves(const NeedleKernel& needle, const Vec3& x, const Vec3& seen);

  std::vector<Index> fixed;
  std::shared_ptr<const Tissue> tissue;
  std::unique_ptr<Topology> topology;
  std::unique_ptr<Locator> locator;
  std::shared_ptr<ComplianceStore> store;
  std::shared_ptr<MeshKernel> kernel;
  std::shared_ptr<const SpreadCompliance> spread;  ///< null without ways
  Medium medium;                                   ///< elastic constants of the first region

 private:
  [[nodiscard]] std::vector<Index> corners_around(const std::vector<Vec3>& points) const;
};

/// A straight rigid needle of 64 mm around the cube's centre that holds tissue points along its length and is
/// displaced.
struct NeedleLine {
  static constexpr double kLength_mm = 64.0;
  static constexpr double kWay_mm = 5.0;
  enum class Method { near_field, node_addition, embedded };

  struct Options {
    double spacing_mm = 4.0;  ///< spacing of the held points
    Vec3 direction = Vec3::UnitZ();
    bool unbounded = false;  ///< the held faces are moved as in an unbounded medium
    Method method = Method::near_field;
  };
  /// Lays the points. Methods other than the near field leave out points whose compliance follows from others, as an
  /// insertion does.
  static NeedleLine build(MediumBlock& block, Options options);

  /// Force [N] that moves the line by kWay_mm along a unit vector.
  [[nodiscard]] double force(const Vec3& along) const;
  [[nodiscard]] double lateral() const { return force(direction.unitOrthogonal()); }
  [[nodiscard]] double axial() const { return force(direction); }

  Vec3 direction = Vec3::UnitZ();
  std::vector<Vec3> points;  ///< [mm]
  MatX A;                    ///< [mm/N] (3·points × 3·points) compliance among the points
};

}  // namespace stylet::validate
