// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/compliance_supply.hpp"

#include "nodes_ahead.hpp"
#include "stylet/core/parallel.hpp"

#include <algorithm>
#include <chrono>
#include <new>
#include <thread>

namespace stylet {
namespace {

constexpr std::size_t kAtOnce = 64;        ///< nodes solved for together where nobody waits for the first
constexpr unsigned kRefused_rounds = 100;  ///< a node that a contact needs is not asked for again so soon
constexpr auto kLook = std::chrono::microseconds(200);

/// What the two sides pass to and fro.
struct Parcel {
  /// A slot that the worker would like to have.
  struct Leaver {
    Index node = -1;
    Index slot = -1;
    bool left = false;
    ComplianceRow row;  ///< what was in it, to be freed
    std::shared_ptr<const MeshKernel::Row> kernel;
  };
  struct KernelRow {
    Index node = -1;
    std::shared_ptr<const MeshKernel::Row> row;
  };
  NeedleWhereabouts needle;
  unsigned call = 0;  ///< of work_through()
  std::vector<Leaver> leavers;
  std::vector<ComplianceRow> rows;
  std::vector<KernelRow> kernel_rows;
};

}  // namespace

struct ComplianceSupply::Parts {
  std::shared_ptr<const Tissue> tissue;
  std::shared_ptr<ComplianceStore> store;
  std::shared_ptr<MeshKernel> kernel;

  Parcel parcel;                          ///< belongs to …
  std::atomic<bool> with_worker = false;  ///< … this side
  std::atomic<bool> open = false;
  std::atomic<bool> failed = false;    ///< the last round
  std::atomic<unsigned> answered = 0;  ///< last call after which nothing more was to be done

  // The step's side.
  unsigned call = 0;
  std::vector<unsigned> stamps;  ///< (displacement nodes) equal to stamp: a contact needs it
  unsigned stamp = 0;

  // The worker's side: what it knows of store and kernel.
  Settings settings;
  NodesAhead ahead;
  NodeSlots slots;
  std::vector<char> has_kernel;         ///< (displacement nodes)
  std::vector<Index> free;              ///< slots
  std::vector<Index> own;               ///< slots that were filled by this supply
  std::vector<unsigned> refused_until;  ///< (displacement nodes) round
  unsigned round = 0;

  Parts(std::shared_ptr<const Tissue> tissue_, std::shared_ptr<ComplianceStore> store_,
        std::shared_ptr<MeshKernel> kernel_, const Locator& locator)
      : tissue(std::move(tissue_)),
        store(std::move(store_)),
        kernel(std::move(kernel_)),
        stamps(static_cast<std::size_t>(tissue->displacement_nodes()), 0),
        ahead(tissue, locator),
        slots(tissue->displacement_nodes()),
        has_kernel(stamps.size(), 0),
        refused_until(stamps.size(), 0) {}

  void look_around();
  void note_what_came_back();
  void ask_for_slots(std::size_t count, const std::vector<Index>& wanted);
  Work go(std::size_t most);

