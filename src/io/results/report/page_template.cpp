// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/page_template.hpp"

#include "report/text.hpp"
#include "stylet/core/version.hpp"

#include <fmt/format.h>

namespace stylet::results {

Result<std::string> fill_page(std::string_view page, const Slots& slots, const std::string& name) {
  std::string filled;
  for (;;) {
    const std::size_t open = page.find("{{");
    if (open == std::string_view::npos) return filled += page;
    const std::size_t close = page.find("}}", open);
    const std::string_view slot_name =
        page.substr(open + 2, close == std::string_view::npos ? close : close - open - 2);
    const auto slot = slots.find(slot_name);
    if (close == std::string_view::npos || slot == slots.end()) {
      return failure(name, fmt::format("its template has an unknown slot '{}'", slot_name),
                     "Build the program again: it was built from files that do not belong together");
    }
    filled += page.substr(0, open);
    filled += slot->second;
    page.remove_prefix(close + 2);
  }
}

Result<std::string> whole_page(const PageAssets& page, Slots slots, const std::string& name) {
  Result<std::string> body = fill_page(page.body, slots, name);
  if (!body) return body;
  slots["body"] = *std::move(body);
  slots["css"] = std::string(page.css) + slots["more_css"];
  slots["js"] = script_safe(page.js);
  slots["version"] = html_escaped(version());
  slots.try_emplace("versions", "Stylet " + slots["version"]);
  slots.try_emplace("heading", slots["title"]);
  slots.try_emplace("kind", "computer simulation");
  slots.try_emplace("no_script");
  slots.try_emplace("more_data");
  return fill_page(page_shell(), slots, name);
}

}  // namespace stylet::results
