// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/contact_compliance.hpp"
#include "stylet/coupling/near_field/mesh_kernel.hpp"
#include "stylet/fem/compliance_store.hpp"

#include <cstddef>
#include <memory>

namespace stylet {

/// Where a needle is, as far as compliance is concerned. Undeformed coordinates.
struct NeedleWhereabouts {
  Vec3 tip = Vec3::Zero();         ///< [mm] LPS
  Vec3 direction = Vec3::UnitZ();  ///< unit, in which it goes on
  Index tet = -1;                  ///< element of the tip, −1 in the air
};

/// Brings compliance to where a needle is about to need it, and forgets what is far behind, so that memory is bounded.
///
/// There are two sides. The step's side owns store and kernel, reads them and changes them, wait-free. The worker's
/// side solves, on a thread of its own (realtime/ComplianceWorker) or, between steps, on the step's (work_through()).
/// They pass one parcel to and fro. The worker puts rows into it, and asks for slots whose nodes are far from the tip;
/// the step takes the rows over, gives up those slots that no contact needs, and writes down where the needle is. What
/// the worker must know of the store it keeps in a list of its own, which the parcels keep right.
/// docs/theory/coupling.md §2.
class ComplianceSupply {
 public:
  struct Settings {
    double radius_mm = 6.0;    ///< nodes of elements within this distance of the needle's way ahead are brought in
    double ahead_mm = 0.0;     ///< length of the way ahead, from the tip on
    Index spare_nodes = 1500;  ///< room for nodes beyond those that were there before, which are never given up
  };

  /// @param store null where the engine keeps K⁻¹ by itself
  /// @param kernel null where there is no near field
  ComplianceSupply(std::shared_ptr<const Tissue> tissue, std::shared_ptr<ComplianceStore> store,
                   std::shared_ptr<MeshKernel> kernel, const Locator& locator);
  ~ComplianceSupply();

  // --- The step's side.

  /// Whether serve() has something to do.
  [[nodiscard]] bool awaits_step() const noexcept;
  /// Takes over what the worker has made, lets go of what it asks for. Wait-free; does not allocate, free or solve.
  /// @param user the nodes that its points need stay
  void serve(const ContactCompliance& user, const NeedleWhereabouts& needle) noexcept;

  /// Brings in all that is wanted around the needle, or as much as there is room for. Not for the step: solves on this
  /// thread or, while a worker is at it, waits for that one. Throws std::bad_alloc when memory runs out.
  void work_through(const ContactCompliance& user, const NeedleWhereabouts& needle, const Settings& settings);

  // --- The worker's side.

  /// A worker begins, or ends, while no step is under way.
  void open(const Settings& settings);
  void close();

  enum class Work {
    waiting,  ///< a step has to come first
    idle,     ///< nothing is wanted
    full,     ///< something is wanted, but nothing can be given up for it
    done,     ///< rows are on their way
    failed    ///< memory, or threads, ran out; nothing has changed
  };
  /// One round. One thread at a time.
  /// @param most nodes solved for at once
  Work work(std::size_t most) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet
