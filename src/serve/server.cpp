// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/serve/server.hpp"

#include "access.hpp"
#include "hand.hpp"
#include "holding.hpp"
#include "implant_text.hpp"
#include "kept_token.hpp"
#include "pages.hpp"
#include "stylet/io/hole_map_io.hpp"
#include "viewer.hpp"

#include <fmt/format.h>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/host_name.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/thread_pool.hpp>
#include <nlohmann/json.hpp>

#include <map>
#include <thread>

namespace stylet::serve {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

namespace {

using Json = nlohmann::ordered_json;

constexpr auto kRequestTime = std::chrono::seconds(20);
constexpr auto kAcceptAgain = std::chrono::milliseconds(200);
constexpr std::size_t kRequestBytes = 16 * 1024;
constexpr std::size_t kKeptEvents = 1000;

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

Json json_of(const SessionStatus::Recording& recording) {
  return {{"name", recording.name},
          {"seconds", recording.seconds},
          {"problem", recording.problem},
          {"warning", recording.warning}};
}

const char* name_of(SessionStatus::State state) {
  switch (state) {
    case SessionStatus::State::loading:
      return "loading";
    case SessionStatus::State::ready:
      return "ready";
    case SessionStatus::State::failed:
      break;
  }
  return "failed";
}

std::string map_text(const LiveMap& live) {
  return text_of({{"map", live.map ? Json::parse(hole_map_json(*live.map)) : Json(nullptr)},
                  {"why_not", live.why_not},
                  {"predicted", live.predicted},
                  {"predicting", live.predicting}});
}

std::optional<Request::Kind> request_kind(wire::Command::Do what) {
  using enum wire::Command::Do;
  switch (what) {
    case hole:
      return Request::Kind::hole;
    case insertion:
      return Request::Kind::insertion;
    case reset:
      return Request::Kind::reset;
    case pause:
      return Request::Kind::pause;
    case resume:
      return Request::Kind::resume;
    case step:
      return Request::Kind::step;
    case open_case:
      return Request::Kind::open_case;
    case replay:
      return Request::Kind::replay;
    case live:
      return Request::Kind::live;
    case seek:
      return Request::Kind::seek;
    case play:
      return Request::Kind::play;
    case drawn:
      return Request::Kind::drawn;
    case needle:
      return Request::Kind::needle;
    case drop:
      return Request::Kind::drop;
    case undo:
      return Request::Kind::undo;
    case clear:
      return Request::Kind::clear;
    case predict:
      return Request::Kind::predict;
    case image:
      return Request::Kind::image;
    case set:
      return Request::Kind::set;
    case take:
    case release:
      break;
  }
  return std::nullopt;
}

}  // namespace

/// Everything here happens in the thread of `io`, except the Audience's calls, which only post work to it.
struct Server::Parts final : public Audience, public ViewerDesk {
  Parts(ServerSettings settings_, Access access_)
      : settings(std::move(settings_)),
        access(std::move(access_)),
        acceptor(io),
        retry(io),
        pages(access, Shelf(settings.session.recordings, settings.session.archive)),
        session(settings.session, *this) {}

  ServerSettings settings;
  Access access;
  asio::io_context io{1};
  tcp::acceptor acceptor;
  asio::steady_timer retry;
  Pages pages;
  Holding holding;
  std::map<std::uint64_t, std::shared_ptr<Viewer>> viewers;
  std::uint64_t last_id = 0;
  std::shared_ptr<const Scene> scene;
  std::string map;  ///< JSON text of the map; empty until there is a map
  /// JSON texts of the plan, what has been carried out of it, and where its seeds are; empty until there is one.
  std::map<wire::Kind, std::string> implant;
  std::shared_ptr<const LiveDose> dose;
  std::shared_ptr<const LiveImage> image;
  SessionStatus status;
  std::deque<std::string> events;  ///< JSON texts of the events since the start of the insertion
  Session session;
  std::thread thread;
  asio::thread_pool readers{1};  ///< last member, so that it ends before the members that its work uses

