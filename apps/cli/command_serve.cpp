// SPDX-License-Identifier: GPL-3.0-or-later
#include "command.hpp"
#include "early_warnings.hpp"
#include "igtl_companion.hpp"
#include "output_path.hpp"
#include "validators.hpp"

#include "stylet/io/implant_record_io.hpp"
#include "stylet/io/model_file.hpp"
#include "stylet/io/scenario_io.hpp"
#include "stylet/patient/implant_plan.hpp"
#include "stylet/patient/prepared_model.hpp"
#include "stylet/serve/server.hpp"

#include <fmt/format.h>

#include <malloc.h>
#include <semaphore.h>
#include <unistd.h>
#include <algorithm>
#include <cmath>

#include <csignal>
#include <filesystem>

namespace stylet::cli {

namespace {

namespace fs = std::filesystem;

struct ServeArguments {
  std::vector<std::string> inputs;
  std::string address = "127.0.0.1";
  int port = 8080;
  std::string token;
  bool no_token = false;
  bool keep_token = false;
  std::string recordings = "out/live";
  double keep_GB = 5.0;
  std::string models = ModelCache::users_folder().string();
  std::vector<std::string> settings;
  IgtlArguments igtl;
};

/// Folder of the models that are installed with the program or were made when it was built.
fs::path models_beside_program() {
  std::error_code code;
  const fs::path program = fs::read_symlink("/proc/self/exe", code);
  return program.parent_path().parent_path() / "share" / "stylet" / "models";
}

void warn_if_not_kept(const PreparedModel& prepared, Console& console) {
  if (!prepared.not_kept.empty())
    console.warn("The model was not stored in the cache, so the next start takes as long: " + prepared.not_kept);
}

/// Opens a scenario with a plan of seeds and no insertion: its needles are those of the plan.
Result<serve::LoadedCase> load_implant(const fs::path& file, const std::vector<std::string>& settings,
                                       const ModelCache& cache, Console& console, const Progress& progress) {
  const Result<Scenario> scenario = read_scenario(file, settings);
  if (!scenario) return scenario.error();
  Result<ImplantPlan> plan = read_implant_plan(*scenario, file.string(), progress);
  if (!plan) return plan.error();
  if (plan->plan.implant == Implant::temporary) {
    return input_error(plan->plan.file, "the plan is a temporary implant, and the live page drops seeds",
                       "Carry it out with stylet implant, or give a plan of permanent seeds");
  }
  auto prepared = prepare_needle_of_file(file.string(), settings, plan->needles.front(), progress, &cache);
  if (!prepared) return prepared.error();
  warn_if_not_kept(*prepared, console);
  serve::LoadedCase loaded{prepared->model, prepared->notes};
  for (const auto* notes : {&plan->plan.notes, &plan->structures.notes})
    loaded.notes.insert(loaded.notes.end(), notes->begin(), notes->end());
  if (scenario->probe.kind != ProbeKind::none && !scenario->probe.in_contours) {
    loaded.notes.emplace_back(
        "The probe moves the pictures only: the seeds of the plan, their errors and their dose are those of tissue "
        "without it. stylet implant drops them under the probe.");
  }
  for (const std::string& warning : loaded.notes) console.warn(warning);
  loaded.implant = std::make_shared<serve::ImplantCase>(
      serve::ImplantCase{std::move(plan->plan), std::move(plan->source), std::move(plan->needles),
                         std::move(plan->structures.structures), std::move(plan->options)});
  return loaded;
}

/// Makes a case of the page from a scenario or a saved model. A scenario is read here, so that its errors are reported
/// before the server starts.
Result<serve::CaseSource> case_of(const fs::path& file, const ServeArguments& arguments, Console& console) {
  std::string title = file.stem().string();
  bool has_plan = false;
  std::vector<std::string> settings = arguments.settings;
  if (!is_hdf5_file(file) && !is_meant_as_model(file)) {
    const Result<Scenario> scenario = read_scenario(file, arguments.settings);
    if (!scenario) return scenario.error();
    warn_before_start(file.string(), arguments.settings, Work::preparation, console);
    title = scenario->name;
    has_plan = scenario->insertions.empty() && scenario->plan.is_given();
    if (has_plan && !scenario->procedure.stabilising.empty()) {
      console.warn(
          fmt::format("{}: the live page carries a plan of seeds out with one needle at a time, so the needles "
                      "of procedure.stabilising stay out. stylet implant holds them.",
                      file.string()));
      settings.emplace_back("procedure.stabilising=[]");
    }
  }
  return serve::CaseSource{
      title,
      [file, has_plan, &console, settings, cache = ModelCache(arguments.models, {models_beside_program()})](
          const Progress& progress) -> Result<serve::LoadedCase> {
        if (has_plan) return load_implant(file, settings, cache, console, progress);
        auto prepared = prepare_model_file(file.string(), settings, progress, &cache);
        if (!prepared) return prepared.error();
        warn_if_not_kept(*prepared, console);
        for (const std::string& warning : prepared->warnings()) console.warn(warning);
        return serve::LoadedCase{prepared->model, prepared->notes};
      }};
}

/// All scenarios and saved models of a folder, sorted by name. Files that cannot be read are left out with a warning.
std::vector<serve::CaseSource> cases_in(const fs::path& folder, const ServeArguments& arguments, Console& console) {
  std::vector<fs::path> files;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(folder, code)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".toml" || extension == ".stylet") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::vector<serve::CaseSource> cases;
  for (const fs::path& file : files) {
    if (auto source = case_of(file, arguments, console)) {
      cases.push_back(std::move(*source));
    } else {
      console.warn(source.error().message());
    }
  }
  return cases;
}

Result<> add_inputs(const ServeArguments& arguments, serve::SessionSettings& session, Console& console) {
  for (const std::string& input : arguments.inputs) {
    std::error_code code;
    if (fs::is_directory(input, code)) {
      auto cases = cases_in(input, arguments, console);
      if (cases.empty())
        return input_error(input, "there is no scenario (.toml) and no saved model (.stylet) in this folder",
                           "Give a folder that contains scenarios or saved models, or give a file");
      std::move(cases.begin(), cases.end(), std::back_inserter(session.cases));
    } else if (is_hdf5_file(input) && !is_meant_as_model(input)) {
      const fs::path file = fs::absolute(input);
      if (file.filename() != "run.h5")
        return input_error(input, "a recording is a folder that contains a file run.h5",
                           "Give the run.h5 in its folder");
      if (is_implant_record(file))
        return input_error(input, "the record of an implant, which the page cannot replay",
                           "Look at its report, or give the scenario of the implant");
      session.archive = file.parent_path().parent_path();
      session.replay = file.parent_path().filename().string();
    } else {
      auto source = need(case_of(input, arguments, console));
      session.cases.push_back(std::move(source));
    }
  }
  return Ok{};
}

/// Converts a limit in gigabytes to bytes; 0 means no limit. Rounds up, so that a small limit does not become 0.
std::uintmax_t keep_bytes(double keep_GB) {
  return keep_GB > 0.0 ? static_cast<std::uintmax_t>(std::ceil(1e9 * keep_GB)) : 0;
}

constexpr unsigned kMostEnding_s = 4;
constexpr int kLargeBlock = 1 << 20;  // [bytes]

/// Waits for SIGINT or SIGTERM. A handler takes them, whichever thread they meet: libraries have threads that began
/// before this program could block a signal in them.
class EndSignal {
 public:
  EndSignal() {
    sem_init(&came(), 0, 0);
    for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { sem_post(&came()); });
  }
  void wait() {
    while (sem_wait(&came()) != 0) {
    }
    for (const int signal : {SIGINT, SIGTERM})
      std::signal(signal, SIG_DFL);  // a second signal ends the program at once
  }
  /// Ends the program after this time [s] whatever it does: a factorisation cannot be interrupted, and with too little
  /// memory nothing is quick. A recording that is not closed by then has all steps but those of the last 0.2 s.
  static void end_within(unsigned seconds) {
    std::signal(SIGALRM, [](int) { _exit(0); });
    alarm(seconds);
  }

