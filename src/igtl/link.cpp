// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/igtl/link.hpp"

#include "check_settings.hpp"
#include "sender.hpp"
#include "stylet/core/survive.hpp"
#include "tracked_device.hpp"
#include "transport.hpp"

#include <fmt/format.h>

#include <boost/asio/post.hpp>

#include <algorithm>
#include <system_error>
#include <thread>

namespace stylet::igtl {

/// `io` is declared before the members that use it. Its queue may hold sockets, so it must be destroyed after them.
struct Link::Parts {
  explicit Parts(const LinkSettings& s) : settings(s), hub(settings), sender(io, settings, hub) {
    hub.feed_probe(probe);
  }

  const LinkSettings settings;
  boost::asio::io_context io{1};
  std::shared_ptr<PoseChannel> probe = std::make_shared<PoseChannel>();
  Hub hub;
  Sender sender;
  std::unique_ptr<Transport> transport;
  std::thread thread;

  /// Does the work of `io` until it is stopped. An exception ends one piece of work, and the link goes on.
  void run() {
    const auto tell = [this](const Error& why) { hub.set_problem(why.what); };
    while (!io.stopped())
      survive(
          "OpenIGTLink", [this] { io.run(); }, tell);
  }
};

Link::Link(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Result<std::unique_ptr<Link>> Link::open(const LinkSettings& settings) {
  if (auto ok = check(settings); !ok) return ok.error();
  auto parts = std::make_unique<Parts>(settings);
  Parts& p = *parts;
  auto transport = settings.role == Role::server ? listen(p.io, p.settings, p.hub) : dial(p.io, p.settings, p.hub);
  if (!transport) return transport.error();
  p.transport = std::move(*transport);
  p.sender.start();
  p.transport->start();
  try {
    p.thread = std::thread([&p] { p.run(); });
  } catch (const std::system_error& error) {
    return failure("OpenIGTLink", fmt::format("no thread can be started: {}", error.code().message()),
                   "End other programs");
  }
  return std::unique_ptr<Link>(new Link(std::move(parts)));
}

Link::~Link() {
  Parts& p = *parts_;
  // Everything is closed in the link's thread, which owns the sockets; messages that are being sent are dropped.
  boost::asio::post(p.io, [&p] {
    p.transport->stop();
    p.sender.stop();
    p.hub.close();
    p.io.stop();
  });
  p.thread.join();
}

std::unique_ptr<Device> Link::device() {
  auto channel = std::make_shared<PoseChannel>();
  boost::asio::post(parts_->io, [&hub = parts_->hub, channel] { hub.feed(channel); });
  return std::make_unique<TrackedDevice>("OpenIGTLink " + parts_->settings.input, std::move(channel));
}

void Link::accept_token(const std::string& token) {
  boost::asio::post(parts_->io, [&hub = parts_->hub, token] { hub.accept_token(token); });
}

void Link::publish(const Picture& picture) { parts_->sender.publish(picture); }

Result<> Link::publish_surface(Surface surface) {
  constexpr std::size_t most = std::size_t{1} << 26;
  const std::size_t triangles = surface.triangles ? surface.triangles->size() : 0;
  const std::size_t bytes = 12 * surface.points.size() + 16 * triangles;
  if (bytes > most)
    return input_error("OpenIGTLink, surface",
                       fmt::format("{} points and {} triangles are more than 64 MiB", surface.points.size(), triangles),
                       "Send a coarser surface, or fewer regions");
  if (triangles > 0) {
    std::uint32_t last = 0;
    for (const auto& t : *surface.triangles) last = std::max({last, t[0], t[1], t[2]});
    if (last >= surface.points.size())
      return input_error(
          "OpenIGTLink, surface",
          fmt::format("a triangle has the corner {}, but there are {} points", last, surface.points.size()),
          "Number the points from 0");
  }
  parts_->sender.publish(std::move(surface));
  return Ok{};
}

Result<> Link::publish_image(GreyPicture image) {
  constexpr std::size_t most = std::size_t{1} << 26;
  constexpr int longest = 65535;
  const bool sized = image.columns > 0 && image.rows > 0 && image.columns <= longest && image.rows <= longest;
  const std::size_t pixels = sized ? static_cast<std::size_t>(image.columns) * static_cast<std::size_t>(image.rows) : 0;
  if (!sized || pixels > most || pixels != image.pixels.size())
    return input_error("OpenIGTLink, image",
                       fmt::format("{} × {} pixels with {} values are no image of at most 64 MiB", image.columns,
                                   image.rows, image.pixels.size()),
                       "Give a value for each pixel, and a smaller image if it is too large");
  parts_->sender.publish(std::move(image));
  return Ok{};
}

std::optional<Pose> Link::probe_pose() {
  parts_->probe->fetch();
  const TrackedPose& newest = parts_->probe->value();
  return newest.valid ? std::optional<Pose>(pose(newest.pose)) : std::nullopt;
}

std::vector<Dropped> Link::news() { return parts_->hub.news(); }

std::vector<GivenCommand> Link::take_commands() { return parts_->hub.take_commands(); }

void Link::answer(const GivenCommand& command, const std::string& refused) {
  boost::asio::post(parts_->io, [&hub = parts_->hub, command, refused] { hub.answer(command, refused); });
}

LinkState Link::state() const { return parts_->hub.state(); }

}  // namespace stylet::igtl