  // Audience: called from the session's thread.
  void show(std::shared_ptr<const Scene> made) override {
    asio::post(io, [this, made = std::move(made)] {
      scene = made;
      events.clear();
      for (const auto& [id, viewer] : each()) viewer->send(scene);
    });
  }
  void show(std::shared_ptr<const LiveFrame> frame) override {
    asio::post(io, [this, frame = std::move(frame)] {
      for (const auto& [id, viewer] : each()) viewer->send(frame);
    });
  }
  void show(const LiveMap& now) override {
    asio::post(io, [this, text = map_text(now)] {
      map = text;
      for (const auto& [id, viewer] : each()) viewer->send(wire::Kind::map, map);
    });
  }
  void show(const LivePlan& now) override {
    if (now.needles.empty()) {
      asio::post(io, [this] {
        implant.clear();
        dose.reset();
      });
    }
    show_text(wire::Kind::plan, plan_text(now));
  }
  void show(const LiveImplant& now) override { show_text(wire::Kind::implant, implant_text(now)); }
  void show(const LiveSeeds& now) override { show_text(wire::Kind::seeds, seeds_text(now)); }
  void show(std::shared_ptr<const LiveDose> now) override {
    asio::post(io, [this, now = std::move(now)] {
      dose = now;
      for (const auto& [id, viewer] : each()) viewer->send(dose);
    });
  }
  void show(std::shared_ptr<const LiveImage> now) override {
    asio::post(io, [this, now = std::move(now)] {
      image = now;
      for (const auto& [id, viewer] : each()) viewer->send(image);
    });
  }
  void show_text(wire::Kind kind, std::string text) {
    asio::post(io, [this, kind, text = std::move(text)] {
      implant[kind] = text;
      for (const auto& [id, viewer] : each()) viewer->send(kind, text);
    });
  }
  void tell(const SessionStatus& now) override {
    asio::post(io, [this, now] {
      status = now;
      say_status();
    });
  }
  void tell(const LiveEvent& event) override {
    asio::post(io, [this, event] {
      if (event.kind == "started") events.clear();
      events.push_back(text_of({{"kind", event.kind},
                                {"time_s", event.time_s},
                                {"depth_mm", event.depth_mm},
                                {"force_N", event.force_N},
                                {"region", event.region}}));
      if (events.size() > kKeptEvents) events.pop_front();
      for (const auto& [id, viewer] : each()) viewer->send(wire::Kind::event, events.back());
    });
  }
  void refuse(std::uint64_t id, const Notice& why) override {
    asio::post(io, [this, id, why] {
      const auto found = viewers.find(id);
      if (found == viewers.end()) return;
      found->second->send(wire::Kind::notice, text_of({{"text", why.text}, {"cure", why.cure}}));
    });
  }

  // ViewerDesk: called from the thread of `io`.
  void arrived(const std::shared_ptr<Viewer>& viewer) override {
    viewers[viewer->id()] = viewer;
    if (scene) viewer->send(scene);
    if (!map.empty()) viewer->send(wire::Kind::map, map);
    for (const auto& [kind, text] : implant) viewer->send(kind, text);
    if (dose) viewer->send(dose);
    if (image) viewer->send(image);
    for (const std::string& event : events) viewer->send(wire::Kind::event, event);
    say_status();
    (void)session.ask({.kind = Request::Kind::greet, .viewer = viewer->id(), .text = {}, .number = 0.0});
  }
  void left(std::uint64_t id) override {
    if (viewers.erase(id) == 0) return;
    if (holding.leave(id)) session.let_go();
    say_status();
  }
  void heard(Viewer& viewer, const HandTarget& hand) override {
    if (holding.holder() == viewer.id()) session.aim(hand);
  }
  void heard(Viewer& viewer, const wire::Command& command) override {
    using enum wire::Command::Do;
    if (command.what == take) {
      holding.take(viewer.id());
      return say_status();
    }
    if (command.what == release) {
      if (holding.holder() == viewer.id()) session.let_go();
      holding.release(viewer.id());
      return say_status();
    }
    if (command.what != drawn && holding.holder() != viewer.id())
      return viewer.send(wire::Kind::notice,
                         text_of({{"text", "another viewer holds the needle"}, {"cure", "Ask for the needle"}}));
    const auto kind = request_kind(command.what);
    if (kind && !session.ask({.kind = *kind, .viewer = viewer.id(), .text = command.text, .number = command.number}))
      viewer.send(wire::Kind::notice, text_of({{"text", "too many requests are waiting"}, {"cure", "Try again"}}));
  }

