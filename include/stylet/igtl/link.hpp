// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/igtl/picture.hpp"
#include "stylet/realtime/device.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace stylet::igtl {

enum class Role {
  server,  ///< listens; several others may connect
  client   ///< connects to one other, again and again until it is there
};

/// Names longer than 20 bytes are cut to them: an OpenIGTLink header has no more room.
struct LinkSettings {
  Role role = Role::server;
  std::string host = "127.0.0.1";           ///< server: address to listen at; client: whom to connect to
  int port = 18944;                         ///< 1…65535; a server takes any free one for 0
  std::string input = "HandleToReference";  ///< TRANSFORM that says where the hand wants the needle's base
  std::string base = "NeedleBaseToReference";
  std::string tip = "NeedleTipToReference";
  std::string force = "BaseForce";
  std::string shaft = "NeedleShaft";
  std::string surface = "TissueSurface";
  std::string status = "Stylet";
  double poses_hz = 60.0;      ///< 1…1000, poses and force
  double surface_hz = 10.0;    ///< 0.1…poses_hz
  double fresh_s = 0.25;       ///< 0.01…10, an older picture has no force
  int max_connections = 8;     ///< 1…64, of a server; others are turned away
  double give_up_s = 10.0;     ///< 0.1…600, a connection that takes nothing for so long is closed
  double retry_s = 0.25;       ///< 0.01…60, a client's first pause before it tries again; doubles up to…
  double longest_retry_s = 5;  ///< retry_s…600
};

/// What a link has seen so far.
struct LinkState {
  int port = 0;                     ///< listens at, or connects to
  int connections = 0;              ///< now
  bool tracked = false;             ///< the last pose of the handle was usable, and its sender is still there
  std::int64_t connected = 0;       ///< connections made, in all
  std::int64_t turned_away = 0;     ///< beyond max_connections
  std::int64_t poses = 0;           ///< received: usable poses of the handle
  std::int64_t unusable = 0;        ///< received: no rigid motion, or sent by somebody whose STATUS was not OK
  std::int64_t of_others = 0;       ///< received: poses of the handle while another connection had it
  std::int64_t other_messages = 0;  ///< received: other types and names
  std::int64_t sent = 0;            ///< bundles of poses and force, surfaces, heartbeats: handed to connections
  std::int64_t dropped = 0;         ///< of those, replaced by newer ones before they left
  std::int64_t garbage = 0;         ///< connections closed because what they sent was no OpenIGTLink
  std::int64_t given_up = 0;        ///< connections closed because they took nothing
  std::string problem;              ///< the last of these, in words
};

/// Shows a running simulation to programs that speak OpenIGTLink, such as 3D Slicer and PLUS, and takes the hand's pose
/// from them; docs/openigtlink.md says what goes over the wire. One thread of its own does everything with sockets;
/// what enters and leaves a real-time thread passes through LatestValue.
class Link {
 public:
  /// Opens the server's port, or looks the client's host up; the rest happens in the link's thread.
  /// Refuses settings out of range, names that are empty or used twice, an unknown host, a port that is taken.
  static Result<std::unique_ptr<Link>> open(const LinkSettings& settings);
  ~Link();  ///< closes all connections; waits for nobody
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// The handle, for a RealtimeRunner; may outlive the link, then without a hand. Only the last one asked for is fed.
  /// A runner needs a late_after_s of some periods of the sender (0.1 s for 30 to 60 Hz): older samples fade its force.
  [[nodiscard]] std::unique_ptr<Device> device();

  /// What is to be seen now. One publishing thread; does not wait. Pictures faster than poses_hz replace each other.
  void publish(const Picture& picture);
  /// Surface, as often as it changes; sent at surface_hz at most, and once to whoever connects later. Any thread but a
  /// real-time one. Refuses triangles that name no point, and surfaces of more than 64 MiB.
  Result<> publish_surface(Surface surface);

  /// As of the last turn of the link's thread, one in 1/poses_hz. Any thread but a real-time one.
  [[nodiscard]] LinkState state() const;

 private:
  struct Parts;
  explicit Link(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet::igtl
