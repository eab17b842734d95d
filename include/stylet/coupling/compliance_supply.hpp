// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/contact_compliance.hpp"
#include "stylet/coupling/near_field/mesh_kernel.hpp"
#include "stylet/fem/compliance_store.hpp"

#include <cstddef>
#include <memory>

namespace stylet {

/// The needle's place and direction, which decide the nodes whose compliance is needed. Undeformed coordinates.
struct NeedleWhereabouts {
  Vec3 tip = Vec3::Zero();         ///< [mm] LPS
  Vec3 direction = Vec3::UnitZ();  ///< unit vector LPS, direction of the needle's motion
  Index tet = -1;                  ///< element that contains the tip, −1 in the air
};

/// Computes compliance around the needle's way ahead and drops the compliance of nodes far behind, so that memory is
/// bounded.
///
/// It has two sides. The step's side owns the store and the mesh kernel; only it reads and changes them, and it is
/// wait-free. The worker's side solves, on its own thread (realtime/ComplianceWorker) or, between steps, on the thread
/// of the step (work_through()). The two sides pass one parcel back and forth. The worker puts new rows into it, and
/// requests slots whose nodes are far from the tip. The step takes the rows over, gives up the requested slots that no
/// contact needs, and writes down the place of the needle. The worker keeps its own list of the store's contents, which
/// the returned parcels update. docs/theory/coupling.md §2f.
class ComplianceSupply {
 public:
  struct Settings {
    double radius_mm = 6.0;  ///< compliance is computed for nodes of elements within this distance of the way ahead
    double ahead_mm = 0.0;   ///< length of the way ahead, from the tip on
    /// Room for nodes beyond the initial ones, which are never given up.
    Index spare_nodes = 1500;
  };

  /// @param store null where the engine keeps K⁻¹ itself
  /// @param kernel null for methods without near field
  ComplianceSupply(std::shared_ptr<const Tissue> tissue, std::shared_ptr<ComplianceStore> store,
                   std::shared_ptr<MeshKernel> kernel, const Locator& locator);
  ~ComplianceSupply();

  // --- The step's side.

  /// Whether the worker has handed the parcel to the step.
  [[nodiscard]] bool awaits_step() const noexcept;
  /// Takes over the worker's rows and gives up the slots that it requests. Wait-free: does not allocate, free or solve.
  /// @param user contact points in use; the nodes that they need keep their slots
  void serve(const ContactCompliance& user, const NeedleWhereabouts& needle) noexcept;

  /// Computes all compliance that is needed around the needle, or as much as there is room for. Not to be called in a
  /// step: solves on this thread, or waits for the worker if one is running. Throws std::bad_alloc when memory runs
  /// out.
  void work_through(const ContactCompliance& user, const NeedleWhereabouts& needle, const Settings& settings);

  // --- The worker's side.

  /// open() begins and close() ends the work of a worker. Neither must be called while a step is running.
  void open(const Settings& settings);
  void close();

  enum class Work {
    waiting,  ///< a step has to return the parcel first
    idle,     ///< no compliance is missing
    full,     ///< compliance is missing, but there is no slot that can be given up for it
    done,     ///< rows have been handed over to the step
    failed    ///< memory or threads ran out; nothing has changed
  };
  /// One round of work. Only one thread may call it at a time.
  /// @param most largest number of nodes to solve for in this round
  Work work(std::size_t most) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet
