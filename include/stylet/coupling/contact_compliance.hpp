// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/tip_dent.hpp"
#include "stylet/coupling/tip_neighbours.hpp"
#include "stylet/geom/locator.hpp"

#include <limits>
#include <span>

namespace stylet {

/// How a contact point is represented in the mesh.
enum class Placement {
  embedded,  ///< no node: force and displacement are interpolated from the element's nodes
  interior,  ///< a node strictly inside an element (every weight ≥ kSmallestWeight)
  face       ///< a node on the face between two elements (Goksel et al. 2005)
};

/// A change of the mesh at a contact.
struct RemeshEvent {
  enum class Kind {
    added_inside,   ///< a node inside an element, which becomes four elements
    added_on_face,  ///< a node on a face: two elements become six; at the outer surface, one becomes three
    repositioned    ///< the nearest node was moved to the contact point
  };
  /// Why the nearest node was not moved and one was added instead.
  enum class Refused {
    no,        ///< the node was moved, or moving was not requested
    boundary,  ///< the node lies on the surface of an organ or of the patient, whose shape it defines
    fixed,     ///< the node is held by a support
    held,      ///< the node is a contact point already
    contacts,  ///< contacts are interpolated in the elements around the node, and would become linearly dependent
    inverts    ///< an element around the node would become flat or inverted
  };
  Kind kind{};
  Refused refused = Refused::no;
  int point = -1;         ///< number of the point that the change was made for
  Index node = -1;        ///< number of the node that was moved or added
  int dimension = 0;      ///< size of ΔK: 3 × the number of nodes of the changed elements, fixed nodes included
  int elements = 0;       ///< number of elements that were changed or created
  double moved_mm = 0.0;  ///< distance by which a node was moved
  /// Condition number of the small matrix in Woodbury's formula; NaN for other methods.
  double condition = std::numeric_limits<double>::quiet_NaN();
};

const char* to_string(RemeshEvent::Kind kind);
const char* to_string(RemeshEvent::Refused refused);

/// The compliance among the tissue points that the needle holds: A(c,d) [mm/N], displacement of point c per force on
/// point d. Point 0 is the needle's tip, which is always interpolated and can be moved; other points are added and stay
/// until reset(). Implementations differ in how they update A when nodes are added or moved.
class ContactCompliance {
 public:
  static constexpr double kSmallestWeight = 0.1;       ///< smallest barycentric weight of a node inside an element
  static constexpr double kSmallestFaceWeight = 0.05;  ///< smallest barycentric weight of a node on a face
  static constexpr int kTip = 0;

  enum class Refusal {
    none,
    missing,   ///< the compliance of a node has not been computed yet; prepare it between steps
    capacity,  ///< no room for another point
    geometry   ///< the point lies too near a face (interior) or an edge (face) for a well-shaped split
  };
  struct Added {
    int point = -1;  ///< number of the new point, −1 when refused
    Refusal refusal = Refusal::none;
  };

  virtual ~ContactCompliance() = default;

  /// Adds a point at x in base tetrahedron at.tet.
  /// @param travel for Placement::face: direction from the first element into the second; x must lie on a face of
  /// at.tet
  virtual Added add(const MaterialPoint& at, const Vec3& x, Placement placement, const Vec3& travel = Vec3::Zero()) = 0;

  /// Moves the tip to x in base tetrahedron at.tet. @return false, with nothing changed, where compliance is missing
  /// there
  virtual bool move_tip(const MaterialPoint& at, const Vec3& x) = 0;

  /// From here on, moves of the tip update its compliance with these points only, to save time. Its compliance with all
  /// others remains that of an earlier place until renew_tip() or release_tip(); those that are new here are updated.
  /// An implementation may always update all.
  virtual void restrict_tip(std::span<const int> /*points*/) {}
  /// Updates the compliance of the tip at its present place with points from which it is restricted.
  virtual void renew_tip(std::span<const int> /*points*/) {}
  /// Ends restrict_tip(), and updates all.
  virtual void release_tip() {}

  /// Begins a sub-step: wide() is updated at the next move of the tip.
  virtual void begin_sub_step() {}

  /// Sets the surface through which the needle is about to enter: it breaks at `force` [N], and the needle goes along
  /// the unit vector `direction`. Before the first call, and after reset(), there is no such surface.
  virtual void enter_by(double /*force*/, const Vec3& /*direction*/) {}

  /// From here on, the tip and the points that are added belong to another needle.
  virtual void change_needle() {}

  /// Whether the compliance of a base tetrahedron's nodes has been computed. Where it has not, no point can be added
  /// and the tip cannot be moved there.
  [[nodiscard]] virtual bool available(Index base_tet) const = 0;

  /// Writes `stamp` to each displacement node whose compliance the points need.
  /// @param stamps (displacement nodes)
  virtual void mark_nodes(std::span<unsigned> /*stamps*/, unsigned /*stamp*/) const {}

  /// Removes the point that was added last; it must be an embedded point.
  virtual void remove_last_embedded() = 0;

  /// Removes all points and all changes of the mesh; A is again what it was before the first point.
  virtual void reset() = 0;

  /// Displacement gradient ∂u/∂X at the tip under forces on the points (3×3).
  /// @param forces [N] LPS (3 × points())
  [[nodiscard]] virtual Mat3 gradient_at_tip(const Eigen::Ref<const MatX>& forces) const = 0;

