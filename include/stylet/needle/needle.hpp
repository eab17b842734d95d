// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <memory>
#include <span>
#include <string>

namespace stylet {

/// A force on the needle's centreline.
struct PointLoad {
  double s = 0.0;             ///< [mm] arc length from the base, 0…length()
  Vec3 force = Vec3::Zero();  ///< [N] LPS; keeps its direction when the needle turns
};

/// The choice of Needle::linearise() when the tangent stiffness is not positive definite.
enum class Indefinite {
  shift,    ///< adds stiffness until it is positive definite
  give_up,  ///< stops; for callers that then pass springs to linearise() and try again
};

/// Position and direction of the centreline.
struct AxisPlace {
  Vec3 point = Vec3::Zero();     ///< [mm] LPS, unless the function that returns it says otherwise
  Vec3 tangent = Vec3::UnitZ();  ///< unit vector towards the tip
};

/// A flexible needle clamped at its base. The model does not include tissue; the caller applies loads. An equilibrium
/// is found by repeating
///   linearise(loads)  →  the caller computes new loads with `compliance`  →  advance(new loads)
/// until residual() and the changes are small. After construction no call allocates, as long as the number of loads
/// does not exceed the capacity given at construction.
class Needle {
 public:
  virtual ~Needle() = default;

  [[nodiscard]] virtual double length() const = 0;  ///< [mm]
  [[nodiscard]] virtual std::string model() const = 0;

  /// Sets the pose of the base. Its local z is the direction in which the needle leaves the base. The shape relative to
  /// the base stays the same.
  virtual void set_base(const Pose& base) = 0;
  [[nodiscard]] virtual const Pose& base() const = 0;

  /// Position of the centreline [mm] LPS and unit tangent (towards the tip) at arc length s [mm], for the current
  /// shape.
  [[nodiscard]] virtual Vec3 point(double s) const = 0;
  [[nodiscard]] virtual Vec3 tangent(double s) const = 0;
  /// Both point() and tangent(), at less cost than two calls.
  [[nodiscard]] virtual AxisPlace place(double s) const { return {point(s), tangent(s)}; }

  /// Computes the tangent problem at the current shape. With loads f, not necessarily in equilibrium with the shape, a
  /// Newton step moves load point c by free(c) + Σ_d compliance(c,d) Δf_d, where Δf_d is the change of load d.
  ///
  /// A needle that is pressed beyond its own buckling load (about 1 N for a brachytherapy needle) has no positive
  /// definite tangent. The caller, who knows what holds the needle, may therefore lend springs. They pull each load
  /// point back to its current position; compliance and free then describe the needle on its springs. The caller has to
  /// include the forces of the springs in its own equations; with them the Newton step stays exact.
  /// @param loads (w) point loads
  /// @param compliance [mm/N] (3w × 3w) output, symmetric positive semidefinite
  /// @param free [mm] (3w) output: motion of the load points in the Newton step with unchanged loads
  /// @param springs [N/mm] (w) stiffness at each load point, LPS, symmetric positive semidefinite; empty = none
  /// @param otherwise what to do when the tangent is not positive definite
  /// @return true when the tangent is positive definite without added stiffness. Otherwise, with Indefinite::shift, the
  ///   step is not exact; with Indefinite::give_up nothing is written, and there is no tangent until the next
  ///   linearise()
  virtual bool linearise(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free,
                         std::span<const Mat3> springs = {}, Indefinite otherwise = Indefinite::shift) = 0;

  /// A modified Newton step: from the current shape, with the tangent, springs and compliance of the last linearise().
  /// It costs a small part of linearise(); repeated steps converge linearly instead of quadratically.
  /// @param loads (w) the loads of the last linearise() at their current arc lengths; a shorter list drops the trailing
  ///   ones
  /// @param free [mm] (3w) output: motion of the load points in this step with unchanged loads
  /// @return false if the needle has no suitable tangent; then nothing has changed, and linearise() has to be called
  virtual bool relax(std::span<const PointLoad> loads, Eigen::Ref<VecX> free) = 0;

