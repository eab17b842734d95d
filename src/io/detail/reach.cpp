// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/reach.hpp"

#include <fmt/format.h>

namespace stylet::detail {

bool is_in_reach(const Vec3& position) {
  return position.allFinite() && position.cwiseAbs().maxCoeff() <= kFarthest_mm;
}

Result<> check_reach(const std::string& where, const Vec3& position, const std::string& name) {
  if (is_in_reach(position)) return Ok{};
  return input_error(
      where,
      fmt::format("{} is at ({:.6g}, {:.6g}, {:.6g}) mm, {}", name, position.x(), position.y(), position.z(),
                  position.allFinite() ? fmt::format("at most {:.0f} mm from the scanner's origin is expected along "
                                                     "each axis",
                                                     kFarthest_mm)
                                       : "finite numbers are expected"),
      "Correct it, or export the data again in patient coordinates in mm");
}

}  // namespace stylet::detail
