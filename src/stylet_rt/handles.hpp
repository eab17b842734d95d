// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/realtime/compliance_worker.hpp"
#include "stylet/sim/simulation.hpp"
#include "stylet/stylet_rt.h"

#include <memory>
#include <vector>

struct stylet_rt_model {
  std::shared_ptr<const stylet::Model> model;
};

struct stylet_rt_sim {
  stylet_rt_sim(std::shared_ptr<const stylet::Model> model_, std::uint32_t flags_, int needles);

  /// Starts the thread of STYLET_RT_WORKER, if it is asked for.
  void start_worker();

  std::shared_ptr<const stylet::Model> model;
  stylet::Simulation simulation;
  std::uint32_t flags = 0;                           ///< of stylet_rt_options
  std::vector<std::size_t> insertions;               ///< (needles) at whose start each needle was last placed
  std::vector<stylet::ContactState> contacts;        ///< scratch
  std::unique_ptr<stylet::ComplianceWorker> worker;  ///< only with STYLET_RT_WORKER
};

namespace stylet::rt {

/// A new handle for an existing model.
stylet_rt_model* make_handle(std::shared_ptr<const Model> model);

}  // namespace stylet::rt
