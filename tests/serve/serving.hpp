// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "live_client.hpp"

#include "sim/box_patient.hpp"
#include "stylet/serve/server.hpp"
#include "support/value_of.hpp"

#include <unistd.h>

#include <filesystem>

namespace stylet::test {

/// A temporary folder named after a process, removed at the end of the test.
struct ProcessFolder {
  static std::filesystem::path of(pid_t process) {
    return std::filesystem::temp_directory_path() / ("stylet-serve-" + std::to_string(process));
  }
  std::filesystem::path path = of(::getpid());
  ProcessFolder() { std::filesystem::remove_all(path); }
  ~ProcessFolder() { std::filesystem::remove_all(path); }
};

inline Scenario hole_scenario() {
  Scenario s = box_scenario();
  s.insertions[0].entry_mm.reset();
  s.tissue_model.creep = 1.0;  // elastic tissue comes to rest together with the needle
  s.insertions[0].hole = "D4";
  s.insertions[0].depth_mm = 30.0;
  return s;
}

inline serve::CaseSource box_case(const std::string& title, const Scenario& scenario = hole_scenario()) {
  return {title, [scenario](const Progress& progress) -> Result<serve::LoadedCase> {
            auto model = Model::compile(scenario, box_patient(), "case.toml", {}, progress);
            if (!model) return model.error();
            return serve::LoadedCase{*model, {"the box has a note"}};
          }};
}

/// A server on a free port with two cases. It runs slowly enough for builds with sanitizers.
struct Serving {
  ProcessFolder folder;
  std::unique_ptr<serve::Server> server;

  explicit Serving(const std::function<void(serve::ServerSettings&)>& change = {}) {
    serve::ServerSettings s;
    s.port = 0;
    s.asks_for_token = false;
    s.hand_silence_s = 10.0;  // tests read the messages of one viewer at a time
    s.session.cases = {box_case("first"), box_case("second")};
    s.session.recordings = folder.path;
    s.session.runner.period_s = 4e-3;
    s.session.runner.late_after_s = 0.5;
    s.session.runner.realtime_scheduling = false;
    s.session.runner.lock_memory = false;
    s.session.field_waits_s = 0.0;  // no page draws in these tests, and recordings have frames only with a field
    if (change) change(s);
    server = value_of(serve::Server::open(std::move(s)));
    server->start();
  }
  [[nodiscard]] std::uint16_t port() const { return server->port(); }
};

/// Everything that the session has recorded.
inline std::vector<std::filesystem::path> recordings_of(const Serving& serving) {
  std::vector<std::filesystem::path> folders;
  for (const auto& entry : std::filesystem::directory_iterator(serving.folder.path)) folders.push_back(entry.path());
  return folders;
}

inline std::unique_ptr<LiveClient> ready_client(const Serving& serving) {
  auto client = std::make_unique<LiveClient>(serving.port());
  EXPECT_TRUE(client->until([&] { return client->ready(); }));
  return client;
}

}  // namespace stylet::test
