// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet_rt/handles.hpp"

#include <memory>

namespace stylet::test {

/// Releases what the C interface has made.
struct Free {
  void operator()(stylet_rt_model* model) const { stylet_rt_model_destroy(model); }
  void operator()(stylet_rt_sim* sim) const { stylet_rt_sim_destroy(sim); }
  void operator()(stylet_rt_display* display) const { stylet_rt_display_destroy(display); }
};
using ModelHandle = std::unique_ptr<stylet_rt_model, Free>;
using SimHandle = std::unique_ptr<stylet_rt_sim, Free>;
using DisplayHandle = std::unique_ptr<stylet_rt_display, Free>;

}  // namespace stylet::test
