// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/contact_compliance.hpp"
#include "stylet/coupling/paper/adapted_mesh.hpp"
#include "stylet/coupling/paper/dense_inverse.hpp"

namespace stylet::paper {

/// Contact compliance read from the full inverse of the stiffness, which is updated in place whenever a node is added
/// or moved (Goksel et al. 2005). It makes the same changes of the mesh as TrackCompliance and gives the same values;
/// its cost grows with the square of the mesh size. Adding points allocates.
///
/// Where nodes may be moved, the nearest node of the element that contains the point is moved to it, unless that node
/// defines the shape of an organ, is fixed, is a contact point already, has contacts interpolated around it, or would
/// flatten an element. In these cases a node is added, and the event has the reason (RemeshEvent::Refused). When nodes
/// may be moved, the tip is interpolated in the present mesh, and a contact in the mesh as it was when the contact was
/// created; otherwise both are interpolated in the base mesh.
class InverseCompliance final : public ContactCompliance {
 public:
  /// @param tissue, locator of the base mesh; must outlive this object
  /// @param initial full_inverse(tissue)
  InverseCompliance(std::shared_ptr<const Tissue> tissue, const Locator& locator, std::shared_ptr<const MatX> initial,
                    DenseInverse::Engine engine, bool move_nodes, int capacity);

  Added add(const MaterialPoint& at, const Vec3& x, Placement placement, const Vec3& travel = Vec3::Zero()) override;
  bool move_tip(const MaterialPoint& at, const Vec3& x) override;
  [[nodiscard]] bool available(Index /*base_tet*/) const override { return true; }
  void remove_last_embedded() override;
  void reset() override;
  [[nodiscard]] Mat3 gradient_at_tip(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] VecX displacement(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] Nodes nodes(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] std::span<const RemeshEvent> remeshing() const override { return events_; }

  [[nodiscard]] const AdaptedMesh& mesh() const { return mesh_; }
  [[nodiscard]] const DenseInverse& inverse() const { return inverse_; }
  [[nodiscard]] Index first_dof(Index node) const { return first_dof_[static_cast<std::size_t>(node)]; }

 private:
  /// A material point as a combination of nodes.
  struct Point {
    std::array<Index, 4> node{-1, -1, -1, -1};
    Vec4 weight = Vec4::Zero();
    Vec3 x = Vec3::Zero();  ///< [mm] undeformed
    Index base_tet = -1;
    bool interpolated = true;
  };

  [[nodiscard]] Point interpolate(const MaterialPoint& at, const Vec3& x) const;
  [[nodiscard]] Mat3 block(Index a, Index b) const;
  [[nodiscard]] Mat3 compliance(const Point& a, const Point& b) const;
  [[nodiscard]] const Material& material_of(const AdaptedMesh::Element& element) const;
  [[nodiscard]] VecX load(const Eigen::Ref<const MatX>& forces) const;
  [[nodiscard]] VecX nodal_displacement(const Eigen::Ref<const MatX>& forces) const;
  bool move_nearest(const MaterialPoint& at, const Vec3& x, RemeshEvent& event);
  Refusal add_node(const MaterialPoint& at, const Vec3& x, Placement placement, const Vec3& travel, RemeshEvent& event);
  void apply(const AdaptedMesh::Change& change, RemeshEvent& event);
  Added finish(const Point& point);
  void write_row(int point);
  void write_all();

  std::shared_ptr<const Tissue> tissue_;
  const Locator* locator_;
  AdaptedMesh mesh_;
  DenseInverse inverse_;
  bool move_nodes_;
  int capacity_;
  std::vector<Index> first_dof_;  ///< (nodes) first degree of freedom, −1: fixed
  std::vector<Point> points_of_;  ///< (points), the tip first
  std::vector<Index> held_;       ///< nodes at which points are
  std::vector<RemeshEvent> events_;
};

}  // namespace stylet::paper