 private:
  static sem_t& came() {
    static sem_t semaphore;
    return semaphore;
  }
};

Result<> run_serve(const ServeArguments& arguments, Console& console) {
  // The matrices of a model that is no longer needed go back to the system at once; otherwise a server that has had
  // many needles keeps a quarter more memory (tests/serve/measure_live.cpp).
  mallopt(M_MMAP_THRESHOLD, kLargeBlock);
  serve::ServerSettings settings;
  settings.address = arguments.address;
  settings.port = static_cast<std::uint16_t>(arguments.port);
  settings.token = arguments.token;
  settings.asks_for_token = !arguments.no_token;
  if (const fs::path cache = ModelCache::users_folder(); arguments.keep_token && !cache.empty())
    settings.token_file = cache.parent_path() / "live_token";
  settings.session.recordings = arguments.recordings;
  settings.session.keep_bytes = keep_bytes(arguments.keep_GB);
  settings.session.say = [&console](const std::string& text) { console.warn(text); };
  settings.session.log = [&console](const std::string& text) { console.detail(text); };
  need(check_output_folder(arguments.recordings));
  need(add_inputs(arguments, settings.session, console));
  EndSignal end;
  auto igtl = need(open_igtl(arguments.igtl));
  settings.session.companion = igtl.companion;
  if (arguments.igtl.hand == "igtl") settings.session.runner.late_after_s = kIgtlLateAfter_s;
  const std::string recordings = settings.session.recordings.string();
  auto server = need(serve::Server::open(std::move(settings)));
  if (igtl.accept_token) igtl.accept_token(server->token());
  server->start();
  console.say(fmt::format("Open {} in a browser. Ctrl-C ends it.", server->url()));
  const std::string limit =
      arguments.keep_GB > 0.0
          ? fmt::format("The oldest recordings are removed when all together take more than {:g} GB (--keep).",
                        arguments.keep_GB)
          : "Recordings may fill the disk (--keep 0).";
  console.say(fmt::format("Recordings are written to {}. {}", recordings, limit));
  if (arguments.no_token) console.warn("Every user of this machine can open this address and move the needle.");
  if (!igtl.warning.empty()) console.warn(igtl.warning);
  if (igtl.companion) console.say(igtl.said);
  Json json{{"url", server->url()}, {"port", server->port()}};
  if (igtl.companion) json["igtl"] = igtl.json;
  need(console.write_json(json));
  end.wait();
  console.say("Closing the recording, then the program ends.");
  EndSignal::end_within(kMostEnding_s);
  server->stop();
  return Ok{};
}

}  // namespace

