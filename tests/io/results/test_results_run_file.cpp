// SPDX-License-Identifier: GPL-3.0-or-later
// Tests that run.h5 can be read, also while the writer is at work or after it was killed.
#include "results/recorder.hpp"
#include "results/run_file_format.hpp"
#include "stylet/io/recorded_moments.hpp"
#include "stylet/io/recording_io.hpp"
#include "stylet/io/scenario_io.hpp"
#include "summary_json.hpp"
#include "synthetic_run.hpp"

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <random>
#include <thread>

using namespace stylet;
using namespace stylet::results;
using stylet::testing::synthetic_run;
using stylet::testing::TemporaryFolder;
namespace fs = std::filesystem;

namespace {

StoredFrame stored(const Frame& frame) {
  const Eigen::VectorXf single = frame.displacement.cast<float>();
  return {frame, {single.data(), single.data() + single.size()}};
}

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// The type of rows without some columns, at the places of the rows in memory.
template <class T, class LeftOut>
h5::Handle type_without(const LeftOut& left_out) {
  const h5::Handle now = record::row_type<T>();
  h5::Handle then = h5::compound_type(H5Tget_size(now));
  for (unsigned k = 0; k < static_cast<unsigned>(H5Tget_nmembers(now)); ++k) {
    char* text = H5Tget_member_name(now, k);
    const std::string name = text;
    H5free_memory(text);
    if (!left_out(name))
      h5::insert_member(then, name.c_str(), H5Tget_member_offset(now, k),
                        h5::Handle(H5Tget_member_type(now, k), H5Tclose));
  }
  return then;
}

void expect_same_step(const Step& a, const Step& b) {
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.dt_s, b.dt_s);
  EXPECT_EQ(a.base.origin, b.base.origin);
  EXPECT_EQ(a.base.rotation.coeffs(), b.base.rotation.coeffs());
  EXPECT_EQ(a.base_depth_mm, b.base_depth_mm);
  EXPECT_EQ(a.force_axial_N, b.force_axial_N);
  EXPECT_EQ(a.force_sagittal_N, b.force_sagittal_N);
  EXPECT_EQ(a.force_lateral_N, b.force_lateral_N);
  EXPECT_EQ(a.torque_Nmm, b.torque_Nmm);
  EXPECT_EQ(a.tip_mm, b.tip_mm);
  EXPECT_EQ(a.tip_state, b.tip_state);
  EXPECT_EQ(a.contacts, b.contacts);
  EXPECT_EQ(a.sticking, b.sticking);
  EXPECT_EQ(a.iterations, b.iterations);
  EXPECT_EQ(a.flags, b.flags);
  EXPECT_EQ(a.step_us, b.step_us);
  EXPECT_EQ(a.rest_steps, b.rest_steps);
}

void expect_same_frame(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.base_depth_mm, b.base_depth_mm);
  EXPECT_EQ(a.label, b.label);
  ASSERT_EQ(a.displacement.size(), b.displacement.size());
  EXPECT_EQ(VecX(a.displacement.cast<float>().cast<double>()), b.displacement);  // stored with single precision
  EXPECT_EQ(a.needle, b.needle);
  ASSERT_EQ(a.contacts.size(), b.contacts.size());
  for (std::size_t c = 0; c < a.contacts.size(); ++c) {
    EXPECT_EQ(a.contacts[c].position, b.contacts[c].position);
    EXPECT_EQ(a.contacts[c].force, b.contacts[c].force);
    EXPECT_EQ(a.contacts[c].s, b.contacts[c].s);
    EXPECT_EQ(a.contacts[c].sticking, b.contacts[c].sticking);
    EXPECT_EQ(a.contacts[c].tip, b.contacts[c].tip);
  }
}

}  // namespace

