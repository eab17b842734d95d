// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/capacity_use.hpp"
#include "stylet/coupling/compliance_supply.hpp"
#include "stylet/coupling/contact_compliance.hpp"
#include "stylet/coupling/event.hpp"
#include "stylet/coupling/laws.hpp"
#include "stylet/coupling/near_field/mesh_kernel.hpp"
#include "stylet/coupling/step.hpp"
#include "stylet/coupling/step_phases.hpp"
#include "stylet/coupling/track.hpp"
#include "stylet/fem/compliance_store.hpp"
#include "stylet/fem/spread_compliance.hpp"
#include "stylet/needle/needle.hpp"

#include <limits>
#include <memory>
#include <span>

namespace stylet {

/// Contact as seen from outside.
struct ContactState {
  Vec3 position = Vec3::Zero();  ///< [mm] LPS, of the tissue point, deformed
  Vec3 force = Vec3::Zero();     ///< [N] on the tissue
  double s = 0.0;                ///< [mm] arc length on the needle
  double length = 0.0;           ///< [mm] tributary length
  bool sticking = false;
  bool tip = false;
};

/// Force on a point of the tissue.
struct TissueForce {
  MaterialPoint at;
  Vec3 force = Vec3::Zero();  ///< [N] LPS, `lasting` included
  Vec3 along = Vec3::Zero();  ///< unit vector LPS, of the piece of shaft it is spread over; zero: the tip's, at a point
  /// [N] LPS, the part of `force` by which the tissue has crept: it acts spread over NeedleKernel::kScale_mm.
  Vec3 lasting = Vec3::Zero();
  double softness = 1.0;  ///< ContactCompliance::softness() of the point
};

/// What the tissue contributes; everything outlives the Insertion.
struct InsertionTissue {
  std::shared_ptr<ComplianceStore> store;
  const Locator* locator = nullptr;
  std::vector<RegionLaws> laws;           ///< one per region of the mesh
  std::shared_ptr<const MatX> inverse{};  ///< the full K⁻¹ (paper::full_inverse), for engines that keep it
  std::shared_ptr<MeshKernel> kernel{};   ///< of the mesh, for the near-field method
  std::shared_ptr<const SpreadCompliance> spread{};  ///< along the needle's ways, for tissue that stiffens or creeps
};

/// A flexible needle in tissue: moves the base, finds the equilibrium of needle and tissue under friction and cutting,
/// and keeps the track. Quasi-static; time enters by viscosity and damping. step() does not allocate, throw, lock
/// or log (engines that keep the full inverse allocate when the mesh changes). docs/theory/coupling.md has the model.
class Insertion {
 public:
  Insertion(InsertionTissue tissue, std::unique_ptr<Needle> needle, const CouplingSettings& settings);
  ~Insertion();
  Insertion(Insertion&&) noexcept;
  Insertion& operator=(Insertion&&) noexcept;

  /// Places the needle without touching tissue; the first call before any step. A needle that is still in is taken out
  /// first, as if withdrawn.
  void place(const Pose& base);

  /// Puts the guide template's hole, if the needle has one, at `hole` [mm] LPS. @param axis LPS, towards the patient
  void place_guide(const Vec3& hole, const Vec3& axis);

  /// Moves the base from where it is to `base` in dt seconds. The step's time, dt and depth are the caller's to fill
  /// in.
  Step step(const Pose& base, double dt);

  /// The events of the last step, as far as there was room for them.
  [[nodiscard]] std::span<const InsertionEvent> events() const;

  /// Makes the compliance of all elements within `radius` of the tip available. Call between steps; returns at once
  /// when the tip has not moved far. Allocates and solves, or waits for the worker that does.
  void prepare(double radius_mm);

  /// The compliance there is now.
  [[nodiscard]] const ComplianceStore& store() const;

  /// What brings compliance to the needle; a worker's side of it may be another thread's.
  [[nodiscard]] ComplianceSupply& supply();

  [[nodiscard]] const Needle& needle() const;
  [[nodiscard]] const ContactCompliance& compliance() const;
  [[nodiscard]] const CouplingSettings& settings() const;
  /// What there is room for, and the most that was ever in use.
  [[nodiscard]] const CapacityUses& capacities() const;

  /// Contacts now, the tip first when it touches. Allocates.
  [[nodiscard]] std::vector<ContactState> contacts() const;
  /// The same into room provided; does not allocate. @return how many were written; capacity + 1 always fit
  std::size_t contacts(std::span<ContactState> out) const;

  /// Displacement of the material at the mesh's nodes [mm] (3n). Solves for it, allocates; for pictures,
  /// never in the loop.
  [[nodiscard]] VecX displacement() const;

  /// The same without the near field of the needle: what the mesh represents, and so alike for all of its nodes, near
  /// the needle or not.
  [[nodiscard]] VecX mesh_displacement() const;

  /// Forces that hold the tissue where it is, on material points: contacts, and in viscous tissue what it remembers of
  /// them. Allocates.
  [[nodiscard]] std::vector<TissueForce> tissue_forces() const;
  /// The same into room provided; does not allocate. @return how many there are, those that found no room included
  std::size_t tissue_forces(std::span<TissueForce> out) const;
  /// Condition number of A among the contacts and the tip where it touches; 1 without any. Allocates.
  [[nodiscard]] double compliance_condition() const;

  /// What contacts and supports exert on the nodes of the mesh as it is now. Allocates.
  [[nodiscard]] ContactCompliance::Nodes nodes() const;

  /// ½ fᵀ A f, elastic energy in the tissue [N mm]; of viscous tissue what it has stored.
  [[nodiscard]] double tissue_energy() const;

  /// Who is told what a step is at (it must outlive the steps); null, the default, is nobody.
  void observe_phases(PhaseObserver* observer);

  /// The current track, and those of earlier insertions.
  [[nodiscard]] const Track& track() const;
  [[nodiscard]] std::span<const Track> old_tracks() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet
