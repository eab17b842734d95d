// SPDX-License-Identifier: GPL-3.0-or-later
#include "igtl_companion.hpp"

#include "stylet/igtl/link.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <utility>

namespace stylet::cli {

namespace {

/// A host as it is written in front of a port: an IPv6 address gets brackets.
std::string bracketed(const std::string& host) { return host.find(':') == std::string::npos ? host : "[" + host + "]"; }

/// Makes an igtl::Link a companion of a session.
class LinkCompanion final : public serve::Companion {
 public:
  LinkCompanion(std::unique_ptr<igtl::Link> link, igtl::LinkSettings settings, bool has_hand)
      : link_(std::move(link)), settings_(std::move(settings)), has_hand_(has_hand) {}

  [[nodiscard]] std::string name() const override { return "OpenIGTLink"; }
  [[nodiscard]] std::unique_ptr<Device> device() override { return has_hand_ ? link_->device() : nullptr; }
  [[nodiscard]] std::string why_no_pose() const override;
  std::vector<serve::Notice> news() override;
  [[nodiscard]] std::int64_t not_used() const override { return link_->state().not_used; }
  std::vector<serve::GivenCommand> take_commands() override;

  void show(const serve::Scene& scene) override;
  void show(const Snapshot& snapshot, const DeviceSnapshot& device) override;
  void show(const Eigen::Ref<const Eigen::Matrix3Xf>& displacement) override;

  [[nodiscard]] bool wants_images() const override { return link_->state().connections > 0; }
  void show(const serve::LiveImage& image) override;
  [[nodiscard]] std::optional<Pose> probe_pose() override { return link_->probe_pose(); }

  void accept_token(const std::string& token) { link_->accept_token(token); }
  [[nodiscard]] int port() const { return link_->state().port; }

 private:
  void publish_surface();

  std::unique_ptr<igtl::Link> link_;
  igtl::LinkSettings settings_;
  bool has_hand_;
  bool is_handle_told_ = false;  ///< that the handle's pose is received while pages move the needle
  Eigen::Matrix3Xf at_rest_;     ///< [mm] LPS, points of the undeformed scene
  Eigen::Matrix3Xf displaced_;   ///< [mm] displacement that was published last
  std::shared_ptr<const igtl::Surface::Triangles> triangles_;
  std::optional<Pose> probe_;  ///< of the last picture
};

std::string LinkCompanion::why_no_pose() const {
  const igtl::LinkState state = link_->state();
  if (state.connections == 0)
    return settings_.role == igtl::Role::server
               ? fmt::format("no client is connected to port {}", state.port)
               : fmt::format("no connection to {}:{}", bracketed(settings_.host), state.port);
  if (state.poses + state.unusable == 0) return fmt::format("no {} has been received yet", settings_.input);
  if (!state.tracked) return fmt::format("no usable {} is received", settings_.input);
  return fmt::format("no new {} is received", settings_.input);
}

std::vector<serve::Notice> LinkCompanion::news() {
  std::vector<serve::Notice> news;
  for (const igtl::Dropped& dropped : link_->news())
    news.push_back(
        {dropped.count > 1 ? fmt::format("{} ({} so far)", dropped.what, dropped.count) : dropped.what, dropped.cure});
  if (has_hand_ || is_handle_told_ || link_->state().poses == 0) return news;
  is_handle_told_ = true;
  news.push_back({settings_.input + " is received, but pages move the needle",
                  "Start Stylet with --hand igtl if the needle is to follow it"});
  return news;
}

std::vector<serve::GivenCommand> LinkCompanion::take_commands() {
  std::vector<serve::GivenCommand> commands;
  for (igtl::GivenCommand& given : link_->take_commands()) {
    std::string text = given.text;
    commands.push_back({std::move(text), [this, given = std::move(given)](const std::optional<serve::Notice>& refused) {
                          link_->answer(given, refused ? refused->text + ". " + refused->cure : std::string());
                        }});
  }
  return commands;
}

void LinkCompanion::show(const serve::Scene& scene) {
  at_rest_ = Eigen::Map<const Eigen::Matrix3Xf>(scene.positions.data(), 3,
                                                static_cast<Eigen::Index>(scene.positions.size() / 3));
  displaced_ = Eigen::Matrix3Xf::Zero(3, at_rest_.cols());
  igtl::Surface::Triangles triangles(scene.triangles.size() / 3);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    triangles[t] = {scene.triangles[3 * t], scene.triangles[3 * t + 1], scene.triangles[3 * t + 2]};
  triangles_ = std::make_shared<const igtl::Surface::Triangles>(std::move(triangles));
  publish_surface();
}

void LinkCompanion::show(const Snapshot& snapshot, const DeviceSnapshot& device) {
  igtl::Picture picture = igtl::picture_of(snapshot, device);
  picture.has_probe = probe_.has_value();
  if (probe_) picture.probe = plain(*probe_);
  link_->publish(picture);
}

void LinkCompanion::show(const serve::LiveImage& image) {
  probe_ = image.probe;
  (void)link_->publish_image(*image.in_patient);  // fails only for a picture that is too large
}

/// An unchanged displacement is not published again. The link limits the rate.
void LinkCompanion::show(const Eigen::Ref<const Eigen::Matrix3Xf>& displacement) {
  if (displacement.cols() != at_rest_.cols() || displacement == displaced_) return;
  displaced_ = displacement;
  publish_surface();
}

void LinkCompanion::publish_surface() {
  igtl::Surface surface;
  surface.triangles = triangles_;
  surface.points.resize(static_cast<std::size_t>(at_rest_.cols()));
  for (std::size_t k = 0; k < surface.points.size(); ++k) {
    const Eigen::Vector3f x = at_rest_.col(static_cast<Eigen::Index>(k)) + displaced_.col(static_cast<Eigen::Index>(k));
    surface.points[k] = {x.x(), x.y(), x.z()};
  }
  (void)link_->publish_surface(
      std::move(surface));  // fails only for a surface that is too large; then the needle is still sent
}

bool only_digits(const std::string& text) { return text.find_first_not_of("0123456789") == std::string::npos; }

/// Parses "PORT", "HOST", "HOST:PORT" or "[IPv6]:PORT". A server needs the port, a client the host.
Result<> read_place(const std::string& option, const std::string& text, igtl::LinkSettings& into) {
  const bool server = into.role == igtl::Role::server;
  const auto wrong = [&](const std::string& what) {
    return input_error(option + " " + text, what,
                       server ? "Give a port such as 18944, or an address and a port such as 0.0.0.0:18944"
                              : "Give a host such as 192.168.0.7, or a host and a port such as 192.168.0.7:18944");
  };
  std::string host = text;
  std::string port;
  const auto colon = text.rfind(':');
  if (only_digits(text)) {
    std::swap(host, port);
  } else if (colon != std::string::npos && text.back() != ']') {
    host = text.substr(0, colon);
    port = text.substr(colon + 1);
    if (host.empty() || port.empty()) return wrong("one side of the colon is empty");
  }
  if (host.empty() && !server) return wrong("there is no host");
  if (port.empty() && server) return wrong("there is no port");
  if (host.size() > 1 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string::npos) {
    return wrong("an IPv6 address has to be in brackets");
  }
  if (!host.empty()) into.host = host;
  if (port.empty()) return Ok{};
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), into.port);
  const int lowest = server ? 0 : 1;
  if (error != std::errc{} || end != port.data() + port.size() || into.port < lowest || into.port > 65535)
    return wrong(fmt::format("'{}' is no port from {} to 65535", port, lowest));
  return Ok{};
}

