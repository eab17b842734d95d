// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/igtl/link.hpp"

#include <functional>
#include <memory>

namespace stylet::igtl {

/// Makes the images of a link in a thread of its own, so that neither the real-time loop nor the link's messages wait
/// for them. Any scanner feeds it: ultrasound, a Fluoroscope, or a test.
class ImagePublisher {
 public:
  /// Makes the newest image. @return false if there is no newer one than last time
  using Source = std::function<bool(GreyPicture& image)>;

  /// Starts the thread. Images that the link refuses are left out.
  /// @param link must outlive the publisher
  /// @param source is called in the thread, at most images_hz times per second
  /// @param images_hz [1/s] 0.1…60
  /// Errors: a rate out of range; no thread can be started.
  static Result<std::unique_ptr<ImagePublisher>> start(Link& link, Source source, double images_hz = 20.0);
  ~ImagePublisher();  ///< waits for the image that is being made
  ImagePublisher(const ImagePublisher&) = delete;
  ImagePublisher& operator=(const ImagePublisher&) = delete;

 private:
  struct Parts;
  explicit ImagePublisher(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet::igtl