  /// A copy of the viewers, because sending may close a viewer and so remove it from the map.
  [[nodiscard]] std::map<std::uint64_t, std::shared_ptr<Viewer>> each() const { return viewers; }

  void say_status() {
    const SessionStatus& s = status;
    Json json{{"state", name_of(s.state)},
              {"stage", s.stage},
              {"fraction", s.fraction < 0.0 ? Json(nullptr) : Json(s.fraction)},
              {"message", s.failure.text},
              {"cure", s.failure.cure},
              {"mode", s.replay.name.empty() ? "live" : "replay"},
              {"paused", s.paused},
              {"insertion", s.insertion},
              {"hole", s.hole},
              {"inside", s.inside},
              {"held", holding.holder() != 0},
              {"asking", holding.asking()},
              {"viewers", viewers.size()},
              {"device", s.device},
              {"device_problem", s.device_problem},
              {"image",
               {{"shown", s.image.shown},
                {"problem", s.image.problem},
                {"stage", s.image.stage},
                {"probe_device", s.image.probe_device},
                {"probe_problem", s.image.probe_problem}}},
              {"recording", json_of(s.recording)},
              {"replay",
               {{"name", s.replay.name},
                {"time_s", s.replay.time_s},
                {"duration_s", s.replay.duration_s},
                {"playing", s.replay.rate > 0.0},
                {"rate", s.replay.rate}}},
              {"loop",
               {{"steps", s.loop.steps},
                {"missed", s.loop.missed},
                {"p50_us", s.loop.p50_us},
                {"p99_us", s.loop.p99_us},
                {"max_us", s.loop.max_us},
                {"rights", s.loop.rights}}}};
    for (const auto& [id, viewer] : each()) {
      json["you_hold"] = holding.holder() == id;
      json["you_ask"] = holding.asks(id);
      json["dropped_messages"] = viewer->dropped_messages();
      json["skipped_frames"] = viewer->skipped_frames();
      viewer->send_status(text_of(json));
    }
  }

