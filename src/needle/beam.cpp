// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/needle/beam.hpp"

#include "needle/rod_chain_parts.hpp"

namespace stylet {

Result<std::unique_ptr<BeamNeedle>> BeamNeedle::build(const NeedleSection& section, int elements, int load_capacity) {
  if (const Result<> checked = check_needle(section, elements, load_capacity); !checked) return checked.error();
  auto parts = std::make_unique<Parts>(section, elements, load_capacity, beam::ElementKind::arc);
  return std::unique_ptr<BeamNeedle>(new BeamNeedle(std::move(parts)));
}

}  // namespace stylet
