// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/springs.hpp"

#include "needle/rod_chain_parts.hpp"

namespace stylet {

Result<std::unique_ptr<SpringsNeedle>> SpringsNeedle::build(const NeedleSection& section, int rods, int load_capacity) {
  if (const Result<> checked = check_needle(section, rods, load_capacity); !checked) return checked.error();
  auto parts = std::make_unique<Parts>(section, rods, load_capacity, beam::ElementKind::rod);
  return std::unique_ptr<SpringsNeedle>(new SpringsNeedle(std::move(parts)));
}

}  // namespace stylet