TEST(RunFile, holds_everything_that_was_written) {
  const auto run = synthetic_run();
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "run.h5";
  {
    auto writer = RunFileWriter::create(path, run.info, run.mesh);
    ASSERT_TRUE(writer.ok()) << writer.error().message();
    Recorder recorder(std::move(*writer));
    for (const auto& step : run.steps) ASSERT_TRUE(recorder.add(step).ok());
    for (const auto& frame : run.frames) ASSERT_TRUE(recorder.add(stored(frame)).ok());
    const auto closed = recorder.close(&run.summary);
    ASSERT_TRUE(closed.ok()) << closed.error().message();
  }
  const auto back = read_recording(path);
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_EQ(back->mesh.nodes, run.mesh.nodes);
  EXPECT_EQ(back->mesh.tets, run.mesh.tets);
  EXPECT_EQ(back->mesh.tet_region, run.mesh.tet_region);
  EXPECT_EQ(back->mesh.regions, run.mesh.regions);

  EXPECT_EQ(back->info.version, run.info.version);
  EXPECT_EQ(back->info.scenario_name, run.info.scenario_name);
  EXPECT_EQ(back->info.scenario_text, run.info.scenario_text);
  EXPECT_EQ(back->info.method, run.info.method);
  EXPECT_EQ(back->info.supports, run.info.supports);
  EXPECT_EQ(back->info.warnings, run.info.warnings);
  EXPECT_EQ(back->info.needle_diameter_mm, run.info.needle_diameter_mm);
  EXPECT_EQ(back->info.needle_length_mm, run.info.needle_length_mm);
  EXPECT_EQ(back->info.target_regions, run.info.target_regions);
  EXPECT_EQ(back->info.entry_mm, run.info.entry_mm);
  EXPECT_EQ(back->info.direction, run.info.direction);
  ASSERT_EQ(back->info.parameters.size(), run.info.parameters.size());
  for (std::size_t k = 0; k < run.info.parameters.size(); ++k) {
    EXPECT_EQ(back->info.parameters[k].name, run.info.parameters[k].name);
    EXPECT_EQ(back->info.parameters[k].value, run.info.parameters[k].value);
    EXPECT_EQ(back->info.parameters[k].unit, run.info.parameters[k].unit);
    EXPECT_EQ(back->info.parameters[k].source, run.info.parameters[k].source);
  }

  ASSERT_EQ(back->steps.size(), run.steps.size());
  for (std::size_t k = 0; k < run.steps.size(); ++k) expect_same_step(run.steps[k], back->steps[k]);
  ASSERT_EQ(back->frames.size(), run.frames.size());
  for (std::size_t k = 0; k < run.frames.size(); ++k) expect_same_frame(run.frames[k], back->frames[k]);

  ASSERT_TRUE(back->summary.has_value());
  EXPECT_EQ(back->summary->peak_axial_N, run.summary.peak_axial_N);
  EXPECT_EQ(back->summary->events.size(), run.summary.events.size());
}

TEST(RunFile, holds_steps_at_rest_as_a_number_and_refuses_one_that_does_not_fit_the_times) {
  const auto run = synthetic_run();
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "run.h5";
  for (const std::int64_t rest_steps : {3, 4, -1}) {
    {
      auto writer = RunFileWriter::create(path, run.info, run.mesh);
      ASSERT_TRUE(writer.ok()) << writer.error().message();
      Step first = run.steps[0];
      first.dt_s = 1e-3;
      Step second = first;
      second.time_s = first.time_s + 4e-3;
      second.rest_steps = rest_steps;
      ASSERT_TRUE(writer->append(std::span<const Step>(std::array{first, second})).ok());
      ASSERT_TRUE(writer->close().ok());
    }
    const auto back = read_recording(path);
    ASSERT_EQ(back.ok(), rest_steps == 3);
    if (back.ok()) {
      EXPECT_EQ(back->steps[1].rest_steps, 3);
    } else {
      EXPECT_NE(back.error().message().find("rest_steps"), std::string::npos) << back.error().message();
    }
  }
}

