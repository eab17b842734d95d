// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/axis_curve.hpp"
#include "needle/tet_segment.hpp"
#include "stylet/needle/needle.hpp"

#include <array>
#include <span>
#include <vector>

namespace stylet::tet {

/// State of one element: deformation gradient and second Piola–Kirchhoff stress, computed by TetShape::update().
struct ElementState {
  Mat3 F = Mat3::Identity();
  Mat3 elastic = Mat3::Zero();  ///< [MPa] elastic stress
  Mat3 S = Mat3::Zero();        ///< [MPa] elastic stress plus the stress of damping
};

/// Displacements of all nodes of a bar of tetrahedra, in base axes relative to the straight needle, with the stresses,
/// nodal forces and energy that update() computes. Layers (cross-sections) and segments are numbered from the base;
/// layer 0 is clamped and has no unknowns.
class TetShape {
 public:
  TetShape(SegmentMesh mesh, int segments, double segment_length, double young_modulus, double poisson);

  /// [mm] ordered by segment: its middle nodes, then the layer at its end. Call update() after writing.
  VecX displacement;
  void update();
  /// Number of calls of update(); values computed for the same number are still valid.
  [[nodiscard]] long revision() const { return revision_; }

  /// Makes a bow of constant curvature [1/mm] the unloaded shape, and sets the current shape to it.
  void bend_rest(const Vec3& curvature);
  /// Displacement of the unloaded shape [mm], in the order of `displacement`.
  [[nodiscard]] const VecX& rest() const { return rest_; }

  /// From now on strain also resists changes from its current value, with `ratio` times its stiffness; see
  /// Needle::damp(). energy() stays the elastic energy.
  void damp(double ratio);
  [[nodiscard]] double damping() const { return damping_; }
  /// Damping stiffness / elastic stiffness.

  /// Multiplies Young's modulus by a factor, and with it stresses, forces and energy.
  void scale_modulus(double factor);

  [[nodiscard]] int segments() const { return segments_; }
  [[nodiscard]] const SegmentMesh& mesh() const { return mesh_; }
  [[nodiscard]] const AxisCurve& curve() const { return curve_; }
  [[nodiscard]] double lambda() const { return lambda_; }  ///< [MPa]
  [[nodiscard]] double mu() const { return mu_; }          ///< [MPa]
  [[nodiscard]] double energy() const { return energy_; }  ///< [N mm]

  /// First unknown of a node of a segment; negative for nodes of the clamped layer.
  [[nodiscard]] Eigen::Index dof(int segment, int node) const;
  /// First unknown of the axis node of layer 1…n.
  [[nodiscard]] Eigen::Index axis_dof(int layer) const { return dof(layer - 1, kLayerNodes + kAxisNode); }

  [[nodiscard]] const ElementState& element(int segment, int e) const { return states_[number(segment, e)]; }
  /// An element of the unloaded needle in base axes.
  [[nodiscard]] const Element& unloaded(int segment, int e) const {
    return bowed_.empty() ? mesh_.elements[static_cast<std::size_t>(e)] : bowed_[number(segment, e)];
  }
  /// [N] nodal forces of the stress, including damping; without damping they are ∂energy/∂displacement
  [[nodiscard]] const VecX& force() const { return force_; }

  /// Point [mm] and unit tangent of the centreline at arc length s [mm], base axes.
  [[nodiscard]] Vec3 point(double s) const;
  [[nodiscard]] Vec3 tangent(double s) const;
  [[nodiscard]] Vec3 axis_point(int layer) const;  ///< [mm] centre of layer 0…n

  /// Current position [mm] of a node of a segment, base axes.
  [[nodiscard]] Vec3 place(int segment, int node) const;

 private:
  [[nodiscard]] std::size_t number(int segment, int e) const {
    return static_cast<std::size_t>(segment) * mesh_.elements.size() + static_cast<std::size_t>(e);
  }
  [[nodiscard]] Vec3 displacement_of(int segment, int node) const {
    const Eigen::Index i = dof(segment, node);
    return i < 0 ? Vec3::Zero() : Vec3(displacement.segment<3>(i));
  }
  /// Displacement relative to the unloaded shape.
  [[nodiscard]] Vec3 strain_displacement_of(int segment, int node) const {
    const Eigen::Index i = dof(segment, node);
    return i < 0 ? Vec3::Zero() : Vec3(displacement.segment<3>(i) - rest_.segment<3>(i));
  }

  SegmentMesh mesh_;
  int segments_;
  AxisCurve curve_;
  double lambda_;
  double mu_;
  double energy_ = 0.0;
  double damping_ = 0.0;
  long revision_ = 0;
  VecX rest_;
  std::vector<Element> bowed_;  ///< elements of a bowed needle, ordered by segment; empty for a straight needle, whose
                                ///< segments are all equal
  std::vector<ElementState> states_;
  std::vector<Mat3> damped_from_;  ///< [MPa] elastic stress of each element from which damping measures
  VecX force_;
};

/// The larger of two values: over the layers, the largest moment [N mm] about the layer's centre of the out-of-balance
/// forces beyond it; over the nodes, the largest out-of-balance force × segment length.
/// @param base_rotation base axes to LPS
/// @param imbalance output (unknowns): the out-of-balance forces [N]
[[nodiscard]] double largest_imbalance(const TetShape& shape, const Mat3& base_rotation,
                                       std::span<const PointLoad> loads, VecX& imbalance);

}  // namespace stylet::tet
