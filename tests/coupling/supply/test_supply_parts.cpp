// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of the compliance supply: the worker's ledger, the rows it makes, the rows the step takes over, and the
// hand-over of the parcel.
#include "coupling/needle_in_block.hpp"
#include "coupling/supply/hand_over.hpp"
#include "coupling/supply/row_ledger.hpp"
#include "coupling/supply/row_maker.hpp"
#include "coupling/supply/row_receiver.hpp"
#include "stylet/coupling/track_compliance.hpp"

#include <gtest/gtest.h>

#include <set>

namespace stylet {
namespace {

using Work = ComplianceSupply::Work;

/// A block of tissue without a needle, and an empty store.
struct EmptyBlock : test::NeedleInBlock {
  EmptyBlock() : nodes(tissue->displacement_nodes()), empty(std::make_shared<ComplianceStore>(tissue)) {}

  /// The first nodes that are not held.
  [[nodiscard]] std::vector<Index> free_nodes(std::size_t count) const {
    std::vector<Index> result;
    for (Index node = 0; result.size() < count; ++node) {
      if (!tissue->is_fixed(node)) result.push_back(node);
    }
    return result;
  }
  [[nodiscard]] NeedleWhereabouts in_the_middle() const {
    const Vec3 x(1, 2, 30);
    return {x, Vec3::UnitZ(), locator->find(x)->tet};
  }

