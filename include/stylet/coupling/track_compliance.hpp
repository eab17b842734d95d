// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/contact_compliance.hpp"
#include "stylet/coupling/split_mesh.hpp"
#include "stylet/fem/compliance_store.hpp"

#include <memory>

namespace stylet {

class AddedHats;
class SplitBorders;
class TipElementRows;
class TrackObservables;

/// Compliance among the contact points, A(c,d) [mm/N]: displacement of c per force on d, with nodes added to the mesh.
///
/// Added nodes are hierarchical: node p brings a hat b_p (1 at p, 0 on the boundary of the elements it splits) with
/// amplitude q_p, so u(x) = Λ_x u_base + Σ_p b_p(x) q_p and the base stiffness never changes. With the border
/// k_jp = a(φ_j, b_p) on the vertices j of the split elements and k_pp = a(b_p, b_p),
///   A(x,y) = Λ_x K⁻¹ Λ_yᵀ + Σ_p z_p(x) s_p⁻¹ z_p(y)ᵀ,
///   z_p(x) = b_p(x) I − Σ_j A_{p−1}(x,j) k_jp,     s_p = k_pp − Σ_ij k_ip ᵀ A_{p−1}(i,j) k_jp.
/// Inside an element k_jp = 0 (a linear field has constant strain there): the update is the shortcut
/// A(p,p) = Λ A Λᵀ + k_pp⁻¹, and old compliances do not change. On a face k_jp = −K^T_{j o} summed over the one or two
/// elements T, o being the vertex opposite the face. docs/theory/coupling.md derives both.
///
/// Point 0 is the needle's tip, which is always embedded and can be moved. After construction nothing allocates except
/// where a comment says so.
///
/// Four parts, each in its own file in src/coupling/track/, hold the terms of these formulas: TrackObservables the
/// places x and K⁻¹ among them, SplitBorders the k_jp, AddedHats the b_p, z_p and s_p⁻¹, and TipElementRows the
/// compliance between the nodes of the tip's element and the points. This class decides when each part is updated, and
/// holds A.
class TrackCompliance final : public ContactCompliance {
 public:
  /// @param store compliance of base nodes; must hold every node that is read
  /// @param locator of the tissue's mesh
  /// @param capacity largest number of points, the tip not counted
  /// @param most_nodes largest number of points that are added nodes, whose hats need memory for each pair of points; a
  /// negative number stands for `capacity`
  TrackCompliance(std::shared_ptr<const ComplianceStore> store, const Locator& locator, int capacity,
                  int most_nodes = -1);
  TrackCompliance(const TrackCompliance&) = delete;
  TrackCompliance& operator=(const TrackCompliance&) = delete;
  ~TrackCompliance() override;

  Added add(const MaterialPoint& at, const Vec3& x, Placement placement, const Vec3& travel = Vec3::Zero()) override;
  bool move_tip(const MaterialPoint& at, const Vec3& x) override;
  void restrict_tip(std::span<const int> points) override {
    tip_neighbours_.restrict(points, [&](int point) { write_tip(point); });
  }
  void renew_tip(std::span<const int> points) override {
    for (const int point : points) write_tip(point);
  }
  void release_tip() override {
    tip_neighbours_.release(points_, [&](int point) { write_tip(point); });
  }
  [[nodiscard]] bool available(Index base_tet) const override { return stored(base_tet); }
  void mark_nodes(std::span<unsigned> stamps, unsigned stamp) const override;
  void remove_last_embedded() override;
  void reset() override;
  [[nodiscard]] Mat3 gradient_at_tip(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] VecX displacement(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] VecX mesh_displacement(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] Nodes nodes(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] Moment moment(const Eigen::Ref<const MatX>& present,
                              const Eigen::Ref<const MatX>& lasting) const override;
  [[nodiscard]] std::span<const RemeshEvent> remeshing() const override { return changes_; }

  /// Forces on the base nodes that are equivalent to forces on the points, with the hats condensed: K u_base = load [N]
  /// (3n). Allocates; for pictures and checks, not for the step.
  /// @param forces [N] LPS (3 × points())
  [[nodiscard]] VecX base_load(const Eigen::Ref<const MatX>& forces) const;

  /// The mesh with the added nodes.
  [[nodiscard]] const SplitMesh& mesh() const { return mesh_; }

 private:
  [[nodiscard]] Nodes nodes_under(VecX load, const VecX& u) const;
  [[nodiscard]] bool stored(Index base_tet) const;
  [[nodiscard]] Material material_of(Index base_tet) const;
  [[nodiscard]] Mat3 compliance(int a, int b) const;
  [[nodiscard]] int observable_of(int point) const { return point_observable_[static_cast<std::size_t>(point)]; }
  int new_observable(const Shape& shape, Index vertex);
  int vertex_observable(Index vertex);

  int add_inside(const SplitMesh::Place& place, const Shape& shape);
  int add_on_face(const SplitMesh::Place& place, const Shape& shape);
  [[nodiscard]] Shape shape_on_face(Index base_tet, const Vec3& x) const;
  void split_elements(const SplitMesh::Place& place);
  void add_bordered_split(const SplitMesh::Place& place);
  void extend(int observable);
  void extend_all();
  void interpolate_hats(int observable, const SplitMesh::Part& part);
  void interpolate_from_face(int observable, const SplitMesh::Part& part);
  void loosen_points(int p);
  int finish_point(int observable);
  template <class Rest>
  void write_row(int point, const Rest& rest);

  [[nodiscard]] std::array<int, kMostElementNodes> tip_nodes() const;
  void know_tip_node(int number);
  void interpolate_tip(int from);
  void write_tip_row();
  void write_tip(int point);

  std::shared_ptr<const ComplianceStore> store_;
  SplitMesh mesh_;
  int capacity_;
  int most_nodes_;  ///< largest number of added nodes
  std::unique_ptr<TrackObservables> observables_;
  std::unique_ptr<SplitBorders> borders_;
  std::unique_ptr<AddedHats> hats_;
  std::unique_ptr<TipElementRows> tip_rows_;
  std::vector<int> point_observable_;  ///< (points) number of each point among the observables
  std::vector<int> node_point_;        ///< (added nodes) number of the point at each node
  std::vector<Mat3> by_points_;        ///< (points) [mm/N] amplitude of a new hat per force on each point
  std::vector<RemeshEvent> changes_;   ///< changes of the mesh since reset()
};

}  // namespace stylet
