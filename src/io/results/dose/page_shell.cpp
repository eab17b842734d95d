// SPDX-License-Identifier: GPL-3.0-or-later
#include "dose/page_shell.hpp"

#include "report/assets.hpp"
#include "report/text.hpp"
#include "stylet/core/version.hpp"

#include <fmt/format.h>

namespace stylet::results {

Result<std::string> page_about_dose(std::string_view body, Slots slots) {
  constexpr const char* kName = "report.html";
  Result<std::string> filled = fill_page(body, slots, kName);
  if (!filled) return filled;
  slots["body"] = *std::move(filled);
  slots["version"] = html_escaped(version());
  slots["versions"] = html_escaped(fmt::format("Stylet {}", version()));
  return fill_page(dose_shell(), slots, kName);
}

}  // namespace stylet::results
