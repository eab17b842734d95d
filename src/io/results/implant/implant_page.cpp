// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/implant_page.hpp"

namespace stylet::results {

Result<std::string> implant_page(const ImplantOutcome& outcome) { return "<p>" + outcome.scenario.name; }

}  // namespace stylet::results
