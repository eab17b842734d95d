// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/progress.hpp"
#include "stylet/core/result.hpp"
#include "stylet/core/types.hpp"

#include <string>
#include <vector>

namespace stylet::measure {

/// Quantiles of processor times [µs].
struct Spread {
  double p5 = 0.0;
  double p50 = 0.0;
  double p95 = 0.0;
  double max = 0.0;
};

/// Processor time of laying a contact on one mesh: all work of the loop for it, from the search of its element to the
/// last entry of the compliance that the next step reads.
struct EventRow {
  Index nodes = 0;
  std::string rule;  ///< "interior" or "paper": node addition by this rule; "near-field": the default, adds no node
  int points = 0;    ///< number of points held at the end of the way; the same on every mesh
  long events = 0;   ///< number of timed events
  Spread warm_us;    ///< events timed directly one after the other
  Spread cold_us;    ///< events timed with the processor's caches emptied before each
};

struct EventBench {
  std::vector<EventRow> rows;
  Index woodbury_nodes = 0;  ///< nodes of the smallest mesh, on which the full inverse is updated
  Spread woodbury_us;        ///< search, ΔK, and update of K⁻¹ by the matrix inversion lemma on one triangle
  Spread woodbury_cold_us;   ///< the same with the caches emptied before each event

  /// The row of a rule on the smallest or the largest mesh; null where there is none.
  [[nodiscard]] const EventRow* coarsest(const std::string& rule) const;
  [[nodiscard]] const EventRow* finest(const std::string& rule) const;
};

struct EventBenchOptions {
  Index largest = 20000;  ///< meshes with more nodes are left out
  int turns = 25;         ///< turns with warm caches; in each, every rule follows the whole way several times
  int cold_turns = 4;     ///< turns with cold caches; few, because emptying the caches takes long
};

/// Times the laying of contacts in the demo patient on meshes of 570, 5,000 and 20,000 nodes. Contacts are laid along
/// the demo's way by node addition with both rules, and with the near field, as a step does it. Errors: failed, if no
/// node can be added anywhere on the way.
Result<EventBench> bench_events(const EventBenchOptions& options, const Progress& progress = {});

}  // namespace stylet::measure
