// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/implant_results.hpp"

#include <string>

namespace stylet::results {

/// The section of the page about the seeds that were found on images, as HTML; empty where none were given.
std::string found_section(const ImplantOutcome& outcome);

}  // namespace stylet::results
