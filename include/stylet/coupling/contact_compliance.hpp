// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/tip_dent.hpp"
#include "stylet/geom/locator.hpp"

#include <limits>
#include <span>

namespace stylet {

/// How a tissue point that the needle holds is represented in the mesh.
enum class Placement {
  embedded,  ///< no node: force and displacement are interpolated from the element's nodes
  interior,  ///< a node strictly inside an element (every weight ≥ kSmallestWeight)
  face       ///< a node on the face between two elements (Goksel et al. 2005)
};

/// A change of the mesh because the needle came by.
struct RemeshEvent {
  enum class Kind {
    added_inside,   ///< a node inside an element, which becomes four
    added_on_face,  ///< a node on a face: two elements become six, one at the outer surface three
    repositioned    ///< the nearest node moved to the tip
  };
  /// Why the nearest node was not moved and one was added instead.
  enum class Refused {
    no,        ///< it was moved, or moving was not asked for
    boundary,  ///< it lies on the surface of an organ or of the patient, whose shape it makes
    fixed,     ///< it is held
    held,      ///< the needle holds it already
    contacts,  ///< contacts are interpolated in the elements around it, and would come to depend on each other
    inverts    ///< an element around it would have become flat or inverted
  };
  Kind kind{};
  Refused refused = Refused::no;
  int point = -1;         ///< the contact it was made for
  Index node = -1;        ///< node moved, or number of the node added
  int dimension = 0;      ///< of ΔK: 3 × the nodes of the elements that changed; fixed ones included
  int elements = 0;       ///< elements that changed, or came to be
  double moved_mm = 0.0;  ///< by which a node was moved
  double condition = std::numeric_limits<double>::quiet_NaN();  ///< of the small matrix of Woodbury's formula
};

const char* to_string(RemeshEvent::Kind kind);
const char* to_string(RemeshEvent::Refused refused);

/// What the tissue gives the needle: the compliance among the points it holds, A(c,d) [mm/N], displacement of c per
/// force on d. Point 0 is the needle's tip: always interpolated, moved at will; others come and stay until reset().
/// Implementations differ in how they keep A right while nodes are added or moved.
class ContactCompliance {
 public:
  static constexpr double kSmallestWeight = 0.1;       ///< interior nodes keep this distance from the faces
  static constexpr double kSmallestFaceWeight = 0.05;  ///< face nodes keep this distance from the edges
  static constexpr int kTip = 0;

  enum class Refusal {
    none,
    missing,   ///< compliance of a node is not there yet: prepare between steps
    capacity,  ///< no room for another point
    geometry   ///< the point lies too near a face (interior) or an edge (face) for a sound split
  };
  struct Added {
    int point = -1;  ///< number of the new point, -1 when refused
    Refusal refusal = Refusal::none;
  };

  virtual ~ContactCompliance() = default;

  /// Adds a point at x in base tetrahedron at.tet. For Placement::face, `travel` is the direction from the first
  /// element into the second; x must lie on a face of at.tet.
  virtual Added add(const MaterialPoint& at, const Vec3& x, Placement placement, const Vec3& travel = Vec3::Zero()) = 0;

  /// Moves the tip to x in base tetrahedron at.tet. False, and nothing changed, when compliance is missing there.
  virtual bool move_tip(const MaterialPoint& at, const Vec3& x) = 0;

  /// A sub-step begins: wide() is that of the tip's next place.
  virtual void begin_sub_step() {}

  /// The needle is to go in, along the unit vector `direction`, through a surface that breaks at `force` [N]; until it
  /// is told, and after reset(), through none.
  virtual void enter_by(double /*force*/, const Vec3& /*direction*/) {}

  /// Whether the compliance of a base tetrahedron's nodes is there. Where it is not, nothing can be added and the tip
  /// stays where it was last.
  [[nodiscard]] virtual bool available(Index base_tet) const = 0;

  /// Writes `stamp` at each displacement node whose compliance the points need.
  /// @param stamps (displacement nodes)
  virtual void mark_nodes(std::span<unsigned> /*stamps*/, unsigned /*stamp*/) const {}

  /// Takes back the point added last, which must have been embedded.
  virtual void remove_last_embedded() = 0;

  /// Forgets all points and all changes of the mesh; A is what it was before the first.
  virtual void reset() = 0;

