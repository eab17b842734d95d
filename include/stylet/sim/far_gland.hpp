// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/step.hpp"
#include "stylet/fem/volume_motion.hpp"

#include <optional>
#include <string>

namespace stylet {

/// Notices a gland that moves or turns further than glands of patients do: the tissue is computed as if it were
/// strained little, and what the needle meets from there on is doubtful.
class FarGland {
 public:
  /// Adds a step that has been taken. @param motion of the gland after the step
  void add(const Step& step, const VolumeMotion& motion);
  /// One or two sentences; empty if the gland went no further than glands do.
  [[nodiscard]] std::optional<std::string> warning() const;

 private:
  struct Largest {
    double value = 0.0;
    double depth_mm = 0.0;  ///< of the needle's base
  };
  Largest turn_deg_;
  Largest shift_mm_;
};

}  // namespace stylet
