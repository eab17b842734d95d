// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/dose/dose_plan.hpp"
#include "stylet/sim/scenario.hpp"

#include <string>

/// Assumptions of a simulated implant, as pairs of name and value.
namespace stylet::results {

/// Technique, speeds, pause, order and plug.
std::string procedure_facts(const Scenario& scenario, Implant implant = Implant::permanent);

/// Stranding, release and loss of seeds, and the swelling of the gland.
std::string seed_facts(const Scenario& scenario, Implant implant = Implant::permanent);

/// Tissue, needle and mesh. @param nodes of the mesh
std::string tissue_facts(const Scenario& scenario, int nodes);

}  // namespace stylet::results