  /// Displacement [mm] (3n) of the material at the base mesh's nodes. Allocates; for pictures and checks.
  /// @param forces [N] LPS (3 × points())
  [[nodiscard]] virtual VecX displacement(const Eigen::Ref<const MatX>& forces) const = 0;

  /// displacement() without the near field of the needle, if an implementation adds one: the displacement that the mesh
  /// represents (3 × Tissue::displacement_nodes()). It includes the nodes that quadratic elements add, and excludes
  /// nodes added at the needle. Allocates.
  /// @param forces [N] LPS (3 × points())
  [[nodiscard]] virtual VecX mesh_displacement(const Eigen::Ref<const MatX>& forces) const {
    return displacement(forces);
  }

  /// Positions of all nodes of the present mesh, and the forces that act on them.
  struct Nodes {
    std::vector<Vec3> position;  ///< [mm] LPS, undeformed
    VecX load;                   ///< [N] force of the contacts on each node, fixed nodes included
    VecX support;                ///< [N] force of the supports on each node, without loads applied directly to fixed
                                 ///< nodes
  };
  /// The result of displacement() computed with the wide() part of the compliance instead of all of A [mm] (3n).
  /// Allocates.
  [[nodiscard]] virtual VecX wide_displacement(const Eigen::Ref<const MatX>& forces) const {
    return displacement(forces);
  }

  /// Forces on the mesh's nodes under forces on the points. Allocates; for checks.
  /// @param forces [N] LPS (3 × points())
  [[nodiscard]] virtual Nodes nodes(const Eigen::Ref<const MatX>& forces) const = 0;

  /// The displacement of a frame, and the forces for its check.
  struct Moment {
    VecX displacement;  ///< [mm] (3n) displacement() by present forces, and wide_displacement() by lasting ones
    Nodes nodes;        ///< under the present forces
  };
  /// Both at once, which takes hardly longer than one of them. Allocates.
  /// @param present, lasting forces [N] LPS (3 × points()); `lasting` may be empty
  [[nodiscard]] virtual Moment moment(const Eigen::Ref<const MatX>& present,
                                      const Eigen::Ref<const MatX>& lasting) const {
    Moment moment{displacement(present), nodes(present)};
    if (lasting.cols() > 0) moment.displacement += wide_displacement(lasting);
    return moment;
  }

  /// Changes of the mesh since the last reset().
  [[nodiscard]] virtual std::span<const RemeshEvent> remeshing() const = 0;

  [[nodiscard]] int points() const { return points_; }  ///< the tip included
  [[nodiscard]] Mat3 operator()(int c, int d) const { return A_.block<3, 3>(3 * c, 3 * d); }
  [[nodiscard]] const MatX& matrix() const { return A_; }  ///< its leading 3·points() rows and columns are in use

  /// The part of the tip's columns of A that has the needle's own scale [mm/N] (3 points × 3). This part stiffens under
  /// force by the law of tip_dent(). Zero where all of A is linear.
  [[nodiscard]] const MatX& needle_scale() const { return needle_scale_; }
  /// The law by which the tip's own block of needle_scale() stiffens.
  [[nodiscard]] TipDent tip_dent() const { return {needle_scale_.topRows<3>(), stiffening_MPa_}; }
  /// Whether the tissue stiffens where the tip is.
  [[nodiscard]] bool stiffens() const { return stiffening_MPa_ > 0.0; }

  /// The wide part of A [mm/N], for every pair of points: A without its part of the needle's own scale. It is the
  /// compliance for forces that are spread over NeedleKernel::kScale_mm, and it is the part of the compliance that
  /// creeps. It equals A where an implementation does not separate the needle's scale. Its leading 3·points() rows and
  /// columns are in use. The tip's entries are those of its first place in a sub-step; the tip moves from there by no
  /// more than the cut of that sub-step.
  [[nodiscard]] const MatX& wide() const { return wide_.size() > 0 ? wide_ : A_; }
  [[nodiscard]] Mat3 wide(int c, int d) const { return wide().block<3, 3>(3 * c, 3 * d); }
  /// The factor softness_in_mesh() by which the mesh's own kernel at a point was multiplied to make wide(); 1 away from
  /// borders.
  [[nodiscard]] virtual double softness(int /*point*/) const { return 1.0; }

  /// Changes whenever a compliance among points other than the tip has changed.
  [[nodiscard]] unsigned version() const { return version_; }

  /// Smallest eigenvalue of the compliance that point c keeps when the points in `others` are held, over the mean of
  /// the diagonal of its full compliance. Near 0, point c is a combination of the others and must not be constrained as
  /// well.
  /// @param others at most kNeighbours points, the nearest first; further points are ignored
  [[nodiscard]] double independence(int c, std::span<const int> others) const;
  static constexpr int kNeighbours = 8;

 protected:
  int points_ = 1;
  unsigned version_ = 0;
  MatX A_;
  MatX needle_scale_ = MatX::Zero(3, 3);
  MatX wide_;                    ///< empty: the same as A_
  double stiffening_MPa_ = 0.0;  ///< k₂ of DentLaw at the tip; 0: linear tissue
  TipNeighbours tip_neighbours_;
};

}  // namespace stylet
