// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/json_parts.hpp"

namespace stylet::results {

Json errors_json(const SeedErrors& errors) {
  Json json{{"seeds", errors.seeds},
            {"mean_mm", errors.mean_mm},
            {"p95_mm", errors.p95_mm},
            {"largest_mm", errors.largest_mm}};
  const char* names[] = {"x_mm", "y_mm", "z_mm"};
  for (std::size_t axis = 0; axis < 3; ++axis)
    json[names[axis]] = {{"mean", errors.axes[axis].mean_mm}, {"sd", errors.axes[axis].sd_mm}};
  return json;
}

}  // namespace stylet::results
