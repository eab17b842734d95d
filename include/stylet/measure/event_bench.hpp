// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <string>
#include <vector>

namespace stylet::measure {

/// Median and spread of many times [µs] of processor time.
struct Spread {
  double p5 = 0.0;
  double p50 = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};

/// What laying a contact costs on one mesh: all that the loop does for it, from the search of its element to the last
/// compliance that the next step reads.
struct EventRow {
  Index nodes = 0;
  std::string rule;  ///< interior, paper: node addition; near-field: the default, no node
  int points = 0;    ///< held when the way is done; the same on every mesh
  long events = 0;   ///< measured
  Spread warm_us;    ///< one event after the other
  Spread cold_us;    ///< everything else has been through the caches between two
};

struct EventBench {
  std::vector<EventRow> rows;
  Index woodbury_nodes = 0;  ///< of the smallest mesh, on which the full inverse is changed
  Spread woodbury_us;        ///< search, ΔK, and all of K⁻¹ by the matrix inversion lemma on one triangle
  Spread woodbury_cold_us;   ///< the same with nothing of it in the caches

  /// The row of a rule on the smallest or the largest mesh; null where there is none.
  [[nodiscard]] const EventRow* coarsest(const std::string& rule) const;
  [[nodiscard]] const EventRow* finest(const std::string& rule) const;
};

struct EventBenchOptions {
  Index largest = 20000;  ///< meshes with more nodes are left out
  int turns = 25;         ///< in each the whole way is gone several times by one rule, then by the next
  int cold_turns = 4;     ///< emptying the caches takes long
};

/// The demo patient on meshes of 570, 5,000 and 20,000 nodes; contacts are laid along the demo's
/// way by node addition with both rules, and with the near field, as a step does it.
/// Errors: failed, where nodes can be added nowhere on the way.
Result<EventBench> bench_events(const EventBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
