// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/probe_section.hpp"

#include "report/html_parts.hpp"

namespace stylet::results {

std::string probe_section(const ProbeReport& report) {
  std::string facts;
  for (const ProbeFact& fact : probe_facts(report)) facts += definition(fact.name, fact.text);
  return "<section aria-labelledby=\"probe\"><h2 id=\"probe\">The ultrasound probe</h2><p>The probe presses the rectal "
         "wall without friction, and the wall presses the gland. The needle’s forces and motions on this page are "
         "those "
         "in the tissue as it was drawn; what the probe does comes on top of them.</p><dl>" +
         facts + "</dl></section>";
}

}  // namespace stylet::results