TEST(RunFile, of_the_first_version_has_its_steps_without_what_they_were_given) {
  const auto run = synthetic_run();
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "run.h5";
  {
    auto writer = RunFileWriter::create(path, run.info, run.mesh);
    ASSERT_TRUE(writer.ok()) << writer.error().message();
    Recorder recorder(std::move(*writer));
    ASSERT_TRUE(recorder.close(nullptr).ok());
  }
  {  // in earlier versions the table of steps had no columns dt_s, base_x_mm … base_qz and flags
    const h5::Handle file(h5::check(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), "open"), H5Fclose);
    const auto steps = record::rows_of(std::span<const Step>(run.steps));
    const h5::Handle then = type_without<Step>([&](const std::string& name) {
      return name == "dt_s" || name == "flags" || (name.starts_with("base_") && name != "base_depth_mm");
    });
    ASSERT_EQ(H5Tget_nmembers(then), 27 - 9);
    h5::check(H5Ldelete(file, "steps", H5P_DEFAULT), "delete");
    h5::check(H5Adelete(file, "format_version"), "delete");
    h5::write_attribute(file, "format_version", std::array{1});
    h5::append_rows(h5::growing_dataset(file, "steps", then, {}, 1024, nullptr), then, steps.size(),
                    steps.bytes.data());
  }
  const auto back = read_recording(path);
  ASSERT_TRUE(back.ok()) << back.error().message();
  ASSERT_EQ(back->steps.size(), run.steps.size());
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    EXPECT_EQ(back->steps[k].force_axial_N, run.steps[k].force_axial_N);
    EXPECT_EQ(back->steps[k].flags, 0U);
    EXPECT_TRUE(std::isnan(back->steps[k].dt_s) && std::isnan(back->steps[k].base.origin.x()));
  }
}

TEST(RunFile, an_empty_run_without_parameters_is_readable) {
  auto run = synthetic_run();
  run.info.parameters.clear();
  run.info.supports.clear();
  run.info.warnings.clear();
  run.info.target_regions.clear();
  const TemporaryFolder folder;
  {
    auto writer = RunFileWriter::create(folder.path() / "run.h5", run.info, run.mesh);
    ASSERT_TRUE(writer.ok()) << writer.error().message();
    const Recorder recorder(std::move(*writer));
  }
  const auto back = read_recording(folder.path() / "run.h5");
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_TRUE(back->steps.empty());
  EXPECT_TRUE(back->frames.empty());
  EXPECT_TRUE(back->info.parameters.empty());
  EXPECT_FALSE(back->summary.has_value());
}

TEST(RunFile, is_readable_half_a_second_behind_while_the_run_goes_on) {
  const auto run = synthetic_run();
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "run.h5";
  auto writer = RunFileWriter::create(path, run.info, run.mesh);
  ASSERT_TRUE(writer.ok()) << writer.error().message();
  Recorder recorder(std::move(*writer));
  for (const auto& step : run.steps) ASSERT_TRUE(recorder.add(step).ok());
  ASSERT_TRUE(recorder.add(stored(run.frames.front())).ok());
  std::this_thread::sleep_for(std::chrono::milliseconds(500));  // the run is busy and adds nothing

  int status = 0;
  const pid_t reader = fork();  // another process, as a viewer would be
  if (reader == 0) {
    const auto back = read_recording(path);
    _exit(back.ok() && back->steps.size() == run.steps.size() && back->frames.size() == 1 && !back->summary ? 0 : 1);
  }
  ASSERT_EQ(waitpid(reader, &status, 0), reader);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  EXPECT_TRUE(recorder.close(nullptr).ok());
}

