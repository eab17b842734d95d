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
  double s = 0.0;             ///< [mm] arc length from the base, 0…length
  Vec3 force = Vec3::Zero();  ///< [N] LPS, does not turn with the needle
};

/// What Needle::linearise() does where the tangent is not positive definite.
enum class Indefinite {
  shift,    ///< makes it so by stiffening the needle
  give_up,  ///< nothing more: for a caller who lends springs only where they are needed
};

/// A place on the centreline.
struct AxisPlace {
  Vec3 point = Vec3::Zero();     ///< [mm]
  Vec3 tangent = Vec3::UnitZ();  ///< unit, towards the tip
};

/// A flexible needle clamped at its base. Knows nothing of tissue. One equilibrium is found by repeating
///   linearise(loads)  →  the caller picks new loads with `compliance`  →  advance(new loads)
/// until residual() and the changes are small. No call after construction allocates, as long as the number of loads
/// stays below the capacity given at construction.
class Needle {
 public:
  virtual ~Needle() = default;

  [[nodiscard]] virtual double length() const = 0;  ///< [mm]
  [[nodiscard]] virtual std::string model() const = 0;

  /// Places the base: local z is the axis the needle leaves the base along. The shape relative to the base is kept.
  virtual void set_base(const Pose& base) = 0;
  [[nodiscard]] virtual const Pose& base() const = 0;

  /// Centreline point [mm] LPS and unit tangent (towards the tip) at arc length s, current shape.
  [[nodiscard]] virtual Vec3 point(double s) const = 0;
  [[nodiscard]] virtual Vec3 tangent(double s) const = 0;
  /// Both, which share much of their arithmetic.
  [[nodiscard]] virtual AxisPlace place(double s) const { return {point(s), tangent(s)}; }

  /// Tangent problem at the current shape. For loads f (not necessarily in equilibrium with the shape) a Newton step to
  /// equilibrium moves load point c by free(c) + Σ_d compliance(c,d) Δf_d where Δf_d changes the given loads.
  /// @param loads (w) point loads
  /// A needle pressed harder than it can bear on its own (a brachytherapy needle buckles under about 1 N) has no
  /// positive definite tangent. What holds it is not known here, so the caller may lend springs: they pull each load
  /// point back to where it is now, and compliance and free are those of the needle on its springs. The caller adds the
  /// springs' forces to its own balance; with them the Newton step stays exact.
  /// @param springs [N/mm] (w) stiffness at each load point, LPS, symmetric positive semidefinite; empty = none
  /// @param otherwise where the tangent is not positive definite
  /// @param compliance [mm/N] (3w × 3w), symmetric positive semidefinite, written
  /// @param free [mm] (3w), written: motion of the load points by the Newton step with unchanged loads
  /// @return true when the tangent was positive definite as it is; otherwise it was made so, and the step is not exact,
  /// or with Indefinite::give_up nothing is written, and there is no tangent until linearise() is called again
  virtual bool linearise(std::span<const PointLoad> loads, Eigen::Ref<MatX> compliance, Eigen::Ref<VecX> free,
                         std::span<const Mat3> springs = {}, Indefinite otherwise = Indefinite::shift) = 0;

  /// A step from the present shape with the tangent, the springs and the compliance of the last linearise(). It costs a
  /// small part of linearise(), and repeated steps converge linearly instead of quadratically.
  /// @param loads (w) the loads of the last linearise() at their present arc lengths; a shorter list drops the loads at
  ///   the end of the earlier one
  /// @param free [mm] (3w), written: motion of the load points by this step with unchanged loads
  /// @return false if the needle has no tangent that fits: nothing was done, and linearise() has to be called
  virtual bool relax(std::span<const PointLoad> loads, Eigen::Ref<VecX> free) = 0;

  /// Adds one load to the problem of the last linearise(). Only the rows of the new load are computed; the rest of the
  /// compliance stays as it is. The new load gets no spring. A call of relax() has to follow.
  /// @param loads (w) the loads of the last linearise(), or the first of them, followed by the new load
  /// @param compliance [mm/N] (3 × 3w), written: motion of the new load point by each load
  /// @return false if this needle model cannot add a load: nothing was done, and linearise() has to be called
  // NOLINTNEXTLINE(performance-unnecessary-value-param): others write through the view
  virtual bool append(std::span<const PointLoad> /*loads*/, Eigen::Ref<MatX> /*compliance*/) { return false; }

  /// Whether a tangent can be made beside the one in use.
  [[nodiscard]] virtual bool prepares() const { return false; }

  /// Begins the next tangent at the present shape. The tangent in use stays in use until take_prepared(). The work is
  /// split into pieces that may be done in different steps: this one, then calls of prepared_compliance().
  /// @return true if the new tangent is positive definite as it is; if it is not, Indefinite::give_up makes none
  virtual bool prepare(std::span<const PointLoad> /*loads*/, std::span<const Mat3> /*springs*/,
                       Indefinite /*otherwise*/) {
    return false;
  }
  /// Computes the next piece of the new tangent's compliance.
  /// @param compliance [mm/N] (3w × 3w), written piece by piece: the same matrix in each call, complete after the last
  /// @return whether this was the last piece
  // NOLINTNEXTLINE(performance-unnecessary-value-param): others write through the view
  virtual bool prepared_compliance(Eigen::Ref<MatX> /*compliance*/) { return true; }
  /// Puts the new tangent, which must be complete, in the place of that of the last linearise(). A call of relax() or
  /// append() has to follow.
  virtual void take_prepared() {}

  /// Takes the step of the last linearise() or relax() with these loads in place of those given there (same s, same
  /// order).
  virtual void advance(std::span<const PointLoad> loads) = 0;

  /// Norm of the out-of-balance moment under the given loads [N mm], 0 at equilibrium. Writes work space.
  [[nodiscard]] virtual double residual(std::span<const PointLoad> loads) = 0;

  /// From now on whatever is elastic also resists every change from the shape of now, `ratio` times as stiffly as it
  /// is: what internal damping with a time constant τ (Kelvin–Voigt) does within a step of τ / ratio, taken
  /// implicitly. 0, as at first: they do not. residual(), linearise() and relax() are of the damped needle, energy()
  /// and find_equilibrium() are not; with a tangent of before, relax() converges more slowly. Models without damping do
  /// nothing.
  virtual void damp(double /*ratio*/) {}

  /// Takes the stress-free shape: straight, or with the bow it was built with. The base is kept.
  virtual void straighten() = 0;

  /// Elastic energy stored in the shape [N mm].
  [[nodiscard]] virtual double energy() const = 0;

  /// Puts the hole of a guide template, if the needle has one, at `hole` [mm] LPS. @param axis LPS, towards the tip
  virtual void place_guide(const Vec3& /*hole*/, const Vec3& /*axis*/) {}
  /// What the guide exerts on the needle at the present shape: LPS, square to the shaft. The hand at the base bears
  /// what the loads and this leave.
  [[nodiscard]] virtual PointLoad guide_load() const { return {}; }

  /// State to save and restore (a step that must be repeated), (dofs).
  [[nodiscard]] virtual Eigen::Ref<const VecX> state() const = 0;
  virtual void set_state(const Eigen::Ref<const VecX>& state) = 0;
};

/// Solves for the equilibrium of a needle under fixed loads, the stand-alone use.
/// @return iterations used, or an error when there is no convergence
Result<int> find_equilibrium(Needle& needle, std::span<const PointLoad> loads, double tolerance_Nmm = 1e-10,
                             int max_iterations = 100);

}  // namespace stylet
