// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/contact_compliance.hpp"
#include "stylet/coupling/split_mesh.hpp"
#include "stylet/coupling/tip_element.hpp"
#include "stylet/fem/compliance_store.hpp"

#include <memory>

namespace stylet {

/// Compliance among the tissue points that the needle holds, A(c,d) [mm/N]: displacement of c per force on d.
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
/// Point 0 is the needle's tip: always embedded, moved at will. After construction nothing allocates but what says so.
class TrackCompliance final : public ContactCompliance {
 public:
  /// @param store compliance of base nodes; must hold every node asked for
  /// @param locator the tissue's mesh
  /// @param capacity largest number of points, the tip not counted
  TrackCompliance(std::shared_ptr<const ComplianceStore> store, const Locator& locator, int capacity);

  Added add(const MaterialPoint& at, const Vec3& x, Placement placement, const Vec3& travel = Vec3::Zero()) override;
  bool move_tip(const MaterialPoint& at, const Vec3& x) override;
  [[nodiscard]] bool available(Index base_tet) const override { return stored(base_tet); }
  void mark_nodes(std::span<unsigned> stamps, unsigned stamp) const override;
  void remove_last_embedded() override;
  void reset() override;
  [[nodiscard]] Mat3 gradient_at_tip(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] VecX displacement(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] VecX mesh_displacement(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] Nodes nodes(const Eigen::Ref<const MatX>& forces) const override;
  [[nodiscard]] std::span<const RemeshEvent> remeshing() const override { return changes_; }

  /// Forces on the base nodes that are equivalent to forces on the points, hats condensed: K u_base = load [N] (3n).
  /// Allocates; for pictures and checks, not for the step.
  [[nodiscard]] VecX base_load(const Eigen::Ref<const MatX>& forces) const;

  [[nodiscard]] const SplitMesh& mesh() const { return mesh_; }

 private:
  /// Something whose displacement can be asked for: a point, or a vertex of a split element.
  struct Observable {
    Shape shape;                                  ///< on the base nodes
    int known = 0;                                ///< z_p is up to date for splits p < known
    std::size_t nodes_before = 0;                 ///< nodes in use before it came
    std::array<int, kMostElementNodes> number{};  ///< of its nodes among those in use; the tip's have none
  };
  /// What belongs to one split among that of all.
  struct Range {
    std::size_t first = 0;
    std::size_t count = 0;
    template <class T>
    [[nodiscard]] auto of(T& all) const {
      return std::span(all).subspan(first, count);
    }
  };
  struct Border {
    int vertex = 0;         ///< observable j
    Mat3 k = Mat3::Zero();  ///< k_jp [N/mm]
  };
  /// An added node.
  struct Split {
    Range border;
    Range loads;                      ///< the same on the base nodes that the vertices are interpolated from
    Mat3 flexibility = Mat3::Zero();  ///< s_p⁻¹ [mm/N]

    [[nodiscard]] bool inside() const { return border.count == 0; }  ///< of an element: no border
  };

  static constexpr int kTipNodes = 1;  ///< observables from 1: the displacement nodes of the tip's element, by number
  static constexpr int kFirstFree = kTipNodes + kMostElementNodes;

  [[nodiscard]] bool stored(Index base_tet) const;
  [[nodiscard]] Mat3 base_block(const Observable& a, const Observable& b) const;
  Mat3& z(int observable, int split) { return z_[static_cast<std::size_t>(observable * capacity_ + split)]; }
  [[nodiscard]] const Mat3& z(int observable, int split) const {
    return z_[static_cast<std::size_t>(observable * capacity_ + split)];
  }
  /// s_q⁻¹ Σ_j z_q(j)ᵀ k_jp over the border of split p, for an earlier split q: what the load k_jp makes of its hat.
  Mat3& passed_on(int q, int p) { return passed_on_[static_cast<std::size_t>(p * capacity_ + q)]; }
  [[nodiscard]] const Mat3& passed_on(int q, int p) const {
    return passed_on_[static_cast<std::size_t>(p * capacity_ + q)];
  }
  double& hat(int observable, int split) { return hat_[static_cast<std::size_t>(observable * capacity_ + split)]; }
  [[nodiscard]] double hat(int observable, int split) const {
    return hat_[static_cast<std::size_t>(observable * capacity_ + split)];
  }
  [[nodiscard]] Mat3 compliance(int a, int b) const;