TEST(RunFile, a_killed_run_stays_readable_and_loses_at_most_a_second) {
  const auto run = synthetic_run();
  const TemporaryFolder folder;
  struct Victim {
    pid_t pid;
    fs::path path;
    double kill_at;
    double killed_at;
  };
  std::vector<Victim> victims;
  std::mt19937 random(20051026);
  std::uniform_real_distribution<double> moment(0.05, 2.0);
  for (int k = 0; k < 20; ++k) {
    const fs::path path = folder.path() / ("run" + std::to_string(k) + ".h5");
    const pid_t pid = fork();
    if (pid == 0) {
      auto writer = RunFileWriter::create(path, run.info, run.mesh);
      if (!writer) _exit(1);
      Recorder recorder(std::move(*writer));
      Step step = run.steps.front();
      for (std::size_t n = 0;; ++n) {
        step.time_s = now_s();  // the same clock in parent and child
        if (!recorder.add(step)) _exit(2);
        if (n % 20 == 0 && !recorder.add(stored(run.frames[(n / 20) % run.frames.size()]))) _exit(3);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    }
    victims.push_back({pid, path, 0, 0});
  }
  for (const Victim& victim : victims) {  // a run may be killed as soon as its file exists
    for (int wait = 0; wait < 1000 && !read_recording(victim.path).ok(); ++wait) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  const double start = now_s();
  for (Victim& victim : victims) victim.kill_at = start + moment(random);
  std::sort(victims.begin(), victims.end(), [](const auto& a, const auto& b) { return a.kill_at < b.kill_at; });
  for (Victim& victim : victims) {
    if (const double left = victim.kill_at - now_s(); left > 0) {
      std::this_thread::sleep_for(std::chrono::duration<double>(left));
    }
    kill(victim.pid, SIGKILL);
    victim.killed_at = now_s();
    int status = 0;
    waitpid(victim.pid, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status)) << "the writer ended by itself with status " << WEXITSTATUS(status);
  }
  for (const Victim& victim : victims) {
    const auto back = read_recording(victim.path);
    ASSERT_TRUE(back.ok()) << back.error().message();
    ASSERT_FALSE(back->steps.empty());
    ASSERT_FALSE(back->frames.empty());
    EXPECT_LT(victim.killed_at - back->steps.back().time_s, 1.0);
    for (std::size_t k = 1; k < back->steps.size(); ++k) ASSERT_LT(back->steps[k - 1].time_s, back->steps[k].time_s);
    for (std::size_t f = 0; f < back->frames.size(); ++f) {
      expect_same_frame(run.frames[f % run.frames.size()], back->frames[f]);
    }
  }
}

TEST(RunFile, replaces_an_earlier_file_without_pulling_it_away_from_a_reader) {
  const auto run = synthetic_run();
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "run.h5";
  std::ofstream(path) << "an earlier run";
  std::ifstream reader(path);
  auto writer = RunFileWriter::create(path, run.info, run.mesh);
  ASSERT_TRUE(writer.ok()) << writer.error().message();
  std::string text;
  std::getline(reader, text);
  EXPECT_EQ(text, "an earlier run");
  ASSERT_TRUE(writer->close().ok());
  EXPECT_TRUE(read_recording(path).ok());
}

TEST(RunFile, takes_away_what_processes_that_were_killed_had_not_put_in_place) {
  const auto run = synthetic_run();
  const TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) _exit(0);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  const fs::path left = folder.path() / (".run." + std::to_string(child) + ".part.h5");
  const fs::path others = folder.path() / (".run." + std::to_string(getppid()) + ".part.h5");  // of a living process
  const fs::path foreign = folder.path() / ".run.notes.part.h5";
  for (const fs::path& path : {left, others, foreign}) std::ofstream(path) << "half a run";
  auto writer = RunFileWriter::create(folder.path() / "run.h5", run.info, run.mesh);
  ASSERT_TRUE(writer.ok()) << writer.error().message();
  EXPECT_FALSE(fs::exists(left));
  EXPECT_TRUE(fs::exists(others));
  EXPECT_TRUE(fs::exists(foreign));
}

TEST(RunFile, foreign_and_damaged_files_are_refused_with_a_message) {
  const auto run = synthetic_run();
  const TemporaryFolder folder;
  EXPECT_EQ(read_recording(folder.path() / "none.h5").error().what, "no such file");
  const fs::path text = folder.path() / "text.h5";
  std::ofstream(text) << "not HDF5";
  ASSERT_FALSE(read_recording(text).ok());
  EXPECT_EQ(read_recording(text).error().kind, ErrorKind::input);

  const fs::path other = folder.path() / "other.h5";
  H5Fclose(H5Fcreate(other.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  ASSERT_FALSE(read_recording(other).ok());

  const fs::path whole = folder.path() / "whole.h5", half = folder.path() / "half.h5";
  auto writer = RunFileWriter::create(whole, run.info, run.mesh);
  ASSERT_TRUE(writer.ok() && writer->append(std::span(run.steps)).ok() && writer->close().ok());
  const std::string bytes = stylet::testing::file_text(whole);
  std::ofstream(half, std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  ASSERT_FALSE(read_recording(half).ok());
}

namespace {

/// The bytes of a finished recording, or of one that the writer has not closed.
std::string bytes_of(const stylet::testing::SyntheticRun& run, bool finished) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "run.h5";
  auto writer = RunFileWriter::create(path, run.info, run.mesh);
  bool good =
      writer.ok() && writer->append(std::span(run.steps)).ok() && writer->append(std::span(run.summary.events)).ok();
  for (const Frame& frame : run.frames) good = good && writer->append_frame(stored(frame)).ok();
  good =
      good && writer->flush().ok() && (!finished || (writer->append_summary(run.summary).ok() && writer->close().ok()));
  EXPECT_TRUE(good);
  return stylet::testing::file_text(path);
}

template <class T>
std::string packed(const T& record) {
  std::string bytes;
  record::pack(bytes, record);
  return bytes;
}

void expect_same_run(const RunRecording& a, const RunRecording& b) {
  EXPECT_EQ(start_digest(a.info, a.mesh), start_digest(b.info, b.mesh));
  ASSERT_EQ(a.steps.size(), b.steps.size());
  for (std::size_t k = 0; k < a.steps.size(); ++k) expect_same_step(a.steps[k], b.steps[k]);
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t k = 0; k < a.frames.size(); ++k) expect_same_frame(a.frames[k], b.frames[k]);
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t k = 0; k < a.events.size(); ++k) EXPECT_EQ(packed(a.events[k]), packed(b.events[k]));
  ASSERT_EQ(a.summary.has_value(), b.summary.has_value());
  if (a.summary) {
    EXPECT_EQ(summary_json(*a.summary), summary_json(*b.summary));
  }
}

/// Number of flips: STYLET_FLIPS in the environment, else a sample that takes seconds.
int flips() {
  const char* wanted = std::getenv("STYLET_FLIPS");
  return wanted == nullptr ? 60 : std::atoi(wanted);
}

}  // namespace

