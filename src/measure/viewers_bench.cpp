// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/viewers_bench.hpp"

#include "driven_needle.hpp"
#include "stylet/io/recording_io.hpp"
#include "stylet/measure/demo.hpp"
#include "stylet/realtime/scripted_device.hpp"
#include "stylet/serve/companion.hpp"
#include "stylet/serve/server.hpp"

#include <unistd.h>
#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <thread>
#include <utility>

namespace stylet::measure {

namespace {

namespace fs = std::filesystem;
namespace beast = boost::beast;
using boost::asio::ip::tcp;

constexpr double kChange_s = 0.5;     ///< simulated time after viewers connect or leave that is not counted
constexpr double kPatience_s = 60.0;  ///< wall-clock time after which a loop that does not advance is an error

/// Moves the needle by a script, keeps the simulated time, and counts the pictures that it wants.
class Script final : public serve::Companion {
 public:
  explicit Script(BaseMotion motion) : motion_(std::move(motion)) {}
  [[nodiscard]] double time_s() const { return time_s_; }

  [[nodiscard]] std::string name() const override { return "script"; }
  [[nodiscard]] std::unique_ptr<Device> device() override { return std::make_unique<ScriptedDevice>(motion_); }
  [[nodiscard]] std::string why_no_pose() const override { return {}; }
  void show(const serve::Scene& /*scene*/) override {}
  void show(const Snapshot& snapshot, const DeviceSnapshot& /*device*/) override { time_s_ = snapshot.step.time_s; }
  void show(const Eigen::Ref<const Eigen::Matrix3Xf>& /*displacement*/) override {}
  [[nodiscard]] bool wants_images() const override { return wants_; }
  void show(const serve::LiveImage& /*image*/) override { ++images_; }

  void want_images(bool wants) { wants_ = wants; }
  [[nodiscard]] std::int64_t images() const { return images_; }

 private:
  BaseMotion motion_;
  std::atomic<bool> wants_ = false;
  std::atomic<std::int64_t> images_ = 0;
  std::atomic<double> time_s_ = 0.0;
};

/// A viewer that reads all messages as fast as they arrive.
class Viewer {
 public:
  static Result<std::unique_ptr<Viewer>> open(std::uint16_t port) {
    std::unique_ptr<Viewer> viewer(new Viewer);
    auto& socket = viewer->socket_;
    beast::error_code error;
    beast::get_lowest_layer(socket).connect({boost::asio::ip::address_v4::loopback(), port}, error);
    socket.set_option(beast::websocket::stream_base::decorator([](beast::websocket::request_type& request) {
      request.set(beast::http::field::sec_websocket_protocol, "stylet-live-2");
    }));
    if (!error) socket.handshake("localhost:" + std::to_string(port), "/live", error);
    if (error)
      return failure("viewer of the live session", "cannot connect: " + error.message(),
                     "Check whether a firewall forbids connections to 127.0.0.1");
    viewer->thread_ = std::jthread([v = viewer.get()] { v->read(); });
    return viewer;
  }
  ~Viewer() { ::shutdown(beast::get_lowest_layer(socket_).native_handle(), SHUT_RDWR); }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;
  [[nodiscard]] std::int64_t pictures() const { return pictures_; }
  [[nodiscard]] std::int64_t bytes() const { return bytes_; }

 private:
  Viewer() : socket_(io_) {}
  void read() {
    beast::flat_buffer buffer;
    beast::error_code error;
    while (true) {
      socket_.read(buffer, error);
      if (error) return;
      constexpr char kFrame = 2;  // docs/live_protocol.md
      if (*static_cast<const char*>(buffer.cdata().data()) == kFrame) ++pictures_;
      bytes_ += static_cast<std::int64_t>(buffer.size());
      buffer.consume(buffer.size());
    }
  }
  boost::asio::io_context io_;
  beast::websocket::stream<tcp::socket> socket_;
  std::atomic<std::int64_t> pictures_ = 0;
  std::atomic<std::int64_t> bytes_ = 0;
  std::jthread thread_;  ///< last member, so that it is joined while the others exist
};

/// A section of the session in simulated time, with or without viewers.
struct Turn {
  double from_s = 0.0;
  double to_s = 0.0;
  bool watched = false;
};

/// A temporary folder that is removed by its destructor.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("stylet-viewers-" + std::to_string(::getpid()));
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

fs::path recording_in(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder)) return entry.path() / "run.h5";
  return {};
}

void add_turn(const Turn& turn, const std::vector<Step>& steps, ViewersReport::Condition& condition) {
  DeadlineHistogram times;
  for (const Step& step : steps) {
    if (step.time_s <= turn.from_s || step.time_s > turn.to_s) continue;
    times.add(std::llround(1e3 * step.step_us));
    if (step.dt_s > 1.5 * kDrivenStep_s) ++condition.late;
  }
  condition.p99_ns.push_back(times.quantile_ns(0.99));
  condition.step_cpu.merge(times);
}

