// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/core/result.hpp"
#include "stylet/igtl/picture.hpp"
#include "stylet/imaging/grey_picture.hpp"
#include "stylet/realtime/device.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stylet::igtl {

enum class Role {
  server,  ///< listens; several programs may connect
  client   ///< connects to one server and tries again until the server answers
};

/// How a Link connects, the device names of its messages, and its rates. A name is cut after 20 bytes, because an
/// OpenIGTLink header has no more room.
struct LinkSettings {
  Role role = Role::server;
  std::string host = "127.0.0.1";                  ///< server: address to listen at; client: host to connect to
  int port = 18944;                                ///< 1…65535; 0 makes a server take any free port
  std::string input = "HandleToReference";         ///< name of the received pose that the base is to have
  std::string probe_input = "StepperToReference";  ///< name of the received pose that the probe is to have
  // Device names of the messages that the link sends.
  std::string base = "NeedleBaseToReference";
  std::string tip = "NeedleTipToReference";
  std::string force = "BaseForce";
  std::string shaft = "NeedleShaft";
  std::string surface = "TissueSurface";
  std::string probe = "ProbeToReference";
  std::string image = "Image_Reference";
  std::string status = "Stylet";  ///< also of the received commands and of the answers to them
  double poses_hz = 60.0;         ///< [1/s] 1…1000, rate of the messages with poses and force
  double surface_hz = 10.0;       ///< [1/s] 0.1…poses_hz, highest rate of the messages with the surface
  double images_hz = 30.0;        ///< [1/s] 0.1…poses_hz, highest rate of the images
  double fresh_s = 0.25;          ///< [s] 0.01…10; the force of a picture older than this is not sent
  bool checksums = true;          ///< whether received messages have to match their checksums; some programs send none
  /// Whether a server takes processes of this user on this machine without a token. All others need one.
  bool trust_own_processes = true;
  int max_connections = 8;     ///< 1…64, of a server; further connections are refused
  double give_up_s = 10.0;     ///< [s] 0.1…600; a connection that accepts no data for this time is closed
  double retry_s = 0.25;       ///< [s] 0.01…60, first pause of a client before it connects again; each pause doubles
  double longest_retry_s = 5;  ///< [s] retry_s…600, longest pause before a client connects again
};

/// State and counters of a link. The counters start at 0 when the link is opened.
struct LinkState {
  int port = 0;                  ///< the port at which it listens, or to which it connects
  int connections = 0;           ///< open connections
  bool tracked = false;          ///< the last pose of the handle was usable, and its sender is still connected
  std::int64_t connected = 0;    ///< connections made in total
  std::int64_t turned_away = 0;  ///< connections refused: max_connections, or strangers without the token
  std::int64_t poses = 0;        ///< usable poses of the handle that were received
  std::int64_t unusable = 0;     ///< received poses that were no rigid motion, or whose sender's STATUS was not OK
  std::int64_t of_others = 0;    ///< received poses of the handle while another connection had the handle
  std::int64_t probe_poses = 0;  ///< usable poses of the probe that were received
  std::int64_t not_used = 0;     ///< received messages that were not used, and connections that were closed or refused
  std::int64_t sent = 0;         ///< messages queued for connections: bundles of poses and force, surfaces, heartbeats
  std::int64_t dropped = 0;      ///< queued messages that newer ones replaced before they were sent
  std::int64_t garbage = 0;      ///< connections whose received bytes were not OpenIGTLink, or ended inside a message
  std::int64_t given_up = 0;     ///< connections closed because they accepted no data
  std::string problem;           ///< the latest trouble in words; may be empty
};

/// Messages or connections of one kind that a link does not use.
struct Dropped {
  std::string what;        ///< the newest: type, name, sender and reason, as a sentence without its full stop
  std::string cure;        ///< a sentence without its full stop
  std::int64_t count = 0;  ///< so far
};

/// A command that a connected program has given, as a STRING or a COMMAND.
struct GivenCommand {
  std::string text;  ///< as printable() gives it; at most 1,000 bytes were received
  std::uint64_t connection = 0;
  std::optional<std::uint32_t> command_id;  ///< of a COMMAND
  std::string command_name;                 ///< of a COMMAND
};

/// Sends a running simulation to programs that speak OpenIGTLink, such as 3D Slicer and PLUS, and receives the pose of
/// the hand from them; docs/openigtlink.md describes the messages. A thread of its own does all socket operations; it
/// exchanges data with real-time threads through LatestValue, without locks.
class Link {
 public:
  /// Opens the server's port, or resolves the client's host name; everything else happens in the link's thread.
  /// Errors: settings out of range, names that are empty or used twice, an unknown host, a port in use.
  static Result<std::unique_ptr<Link>> open(const LinkSettings& settings);
  ~Link();  ///< closes all connections without waiting for the other programs
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// The handle as a device for a RealtimeRunner. It may outlive the link and then gives no valid pose. Only the device
  /// of the latest call receives poses. Set RunnerSettings::late_after_s to several periods of the sender (0.1 s for 30
  /// to 60 Hz), because the runner fades the force out when samples are older than this.
  [[nodiscard]] std::unique_ptr<Device> device();

  /// Lets programs of other users and machines in that give this token, as the STRING "Token" and within 5 s. Without a
  /// token a server refuses them. May be called from any thread.
  void accept_token(const std::string& token);

  /// Sets the picture that is sent next. Does not wait; call it from one thread only. Of pictures that come faster than
  /// poses_hz, the newest is sent.
  void publish(const Picture& picture);
  /// Sets the surface. It is sent at most surface_hz times per second, and once to every program that connects later.
  /// Call it from any thread but a real-time thread. Errors: triangles whose corners are not points of the surface;
  /// surfaces of more than 64 MiB.
  Result<> publish_surface(Surface surface);

  /// Sets the image: an ultrasound or X-ray picture. It is sent at most images_hz times per second, the newest one
  /// only, and once to every program that connects later. Call it from any thread but a real-time thread;
  /// ImagePublisher does so from a thread of its own. Errors: a picture without pixels, with more than 64 MiB of them,
  /// or whose size and values do not fit.
  Result<> publish_image(GreyPicture image);
  /// The pose (LPS) that the other program last sent for the probe, while it is usable and its sender is connected; as
  /// for the handle, one sender at a time moves the probe. Call it from one thread only, which may be a real-time
  /// thread.
  [[nodiscard]] std::optional<Pose> probe_pose();

  /// The messages and connections that were not used and are to be told at this moment: of each kind the first at once,
  /// and more of them seldom. Call it often, from one thread that is no real-time thread.
  std::vector<Dropped> news();
  /// The commands received since the last call; at most 16 wait. Each is to be answered. Call it from any thread but a
  /// real-time thread.
  std::vector<GivenCommand> take_commands();
  /// Answers the program that gave a command, if it is still connected: with a STRING, or with an RTS_COMMAND to a
  /// COMMAND. Call it from any thread but a real-time thread.
  /// @param refused why it is not carried out; empty: it has been carried out; at most 2,000 bytes are sent
  void answer(const GivenCommand& command, const std::string& refused);

  /// The state that the link's thread stored last, every 1/poses_hz. Call it from any thread but a real-time thread.
  [[nodiscard]] LinkState state() const;

 private:
  struct Parts;
  explicit Link(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace stylet::igtl