TEST(RunFile, with_any_bit_changed_is_refused_or_reads_as_it_was_written) {
  const auto run = synthetic_run({.cells = {4, 4, 5}, .step_s = 0.05, .frames = 4});
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "flipped.h5";
  std::mt19937 random(20051026);
  for (const bool finished : {true, false}) {
    const std::string whole = bytes_of(run, finished);
    std::ofstream(path, std::ios::binary) << whole;
    const auto expected = read_recording(path);
    ASSERT_TRUE(expected.ok()) << expected.error().message();
    EXPECT_EQ(expected->steps.size(), run.steps.size());
    EXPECT_EQ(expected->summary.has_value(), finished);
    int refused = 0;
    for (int k = 0; k < flips(); ++k) {
      const std::size_t at = random() % whole.size();
      std::string bytes = whole;
      bytes[at] ^= static_cast<char>(1 << (random() % 8));
      std::ofstream(path, std::ios::binary) << bytes;
      const auto back = read_recording(path);
      SCOPED_TRACE("byte " + std::to_string(at) + (finished ? " of a finished one" : " of an unfinished one"));
      if (back) {
        RunRecording same = *expected;
        if (!finished) {  // the recording ends before the damaged row
          if (back->steps.size() + 1 == same.steps.size()) same.steps.pop_back();
          if (back->frames.size() + 1 == same.frames.size()) same.frames.pop_back();
          if (back->events.size() + 1 == same.events.size()) same.events.pop_back();
        }
        expect_same_run(same, *back);
        continue;
      }
      ++refused;
      EXPECT_EQ(back.error().kind, ErrorKind::input);
      EXPECT_NE(back.error().message().find("flipped.h5"), std::string::npos);
      EXPECT_FALSE(back.error().cure.empty());
    }
    std::cout << (finished ? "finished: " : "unfinished: ") << refused << " of " << flips() << " refused\n";
    EXPECT_GT(refused, flips() / 10);
  }
}