  Index nodes;
  std::shared_ptr<ComplianceStore> empty;
};

/// Rows without meaningful values, in the next slots of the ledger.
std::vector<ComplianceRow> rows_for(const RowLedger& ledger, std::span<const Index> nodes) {
  std::vector<ComplianceRow> rows(nodes.size());
  const auto slots = ledger.next_slots(nodes.size());
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    rows[k].node = nodes[k];
    rows[k].slot = slots[k];
  }
  return rows;
}

TEST(RowLedger, has_as_many_free_slots_as_are_to_spare) {
  EmptyBlock block;
  RowLedger ledger(block.nodes);
  ledger.read(*block.empty, 10);
  EXPECT_EQ(ledger.free_slots(), 10u);
  const std::vector<Index> nodes = block.free_nodes(4);
  ledger.record(rows_for(ledger, nodes), {});
  EXPECT_EQ(ledger.free_slots(), 6u);
  for (const Index node : nodes) EXPECT_TRUE(ledger.has_row(node));
}

TEST(RowLedger, gets_back_what_the_step_gives_up_and_does_not_ask_again_for_what_it_keeps) {
  EmptyBlock block;
  RowLedger ledger(block.nodes);
  ledger.read(*block.empty, 3);
  const std::vector<Index> nodes = block.free_nodes(3);
  ledger.record(rows_for(ledger, nodes), {});
  ledger.begin_round();
  ASSERT_EQ(ledger.dispensable({}).size(), 3u);
  EXPECT_EQ(ledger.dispensable(std::span(nodes).first(1)).size(), 2u) << "one is wanted";

  const Index slot = ledger.slots().slot(nodes[0]);
  ledger.note({.node = nodes[0], .slot = slot, .left = true, .row = {}, .kernel = nullptr});
  EXPECT_FALSE(ledger.has_row(nodes[0]));
  EXPECT_EQ(ledger.free_slots(), 1u);
  ledger.note({.node = nodes[1], .slot = ledger.slots().slot(nodes[1]), .left = false, .row = {}, .kernel = nullptr});
  EXPECT_TRUE(ledger.has_row(nodes[1]));
  EXPECT_EQ(ledger.dispensable({}).size(), 1u);
  for (int round = 0; round < 200; ++round) ledger.begin_round();
  EXPECT_EQ(ledger.dispensable({}).size(), 2u) << "contacts may have left it by now";
}

TEST(RowMaker, makes_the_rows_that_a_needle_is_about_to_need_and_then_no_more) {
  EmptyBlock block;
  RowMaker maker(block.tissue, block.empty, nullptr, *block.locator);
  RowReceiver receiver(block.nodes, block.empty, nullptr);
  const TrackCompliance user(block.empty, *block.locator, 2);
  SupplyParcel parcel;
  maker.begin({.radius_mm = 8.0, .ahead_mm = 4.0, .spare_nodes = 500}, parcel, false);
  parcel.needle = block.in_the_middle();
  std::set<Index> made;
  Work work = Work::done;
  for (int round = 0; round < 500 && work == Work::done; ++round) {
    work = maker.make(parcel, 8, false);
    EXPECT_LE(parcel.rows.size(), 8u);
    for (const ComplianceRow& row : parcel.rows) EXPECT_TRUE(made.insert(row.node).second) << "each once";
    receiver.receive(parcel, user);
  }
  EXPECT_EQ(work, Work::idle);
  ASSERT_FALSE(made.empty());
  for (const Index node : made) EXPECT_TRUE(block.empty->has(node));
  for (const Index node : block.tissue->mesh().tets[static_cast<std::size_t>(parcel.needle.tet)])
    EXPECT_TRUE(block.empty->has(node)) << "where the tip is";
}

TEST(RowMaker, asks_for_the_furthest_slots_where_none_is_free) {
  constexpr Index kRoom = 40;  // enough for one place of the tip, not for five
  EmptyBlock block;
  RowMaker maker(block.tissue, block.empty, nullptr, *block.locator);
  RowReceiver receiver(block.nodes, block.empty, nullptr);
  const TrackCompliance user(block.empty, *block.locator, 2);
  SupplyParcel parcel;
  maker.begin({.radius_mm = 1.0, .ahead_mm = 0.0, .spare_nodes = kRoom}, parcel, false);
  Work work = Work::done;
  for (const double depth : {15.0, 30.0, 45.0, 60.0, 75.0}) {
    const Vec3 x(1, 2, depth);
    parcel.needle = {x, Vec3::UnitZ(), block.locator->find(x)->tet};
    for (int round = 0; round < 50 && work != Work::idle && work != Work::full; ++round) {
      work = maker.make(parcel, 8, false);
      receiver.receive(parcel, user);
    }
    for (const Index node : block.tissue->mesh().tets[static_cast<std::size_t>(parcel.needle.tet)])
      EXPECT_TRUE(block.empty->has(node)) << depth;
    EXPECT_LE(block.empty->stored_nodes(), kRoom);
    work = Work::done;
  }
}

TEST(RowReceiver, keeps_the_rows_that_a_contact_needs) {
  EmptyBlock block;
  const std::vector<Index> tet_nodes = [&] {
    const auto& tet = block.tissue->mesh().tets[static_cast<std::size_t>(block.in_the_middle().tet)];
    return std::vector<Index>(tet.begin(), tet.end());
  }();
  std::vector<Index> nodes = tet_nodes;
  const Index other = [&] {
    for (Index node = 0;; ++node) {
      if (!block.tissue->is_fixed(node) && std::find(nodes.begin(), nodes.end(), node) == nodes.end()) return node;
    }
  }();
  nodes.push_back(other);
  block.empty->add_nodes(nodes);
  TrackCompliance user(block.empty, *block.locator, 2);
  const Vec3 x = block.in_the_middle().tip;
  ASSERT_TRUE(user.move_tip(*block.locator->find(x), x));
  SupplyParcel parcel;
  for (const Index node : {tet_nodes[0], other})
    parcel.leavers.push_back({node, block.empty->slots().slot(node), false, {}, nullptr});
  RowReceiver receiver(block.nodes, block.empty, nullptr);
  receiver.receive(parcel, user);
  EXPECT_FALSE(parcel.leavers[0].left);
  EXPECT_TRUE(parcel.leavers[1].left);
  EXPECT_TRUE(block.empty->has(tet_nodes[0]));
  EXPECT_FALSE(block.empty->has(other));
}

TEST(SupplyHandOver, goes_to_and_fro) {
  SupplyHandOver hand_over;
  EXPECT_TRUE(hand_over.with_step());
  hand_over.give_to_worker({.tip = Vec3(1, 2, 3), .direction = Vec3::UnitZ(), .tet = 7});
  EXPECT_TRUE(hand_over.with_worker());
  EXPECT_EQ(hand_over.parcel().needle.tet, 7);
  hand_over.give_to_step(Work::done);
  EXPECT_TRUE(hand_over.with_step());
  EXPECT_FALSE(hand_over.failed());
}

TEST(SupplyHandOver, a_call_is_answered_by_a_round_that_knew_of_it_and_found_no_more_work) {
  SupplyHandOver hand_over;
  hand_over.give_to_worker({});
  hand_over.call();
  hand_over.give_to_step(Work::idle);
  EXPECT_FALSE(hand_over.answered()) << "that round did not know of the call";
  hand_over.give_to_worker({});
  hand_over.give_to_step(Work::done);
  EXPECT_FALSE(hand_over.answered()) << "there may be more to do";
  hand_over.give_to_worker({});
  hand_over.give_to_step(Work::failed);
  EXPECT_TRUE(hand_over.answered());
  EXPECT_TRUE(hand_over.failed());
}

}  // namespace
}  // namespace stylet