  /// Adds one load to the problem of the last linearise(). Only the rows of the new load are computed; the rest of the
  /// compliance stays the same. The new load gets no spring. relax() has to be called next.
  /// @param loads (w) the loads of the last linearise(), or the leading ones of them, followed by the new load
  /// @param compliance [mm/N] (3 × 3w) output: motion of the new load point per force of each load
  /// @return false if this model cannot add a load; then nothing has changed, and linearise() has to be called
  // NOLINTNEXTLINE(performance-unnecessary-value-param): overrides write through the view
  virtual bool append(std::span<const PointLoad> /*loads*/, Eigen::Ref<MatX> /*compliance*/) { return false; }

  /// Whether the model can prepare a new tangent while another one is in use.
  [[nodiscard]] virtual bool prepares() const { return false; }

  /// Begins to compute a new tangent at the current shape. The current tangent stays in use until take_prepared(). The
  /// work is divided into pieces that may be done in different steps: this call, then calls of prepared_compliance().
  /// @return true if the new tangent is positive definite without added stiffness; if it is not, Indefinite::give_up
  ///   makes no tangent
  virtual bool prepare(std::span<const PointLoad> /*loads*/, std::span<const Mat3> /*springs*/,
                       Indefinite /*otherwise*/) {
    return false;
  }
  /// Computes the next piece of the compliance of the new tangent.
  /// @param compliance [mm/N] (3w × 3w) output, written piece by piece: pass the same matrix in each call
  /// @return true when this was the last piece and the matrix is complete
  // NOLINTNEXTLINE(performance-unnecessary-value-param): overrides write through the view
  virtual bool prepared_compliance(Eigen::Ref<MatX> /*compliance*/) { return true; }
  /// Replaces the tangent in use by the new one, which must be complete. relax() or append() has to be called next.
  virtual void take_prepared() {}

  /// Takes the step computed by the last linearise() or relax(), with `loads` in place of the loads given there (same
  /// order, same s).
  virtual void advance(std::span<const PointLoad> loads) = 0;

  /// Norm of the out-of-balance moment under the given loads [N mm], 0 at equilibrium. Uses internal work space.
  [[nodiscard]] virtual double residual(std::span<const PointLoad> loads) = 0;

  /// Damping within a sub-step: from now on, everything elastic also resists changes from the current shape, with
  /// `ratio` times its stiffness. This is internal damping with a time constant τ (Kelvin–Voigt) in a sub-step of the
  /// length τ / ratio, integrated implicitly. It affects residual(), linearise() and relax(), but not energy() or
  /// find_equilibrium(); with a tangent made before the call, relax() converges more slowly. 0, the initial value,
  /// switches it off. Models without damping ignore it.
  virtual void damp(double /*ratio*/) {}

  /// Sets the shape to the stress-free one: straight, or with the bow given at construction. The base keeps its pose.
  virtual void straighten() = 0;

  /// Elastic energy stored in the shape [N mm].
  [[nodiscard]] virtual double energy() const = 0;

  /// Places the hole of the guide template, if the needle has one.
  /// @param hole centre of the hole [mm] LPS
  /// @param axis axis of the hole, LPS, towards the tip
  virtual void place_guide(const Vec3& /*hole*/, const Vec3& /*axis*/) {}
  /// Force of the guide on the needle at the current shape, LPS, perpendicular to the shaft. The hand at the base
  /// carries the sum of the loads and this force.
  [[nodiscard]] virtual PointLoad guide_load() const { return {}; }

  /// The degrees of freedom (dofs), to be saved before a step that may have to be repeated and restored by set_state().
  [[nodiscard]] virtual Eigen::Ref<const VecX> state() const = 0;
  virtual void set_state(const Eigen::Ref<const VecX>& state) = 0;
};

/// Solves for the equilibrium of a needle under constant loads, without tissue.
/// @param tolerance_Nmm largest residual() of the solution [N mm]
/// @param max_iterations largest number of Newton steps
/// @return number of iterations, or an error when the iteration does not converge
Result<int> find_equilibrium(Needle& needle, std::span<const PointLoad> loads, double tolerance_Nmm = 1e-10,
                             int max_iterations = 100);

}  // namespace stylet