namespace {

RecordedPlan two_needles() {
  RecordedPlan plan;
  plan.needles = {{"B4", "B4", Vec3(1, 2, 3), Vec3::UnitZ(), 70.0}, {"beside", "", Vec3(4, 5, 6), Vec3::UnitX(), 60.0}};
  plan.seeds = {{7, 0, Vec3(1, 2, 60), Vec3::UnitZ(), 62.0}, {8, 1, Vec3(30, 5, 6), Vec3::UnitX(), 52.0}};
  plan.current = 1;
  plan.seed_length_mm = 4.5;
  plan.seed_diameter_mm = 0.8;
  plan.prescription_Gy = 145.0;
  plan.source = "i125_6711";
  return plan;
}

std::vector<SeedAct> three_acts() {
  SeedHistory seed;
  seed.number = 7;
  seed.planned_mm = Vec3(1, 2, 60);
  seed.dropped_mm = Vec3(1.5, 2, 61);
  seed.rest_mm = Vec3(1.25, 2, 58.5);
  seed.axis = Vec3::UnitZ();
  seed.dropped_s = 4.5;
  seed.by(SeedCause::aim) = Vec3(0.5, 0, 1);
  seed.by(SeedCause::motion) = Vec3(-0.25, 0, -2.5);
  SeedHistory other = seed;
  other.number = 8;
  other.needle = 1;
  other.in_tissue = false;
  return {{SeedAct::Kind::earlier, 0.0, seed},
          {SeedAct::Kind::dropped, 1.25, other},
          {SeedAct::Kind::taken_back, 2.5, other}};
}

void write_with_seeds(const fs::path& path, const SyntheticRun& run, bool finished) {
  const RecordedPlan plan = two_needles();
  auto writer = RunFileWriter::create(path, run.info, run.mesh, {}, &plan);
  ASSERT_TRUE(writer.ok()) << writer.error().message();
  ASSERT_TRUE(writer->append(std::span(run.steps)).ok());
  const std::vector<RecordedScore> scores{{RecordedScore::kOfPlan, 2, 160.0, 110.0, 97.0}, {2, 2, 20.0, 14.0, 3.0}};
  ASSERT_TRUE(writer->append(std::span<const SeedAct>(three_acts())).ok());
  ASSERT_TRUE(writer->append(std::span(scores)).ok());
  ASSERT_TRUE((finished ? writer->close() : writer->flush()).ok());
}

}  // namespace

TEST(RunFile, of_a_live_session_holds_the_seeds_of_its_implant) {
  const auto run = synthetic_run();
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "run.h5";
  for (const bool finished : {true, false}) {
    write_with_seeds(path, run, finished);
    const auto back = read_recording(path);
    ASSERT_TRUE(back.ok()) << back.error().message();
    ASSERT_TRUE(back->implant);
    const RecordedPlan& plan = back->implant->plan;
    ASSERT_EQ(plan.needles.size(), 2u);
    EXPECT_EQ(plan.needles[1].name, "beside");
    EXPECT_EQ(plan.needles[0].hole, "B4");
    EXPECT_EQ(plan.needles[1].direction, Vec3::UnitX());
    ASSERT_EQ(plan.seeds.size(), 2u);
    EXPECT_EQ(plan.seeds[1].number, 8u);
    EXPECT_EQ(plan.seeds[1].needle, 1u);
    EXPECT_EQ(plan.seeds[1].drop_depth_mm, 52.0);
    EXPECT_EQ(plan.current, 1);
    EXPECT_EQ(plan.source, "i125_6711");
    const auto& acts = back->implant->acts;
    ASSERT_EQ(acts.size(), 3u);
    const SeedHistory expected = three_acts()[1].seed;
    EXPECT_EQ(acts[1].kind, SeedAct::Kind::dropped);
    EXPECT_EQ(acts[1].time_s, 1.25);
    EXPECT_EQ(acts[1].seed.needle, 1u);
    EXPECT_EQ(acts[1].seed.rest_mm, expected.rest_mm);
    EXPECT_EQ(acts[1].seed.dropped_s, 4.5);
    EXPECT_EQ(acts[1].seed.by(SeedCause::motion), expected.by(SeedCause::motion));
    EXPECT_FALSE(acts[1].seed.in_tissue);
    // The seeds that were in the tissue at each moment follow from the acts.
    EXPECT_EQ(back->implant->seeds_after(back->implant->acts_until(1.0)).size(), 1u);
    EXPECT_EQ(back->implant->seeds_after(back->implant->acts_until(1.25)).size(), 2u);
    ASSERT_EQ(back->implant->seeds_after(back->implant->acts_until(9.0)).size(), 1u);
    EXPECT_EQ(back->implant->seeds_after(3)[0].number, 7u);
    EXPECT_EQ(back->implant->dose_after(2)->d90_percent, 14.0);
    EXPECT_EQ(back->implant->dose_after(RecordedScore::kOfPlan)->d90_Gy, 160.0);
    EXPECT_FALSE(back->implant->dose_after(3)) << "it was not computed";
  }
}