bool this_machine_only(const std::string& host) {
  return host == "localhost" || host == "::1" || host.starts_with("127.");
}

}  // namespace

Result<IgtlCompanion> open_igtl(const IgtlArguments& arguments) {
  const bool listens = !arguments.listen.empty();
  const bool has_hand = arguments.hand == "igtl";
  if (!listens && arguments.connect.empty()) {
    if (!has_hand) return IgtlCompanion{};
    return input_error("--hand igtl", "there is no OpenIGTLink connection from which to take the hand's pose",
                       "Give --igtl PORT (usually 18944) or --igtl-connect HOST as well");
  }
  igtl::LinkSettings settings;
  settings.checksums = !arguments.no_checksum;
  settings.role = listens ? igtl::Role::server : igtl::Role::client;
  const auto read = listens ? read_place("--igtl", arguments.listen, settings)
                            : read_place("--igtl-connect", arguments.connect, settings);
  if (!read) return read.error();
  auto link = igtl::Link::open(settings);
  if (!link) return link.error();
  auto companion = std::make_shared<LinkCompanion>(std::move(*link), settings, has_hand);
  const std::string place = fmt::format("{}:{}", bracketed(settings.host), companion->port());
  IgtlCompanion made;
  made.json = {{"role", listens ? "server" : "client"},
               {"host", settings.host},
               {"port", companion->port()},
               {"hand", has_hand}};
  made.said = fmt::format("OpenIGTLink: {} {}{}.", listens ? "listening at" : "connecting to", place,
                          has_hand ? "; the needle follows " + settings.input : "");
  if (listens && !this_machine_only(settings.host))
    made.warning = fmt::format("OpenIGTLink is not encrypted: everyone in between can read what passes {}.", place);
  made.accept_token = [companion](const std::string& token) { companion->accept_token(token); };
  made.companion = std::move(companion);
  return made;
}

}  // namespace stylet::cli
