// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/serve/picture.hpp"

#include <algorithm>
#include <cmath>

namespace stylet::serve {

namespace {

constexpr double kFinest_mm = 1e-3;
constexpr double kLargest = 32767.0;

}  // namespace

void set_displacement(LiveFrame& frame, const Eigen::Ref<const Eigen::Matrix3Xf>& u) {
  frame.displacement.resize(static_cast<std::size_t>(u.size()));
  const double most = u.size() > 0 ? static_cast<double>(u.cwiseAbs().maxCoeff()) : 0.0;
  if (!std::isfinite(most)) {
    frame.displacement.clear();
    return;
  }
  frame.unit_mm = std::max(kFinest_mm, most / kLargest);
  const auto scale = static_cast<float>(1.0 / frame.unit_mm);
  std::transform(u.reshaped().begin(), u.reshaped().end(), frame.displacement.begin(),
                 [scale](float value) { return static_cast<std::int16_t>(std::lround(value * scale)); });
}

}  // namespace stylet::serve
