// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/contact_compliance.hpp"

#include <optional>
#include <vector>

namespace stylet::paper {

/// The tissue mesh with the changes made at the needle: elements split by added nodes, and elements deformed because a
/// node was moved. Base nodes keep their numbers; added node k has the number base nodes + k. Each change is reported
/// as elements removed and elements put in their place, from which ΔK follows. Changes allocate.
class AdaptedMesh {
 public:
  struct Element {
    std::array<Index, 4> nodes{-1, -1, -1, -1};
    Index base_tet = -1;        ///< tetrahedron of the base mesh that it comes from, which has its region and material
    bool present = true;        ///< false: a change has removed the element
    double volume = 0.0;        ///< [mm³]
    double first_volume = 0.0;  ///< [mm³] volume when the element was created
    Eigen::Matrix<double, 3, 4> gradients = Eigen::Matrix<double, 3, 4>::Zero();  ///< of the barycentric weights [1/mm]
    Vec4 offset = Vec4::Zero();  ///< weights(x) = offset + gradientsᵀ x
    [[nodiscard]] Vec4 weights(const Vec3& x) const { return offset + gradients.transpose() * x; }
  };

  /// The elements that a change removed, and those that replaced them.
  struct Change {
    std::vector<Element> before;
    std::vector<Element> after;
    Index node = -1;  ///< number of the node that was moved or added
  };

  explicit AdaptedMesh(const Locator& base);

  [[nodiscard]] Index node_count() const { return static_cast<Index>(positions_.size()); }
  [[nodiscard]] const Vec3& position(Index node) const { return positions_[static_cast<std::size_t>(node)]; }
  [[nodiscard]] const std::vector<Vec3>& positions() const { return positions_; }
  [[nodiscard]] const std::vector<Element>& elements() const { return elements_; }  ///< absent elements included
  [[nodiscard]] const Element& element(Index e) const { return elements_[static_cast<std::size_t>(e)]; }
  [[nodiscard]] const std::vector<Index>& elements_around(Index node) const {
    return around_[static_cast<std::size_t>(node)];
  }

  /// The element that contains x [mm], or −1 outside.
  /// @param hint the tetrahedron of the base mesh that would contain x if no node had moved
  [[nodiscard]] Index find(const Vec3& x, Index hint) const;

  /// Whether the node lies on the surface of an organ or of the patient, whose shape it defines.
  [[nodiscard]] bool on_boundary(Index node) const { return on_boundary_[static_cast<std::size_t>(node)]; }

  /// Smallest volume that move_node() leaves to an element, as a share of its first_volume.
  static constexpr double kSmallestShare = 0.1;
  /// Moves a node. Empty, with nothing changed, if an element around it would keep less than kSmallestShare.
  std::optional<Change> move_node(Index node, const Vec3& to);

  /// Splits an element into four at an inner point.
  Change split_inside(Index element, const Vec3& x);
  /// Splits the two elements that share a face (at the outer surface: one, second = −1) into three each, at a point of
  /// the face.
  /// @param local1, local2 local number of the vertex opposite the face
  Change split_face(Index first, int local1, Index second, int local2, const Vec3& x);

  void reset();

  /// The present mesh as a mesh of its own, for checks against a new factorisation.
  [[nodiscard]] TetMesh materialise() const;

 private:
  void shape(Element& element) const;
  Index put(const std::array<Index, 4>& nodes, Index base_tet);
  void take(Index element, Change& change);
  void split(Index element, int skip, Change& change);

  const Locator* base_;
  std::vector<Vec3> positions_;
  std::vector<Element> elements_;
  std::vector<std::vector<Index>> around_;  ///< (nodes) elements that have the node
  std::vector<std::vector<Index>> parts_;   ///< (base tets) elements that the tetrahedron was split into; empty: not
                                            ///< split
  std::vector<bool> on_boundary_;
};

}  // namespace stylet::paper