  /// What the base compliance makes of a split's loads at a base node.
  Mat3 base_moved(Index node, const Split& split);
  /// s_p⁻¹ z_pᵀ: what a force on an observable makes of a split's hat.
  [[nodiscard]] Mat3 amplitude(int observable, int split) const;
  /// What a split's loads, or a force on an observable, make of the nodes in use, field_. Many observables share nodes,
  /// so each block of the store is read once.
  void load_nodes_by(const Split& split);
  void load_nodes_by(int observable);
  /// And what the force makes of the hats, amplitude_.
  void load_hats_by(int observable);
  /// The displacement of an observable by that of its nodes, and by that of the hats.
  [[nodiscard]] Mat3 at_nodes(const Observable& o) const;
  [[nodiscard]] Mat3 moved_by_hats(int observable) const;
  /// @param base what the base compliance makes of the split's loads there
  void set_z(int observable, int split, const Mat3& base);
  void extend(int observable);
  /// All points and the nodes of the tip's element.
  void extend_all();
  /// For observables at the same node.
  void copy_z(int from, int to);
  int new_observable(const Shape& shape, Index vertex);
  void interpolate_hats(int observable, const SplitMesh::Part& part);
  int add_inside(const SplitMesh::Place& place, const Shape& shape);
  int add_on_face(const SplitMesh::Place& place, const Shape& shape);
  [[nodiscard]] Shape shape_on_face(Index base_tet, const Vec3& x) const;
  void split_elements(const SplitMesh::Place& place);
  void add_bordered_split(const SplitMesh::Place& place);
  void add_border(Split& split, const SplitMesh::Leaf& leaf, std::span<const Mat3, 4> k);
  void gather_loads(Split& split);
  void interpolate_from_face(int observable, const SplitMesh::Part& part);
  void loosen_points(int p);
  int finish_point(int observable);
  int vertex_observable(Index vertex);
  void interpolate_row(int observable, const TipElement::Weights& weights);
  template <class Rest>
  void write_row(int point, const Rest& rest);
  void know_tip_node(int number);
  void interpolate_tip(int from);
  void combine_tip_rows(const TipElement::Weights& weights);
  void write_tip_row();
  Mat3& tip_node_row(int number, int point) {
    return tip_node_rows_[static_cast<std::size_t>(number * (capacity_ + 1) + point)];
  }
  [[nodiscard]] const Mat3& tip_node_row(int number, int point) const {
    return tip_node_rows_[static_cast<std::size_t>(number * (capacity_ + 1) + point)];
  }
  [[nodiscard]] Material material_of(Index base_tet) const;

  std::shared_ptr<const ComplianceStore> store_;
  SplitMesh mesh_;
  int capacity_;
  std::vector<Observable> observables_;
  std::vector<Index> vertex_of_;  ///< base node of each vertex observable, for look-up
  std::vector<Split> splits_;
  std::vector<int> point_observable_;  ///< (points) observable of a point
  std::vector<int> node_point_;        ///< (splits) point that sits on an added node
  std::vector<Mat3> z_;
  std::vector<double> hat_;
  std::vector<Mat3> passed_on_;
  std::vector<Border> borders_;
  std::vector<Index> load_node_;
  std::vector<Mat3> load_;       ///< Σ_j (weight of the node at vertex j) k_jp [N/mm]
  std::vector<Mat3> blocks_;     ///< (loads of a split) of the store, side by side
  std::vector<Index> nodes_;     ///< base nodes of all observables but the tip's, each once
  std::vector<Mat3> field_;      ///< (nodes_) [mm/N], or of a split's loads [1]
  std::vector<Mat3> amplitude_;  ///< (splits) [mm/N], or those of a new split by (points)
  std::vector<RemeshEvent> changes_;
  MaterialPoint tip_;
  TipElement tip_element_;
  std::vector<Mat3>
      tip_node_rows_;  ///< (numbers × points) A of the nodes of the tip's element and the points but the tip
  VecX tip_row_;       ///< (9 × points but the tip) blocks of the tip, one behind the other
};

}  // namespace stylet
