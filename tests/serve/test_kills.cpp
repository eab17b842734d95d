// SPDX-License-Identifier: GPL-3.0-or-later
// A server that is killed during an insertion. Its recording must be complete up to the last second.
#include "results/run_file_writer.hpp"
#include "serving.hpp"

#include "stylet/io/recording_io.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/sim/recorded_steps.hpp"

#include <sys/wait.h>

#include <csignal>
#include <random>
#include <thread>

using namespace stylet;
using namespace stylet::test;

namespace {

namespace fs = std::filesystem;

/// A server in a process of its own, which runs until it is killed.
class ServingProcess {
 public:
  explicit ServingProcess(const std::shared_ptr<const Model>& model, const fs::path& archive = {}) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    pid_ = fork();
    if (pid_ == 0) {
      const Serving serving([&](serve::ServerSettings& s) {
        s.session.archive = archive;
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

/// Moves the needle until a time of its own [s] and kills the server. @return how much of it the recording lacks [s]
double lost_by_a_kill(ServingProcess& server, LiveClient& client, double after_s) {
  client.command(R"({"do": "take"})");
  client.hand(40.0F, 8.0F);  // keeps moving for 5 s, because a rest is recorded only at its end
  const double until_s = client.time_s + after_s;
  EXPECT_TRUE(client.until([&] { return client.time_s >= until_s; }));
  server.kill();

  const auto recording = read_recording(server.recording());
  EXPECT_TRUE(recording.ok()) << recording.error().message();
  if (!recording) return client.time_s;
  double time_s = 0.0;
  const RecordedSteps steps(recording->steps);
  for (std::int64_t step = 0; step < steps.count(); ++step) {
    time_s += steps.at(step).dt_s;
    EXPECT_NEAR(steps.at(step).time_s, time_s, 1e-9) << "a step before it is missing";
  }
  return client.time_s - time_s;
}

/// Writes a recording of 200 MB and more below a folder: a run of a second, over and over.
void write_long_recording(const fs::path& folder, const Model& model) {
  fs::create_directories(folder);
  RunInfo info;
  info.scenario_text = to_toml(model.scenario());
  auto writer = value_of(results::RunFileWriter::create(folder / "run.h5", info, model.mesh()));
  std::vector<Step> steps(10000);
  for (int part = 0; fs::file_size(folder / "run.h5") < 200'000'000; ++part) {
    for (std::size_t k = 0; k < steps.size(); ++k) {
      steps[k].dt_s = 1e-3;
      steps[k].time_s = 1e-3 * static_cast<double>(static_cast<std::size_t>(part) * steps.size() + k + 1);
    }
    ASSERT_TRUE(writer.append(std::span<const Step>(steps)).ok() && writer.flush().ok());
  }
  ASSERT_TRUE(writer.close().ok());
}

}  // namespace

TEST(KilledServer, loses_at_most_a_second_of_its_recording_a_hundred_times) {
  const auto model = compiled(hole_scenario());
  std::mt19937 random(20051026);
  std::uniform_real_distribution<double> moment_s(0.1, 1.5);
  for (int k = 0; k < 100; ++k) {
    ServingProcess server(model);
    LiveClient client(server.port());
    ASSERT_TRUE(client.until([&] { return client.ready(); }));
    EXPECT_LT(lost_by_a_kill(server, client, moment_s(random)), 1.0);
  }
}

TEST(KilledServer, loses_no_more_while_somebody_downloads_a_long_recording) {
  const auto model = compiled(hole_scenario());
  const ProcessFolder archive;
  write_long_recording(archive.path / "2026-01-01-000000-long", *model);
  std::mt19937 random(20051026);
  std::uniform_real_distribution<double> moment_s(0.5, 4.0);
  double most_s = 0.0;
  for (int k = 0; k < 20; ++k) {
    ServingProcess server(model, archive.path);
    LiveClient client(server.port());
    ASSERT_TRUE(client.until([&] { return client.ready(); }));
    std::thread visitor([port = server.port()] {
      try {
        (void)get(port, "/recordings/2026-01-01-000000-long/forces.csv");
      } catch (const std::exception&) {
        // The server has been killed.
      }
    });
    most_s = std::max(most_s, lost_by_a_kill(server, client, moment_s(random)));
    visitor.join();
  }
  std::cout << "most of a recording that was lost: " << most_s << " s\n";
  EXPECT_LT(most_s, 0.5);
}