  // Connections.
  void accept() {
    acceptor.async_accept([this](beast::error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) return accept_later();
      beast::error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      read_request(std::make_shared<beast::tcp_stream>(std::move(socket)));
      accept();
    });
  }
  /// Accepts again after a pause. Used after an error that would recur at once, such as too many open files.
  void accept_later() {
    retry.expires_after(kAcceptAgain);
    retry.async_wait([this](beast::error_code error) {
      if (!error) accept();
    });
  }
  struct Reading {
    beast::flat_buffer buffer{kRequestBytes};
    http::request_parser<http::string_body> parser;
  };
  void read_request(const std::shared_ptr<beast::tcp_stream>& stream) {
    auto reading = std::make_shared<Reading>();
    reading->parser.body_limit(kRequestBytes);
    stream->expires_after(kRequestTime);
    http::async_read(*stream, reading->buffer, reading->parser,
                     [this, stream, reading](beast::error_code error, std::size_t /*bytes*/) {
                       if (!error) answer(stream, reading->parser.get());
                     });
  }
  void answer(const std::shared_ptr<beast::tcp_stream>& stream, const HttpRequest& request) {
    if (beast::websocket::is_upgrade(request) && path_of(target(request)) == "/live" &&
        pages.verdict(request) == Access::Verdict::granted && viewers.size() < settings.viewers) {
      std::make_shared<Viewer>(++last_id, std::move(*stream), *this, settings.silence_s)->accept(request);
      return;
    }
    if (beast::websocket::is_upgrade(request) && viewers.size() >= settings.viewers)
      return write(stream,
                   Pages::refusal(request, http::status::service_unavailable, "There are too many viewers already."));
    // Reading a recording takes a while, so another thread does it; here all viewers would have to wait.
    stream->expires_never();
    asio::post(readers, [this, stream, request] {
      asio::post(io, [this, stream, response = pages.answer(request)] { write(stream, response); });
    });
  }
  void write(const std::shared_ptr<beast::tcp_stream>& stream, HttpResponse made) {
    auto response = std::make_shared<HttpResponse>(std::move(made));
    const bool again = response->keep_alive();
    stream->expires_after(kRequestTime);
    http::async_write(*stream, *response, [this, stream, response, again](beast::error_code error, std::size_t /*n*/) {
      if (!error && again) return read_request(stream);
      beast::error_code ignored;
      stream->socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }
};

namespace {

/// Makes the access rules from the settings. With a given token the server answers under any host name, so that a proxy
/// can forward requests to it.
Result<Access> access_for(const ServerSettings& settings, bool is_loopback) {
  const std::string& given = settings.token;
  if (!settings.asks_for_token) {
    if (is_loopback && given.empty()) return Access("");
    return input_error(
        "stylet serve",
        given.empty()
            ? fmt::format("without a token, everybody who can reach {} could move the needle", settings.address)
            : "--token and --no-token exclude each other",
        given.empty() ? "Leave --no-token out, or listen on 127.0.0.1" : "Give either --token or --no-token");
  }
  if (!given.empty() && !is_plain_token(given))
    return input_error("stylet serve",
                       fmt::format("the token '{}' has characters that a web address cannot hold", given),
                       "Use letters, digits and -._~ only");
  if (!given.empty()) return Access(given, Access::Names::any);
  return is_loopback ? Access(kept_token(settings.token_file)) : Access(random_token(), Access::Names::any);
}

}  // namespace

Result<std::unique_ptr<Server>> Server::open(ServerSettings settings) {
  const std::string where = fmt::format("stylet serve, {}:{}", settings.address, settings.port);
  if (settings.session.cases.empty() && settings.session.replay.empty())
    return input_error("stylet serve", "there is no case to open", "Name a scenario file");
  beast::error_code error;
  const auto address = asio::ip::make_address(settings.address, error);
  if (error)
    return input_error(where, fmt::format("'{}' is not an IP address", settings.address),
                       "Give an address such as 127.0.0.1 (this machine only) or 0.0.0.0 (all its networks)");
  auto access = access_for(settings, address.is_loopback());
  if (!access) return access.error();
  auto parts = std::make_unique<Parts>(std::move(settings), std::move(*access));
  const tcp::endpoint endpoint(address, parts->settings.port);
  const auto refused = [&](const char* what) {
    return failure(where, fmt::format("cannot {}: {}", what, error.message()),
                   "Choose another port with --port (0: any free port), or end the program that uses this one");
  };
  parts->acceptor.open(endpoint.protocol(), error);
  if (error) return refused("open a socket");
  parts->acceptor.set_option(asio::socket_base::reuse_address(true), error);
  parts->acceptor.bind(endpoint, error);
  if (error) return refused("listen at this address and port");
  parts->acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) return refused("listen at this address and port");
  return std::unique_ptr<Server>(new Server(std::move(parts)));
}

Server::Server(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Server::~Server() { stop(); }

std::uint16_t Server::port() const {
  beast::error_code ignored;
  return parts_->acceptor.local_endpoint(ignored).port();
}

std::string Server::url() const {
  beast::error_code ignored;
  const auto address = parts_->acceptor.local_endpoint(ignored).address();
  const std::string host = address.is_loopback()      ? "localhost"
                           : address.is_unspecified() ? asio::ip::host_name(ignored)
                           : address.is_v6()          ? "[" + address.to_string() + "]"
                                                      : address.to_string();
  const std::string query = parts_->access.token().empty() ? "" : "?token=" + parts_->access.token();
  return fmt::format("http://{}:{}/{}", host, port(), query);
}

void Server::start() {
  Parts& p = *parts_;
  p.accept();
  p.thread = std::thread([&p] { p.io.run(); });
  p.session.start();
}

void Server::stop() {
  Parts& p = *parts_;
  if (!p.thread.joinable()) return;
  p.session.stop();
  p.readers.join();
  asio::post(p.io, [&p] {
    beast::error_code ignored;
    p.acceptor.close(ignored);
    p.retry.cancel();
    for (const auto& [id, viewer] : p.each()) viewer->close();
    p.io.stop();
  });
  p.thread.join();
}

}  // namespace stylet::serve
