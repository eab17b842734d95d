// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/imaging/grey_picture.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stylet::serve {

/// The kind of picture that the pages look at beside the 3D view.
enum class ShownImage { none, transverse, sagittal, xray };

/// "none", "transverse", "sagittal", "xray"
const char* to_string(ShownImage shown);
/// The kind of picture with this name; empty: there is none.
std::optional<ShownImage> shown_image(std::string_view name);

/// A picture for the pages: ultrasound before scan conversion, or X-ray.
struct LiveImage {
  std::string text;                     ///< JSON: modality, place, scale (docs/live_protocol.md)
  std::uint32_t rows = 0, columns = 0;  ///< ultrasound: lines, and samples along each
  std::vector<std::uint8_t> pixels{};   ///< (rows × columns) row by row
  /// The same picture as a rectangle in the patient, in the scenario's grey values; null while no companion wants it.
  std::shared_ptr<const GreyPicture> in_patient{};
  std::optional<Pose> probe{};  ///< LPS, of the probe in this picture; empty: there is none
};

}  // namespace stylet::serve
