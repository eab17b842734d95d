// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/coupling/compliance_supply.hpp"

#include "coupling/supply/hand_over.hpp"
#include "coupling/supply/row_maker.hpp"
#include "coupling/supply/row_receiver.hpp"

#include <chrono>
#include <new>
#include <thread>

namespace stylet {
namespace {

/// Nodes solved for at once when a caller waits for all of them. Raised, each node costs less and memory grows.
constexpr std::size_t kAtOnce = 64;
/// Time between two checks for a worker's answer. Raised, prepare() returns later after the answer.
constexpr auto kLook = std::chrono::microseconds(200);

}  // namespace

/// Each side uses only its own members, and the parcel in `hand_over` only while it has the parcel.
struct ComplianceSupply::Parts {
  SupplyHandOver hand_over;
  RowReceiver receiver;  ///< for the step's side
  RowMaker maker;        ///< for the worker's side
};

ComplianceSupply::ComplianceSupply(std::shared_ptr<const Tissue> tissue, std::shared_ptr<ComplianceStore> store,
                                   std::shared_ptr<MeshKernel> kernel, const Locator& locator)
    : parts_(new Parts{.hand_over = {},
                       .receiver = {tissue->displacement_nodes(), store, kernel},
                       .maker = {tissue, store, kernel, locator}}) {}
ComplianceSupply::~ComplianceSupply() = default;

bool ComplianceSupply::awaits_step() const noexcept { return parts_->hand_over.with_step(); }

void ComplianceSupply::serve(const ContactCompliance& user, const NeedleWhereabouts& needle) noexcept {
  Parts& p = *parts_;
  if (!p.hand_over.with_step()) return;
  p.receiver.receive(p.hand_over.parcel(), user);
  p.hand_over.give_to_worker(needle);
}

ComplianceSupply::Work ComplianceSupply::work(std::size_t most) noexcept {
  Parts& p = *parts_;
  if (!p.hand_over.with_worker()) return Work::waiting;
  Work done = Work::failed;
  try {
    done = p.maker.make(p.hand_over.parcel(), most, p.hand_over.is_open());
  } catch (...) {  // memory or threads ran out
    p.hand_over.parcel().clear();
  }
  p.hand_over.give_to_step(done);
  return done;
}

void ComplianceSupply::work_through(const ContactCompliance& user, const NeedleWhereabouts& needle,
                                    const Settings& settings) {
  SupplyHandOver& hand_over = parts_->hand_over;
  if (hand_over.is_open()) {
    hand_over.call();
    while (!hand_over.answered() && hand_over.is_open()) {
      serve(user, needle);
      std::this_thread::sleep_for(kLook);
    }
    if (hand_over.failed()) throw std::bad_alloc();
    return;
  }
  serve(user, needle);  // so that the parcel's rows are not lost
  parts_->maker.begin(settings, hand_over.parcel(), hand_over.with_worker());
  while (true) {
    hand_over.parcel().needle = needle;
    const Work done = work(kAtOnce);
    if (done == Work::failed) throw std::bad_alloc();
    if (done == Work::idle || done == Work::full) return;
    serve(user, needle);
  }
}

void ComplianceSupply::open(const Settings& settings) {
  Parts& p = *parts_;
  p.maker.begin(settings, p.hand_over.parcel(), p.hand_over.with_worker());
  p.hand_over.open();
}

void ComplianceSupply::close() { parts_->hand_over.close(); }

}  // namespace stylet