double median_of(std::vector<std::int64_t> values) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return 0.5 * static_cast<double>(values[half] + values[(values.size() - 1) / 2]);
}

}  // namespace

double ViewersReport::p99_ratio() const { return median_of(with.p99_ns) / median_of(without.p99_ns); }

Result<ViewersReport> bench_viewers(const ViewersBenchOptions& options, const Progress& progress) {
  const auto anatomy = mesh_demo(options.nodes, progress);
  if (!anatomy) return anatomy.error();
  Scenario scenario = driven_scenario(options.contacts);
  if (options.ultrasound) scenario.probe.kind = ProbeKind::biplane;
  const auto model = Model::compile(scenario, anatomy->mesh, "the demo", {}, progress);
  if (!model) return model.error();
  const PlannedInsertion& plan = (*model)->insertions().front();
  const Pose first = plan.motion.at(0.0);
  const Vec3 tip = first.origin + (*model)->scenario().needle.length_mm * (first.rotation * Vec3::UnitZ());
  const double start_mm = (tip - plan.entry).dot(plan.direction);
  const double turn_s = kDrivenStep_s * static_cast<double>(driven_depths(start_mm).size());
  const int pairs = std::max(1, static_cast<int>(std::lround(options.seconds / (2.0 * turn_s))));
  const double all_s = (2 * pairs + 1) * (turn_s + 2.0 * kChange_s);

  const Folder folder;
  auto script = std::make_shared<Script>(driven_motion(plan, start_mm, 2.0 * all_s));
  serve::ServerSettings settings;
  settings.port = 0;
  settings.asks_for_token = false;
  settings.session.cases = {{"the demo", [&](const Progress&) { return Result(serve::LoadedCase{*model, {}}); }}};
  settings.session.recordings = folder.path;
  settings.session.companion = script;
  settings.session.field_waits_s = 0.0;  // the field is prepared before the first turn begins
  auto server = serve::Server::open(std::move(settings));
  if (!server) return server.error();
  (*server)->start();
  const auto wait_until = [&](double time_s) -> Result<> {
    using Clock = std::chrono::steady_clock;
    Clock::time_point moved = Clock::now();
    for (double last_s = script->time_s(); last_s < time_s;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
      if (std::exchange(last_s, script->time_s()) != last_s) moved = Clock::now();
      report(progress, "real time", last_s / all_s);
      if (std::chrono::duration<double>(Clock::now() - moved).count() > kPatience_s)
        return failure("live session", "its real-time loop does not advance",
                       "Check whether stylet serve runs on this machine");
    }
    return Ok{};
  };

  ViewersReport result;
  result.nodes = (*model)->mesh().node_count();
  result.viewers = options.ultrasound ? 0 : options.viewers;
  std::vector<Turn> turns;
  double watched_s = 0.0;
  // The first turn is not counted, because the skin breaks only then and the displacement field is being prepared.
  if (auto waited = wait_until(turn_s); !waited) return waited.error();
  for (int turn = 0; turn < 2 * pairs; ++turn) {
    const bool watched = turn % 2 == 1;
    std::vector<std::unique_ptr<Viewer>> viewers;
    script->want_images(watched && options.ultrasound);
    for (int k = 0; watched && k < result.viewers; ++k) {
      auto viewer = Viewer::open((*server)->port());
      if (!viewer) return viewer.error();
      viewers.push_back(std::move(*viewer));
    }
    if (auto waited = wait_until(script->time_s() + kChange_s); !waited) return waited.error();
    const double from_s = script->time_s();
    turns.push_back({from_s, from_s + turn_s, watched});
    const std::int64_t images = script->images();
    std::vector<std::int64_t> pictures;
    std::vector<std::int64_t> bytes;
    for (const auto& viewer : viewers) {
      pictures.push_back(viewer->pictures());
      bytes.push_back(viewer->bytes());
    }
    if (auto waited = wait_until(from_s + turn_s); !waited) return waited.error();
    if (watched) {
      result.ultrasound_per_s += static_cast<double>(script->images() - images);
      watched_s += turn_s;
    }
    for (std::size_t k = 0; k < viewers.size(); ++k) {
      result.pictures_per_s += static_cast<double>(viewers[k]->pictures() - pictures[k]);
      result.megabytes_per_s += 1e-6 * static_cast<double>(viewers[k]->bytes() - bytes[k]);
    }
  }
  (*server)->stop();
  if (watched_s > 0.0) {
    result.pictures_per_s /= watched_s * std::max(1, result.viewers);
    result.megabytes_per_s /= watched_s * std::max(1, result.viewers);
    result.ultrasound_per_s /= watched_s;
  }

  const auto recording = read_recording(recording_in(folder.path));
  if (!recording) return recording.error();
  for (const Turn& turn : turns) add_turn(turn, recording->steps, turn.watched ? result.with : result.without);
  return result;
}

}  // namespace stylet::measure
