// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/io/implant_results.hpp"

#include <string>

/// The sections of the page about the same implant under another choice, as HTML.
namespace stylet::results {

/// Before and after the needles were aimed to make up for the errors; empty where they were not.
std::string compensation_section(const ImplantOutcome& outcome);

/// In firm, typical and soft tissue; empty where a span was not asked for.
std::string span_section(const ImplantOutcome& outcome);

}  // namespace stylet::results