Command add_serve_command(CLI::App& program) {
  auto arguments = std::make_shared<ServeArguments>();
  CLI::App* app = program.add_subcommand(
      "serve", "Run a live simulation in which you move the needle in a browser. Not a medical device");
  option(app, "INPUT", arguments->inputs, "SCENARIO.toml",
         "Scenario files (TOML), models saved by `stylet prepare`, folders of such files, or the run.h5 of a "
         "recording to replay")
      ->required();
  option(app, "--port", arguments->port, "P", "Port to listen on; 0 chooses a free port")
      ->capture_default_str()
      ->check(whole_number_between(0, 65535));
  option(app, "--address", arguments->address, "IP",
         "Address to listen on; the default serves this machine only, 0.0.0.0 every network of this machine")
      ->capture_default_str();
  option(app, "--token", arguments->token, "TEXT",
         "Token that viewers must know (default: a random one at each start); safer in the environment variable, which "
         "other users of this machine cannot read")
      ->envname("STYLET_TOKEN");
  app->add_flag("--no-token", arguments->no_token,
                "Let every user of this machine open the page without a token, for example where nobody else can log "
                "in");
  app->add_flag(
      "--keep-token", arguments->keep_token,
      "Use the same random token at each start, so that an open page connects to the next server; it is kept in "
      "~/.cache/stylet/live_token");
  option(app, "-o,--output", arguments->recordings, "OUT/", "Folder for the recordings, one for each insertion")
      ->capture_default_str();
  option(app, "--keep", arguments->keep_GB, "GB",
         "Gigabytes that all recordings may take together; the oldest are removed when they take more; 0 sets no limit")
      ->capture_default_str()
      ->check(number_between(0.0, 1e6, "GB"));
  option(app, "--models", arguments->models, "MODELS/",
         "Folder in which compiled models are kept, so that a case opens at once the next time (default: "
         "~/.cache/stylet/models); \"\" keeps none");
  repeated_option(app, "--set", arguments->settings, "KEY=VALUE",
                  "Set a key of the scenarios, e.g. --set mesh.nodes=5000; may be repeated");
  add_igtl_options(*app, arguments->igtl);
  return {app, [arguments](Console& console) { return run_serve(*arguments, console); }};
}

}  // namespace stylet::cli
