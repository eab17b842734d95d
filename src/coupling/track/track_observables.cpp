// SPDX-License-Identifier: GPL-3.0-or-later
#include "coupling/track/track_observables.hpp"

#include "core/dense_kernels.hpp"

#include <algorithm>

namespace stylet {

TrackObservables::TrackObservables(std::shared_ptr<const ComplianceStore> store, int capacity, int most_loads)
    : store_(std::move(store)) {
  const auto most = static_cast<std::size_t>(capacity + kFirstFree);
  observables_.reserve(most);
  vertex_of_.reserve(most);
  nodes_.reserve(most * kMostElementNodes);
  field_.resize(most * kMostElementNodes);
  blocks_.resize(static_cast<std::size_t>(most_loads));
  reset();
}

void TrackObservables::reset() {
  observables_.assign(static_cast<std::size_t>(kFirstFree), Observable{});
  vertex_of_.assign(static_cast<std::size_t>(kFirstFree), -1);
  nodes_.clear();
}

int TrackObservables::add(const Shape& shape, Index vertex) {
  Observable o{.shape = shape, .nodes_before = nodes_.size()};
  for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i) {
    // Backwards, because the nodes that were added last belong to elements nearby.
    const auto found = std::find(nodes_.rbegin(), nodes_.rend(), shape.node[i]);
    o.number[i] = static_cast<int>(nodes_.rend() - found) - 1;
    if (found != nodes_.rend()) continue;
    o.number[i] = static_cast<int>(nodes_.size());
    nodes_.push_back(shape.node[i]);
  }
  observables_.push_back(o);
  vertex_of_.push_back(vertex);
  return count() - 1;
}

void TrackObservables::remove_last() {
  assert(count() > kFirstFree);
  nodes_.resize(observables_.back().nodes_before);
  observables_.pop_back();
  vertex_of_.pop_back();
}

int TrackObservables::find(Index vertex) const {
  const auto found = std::find(vertex_of_.begin() + kFirstFree, vertex_of_.end(), vertex);
  return found == vertex_of_.end() ? -1 : static_cast<int>(found - vertex_of_.begin());
}

Mat3 TrackObservables::compliance(int a, int b) const {
  const Shape& at = shape(a);
  const Shape& on = shape(b);
  Mat3 sum = Mat3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(at.count); ++i) {
    if (at.weight[i] == 0.0) continue;
    for (std::size_t j = 0; j < static_cast<std::size_t>(on.count); ++j) {
      if (on.weight[j] == 0.0) continue;
      sum += (at.weight[i] * on.weight[j]) * store_->block(at.node[i], on.node[j]);
    }
  }
  return sum;
}

Mat3 TrackObservables::node_moved_by(const NodeLoads& loads, Index node) {
  for (std::size_t k = 0; k < loads.nodes.size(); ++k) blocks_[k] = store_->block(node, loads.nodes[k]);
  return dense::sum_of_products(std::span(blocks_).first(loads.nodes.size()), loads.blocks);
}

Mat3 TrackObservables::moved_by(const NodeLoads& loads, int observable) {
  const Shape& at = shape(observable);
  Mat3 sum = Mat3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(at.count); ++i) {
    if (at.weight[i] != 0.0) sum += at.weight[i] * node_moved_by(loads, at.node[i]);
  }
  return sum;
}

void TrackObservables::load(const NodeLoads& loads) {
  for (std::size_t m = 0; m < nodes_.size(); ++m) field_[m] = node_moved_by(loads, nodes_[m]);
}

void TrackObservables::load(int observable) {
  const Shape& on = shape(observable);
  for (std::size_t m = 0; m < nodes_.size(); ++m) {
    field_[m].setZero();
    for (std::size_t i = 0; i < static_cast<std::size_t>(on.count); ++i) {
      if (on.weight[i] != 0.0) field_[m] += on.weight[i] * store_->block(nodes_[m], on.node[i]);
    }
  }
}

Mat3 TrackObservables::at(int observable) const {
  assert(observable >= kFirstFree);
  const Observable& o = observables_[static_cast<std::size_t>(observable)];
  Mat3 sum = Mat3::Zero();
  for (std::size_t i = 0; i < static_cast<std::size_t>(o.shape.count); ++i)
    sum += o.shape.weight[i] * field_[static_cast<std::size_t>(o.number[i])];
  return sum;
}

void TrackObservables::mark_nodes(std::span<unsigned> stamps, unsigned stamp) const {
  for (const Observable& observable : observables_) {
    for (int i = 0; i < observable.shape.count; ++i)
      stamps[static_cast<std::size_t>(observable.shape.node[static_cast<std::size_t>(i)])] = stamp;
  }
}

}  // namespace stylet
