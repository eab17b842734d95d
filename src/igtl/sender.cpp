// SPDX-License-Identifier: GPL-3.0-or-later
#include "sender.hpp"

#include "ras.hpp"
#include "stylet/core/survive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stylet::igtl {

namespace {

using Seconds = std::chrono::duration<double>;

Connection::Clock::duration period(double hz) {
  return std::chrono::duration_cast<Connection::Clock::duration>(Seconds(1.0 / hz));
}

bool finite(const Picture& p) {
  double sum = p.time_s;
  const auto add = [&sum](const auto& values) {
    for (const double x : values) sum += x;
  };
  for (const PlainPose* q : {&p.base, &p.tip, &p.probe}) {
    add(q->origin);
    add(q->rotation);
  }
  add(p.on_hand.force);
  add(p.on_hand.torque);
  for (const Triple& s : p.shaft) add(s);
  return std::isfinite(sum);
}

Connection::Shared shared(Bytes bytes) { return std::make_shared<const Bytes>(std::move(bytes)); }

}  // namespace

void Sender::publish(Surface surface) {
  const std::scoped_lock lock(mutex_);
  surface_ = std::move(surface);
}

void Sender::publish(GreyPicture image) {
  const std::scoped_lock lock(mutex_);
  image_ = std::move(image);
}

void Sender::start() {
  timer_.expires_at(Clock::now());
  wait();
}

void Sender::wait() {
  timer_.async_wait([this](const boost::system::error_code& error) {
    if (error) return;
    const auto now = Clock::now();
    survive(
        "sending by OpenIGTLink", [&] { turn(now); }, [this](const Error& why) { hub_.set_problem(why.what); });
    // The times lie on a regular grid; missed turns are not made up for.
    timer_.expires_at(std::max(timer_.expiry() + period(settings_.poses_hz), now));
    wait();
  });
}

void Sender::turn(Clock::time_point now) {
  if (picture_.fetch()) {
    have_picture_ = true;
    picture_time_ = now;
  }
  const bool fresh =
      have_picture_ && Seconds(now - picture_time_).count() <= settings_.fresh_s && finite(picture_.value());

  if (now >= heartbeat_due_) {
    heartbeat_due_ = now + std::chrono::seconds(1);
    const auto message = shared(heartbeat(fresh));
    hub_.greet_with(Connection::status, message);
    hub_.send(Connection::status, message);
  }
  if (have_picture_ && !hub_.empty()) hub_.send(Connection::poses, shared(poses(fresh)));
  send_surface(now);
  send_image(now);
  hub_.give_up(now);
  hub_.show_state();
}

void Sender::send_surface(Clock::time_point now) {
  if (now < surface_due_) return;
  std::optional<Surface> surface;
  {
    const std::scoped_lock lock(mutex_);
    surface.swap(surface_);
  }
  if (!surface) return;
  surface_due_ = now + period(settings_.surface_hz);
  Bytes bytes;
  add_surface(bytes, settings_.surface, *surface);
  const auto message = shared(std::move(bytes));
  hub_.greet_with(Connection::surface, message);
  hub_.send(Connection::surface, message);
}

void Sender::send_image(Clock::time_point now) {
  if (now < image_due_) return;
  std::optional<GreyPicture> image;
  {
    const std::scoped_lock lock(mutex_);
    image.swap(image_);
  }
  if (!image) return;
  // On a regular grid, so that turns that come a little late do not lower the rate; missed images are not made up for.
  image_due_ = std::max(image_due_ + period(settings_.images_hz), now);
  Bytes bytes;
  add_image(bytes, settings_.image, *image);
  const auto message = shared(std::move(bytes));
  hub_.greet_with(Connection::image, message);
  hub_.send(Connection::image, message);
}

/// Poses are sent only of a fresh picture, because an old one would look like a running simulation. Without a fresh
/// picture the force is sent as zero with "fresh": false.
Bytes Sender::poses(bool fresh) const {
  const Picture& p = picture_.value();
  Bytes out;
  Wrench on_hand;
  if (fresh) {
    on_hand = wrench(p.on_hand);
    add_transform(out, settings_.base, pose(p.base));
    add_transform(out, settings_.tip, pose(p.tip));
    add_points(out, settings_.shaft, p.shaft);
    if (p.has_probe) add_transform(out, settings_.probe, pose(p.probe));
  }
  add_wrench(out, settings_.force, on_hand);
  const Vec3 f = ras(on_hand.force);
  const Vec3 t = ras(on_hand.torque);
  const double time_s = std::isfinite(p.time_s) ? p.time_s : 0.0;
  add_string(out, settings_.force,
             fmt::format(R"({{"time_s": {:.4f}, "force_N": [{:.5g}, {:.5g}, {:.5g}], )"
                         R"("torque_Nmm": [{:.5g}, {:.5g}, {:.5g}], "frame": "RAS", "fresh": {}}})",
                         time_s, f.x(), f.y(), f.z(), t.x(), t.y(), t.z(), fresh));
  return out;
}

Bytes Sender::heartbeat(bool fresh) const {
  Bytes out;
  if (fresh)
    add_status(out, settings_.status, StatusCode::ok, "running");
  else
    add_status(out, settings_.status, StatusCode::not_ready, "no picture of the simulation");
  return out;
}

}  // namespace stylet::igtl