  /// Displacement gradient ∂u/∂X around the tip under forces on the points (3×3).
  /// @param forces [N] (3 × points())
  [[nodiscard]] virtual Mat3 gradient_at_tip(const Eigen::Ref<const MatX>& forces) const = 0;

  /// Displacement [mm] (3n) of the material at the base mesh's nodes. Allocates; for pictures and checks.
  [[nodiscard]] virtual VecX displacement(const Eigen::Ref<const MatX>& forces) const = 0;

  /// The same without the near field of the needle, where an implementation adds one: what the mesh represents. Of all
  /// displacement nodes, those that the kind of element adds included (3 × Tissue::displacement_nodes()); nodes put at
  /// the needle do not count. Allocates.
  /// @param forces [N] LPS (3 × points())
  [[nodiscard]] virtual VecX mesh_displacement(const Eigen::Ref<const MatX>& forces) const {
    return displacement(forces);
  }

  /// Every node of the mesh as it is now.
  struct Nodes {
    std::vector<Vec3> position;  ///< [mm] LPS, undeformed
    VecX load;                   ///< [N] what the contacts come to on each node; on fixed ones too
    VecX support;                ///< [N] what the supports exert, not counting loads put on fixed nodes directly
  };
  /// Displacement [mm] (3n) of the material at the base mesh's nodes, through the wide part of A. Allocates.
  [[nodiscard]] virtual VecX wide_displacement(const Eigen::Ref<const MatX>& forces) const {
    return displacement(forces);
  }

  /// Forces on the mesh's nodes under forces on the points. Allocates; for checks.
  [[nodiscard]] virtual Nodes nodes(const Eigen::Ref<const MatX>& forces) const = 0;

  /// Changes of the mesh since the last reset().
  [[nodiscard]] virtual std::span<const RemeshEvent> remeshing() const = 0;

  [[nodiscard]] int points() const { return points_; }  ///< tip included
  [[nodiscard]] Mat3 operator()(int c, int d) const { return A_.block<3, 3>(3 * c, 3 * d); }
  [[nodiscard]] const MatX& matrix() const { return A_; }  ///< leading 3·points() rows and columns are in use

  /// The part of the tip's columns of A that is of the needle's own scale [mm/N] (3 points × 3). This part of the
  /// compliance stiffens under force, as tip_dent() says. Zero where all of A is linear.
  [[nodiscard]] const MatX& needle_scale() const { return needle_scale_; }
  /// How the tip's own part of that gives way.
  [[nodiscard]] TipDent tip_dent() const { return {needle_scale_.topRows<3>(), stiffening_MPa_}; }
  /// Whether the tissue stiffens where the tip is.
  [[nodiscard]] bool stiffens() const { return stiffening_MPa_ > 0.0; }

  /// The wide part of A [mm/N]: what is left of it without the needle's own scale, for every pair of points. It is the
  /// compliance for forces that are spread over NeedleKernel::kScale_mm, and what of the tissue creeps. A itself where
  /// an implementation does not know the needle's scale. Leading 3·points() rows and columns are in use. The tip's are
  /// those of its first place in a sub-step, from which it goes no further than the cut of that sub-step.
  [[nodiscard]] const MatX& wide() const { return wide_.size() > 0 ? wide_ : A_; }
  [[nodiscard]] Mat3 wide(int c, int d) const { return wide().block<3, 3>(3 * c, 3 * d); }
  /// How much of its own near field the mesh has at a point, with which wide() was made; 1 away from borders.
  [[nodiscard]] virtual double softness(int /*point*/) const { return 1.0; }

  /// Changes whenever compliances among points other than the tip have changed.
  [[nodiscard]] unsigned version() const { return version_; }

  /// Smallest eigenvalue of what is left of point c's own compliance when the points in `others` are held, over the
  /// mean of its diagonal: near 0 means that c follows from the others and must not be constrained as well.
  /// @param others at most kNeighbours points, the nearest ones; further ones are ignored
  [[nodiscard]] double independence(int c, std::span<const int> others) const;
  static constexpr int kNeighbours = 8;

 protected:
  int points_ = 1;
  unsigned version_ = 0;
  MatX A_;
  MatX needle_scale_ = MatX::Zero(3, 3);
  MatX wide_;                    ///< empty: all of A
  double stiffening_MPa_ = 0.0;  ///< k₂ of DentLaw where the tip is; 0: linear
};

}  // namespace stylet
