// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/coupling/capacity_use.hpp"
#include "stylet/coupling/compliance_supply.hpp"
#include "stylet/coupling/contact_compliance.hpp"
#include "stylet/coupling/event.hpp"
#include "stylet/coupling/laws.hpp"
#include "stylet/coupling/near_field/mesh_kernel.hpp"
#include "stylet/coupling/step.hpp"
#include "stylet/coupling/track.hpp"
#include "stylet/fem/compliance_store.hpp"
#include "stylet/fem/spread_compliance.hpp"
#include "stylet/needle/needle.hpp"

#include <limits>
#include <memory>
#include <optional>
#include <span>

namespace stylet {

/// The state of a contact, for reports and pictures.
struct ContactState {
  Vec3 position = Vec3::Zero();  ///< [mm] LPS, position of the tissue point in the deformed tissue
  Vec3 force = Vec3::Zero();     ///< [N] LPS, force of the needle on the tissue
  double s = 0.0;                ///< [mm] arc length on the needle, from its base
  double length = 0.0;           ///< [mm] length of shaft that the contact represents
  bool sticking = false;
  bool tip = false;
};

/// A force on a point of the tissue.
struct TissueForce {
  MaterialPoint at;           ///< where the force acts
  Vec3 force = Vec3::Zero();  ///< [N] LPS, with `lasting` included
  /// Unit vector LPS along the piece of shaft over which the force is spread; zero for the tip, whose force acts at a
  /// point.
  Vec3 along = Vec3::Zero();
  /// [N] LPS, the part of `force` under which the tissue has crept; it acts spread over NeedleKernel::kScale_mm.
  Vec3 lasting = Vec3::Zero();
  double softness = 1.0;  ///< ContactCompliance::softness() of the point
};

/// The tissue of an insertion. Everything it points to must outlive the Insertion.
struct InsertionTissue {
  std::shared_ptr<ComplianceStore> store;
  const Locator* locator = nullptr;
  std::vector<RegionLaws> laws;           ///< one for each region of the mesh
  std::shared_ptr<const MatX> inverse{};  ///< the full K⁻¹ (paper::full_inverse), for the engines that keep it
  std::shared_ptr<MeshKernel> kernel{};   ///< kernel of the mesh, for the near-field method
  /// Compliance along the planned paths of the needle, for tissue that stiffens or creeps.
  std::shared_ptr<const SpreadCompliance> spread{};
};

/// Flexible needles in tissue: moves the base of one needle, finds the balance of needles and tissue under friction and
/// cutting, and keeps the tracks. The hand holds one needle at a time; others rest where it left them, with their hubs
/// locked, and take part in every balance: they hold the tissue, bend, and slip (docs/theory/several_needles.md).
/// Unless said otherwise, a function is about the needle that the hand holds. The model is quasi-static; time enters
/// through viscosity and damping. step() does not allocate, throw, lock or log, except that engines with the full
/// inverse allocate when the mesh changes. docs/theory/coupling.md describes the model.
class Insertion {
 public:
  Insertion(InsertionTissue tissue, std::unique_ptr<Needle> needle, const CouplingSettings& settings);
  ~Insertion();
  Insertion(Insertion&&) noexcept;
  Insertion& operator=(Insertion&&) noexcept;

  /// Adds a needle, which is in the air and at rest. Call it between steps; it allocates.
  /// @return the needle's number; an error where CouplingSettings::needles leaves no room, or with the staggered solver
  /// or an engine that keeps the full inverse
  Result<int> add_needle(std::unique_ptr<Needle> needle);
  /// Lays the held needle to rest and takes up another. The hub of a needle at rest is locked where the hand left it.
  /// The tip of a needle at rest presses the tissue with at most its cutting force, does not pull, and once the tissue
  /// has left it, stays open until the needle is taken up. Call it between steps; it allocates.
  /// @return an error, with nothing changed, where there is no such needle or no room for the tip's contact
  Result<> take_up(int needle);
  [[nodiscard]] int needles() const;  ///< number of needles; the first one is needle 0
  [[nodiscard]] int held() const;     ///< number of the needle that the hand holds

  /// Places the needle without touching tissue; must be called before the first step. A needle that is still in the
  /// tissue is withdrawn first.
  void place(const Pose& base);

