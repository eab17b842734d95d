// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/igtl/image_publisher.hpp"

#include "stylet/core/survive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

namespace stylet::igtl {

struct ImagePublisher::Parts {
  Parts(Link& to, Source from, std::chrono::steady_clock::duration each)
      : link(to), source(std::move(from)), period(each) {}

  Link& link;
  Source source;
  std::chrono::steady_clock::duration period;
  std::mutex mutex;
  std::condition_variable ends;
  bool end = false;  ///< guarded by the mutex
  std::thread thread;

  void run() {
    GreyPicture image;
    auto due = std::chrono::steady_clock::now();
    std::unique_lock lock(mutex);
    while (!end) {
      lock.unlock();
      survive(
          "the image for OpenIGTLink",
          [&] {
            if (source(image)) (void)link.publish_image(image);
          },
          [](const Error&) {});
      lock.lock();
      due = std::max(due + period, std::chrono::steady_clock::now());
      ends.wait_until(lock, due, [this] { return end; });
    }
  }
};

ImagePublisher::ImagePublisher(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Result<std::unique_ptr<ImagePublisher>> ImagePublisher::start(Link& link, Source source, double images_hz) {
  constexpr double slowest_hz = 0.1;
  constexpr double fastest_hz = 60.0;
  if (!(images_hz >= slowest_hz && images_hz <= fastest_hz))
    return input_error("OpenIGTLink, images_hz",
                       fmt::format("{} Hz is not within {}…{}", images_hz, slowest_hz, fastest_hz),
                       "Give a value within the range");
  const auto period =
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(1.0 / images_hz));
  auto parts = std::make_unique<Parts>(link, std::move(source), period);
  try {
    parts->thread = std::thread([&p = *parts] { p.run(); });
  } catch (const std::system_error& error) {
    return failure("OpenIGTLink", fmt::format("no thread can be started: {}", error.code().message()),
                   "End other programs");
  }
  return std::unique_ptr<ImagePublisher>(new ImagePublisher(std::move(parts)));
}

ImagePublisher::~ImagePublisher() {
  {
    const std::scoped_lock lock(parts_->mutex);
    parts_->end = true;
  }
  parts_->ends.notify_all();
  parts_->thread.join();
}

}  // namespace stylet::igtl
