// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/structure_slices.hpp"

#include <memory>

namespace stylet::meshing {

/// A solid, given by its signed distance function: negative inside, positive outside.
class Shape {
 public:
  virtual ~Shape() = default;
  /// Signed distance [mm]: exact near the surface, elsewhere an estimate of the right sign. @param p [mm] LPS
  [[nodiscard]] virtual double distance(const Vec3& p) const = 0;
  /// Box [mm] LPS that contains the solid.
  [[nodiscard]] virtual Eigen::AlignedBox3d box() const = 0;
  /// Volume of {distance < offset} [mm³]. @param offset [mm]
  [[nodiscard]] virtual double volume(double offset) const = 0;
  /// Largest distance between an inner point and the surface [mm]: half the thickness of the thickest part.
  [[nodiscard]] virtual double inner_radius() const = 0;
};

using ShapePtr = std::shared_ptr<const Shape>;

/// A grid of signed distances in a slice frame with trilinear interpolation. Beyond the grid, the distance is the value
/// at its rim plus the distance from the rim.
class GridShape : public Shape {
 public:
  SliceFrame frame;
  Vec3 low = Vec3::Zero();           ///< [mm] local coordinates of node (0,0,0)
  Vec3 spacing = Vec3::Ones();       ///< [mm]
  std::array<int, 3> size{0, 0, 0};  ///< number of nodes along u, v, n
  std::vector<float> values;         ///< [mm] (nodes) signed distances, u varies fastest

  [[nodiscard]] double distance(const Vec3& p) const override;
  [[nodiscard]] Eigen::AlignedBox3d box() const override;
  [[nodiscard]] double volume(double offset) const override;
  [[nodiscard]] double inner_radius() const override;

  [[nodiscard]] std::size_t at(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * size[1] + j) * size[0] + i;
  }
  [[nodiscard]] Vec3 node(int i, int j, int k) const { return frame.lps(low + spacing.cwiseProduct(Vec3(i, j, k))); }
};

/// Makes the values true distances again without moving their zero surface (fast sweeping, Zhao 2005).
void redistance(GridShape& grid);

/// Smooths the values by a Gaussian. @param sigma [mm]
void smooth(GridShape& grid, double sigma);

/// Rounds convex edges to a radius [mm] by morphological opening (erosion, then dilation). The values must be
/// distances, and are distances afterwards.
void round_edges(GridShape& grid, double radius);

/// A rod with round ends.
class Capsule : public Shape {
 public:
  Capsule(const Vec3& from, const Vec3& to, double radius) : from_(from), to_(to), radius_(radius) {}
  [[nodiscard]] double distance(const Vec3& p) const override;
  [[nodiscard]] Eigen::AlignedBox3d box() const override;
  [[nodiscard]] double volume(double offset) const override;
  [[nodiscard]] double inner_radius() const override { return radius_; }

 private:
  Vec3 from_, to_;
  double radius_;
};

/// A superquadric (x/a)⁴ + (y/b)⁴ + (z/c)⁴ < 1: a shape between an ellipsoid and a box, flat in the middle of its faces
/// and without edges.
class Superquadric : public Shape {
 public:
  Superquadric(const Vec3& centre, const Vec3& half_axes) : centre_(centre), half_axes_(half_axes) {}
  [[nodiscard]] double distance(const Vec3& p) const override;
  [[nodiscard]] Eigen::AlignedBox3d box() const override;
  [[nodiscard]] double volume(double offset) const override;
  [[nodiscard]] double inner_radius() const override { return half_axes_.minCoeff(); }

 private:
  Vec3 centre_, half_axes_;
};

/// Signed distance of the solid between parallel slices. The signed distance fields of slices that join are
/// interpolated along the slice normal (shape-based interpolation, Raya & Udupa 1990). Rounded caps close the solid
/// half a slice beyond its last contours; the result is smoothed and made a true distance.
/// @param voxel wanted grid spacing [mm]
/// @param sigma width of the Gaussian for smoothing [mm]
std::shared_ptr<GridShape> interpolate_slices(const StructureSlices& slices, double voxel, double sigma);

/// Union of two solids in the same slice frame, on a grid that contains both.
std::shared_ptr<GridShape> unite(const GridShape& a, const GridShape& b);

/// A stack of in-plane signed distance fields on a common grid.
struct SliceFields {
  SliceFrame frame;
  Eigen::Vector2d low = Eigen::Vector2d::Zero();      ///< [mm] local position of pixel (0, 0)
  Eigen::Vector2d spacing = Eigen::Vector2d::Ones();  ///< [mm]
  std::array<int, 2> size{0, 0};
  std::vector<double> heights;  ///< (slices) [mm] along the normal, ascending
  /// (slices) [mm] size[0]*size[1] values each; empty for a slice without the structure.
  std::vector<std::vector<float>> fields;
  std::vector<bool> joins_next;  ///< (slices) whether the structure continues to the next slice, if both have it
  double gap = 0;                ///< [mm] usual distance between slices
};

/// The same, from in-plane distance fields.
/// @param step grid spacing along the normal [mm]
/// @param sigma width of the Gaussian for smoothing [mm]
std::shared_ptr<GridShape> interpolate_fields(const SliceFields& stack, double step, double sigma);

/// In-plane signed distance [mm] (nx*ny) of a pixel mask to the line half way between its inner and outer pixels, from
/// the exact Euclidean distance between pixel centres (Felzenszwalb & Huttenlocher 2012).
/// @param dx, dy pixel size [mm]
/// @return empty when no pixel is set
std::vector<float> mask_distance(const std::vector<bool>& mask, int nx, int ny, double dx, double dy);

}  // namespace stylet::meshing
