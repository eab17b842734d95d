// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"

#include <vtkSmartPointer.h>

#include <memory>
#include <span>
#include <string>

class vtkRenderer;

namespace stylet::results {

/// Draws VTK renderers into PNG pictures without a screen: an OpenGL context on Mesa's surfaceless EGL platform.
/// Pictures are drawn at twice their size and averaged down, which smooths edges and text and works with depth peeling.
class Canvas {
 public:
  static constexpr int kWidth = 1440, kHeight = 1080;  ///< size of a picture [pixels]
  static constexpr int kOversampling = 2;              ///< lines and text must be drawn larger by this factor

  static Result<std::unique_ptr<Canvas>> open();
  ~Canvas();
  Canvas(const Canvas&) = delete;
  Canvas& operator=(const Canvas&) = delete;

  /// Draws renderers one after the other, each on its own part of the picture.
  /// @return the bytes of a PNG file
  Result<std::string> draw(std::span<const vtkSmartPointer<vtkRenderer>> layers);

 private:
  struct Parts;
  explicit Canvas(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet::results
