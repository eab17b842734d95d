// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/probe/patient_probe.hpp"

#include <string>

namespace stylet::results {

/// The report's section about the ultrasound probe, as HTML.
std::string probe_section(const ProbeReport& report);

}  // namespace stylet::results