TEST(RunFile, of_a_live_session_holds_the_way_of_the_probe) {
  auto run = synthetic_run({.cells = {4, 4, 5}, .step_s = 0.05, .frames = 4});
  Scenario scenario;
  scenario.name = "probed";
  scenario.patient.source = "/patient.json";
  scenario.insertions.resize(1);
  scenario.insertions[0].hole = "D4";
  scenario.probe.kind = ProbeKind::endfire;
  scenario.probe.in_contours = true;
  run.info.scenario_text = to_toml(scenario);
  ProbeSettings probe = scenario.probe;
  probe.lift_mm = 3.0;
  ProbeSettings then = probe;
  then.depth_mm = -12.5;
  then.tilt_deg = 4.0;
  then.roll_deg = -30.0;
  then.diameter_mm = 22.0;
  then.balloon_mm = 5.0;
  const std::vector<ProbeMove> moves{{0.0, probe}, {1.5, then}};
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "run.h5";
  for (const bool finished : {true, false}) {
    auto writer = RunFileWriter::create(path, run.info, run.mesh);
    ASSERT_TRUE(writer.ok()) << writer.error().message();
    ASSERT_TRUE(writer->append(std::span(moves)).ok());
    ASSERT_TRUE((finished ? writer->close() : writer->flush()).ok());
    const auto back = read_recording(path);
    ASSERT_TRUE(back.ok()) << back.error().message();
    ASSERT_EQ(back->probe_moves.size(), 2u);
    EXPECT_EQ(back->probe_moves[0].time_s, 0.0);
    EXPECT_EQ(back->probe_moves[0].probe, probe) << "without a depth: the middle of the gland";
    EXPECT_EQ(back->probe_moves[1].time_s, 1.5);
    EXPECT_EQ(back->probe_moves[1].probe, then);
    const RecordedMoments at(*back);
    EXPECT_EQ(at.probe_at(0.0), probe);
    EXPECT_EQ(at.probe_at(1.49), probe) << "a place holds until the next one";
    EXPECT_EQ(at.probe_at(1.5), then);
    EXPECT_EQ(at.probe_at(99.0), then);
  }
}

TEST(RunFile, with_a_changed_seed_is_refused) {
  const auto run = synthetic_run({.cells = {4, 4, 5}, .step_s = 0.05, .frames = 4});
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "run.h5";
  write_with_seeds(path, run, true);
  {
    const h5::Handle file(h5::check(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), "open"), H5Fclose);
    const h5::Handle acts = h5::dataset(file, "implant/acts");
    const h5::Handle column = h5::compound_type(sizeof(double));
    h5::insert_member(column, "time_s", 0, H5T_NATIVE_DOUBLE);
    const std::array<double, 1> later{1.5};
    h5::write_rows(acts, column, 1, 1, later.data());
  }
  const auto back = read_recording(path);
  ASSERT_FALSE(back.ok());
  EXPECT_NE(back.error().message().find("/implant/acts"), std::string::npos) << back.error().message();
}

TEST(RunFile, with_a_changed_place_of_the_probe_is_refused) {
  const auto run = synthetic_run({.cells = {4, 4, 5}, .step_s = 0.05, .frames = 4});
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "run.h5";
  {
    auto writer = RunFileWriter::create(path, run.info, run.mesh);
    ASSERT_TRUE(writer.ok()) << writer.error().message();
    ASSERT_TRUE(writer->append(std::span<const ProbeMove>(std::vector<ProbeMove>(2))).ok());
    ASSERT_TRUE(writer->close().ok());
  }
  {
    const h5::Handle file(h5::check(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), "open"), H5Fclose);
    const h5::Handle column = h5::compound_type(sizeof(double));
    h5::insert_member(column, "lift_mm", 0, H5T_NATIVE_DOUBLE);
    const std::array<double, 1> higher{1.0};
    h5::write_rows(h5::dataset(file, "probe"), column, 1, 1, higher.data());
  }
  const auto back = read_recording(path);
  ASSERT_FALSE(back.ok());
  EXPECT_NE(back.error().message().find("/probe"), std::string::npos) << back.error().message();
}