  [[nodiscard]] bool needs_row(Index node) const {
    return store != nullptr && !slots.has(node) && !tissue->is_fixed(node);
  }
  [[nodiscard]] bool needs_kernel(Index node) const {
    return kernel != nullptr && has_kernel[static_cast<std::size_t>(node)] == 0;
  }
};

/// Store and kernel as they are, which nobody may be changing: nodes may have come by add_nodes().
void ComplianceSupply::Parts::look_around() {
  if (with_worker) {
    note_what_came_back();
  } else if (!parcel.rows.empty()) {  // a worker stopped before the step took them
    parcel.rows.clear();
    parcel.kernel_rows.clear();
  }
  if (kernel) {
    for (std::size_t node = 0; node < has_kernel.size(); ++node)
      has_kernel[node] = kernel->has(static_cast<Index>(node)) ? 1 : 0;
  }
  if (!store) return;
  std::erase_if(own, [&](Index slot) { return store->slots().node(slot) < 0; });
  const auto most = static_cast<std::size_t>(settings.spare_nodes);
  const std::size_t room = most - std::min(own.size(), most);
  const auto find_free = [&] {
    free.clear();
    for (Index slot = 0; slot < store->slots().count() && free.size() < room; ++slot) {
      if (store->slots().node(slot) < 0) free.push_back(slot);
    }
  };
  find_free();
  if (free.size() < room) {
    store->reserve(static_cast<Index>(room - free.size()));
    find_free();
  }
  slots = store->slots();
}

void ComplianceSupply::Parts::note_what_came_back() {
  for (const Parcel::Leaver& leaver : parcel.leavers) {
    const auto node = static_cast<std::size_t>(leaver.node);
    if (!leaver.left) {
      refused_until[node] = round + kRefused_rounds;
      continue;
    }
    slots.vacate(leaver.slot);
    has_kernel[node] = 0;
    free.push_back(leaver.slot);
    own.erase(std::find(own.begin(), own.end(), leaver.slot));
  }
  parcel.leavers.clear();
  parcel.rows.clear();
  parcel.kernel_rows.clear();
}

/// Those whose nodes are furthest from the tip.
void ComplianceSupply::Parts::ask_for_slots(std::size_t count, const std::vector<Index>& wanted) {
  std::vector<std::pair<double, Index>> far;
  for (const Index slot : own) {
    const Index node = slots.node(slot);
    if (refused_until[static_cast<std::size_t>(node)] > round) continue;
    if (std::find(wanted.begin(), wanted.end(), node) != wanted.end()) continue;
    far.emplace_back(-(tissue->node_position(node) - parcel.needle.tip).squaredNorm(), slot);
  }
  count = std::min(count, far.size());
  std::partial_sort(far.begin(), far.begin() + static_cast<std::ptrdiff_t>(count), far.end());
  for (std::size_t k = 0; k < count; ++k)
    parcel.leavers.push_back({slots.node(far[k].second), far[k].second, false, {}, nullptr});
}

ComplianceSupply::Work ComplianceSupply::Parts::go(std::size_t most) {
  note_what_came_back();
  ++round;
  const std::vector<Index>& wanted = ahead.find(parcel.needle, settings.radius_mm, settings.ahead_mm);
  std::vector<Index> rows;
  std::vector<Index> kernel_rows;
  std::size_t without_room = 0;
  for (std::size_t k = 0; k < wanted.size() && std::max(rows.size(), kernel_rows.size()) < most; ++k) {
    const Index node = wanted[k];
    if (needs_row(node)) {
      if (rows.size() == free.size()) {
        if (++without_room == most) break;
        continue;
      }
      rows.push_back(node);
    }
    if (needs_kernel(node)) kernel_rows.push_back(node);
  }
  if (without_room > 0) ask_for_slots(2 * most, wanted);
  if (rows.empty() && kernel_rows.empty()) {
    if (!parcel.leavers.empty()) return Work::waiting;
    return without_room > 0 ? Work::full : Work::idle;
  }

  if (!rows.empty()) {
    const std::span<const Index> places = std::span(free).last(rows.size());
    parcel.rows = solve_rows(*tissue, slots, rows, places);
  }
  parcel.kernel_rows.resize(kernel_rows.size());
  const auto make = [&](std::size_t k) { parcel.kernel_rows[k] = {kernel_rows[k], kernel->make_row(kernel_rows[k])}; };
  if (open.load(std::memory_order_relaxed)) {  // the cores are not all ours
    for (std::size_t k = 0; k < kernel_rows.size(); ++k) make(k);
  } else {
    for_each_in_parallel(kernel_rows.size(), make);
  }
  own.reserve(own.size() + rows.size());  // from here on nothing can fail
  for (const ComplianceRow& row : parcel.rows) {
    slots.occupy(row.slot, row.node);
    own.push_back(row.slot);
  }
  free.resize(free.size() - rows.size());
  for (const Index node : kernel_rows) has_kernel[static_cast<std::size_t>(node)] = 1;
  return Work::done;
}

ComplianceSupply::ComplianceSupply(std::shared_ptr<const Tissue> tissue, std::shared_ptr<ComplianceStore> store,
                                   std::shared_ptr<MeshKernel> kernel, const Locator& locator)
    : parts_(std::make_unique<Parts>(std::move(tissue), std::move(store), std::move(kernel), locator)) {}
ComplianceSupply::~ComplianceSupply() = default;

bool ComplianceSupply::awaits_step() const noexcept { return !parts_->with_worker.load(std::memory_order_acquire); }

void ComplianceSupply::serve(const ContactCompliance& user, const NeedleWhereabouts& needle) noexcept {
  Parts& p = *parts_;
  if (!awaits_step()) return;
  if (!p.parcel.leavers.empty()) {
    user.mark_nodes(p.stamps, ++p.stamp);
    for (Parcel::Leaver& leaver : p.parcel.leavers) {
      leaver.left = p.stamps[static_cast<std::size_t>(leaver.node)] != p.stamp;
      if (!leaver.left) continue;
      p.store->release(leaver.slot, leaver.row);
      if (p.kernel) p.kernel->exchange(leaver.node, leaver.kernel);
    }
  }
  for (ComplianceRow& row : p.parcel.rows) p.store->take(row);
  for (Parcel::KernelRow& fresh : p.parcel.kernel_rows) p.kernel->exchange(fresh.node, fresh.row);
  p.parcel.needle = needle;
  p.parcel.call = p.call;
  p.with_worker.store(true, std::memory_order_release);
}

ComplianceSupply::Work ComplianceSupply::work(std::size_t most) noexcept {
  Parts& p = *parts_;
  if (!p.with_worker.load(std::memory_order_acquire)) return Work::waiting;
  Work done = Work::failed;
  try {
    done = p.go(most);
  } catch (...) {  // memory, or threads, ran out
    p.parcel.leavers.clear();
    p.parcel.rows.clear();
    p.parcel.kernel_rows.clear();
  }
  const unsigned call = p.parcel.call;
  p.failed.store(done == Work::failed, std::memory_order_relaxed);
  if (done != Work::done && done != Work::waiting) p.answered.store(call, std::memory_order_release);
  p.with_worker.store(false, std::memory_order_release);
  return done;
}

void ComplianceSupply::work_through(const ContactCompliance& user, const NeedleWhereabouts& needle,
                                    const Settings& settings) {
  Parts& p = *parts_;
  if (p.open.load(std::memory_order_acquire)) {
    ++p.call;
    while (p.answered.load(std::memory_order_acquire) != p.call && p.open.load(std::memory_order_acquire)) {
      serve(user, needle);
      std::this_thread::sleep_for(kLook);
    }
    if (p.failed.load(std::memory_order_relaxed)) throw std::bad_alloc();
    return;
  }
  serve(user, needle);  // nothing stays under way
  p.settings = settings;
  p.look_around();
  while (true) {
    p.parcel.needle = needle;
    const Work done = work(kAtOnce);
    if (done == Work::failed) throw std::bad_alloc();
    if (done == Work::idle || done == Work::full) return;
    serve(user, needle);
  }
}

void ComplianceSupply::open(const Settings& settings) {
  Parts& p = *parts_;
  p.settings = settings;
  p.look_around();
  p.open.store(true, std::memory_order_release);
}

void ComplianceSupply::close() { parts_->open.store(false, std::memory_order_release); }

}  // namespace stylet