  /// Puts the hole of the guide template, if the needle has one, at `hole` [mm] LPS.
  /// @param axis unit vector LPS, towards the patient
  void place_guide(const Vec3& hole, const Vec3& axis);

  /// Moves the base to the pose `base` in dt seconds.
  /// @return the step; its fields time_s, dt_s, base_depth_mm and the three parts of the force are left for the caller
  Step step(const Pose& base, double dt);

  /// The events of the last step; CapacityUses::events tells whether some found no room.
  [[nodiscard]] std::span<const InsertionEvent> events() const;

  /// Computes the compliance of all elements within `radius_mm` of the tip. Must be called between steps; returns at
  /// once where the tip has not moved far since the last call. Allocates and solves, or waits for the worker that does.
  void prepare(double radius_mm);

  /// The compliance that has been computed so far.
  [[nodiscard]] const ComplianceStore& store() const;

  /// The supply of compliance around the needle; its worker's side may run on another thread.
  [[nodiscard]] ComplianceSupply& supply();

  [[nodiscard]] const Needle& needle() const;
  [[nodiscard]] const ContactCompliance& compliance() const;
  [[nodiscard]] const CouplingSettings& settings() const;
  /// The capacities, with the largest use so far.
  [[nodiscard]] const CapacityUses& capacities() const;

  /// The present contacts, the tip first when it touches. Allocates.
  [[nodiscard]] std::vector<ContactState> contacts() const;
  /// The same, written to `out`; does not allocate. @return number of contacts written; capacity + 1 elements are
  /// enough
  std::size_t contacts(std::span<ContactState> out) const;

  /// The contacts of any needle, one at rest included. Allocates.
  [[nodiscard]] std::vector<ContactState> contacts_of(int needle) const;
  /// [N] LPS, force of the hand or the lock on the base of any needle.
  [[nodiscard]] Vec3 hand_force_on(int needle) const;
  [[nodiscard]] const Needle& needle(int number) const;
  [[nodiscard]] const Track& track(int number) const;
  /// Whether a needle touches the tissue or is in it.
  [[nodiscard]] bool in_tissue(int number) const;

  /// Displacement of the material at the mesh's nodes [mm] (3n). Solves and allocates; for pictures, never in the
  /// real-time loop.
  [[nodiscard]] VecX displacement() const;

  /// displacement() without the near field of the needle: the displacement that the mesh represents, which has the same
  /// meaning at all nodes, near the needle or not.
  [[nodiscard]] VecX mesh_displacement() const;

  /// The displacement of a material point of the tissue [mm] LPS: of a seed, for instance.
  struct PointDisplacement {
    Vec3 whole = Vec3::Zero();    ///< all of it, the near field of the needle included
    Vec3 lasting = Vec3::Zero();  ///< the part to which the tissue has crept; it goes back only slowly
  };
  /// The displacement of any material point under the present forces, exactly as that of a contact. Call it between
  /// steps; it does not allocate, and the next step takes up its equations anew.
  /// @param x [mm] LPS, the undeformed place, which lies in element at.tet
  /// @return empty where the compliance has not been computed, or where there is no room for another point
  std::optional<PointDisplacement> displacement_at(const MaterialPoint& at, const Vec3& x);

  /// Forces on material points that hold the tissue in its present shape: those of the contacts, and in viscous tissue
  /// the lasting forces of earlier contacts. Allocates.
  [[nodiscard]] std::vector<TissueForce> tissue_forces() const;
  /// The same, written to `out`; does not allocate. @return number of forces, including those that did not fit
  std::size_t tissue_forces(std::span<TissueForce> out) const;
  /// Condition number of A among the contacts, the tip included where it touches; 1 without contacts. Allocates.
  [[nodiscard]] double compliance_condition() const;

  /// Forces of contacts and supports on the nodes of the present mesh. Allocates.
  [[nodiscard]] ContactCompliance::Nodes nodes() const;
  /// displacement() and nodes() at once, which takes hardly longer than one of them.
  [[nodiscard]] ContactCompliance::Moment moment() const;

  /// Elastic energy in the tissue, ½ fᵀ A f [N mm]; for viscous tissue, the stored energy.
  [[nodiscard]] double tissue_energy() const;

  /// The current track, and the tracks of earlier insertions.
  [[nodiscard]] const Track& track() const;
  [[nodiscard]] std::span<const Track> old_tracks() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet
