// SPDX-License-Identifier: GPL-3.0-or-later
// A server that is killed during an insertion. Its recording must be complete up to the last second.
#include "serving.hpp"

#include "stylet/io/recording_io.hpp"
#include "stylet/sim/recorded_steps.hpp"

#include <sys/wait.h>

#include <csignal>
#include <random>

using namespace stylet;
using namespace stylet::test;

namespace {

namespace fs = std::filesystem;

/// A server in a process of its own, which runs until it is killed.
class ServingProcess {
 public:
  explicit ServingProcess(const std::shared_ptr<const Model>& model) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    pid_ = fork();
    if (pid_ == 0) {
      const Serving serving([&](serve::ServerSettings& s) {
        s.session.cases = {{"box", [&](const Progress&) { return Result(serve::LoadedCase{model, {}}); }}};
      });
      const std::uint16_t port = serving.port();
      if (write(ends[1], &port, sizeof port) != sizeof port) _exit(1);
      while (true) pause();
    }
    close(ends[1]);
    if (read(ends[0], &port_, sizeof port_) != sizeof port_) throw std::runtime_error("the server did not start");
    close(ends[0]);
    folder_ = ProcessFolder::of(pid_);
  }
  ~ServingProcess() {
    if (pid_ > 0) kill();
    fs::remove_all(folder_);
  }
  ServingProcess(const ServingProcess&) = delete;
  ServingProcess& operator=(const ServingProcess&) = delete;

  void kill() {
    ::kill(pid_, SIGKILL);
    int status = 0;
    waitpid(pid_, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status)) << "the server ended by itself";
    pid_ = 0;
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] fs::path recording() const {
    for (const auto& entry : fs::directory_iterator(folder_)) return entry.path() / "run.h5";
    return {};
  }

 private:
  pid_t pid_ = 0;
  std::uint16_t port_ = 0;
  fs::path folder_;
};

}  // namespace

TEST(KilledServer, loses_at_most_a_second_of_its_recording_a_hundred_times) {
  const auto model = compiled(hole_scenario());
  std::mt19937 random(20051026);
  std::uniform_real_distribution<double> moment_s(0.1, 1.5);
  for (int k = 0; k < 100; ++k) {
    ServingProcess server(model);
    LiveClient client(server.port());
    ASSERT_TRUE(client.until([&] { return client.ready(); }));
    client.command(R"({"do": "take"})");
    client.hand(40.0F, 20.0F);  // keeps moving, because a rest is recorded only at its end
    const double until_s = client.time_s + moment_s(random);
    ASSERT_TRUE(client.until([&] { return client.time_s >= until_s; }));
    server.kill();

    const auto recording = read_recording(server.recording());
    ASSERT_TRUE(recording.ok()) << recording.error().message();
    const double recorded_s = recording->steps.empty() ? 0.0 : recording->steps.back().time_s;
    EXPECT_GT(recorded_s, client.time_s - 1.0);
    double time_s = 0.0;
    const RecordedSteps steps(recording->steps);
    for (std::int64_t step = 0; step < steps.count(); ++step) {
      time_s += steps.at(step).dt_s;
      ASSERT_NEAR(steps.at(step).time_s, time_s, 1e-9) << "a step before it is missing";
    }
  }
}
