// SPDX-License-Identifier: GPL-3.0-or-later
// A server that is killed during an insertion. Its recording must be complete up to the last second, and the seeds of
// an implant must be there after the restart.
#include "results/run_file_writer.hpp"
#include "small_implant.hpp"

#include "stylet/io/recording_io.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/sim/recorded_steps.hpp"

#include <sys/wait.h>

#include <algorithm>
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
  /// @param recordings folder, which stays; empty: one of its own, which is removed
  explicit ServingProcess(const serve::LoadedCase& loaded, const fs::path& archive = {},
                          const fs::path& recordings = {}) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    pid_ = fork();
    if (pid_ == 0) {
      const Serving serving([&](serve::ServerSettings& s) {
        s.session.archive = archive;
        s.session.cases = {{"box", [&](const Progress&) { return Result(loaded); }}};
        if (!recordings.empty()) s.session.recordings = recordings;
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

/// A page that carries an implant out, as fast as it can, until a moment that comes by chance.
class HastyPage {
 public:
  HastyPage(std::uint16_t port, std::mt19937& random) : client_(port), random_(random) {
    EXPECT_TRUE(client_.until([&] { return client_.ready() && client_.implant.contains("seeds"); }));
    EXPECT_TRUE(client_.take());
  }

  /// Goes on with an implant that is offered.
  void go_on() {
    ASSERT_TRUE(client_.until([&] { return !client_.status["interrupted"].is_null(); })) << client_.status;
    offered = client_.status["interrupted"];
    client_.command(R"({"do":"interrupted","go_on":1})");
    ASSERT_TRUE(client_.until([&] {
      return count() == offered["seeds"] && client_.status["interrupted"].is_null() && is_computed() &&
             client_.depth_mm < 0.0F && client_.status.value("insertion", "") == offered["needle"];
    })) << client_.status;
  }

  void work_for(std::chrono::milliseconds time) {
    end_ = std::chrono::steady_clock::now() + time;
    while (!is_over()) {
      const std::size_t needle = client_.plan["current"];
      const auto& seeds = client_.plan["needles"][needle]["seeds"];
      const auto of_needle = static_cast<std::size_t>(
          std::ranges::count_if(client_.implant["seeds"], [&](const auto& seed) { return seed["needle"] == needle; }));
      if (count() + 1 >= client_.implant["planned_seeds"] || (count() > 1 && random_() % 5 == 0)) {
        act(R"({"do":"undo"})", [&, before = count()] { return count() != before; });
      } else if (of_needle == seeds.size() || random_() % 6 == 0) {
        const std::size_t other = 1 - needle;
        act(R"({"do":"needle","index":)" + std::to_string(other) + "}",
            [&] { return client_.plan["current"] == other && client_.depth_mm < 0.0F; });
      } else {
        const double depth_mm = seeds[of_needle]["drop_depth_mm"];
        client_.hand(static_cast<float>(depth_mm), 150.0F);
        (void)client_.until([&] { return std::abs(client_.depth_mm - depth_mm) < 1.0 || is_over(); });
        if (!is_over()) act(R"({"do":"drop"})", [&, before = count()] { return count() != before; });
      }
    }
  }

  [[nodiscard]] std::size_t count() const { return client_.implant["seeds"].size(); }
  [[nodiscard]] bool is_computed() const {
    return !client_.implant["now"].is_null() && !client_.implant.value("computing", true) &&
           client_.implant["now"]["seeds"] == count();
  }
  [[nodiscard]] const nlohmann::json& implant() const { return client_.implant; }
  /// Number of seeds that a command that was not answered may have added, or taken away.
  int under_way = 0;
  nlohmann::json offered;

 private:
  [[nodiscard]] bool is_over() const { return std::chrono::steady_clock::now() > end_; }
  void act(const std::string& command, const std::function<bool()>& is_done) {
    under_way = command.find("drop") != std::string::npos ? 1 : command.find("undo") != std::string::npos ? -1 : 0;
    client_.command(command);
    // A needle that is not compiled takes longer than the page may live.
    (void)client_.until([&] { return is_done() || is_over(); });
    if (is_done()) under_way = 0;
  }

  LiveClient client_;
  std::mt19937& random_;
  std::chrono::steady_clock::time_point end_;
};

/// Whether two seeds of messages, whose lengths are rounded to a micrometre, are the same.
void expect_same_seed(const nlohmann::json& was, const nlohmann::json& is) {
  const auto expect_same = [](const nlohmann::json& a, const nlohmann::json& b, const std::string& what) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(a[axis].get<double>(), b[axis].get<double>(), 1.001e-3) << what;
  };
  for (const char* key : {"number", "needle", "in_tissue", "lost"}) EXPECT_EQ(was[key], is[key]) << key;
  for (const char* key : {"planned_mm", "dropped_mm", "rest_mm", "axis"}) expect_same(was[key], is[key], key);
  for (const auto& [cause, part] : was["why"].items()) expect_same(part, is["why"][cause], cause);
}

/// Kills a server during an implant and goes on with the next one in the same folder, again and again.
void kill_an_implant(int times, std::uint_fast32_t start) {
  Scenario scenario = box_scenario();
  scenario.procedure.technique = SeedTechnique::pushed;
  scenario.seed = {.stranded = true, .release_sd_mm = 1.0, .loss_percent = 10.0, .random = 3};
  const ProcessFolder folder;
  const serve::LoadedCase loaded = value_of(implant_case([&](Scenario& s) { s = scenario; }).load({}));
  std::mt19937 random(start);
  std::uniform_int_distribution<int> moment_ms(50, 2500);
  nlohmann::json seen;  // by the page whose server was killed
  int under_way = 0, compared = 0, compared_doses = 0;
  for (int k = 0; k <= times; ++k) {
    ServingProcess server(loaded, {}, folder.path);
    HastyPage page(server.port(), random);
    const std::size_t before = seen.is_null() ? 0 : seen["seeds"].size();
    if (before > 0) {
      page.go_on();
      const auto& seeds = page.implant()["seeds"];
      const int more = static_cast<int>(seeds.size()) - static_cast<int>(before);
      EXPECT_TRUE(more == 0 || more == under_way) << before << " seeds became " << seeds.size();
      // A strand moves its other seeds when one is added or taken away.
      for (std::size_t of = 0; of < before && more == 0; ++of) expect_same_seed(seen["seeds"][of], seeds[of]);
      ++compared;
      const auto &was = seen["now"], &is = page.implant()["now"];
      if (more == 0 && !was.is_null() && was["seeds"] == before && !seen["computing"]) {
        EXPECT_NEAR(is["d90_Gy"].get<double>(), was["d90_Gy"].get<double>(), 1e-3 * was["d90_Gy"].get<double>());
        ++compared_doses;
      }
      EXPECT_GE(page.implant()["tally"]["skin_punctures"], seen["tally"]["skin_punctures"].get<int>() - 1)
          << "the last one may not have reached the disk";
    }
    page.work_for(std::chrono::milliseconds(moment_ms(random)));
    server.kill();
    seen = page.implant();
    under_way = page.under_way;
    if (::testing::Test::HasFailure()) FAIL() << "after kill " << k;
  }
  EXPECT_GT(compared, times / 2);
  EXPECT_GT(compared_doses, times / 5);  // on a busy machine few are computed when the server is killed
}

}  // namespace

TEST(KilledImplant, has_the_same_seeds_causes_and_dose_after_the_restart) { kill_an_implant(4, 5); }

TEST(KilledServer, gives_an_implant_back_fifty_times) { kill_an_implant(50, 20051027); }

TEST(KilledServer, loses_at_most_a_second_of_its_recording_a_hundred_times) {
  const auto model = compiled(hole_scenario());
  std::mt19937 random(20051026);
  std::uniform_real_distribution<double> moment_s(0.1, 1.5);
  for (int k = 0; k < 100; ++k) {
    ServingProcess server(serve::LoadedCase{model, {}});
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
    ServingProcess server(serve::LoadedCase{model, {}}, archive.path);
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