TEST(RunFile, of_the_version_before_seeds_is_read_with_its_checks) {
  const auto run = synthetic_run({.cells = {4, 4, 5}, .step_s = 0.05, .frames = 4});
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "run.h5";
  std::ofstream(path, std::ios::binary) << bytes_of(run, true);
  const auto expected = read_recording(path);
  ASSERT_TRUE(expected.ok());
  {
    const h5::Handle file(h5::check(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), "open"), H5Fclose);
    h5::check(H5Adelete(file, "format_version"), "delete");
    h5::write_attribute(file, "format_version", std::array{4});
    auto row = record::read_rows<RunEnd>(file, "end");
    const auto is_later = [](const std::string& name) {
      return name == "acts" || name == "doses" || name == "probe_moves";
    };
    const h5::Handle then = type_without<RunEnd>(is_later);
    std::uint32_t check = 0;
    row.each_value(0, [&](std::span<const char> value, const record::Column& column) {
      if (!is_later(column.name)) check = record::check_of(value.data(), value.size(), check);
    });
    std::memcpy(row.bytes.data() + row.bytes.size() - sizeof check, &check, sizeof check);
    h5::check(H5Ldelete(file, "end", H5P_DEFAULT), "delete");
    h5::check(H5Ldelete(file, "probe", H5P_DEFAULT), "delete");
    const h5::Handle end = h5::growing_dataset(file, "end", then, {}, 1, nullptr);
    h5::append_rows(end, then, 1, row.bytes.data());
  }
  const auto back = read_recording(path);
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_FALSE(back->implant);
  EXPECT_TRUE(back->probe_moves.empty());
  EXPECT_EQ(back->steps.size(), expected->steps.size());
}

TEST(RunFile, of_earlier_versions_is_read_without_checks) {
  const auto run = synthetic_run();
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "run.h5";
  std::ofstream(path, std::ios::binary) << bytes_of(run, true);
  {  // with texts of variable length, as in earlier versions
    const h5::Handle file(h5::check(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), "open"), H5Fclose);
    h5::check(H5Adelete(file, "format_version"), "delete");
    h5::write_attribute(file, "format_version", std::array{2});
    const h5::Handle text(h5::check(H5Tcopy(H5T_C_S1), "type"), H5Tclose);
    h5::check(H5Tset_size(text, H5T_VARIABLE), "type");
    const h5::Handle one(h5::check(H5Screate(H5S_SCALAR), "space"), H5Sclose);
    const char* value = "an earlier name";
    h5::check(H5Adelete(file, "scenario_name"), "delete");
    const h5::Handle name(H5Acreate2(file, "scenario_name", text, one, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    h5::check(H5Awrite(name, text, &value), "write");
    h5::check(H5Ldelete(file, "supports", H5P_DEFAULT), "delete");
    const std::array<const char*, 2> supports{"held here", "and there"};
    const hsize_t count = supports.size();
    h5::write_array(file, "supports", text, {&count, 1}, supports.data());
    h5::check(H5Ldelete(file, "end", H5P_DEFAULT), "delete");
  }
  const auto back = read_recording(path);
  ASSERT_TRUE(back.ok()) << back.error().message();
  EXPECT_EQ(back->info.scenario_name, "an earlier name");
  EXPECT_EQ(back->info.supports, (std::vector<std::string>{"held here", "and there"}));
  EXPECT_EQ(back->steps.size(), run.steps.size());
  EXPECT_EQ(back->frames.size(), run.frames.size());
  EXPECT_TRUE(back->summary.has_value());
}

TEST(RunFile, a_damaged_head_is_refused_whether_or_not_the_run_has_ended) {
  const auto run = synthetic_run();
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "run.h5", bad = folder.path() / "bad.h5";
  auto writer = RunFileWriter::create(path, run.info, run.mesh);
  ASSERT_TRUE(writer.ok() && writer->append(std::span(run.steps)).ok() && writer->flush().ok());
  const std::string growing = stylet::testing::file_text(path);
  ASSERT_TRUE(writer->close().ok());
  const std::string ended = stylet::testing::file_text(path);
  constexpr std::size_t mark = 11;  // marks a file that is being written; must differ between the two cases
  EXPECT_NE(growing.at(mark), ended.at(mark));
  for (const std::string& whole : {growing, ended}) {
    std::ofstream(bad, std::ios::binary) << whole;
    EXPECT_TRUE(read_recording(bad).ok());
    for (const std::size_t at : {12, 16, 24, 60, 100}) {  // in the superblock, then in the root group
      std::string bytes = whole;
      bytes.at(at) ^= 64;
      std::ofstream(bad, std::ios::binary) << bytes;
      const auto back = read_recording(bad);
      ASSERT_FALSE(back.ok()) << at;
      EXPECT_EQ(back.error().kind, ErrorKind::input);
      EXPECT_NE(back.error().message().find("bad.h5"), std::string::npos);
      EXPECT_NE(back.error().what.find("checksum"), std::string::npos) << back.error().what;
    }
  }
}
