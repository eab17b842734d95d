// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "needle/axis_curve.hpp"
#include "needle/tet_segment.hpp"
#include "stylet/needle/needle.hpp"

#include <array>
#include <span>
#include <vector>

namespace stylet::tet {

/// Layers (cross-sections) and segments count from the base; layer 0 is clamped and not among the unknowns.
/// What update() knows of one element: deformation gradient and second Piola–Kirchhoff stress.
struct ElementState {
  Mat3 F = Mat3::Identity();
  Mat3 elastic = Mat3::Zero();  ///< [MPa]
  Mat3 S = Mat3::Zero();        ///< [MPa] elastic, and what damping adds
};

/// Displacements of all nodes in base axes from where they are in a straight needle, with stresses, nodal forces and
/// energy, refreshed by update().
class TetShape {
 public:
  TetShape(SegmentMesh mesh, int segments, double segment_length, double young_modulus, double poisson);

  /// [mm] segment by segment: its middle nodes, then the layer at its end. Call update() after writing.
  VecX displacement;
  void update();
  /// Counts the calls of update(): what was made for the same number is still valid.
  [[nodiscard]] long revision() const { return revision_; }

  /// Makes a bow of constant curvature [1/mm] the unloaded shape, and takes it.
  void bend_rest(const Vec3& curvature);
  /// [mm] of the unloaded shape, as displacement.
  [[nodiscard]] const VecX& rest() const { return rest_; }

  /// From now on strain also resists every change from that of now, `ratio` times as stiffly as it is; Needle::damp().
  /// energy() stays what is stored.
  void damp(double ratio);
  [[nodiscard]] double damping() const { return damping_; }

  /// Multiplies Young's modulus (and stresses, forces, energy).
  void scale_modulus(double factor);

  [[nodiscard]] int segments() const { return segments_; }
  [[nodiscard]] const SegmentMesh& mesh() const { return mesh_; }
  [[nodiscard]] const AxisCurve& curve() const { return curve_; }
  [[nodiscard]] double lambda() const { return lambda_; }  ///< [MPa]
  [[nodiscard]] double mu() const { return mu_; }          ///< [MPa]
  [[nodiscard]] double energy() const { return energy_; }  ///< [N mm]

  /// First unknown of a node of a segment; negative for the clamped layer.
  [[nodiscard]] Eigen::Index dof(int segment, int node) const;
  /// First unknown of the axis node of layer 1…n.
  [[nodiscard]] Eigen::Index axis_dof(int layer) const { return dof(layer - 1, kLayerNodes + kAxisNode); }

  [[nodiscard]] const ElementState& element(int segment, int e) const { return states_[number(segment, e)]; }
  /// An element of the unloaded needle, base axes.
  [[nodiscard]] const Element& unloaded(int segment, int e) const {
    return bowed_.empty() ? mesh_.elements[static_cast<std::size_t>(e)] : bowed_[number(segment, e)];
  }
  /// [N] of the stress on the nodes, damping's included; else ∂energy/∂displacement
  [[nodiscard]] const VecX& force() const { return force_; }

  /// Centreline in base axes.
  [[nodiscard]] Vec3 point(double s) const;
  [[nodiscard]] Vec3 tangent(double s) const;
  [[nodiscard]] Vec3 axis_point(int layer) const;  ///< [mm] layer 0…n

  /// Present place [mm] of a node of a segment.
  [[nodiscard]] Vec3 place(int segment, int node) const;

 private:
  [[nodiscard]] std::size_t number(int segment, int e) const {
    return static_cast<std::size_t>(segment) * mesh_.elements.size() + static_cast<std::size_t>(e);
  }
  [[nodiscard]] Vec3 displacement_of(int segment, int node) const {
    const Eigen::Index i = dof(segment, node);
    return i < 0 ? Vec3::Zero() : Vec3(displacement.segment<3>(i));
  }
  /// From the unloaded shape.
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
  std::vector<Element> bowed_;  ///< of a bowed needle, segment by segment; a straight one's segments are all alike
  std::vector<ElementState> states_;
  std::vector<Mat3> damped_from_;  ///< [MPa] elastic stress of each element
  VecX force_;
};

/// Largest moment [N mm], over the layers, of the out-of-balance forces beyond about the layer's centre, or over the
/// nodes of out-of-balance force × segment length, whichever is larger. Written to (unknowns): the forces themselves.
/// @param base_rotation base axes to LPS
[[nodiscard]] double largest_imbalance(const TetShape& shape, const Mat3& base_rotation,
                                       std::span<const PointLoad> loads, VecX& imbalance);

}  // namespace stylet::tet
