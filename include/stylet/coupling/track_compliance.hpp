// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/split_mesh.hpp"
#include "stylet/fem/compliance_store.hpp"

#include <memory>
#include <span>

namespace stylet {

/// How a tissue point that the needle holds is represented in the mesh.
enum class Placement {
  embedded,  ///< no node: force and displacement are interpolated from the element's nodes
  interior,  ///< a node strictly inside an element (every weight ≥ kSmallestWeight)
  face       ///< a node on the face between two elements (Goksel et al. 2005)
};

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
/// Point 0 is the needle's tip: always embedded, moved at will. No call after construction allocates.
class TrackCompliance {
 public:
  static constexpr double kSmallestWeight = 0.1;       ///< interior nodes keep this distance from the faces
  static constexpr double kSmallestFaceWeight = 0.05;  ///< face nodes keep this distance from the edges
  static constexpr int kTip = 0;

  /// @param store compliance of base nodes; must hold every node asked for
  /// @param locator the tissue's mesh
  /// @param capacity largest number of points, the tip not counted
  TrackCompliance(std::shared_ptr<const ComplianceStore> store, const Locator& locator, int capacity);

  enum class Refusal {
    none,
    missing,   ///< the store lacks a node: call ComplianceStore::add_nodes between steps
    capacity,  ///< no room for another point
    geometry   ///< the point lies too near a face (interior) or an edge (face) for a sound split
  };
  struct Added {
    int point = -1;  ///< number of the new point, -1 when refused
    Refusal refusal = Refusal::none;
  };

  /// Adds a point at x in base tetrahedron at.tet. For Placement::face, `travel` is the direction from the first
  /// element into the second; x must lie on a face of at.tet.
  Added add(const MaterialPoint& at, const Vec3& x, Placement placement, const Vec3& travel = Vec3::Zero());

  /// Moves the tip. False, and nothing changed, when the store lacks a node.
  bool move_tip(const MaterialPoint& at, const Vec3& x);

  [[nodiscard]] int points() const { return points_; }  ///< tip included
  [[nodiscard]] Mat3 operator()(int c, int d) const { return A_.block<3, 3>(3 * c, 3 * d); }
  [[nodiscard]] const MatX& matrix() const { return A_; }  ///< leading 3·points() rows and columns are in use

  /// Displacement gradient ∂u/∂X in the base tetrahedron of the tip under forces on the points, hats left out (3×3).
  /// @param forces [N] (3 × points())
  [[nodiscard]] Mat3 gradient_at_tip(const Eigen::Ref<const MatX>& forces) const;

  /// Forces on the base nodes that are equivalent to forces on the points, hats condensed: K u_base = load [N] (3n).
  /// Allocates; for pictures and checks, not for the step.
  [[nodiscard]] VecX base_load(const Eigen::Ref<const MatX>& forces) const;

  /// Smallest eigenvalue of what is left of point c's own compliance when the points in `others` are held, over the
  /// mean of its diagonal: near 0 means that c follows from the others and must not be constrained as well.
  /// @param others at most kNeighbours points, the nearest ones; further ones are ignored
  [[nodiscard]] double independence(int c, std::span<const int> others) const;
  static constexpr int kNeighbours = 8;

  /// Takes back the point added last, which must have been embedded.
  void remove_last_embedded();

  /// Forgets all points and all added nodes; A is what it was before the first.
  void reset();

  [[nodiscard]] const SplitMesh& mesh() const { return mesh_; }

 private:
  /// Something whose displacement can be asked for: a point, or a vertex of a split element.
  struct Observable {
    std::array<Index, 4> node{-1, -1, -1, -1};
    std::array<double, 4> weight{0, 0, 0, 0};
    int known = 0;  ///< z_p is up to date for splits p < known
  };
  /// An added node.
  struct Split {
    int vertices = 0;                 ///< of the border, 0 inside an element
    std::array<int, 8> vertex{};      ///< observables
    std::array<Mat3, 8> border{};     ///< k_jp [N/mm]
    Mat3 flexibility = Mat3::Zero();  ///< s_p⁻¹ [mm/N]
  };

  static constexpr int kTipNodes = 1;  ///< observables 1…4: the nodes of the tip's tetrahedron
  static constexpr int kFirstFree = 5;

  [[nodiscard]] bool stored(Index base_tet) const;
  [[nodiscard]] Mat3 base_block(const Observable& a, const Observable& b) const;
  Mat3& z(int observable, int split) { return z_[static_cast<std::size_t>(observable * capacity_ + split)]; }
  [[nodiscard]] const Mat3& z(int observable, int split) const {
    return z_[static_cast<std::size_t>(observable * capacity_ + split)];
  }
  double& hat(int observable, int split) { return hat_[static_cast<std::size_t>(observable * capacity_ + split)]; }
  [[nodiscard]] double hat(int observable, int split) const {
    return hat_[static_cast<std::size_t>(observable * capacity_ + split)];
  }
  [[nodiscard]] Mat3 compliance(int a, int b, int splits) const;
  void extend(int observable, int splits);
  int new_observable(Index base_tet, const Vec4& weights);
  void interpolate_hats(int observable, const SplitMesh::Leaf& leaf, const Vec4& leaf_weights);
  Added place_inside(const MaterialPoint& at, const Vec3& x);
  Added place_on_face(const MaterialPoint& at, const Vec3& x, const Vec3& travel);
  void add_hat_stiffness(Mat3& stiffness, const SplitMesh::Leaf& leaf, const Vec4& leaf_weights) const;
  void add_border(Split& split, const SplitMesh::Leaf& leaf, int opposite);
  int finish_point(int observable);
  int vertex_observable(Index vertex);
  void write_row(int point);
  [[nodiscard]] Material material_of(Index base_tet) const;

  std::shared_ptr<const ComplianceStore> store_;
  SplitMesh mesh_;
  int capacity_;
  int points_ = 1;
  std::vector<Observable> observables_;
  std::vector<Index> vertex_of_;  ///< base node of each vertex observable, for look-up
  std::vector<Split> splits_;
  std::vector<int> point_observable_;  ///< (points) observable of a point
  std::vector<int> node_point_;        ///< (splits) point that sits on an added node
  std::vector<Mat3> z_;
  std::vector<double> hat_;
  MaterialPoint tip_;
  MatX A_;
};

}  // namespace stylet
