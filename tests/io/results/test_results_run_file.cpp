// SPDX-License-Identifier: GPL-3.0-or-later
// Tests that run.h5 can be read, also while the writer is at work or after it was killed.
#include "run_files.hpp"
#include "stylet/io/scenario_io.hpp"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <random>
#include <thread>

using namespace stylet;
using namespace stylet::results;
using namespace stylet::test;
using namespace stylet::testing;
namespace fs = std::filesystem;

namespace {

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// Number of flips: STYLET_FLIPS in the environment, else a sample that takes seconds.
int flips() {
  const char* wanted = std::getenv("STYLET_FLIPS");
  return wanted == nullptr ? 60 : std::atoi(wanted);
}

/// A closed surface. @param x_mm of its middle
Surface octahedron(const std::string& name, double x_mm) {
  const Vec3 middle(x_mm, 0.25, 0.0);
  Surface s{.name = name, .points = {}, .triangles = {}};
  for (int k = 0; k < 3; ++k) {
    for (const double side : {1.0, -1.0}) s.points.emplace_back(middle + side * Vec3::Unit(k));
  }
  s.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return s;
}

/// A run whose mesh has a surface for each region.
SyntheticRun with_surfaces(SyntheticRun run) {
  for (std::size_t r = 0; r < run.mesh.regions.size(); ++r)
    run.mesh.surfaces.push_back(octahedron(run.mesh.regions[r], static_cast<double>(10 * r)));
  return run;
}

}  // namespace

TEST(RunFile, holds_everything_that_was_written) {
  const auto run = with_surfaces(synthetic_run());
  const Folder folder;
  {
    auto writer = value_of(RunFileWriter::create(folder / "run.h5", run.info, run.mesh));
    Recorder recorder(std::move(writer));
    for (const auto& step : run.steps) ASSERT_TRUE(recorder.add(step).ok());
    for (const auto& frame : run.frames) ASSERT_TRUE(recorder.add(stored(frame)).ok());
    const auto closed = recorder.close(&run.summary);
    ASSERT_TRUE(closed.ok()) << closed.error().message();
  }
  const RunRecording back = read_back(folder / "run.h5");
  EXPECT_EQ(back.mesh.nodes, run.mesh.nodes);
  EXPECT_EQ(back.mesh.tets, run.mesh.tets);
  EXPECT_EQ(back.mesh.tet_region, run.mesh.tet_region);
  EXPECT_EQ(back.mesh.regions, run.mesh.regions);
  ASSERT_EQ(back.mesh.surfaces.size(), run.mesh.surfaces.size());
  for (std::size_t r = 0; r < run.mesh.surfaces.size(); ++r) {
    EXPECT_EQ(back.mesh.surfaces[r].name, run.mesh.regions[r]);
    EXPECT_EQ(back.mesh.surfaces[r].points, run.mesh.surfaces[r].points);
    EXPECT_EQ(back.mesh.surfaces[r].triangles, run.mesh.surfaces[r].triangles);
  }
  RunRecording written = recording_of(run);
  written.events = run.summary.events;
  expect_same_run(written, back);
}

TEST(RunFile, holds_steps_at_rest_as_a_number_and_refuses_one_that_does_not_fit_the_times) {
  auto run = small_run();
  const Folder folder;
  for (const std::int64_t rest_steps : {3, 4, -1}) {
    run.steps.resize(2);
    run.steps[0].dt_s = 1e-3;
    run.steps[1] = run.steps[0];
    run.steps[1].time_s += 4e-3;
    run.steps[1].rest_steps = rest_steps;
    write_run_file(folder / "run.h5", run, true);
    const auto back = read_recording(folder / "run.h5");
    ASSERT_EQ(back.ok(), rest_steps == 3);
    if (back.ok()) {
      EXPECT_EQ(back->steps[1].rest_steps, 3);
    } else {
      EXPECT_NE(back.error().message().find("rest_steps"), std::string::npos) << back.error().message();
    }
  }
}

TEST(RunFile, an_empty_run_without_parameters_is_readable) {
  auto run = synthetic_run();
  run.info.parameters.clear();
  run.info.supports.clear();
  run.info.warnings.clear();
  run.info.target_regions.clear();
  const Folder folder;
  {
    auto writer = value_of(RunFileWriter::create(folder / "run.h5", run.info, run.mesh));
    const Recorder recorder(std::move(writer));
  }
  const auto back = value_of(read_recording(folder / "run.h5"));
  EXPECT_TRUE(back.steps.empty());
  EXPECT_TRUE(back.frames.empty());
  EXPECT_TRUE(back.info.parameters.empty());
  EXPECT_FALSE(back.summary.has_value());
}

TEST(RunFile, is_readable_half_a_second_behind_while_the_run_goes_on) {
  const auto run = synthetic_run();
  const Folder folder;
  const fs::path path = folder / "run.h5";
  auto writer = value_of(RunFileWriter::create(path, run.info, run.mesh));
  Recorder recorder(std::move(writer));
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
  const Folder folder;
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
    const fs::path path = folder / ("run" + std::to_string(k) + ".h5");
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
    const auto back = value_of(read_recording(victim.path));
    ASSERT_FALSE(back.steps.empty());
    ASSERT_FALSE(back.frames.empty());
    EXPECT_LT(victim.killed_at - back.steps.back().time_s, 1.0);
    for (std::size_t k = 1; k < back.steps.size(); ++k) ASSERT_LT(back.steps[k - 1].time_s, back.steps[k].time_s);
    for (std::size_t f = 0; f < back.frames.size(); ++f) {
      expect_same_frame(run.frames[f % run.frames.size()], back.frames[f]);
    }
  }
}

TEST(RunFile, replaces_an_earlier_file_without_pulling_it_away_from_a_reader) {
  const auto run = synthetic_run();
  const Folder folder;
  const fs::path path = folder / "run.h5";
  std::ofstream(path) << "an earlier run";
  std::ifstream reader(path);
  auto writer = value_of(RunFileWriter::create(path, run.info, run.mesh));
  std::string text;
  std::getline(reader, text);
  EXPECT_EQ(text, "an earlier run");
  ASSERT_TRUE(writer.close().ok());
  EXPECT_TRUE(read_recording(path).ok());
}

TEST(RunFile, on_a_disk_that_is_full_at_any_moment_ends_with_an_error_and_stays_readable) {
  const auto run = small_run();
  const Folder folder;
  write_run_file(folder / "whole.h5", run, true);
  const auto size = fs::file_size(folder / "whole.h5");
  constexpr int limits = 24;
  int unfinished = 0;
  for (int k = 0; k < limits; ++k) {
    const fs::path path = folder / std::to_string(k) / "run.h5";
    fs::create_directories(path.parent_path());
    const pid_t child = fork();
    if (child == 0) {
      std::signal(SIGXFSZ, SIG_IGN);
      const rlimit limit{k * size / limits, k * size / limits};
      setrlimit(RLIMIT_FSIZE, &limit);
      bool failed = true;
      if (auto writer = RunFileWriter::create(path, run.info, run.mesh)) {
        (void)writer->append(std::span(run.steps));
        for (const Frame& frame : run.frames) (void)writer->append_frame(stored(frame));
        (void)writer->flush();
        (void)writer->append_summary(run.summary);
        const auto closed = writer->close();
        failed = !closed && closed.error().kind == ErrorKind::failed;
      }
      H5close();  // crashed for a file that could not be closed
      _exit(failed ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << k << ": " << status;
    if (!fs::exists(path)) {
      EXPECT_TRUE(names_in(path.parent_path()).empty());
      continue;
    }
    const auto read = read_recording(path);
    ASSERT_TRUE(read.ok()) << k << ": " << read.error().message();
    EXPECT_LE(read->steps.size(), run.steps.size());
    ++unfinished;
  }
  EXPECT_GT(unfinished, 3);
}

TEST(RunFile, foreign_and_damaged_files_are_refused_with_a_message) {
  const auto run = synthetic_run();
  const Folder folder;
  EXPECT_EQ(read_recording(folder / "none.h5").error().what, "no such file");
  const fs::path text = folder / "text.h5";
  std::ofstream(text) << "not HDF5";
  ASSERT_FALSE(read_recording(text).ok());
  EXPECT_EQ(read_recording(text).error().kind, ErrorKind::input);

  const fs::path other = folder / "other.h5";
  H5Fclose(H5Fcreate(other.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  ASSERT_FALSE(read_recording(other).ok());

  const fs::path whole = folder / "whole.h5", half = folder / "half.h5";
  auto writer = RunFileWriter::create(whole, run.info, run.mesh);
  ASSERT_TRUE(writer.ok() && writer->append(std::span(run.steps)).ok() && writer->close().ok());
  const std::string bytes = content_of(whole);
  std::ofstream(half, std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  ASSERT_FALSE(read_recording(half).ok());
}

TEST(RunFile, with_a_summary_of_two_axes_is_refused) {
  const Folder folder;
  const fs::path path = folder / "run.h5";
  write_run_file(path, small_run(), true);
  {
    const h5::Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
    ASSERT_GE(H5Ldelete(file, "summary_json", H5P_DEFAULT), 0);
    const std::array<hsize_t, 2> shape{1, 100000};
    h5::write_array(file, "summary_json", H5T_NATIVE_UINT8, shape, std::string(shape[1], ' ').data());
  }
  const auto read = read_recording(path);
  ASSERT_FALSE(read.ok());
  EXPECT_NE(read.error().what.find("/summary_json must have one axis"), std::string::npos) << read.error().message();
}

TEST(Hdf5, rows_for_which_there_is_no_room_are_not_read) {
  const Folder folder;
  const h5::Handle file(H5Fcreate((folder / "f.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  const std::array<hsize_t, 3> shape{hsize_t{1} << 15U, hsize_t{1} << 47U, 4};  // 2^64 values, which is 0 in 64 bits
  const std::array<hsize_t, 3> chunk{1, 1, 4};
  const h5::Handle space(H5Screate_simple(3, shape.data(), nullptr), H5Sclose);
  const h5::Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_chunk(properties, 3, chunk.data());
  const h5::Handle set(H5Dcreate2(file, "set", H5T_NATIVE_INT32, space, H5P_DEFAULT, properties, H5P_DEFAULT),
                       H5Dclose);
  ASSERT_GE(set, 0);
  std::vector<std::int32_t> values(16);
  EXPECT_THROW(h5::read_rows(set, H5T_NATIVE_INT32, 0, shape[0], std::as_writable_bytes(std::span(values))),
               h5::Failure);
}

TEST(RunFile, whose_scenario_has_no_insertion_is_refused) {
  const Folder folder;
  SyntheticRun run = small_run();
  run.info.scenario_text = "[patient]\nsource = \"phantom\"\n\n[plan]\nfile = \"plan.csv\"\n";
  (void)value_of(parse_scenario(run.info.scenario_text, "scenario"));  // it is a scenario
  write_run_file(folder / "run.h5", run, true);
  const auto read = read_recording(folder / "run.h5");
  ASSERT_FALSE(read.ok());
  EXPECT_NE(read.error().message().find("no insertion"), std::string::npos);
}

TEST(RunFile, with_any_bit_changed_is_refused_or_reads_as_it_was_written) {
  const auto run = with_surfaces(small_run());
  const Folder folder;
  const fs::path path = folder / "flipped.h5";
  std::mt19937 random(20051026);
  for (const bool finished : {true, false}) {
    write_run_file(folder / "whole.h5", run, finished);
    const std::string whole = content_of(folder / "whole.h5");
    const RunRecording expected = read_back(folder / "whole.h5");
    EXPECT_EQ(expected.steps.size(), run.steps.size());
    EXPECT_EQ(expected.summary.has_value(), finished);
    int refused = 0;
    for (int k = 0; k < flips(); ++k) {
      const std::size_t at = random() % whole.size();
      std::string bytes = whole;
      bytes[at] ^= static_cast<char>(1 << (random() % 8));
      write_file(path, bytes);
      const auto back = read_recording(path);
      SCOPED_TRACE("byte " + std::to_string(at) + (finished ? " of a finished one" : " of an unfinished one"));
      if (back) {
        RunRecording same = expected;
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

TEST(RunFile, a_damaged_head_is_refused_whether_or_not_the_run_has_ended) {
  const auto run = synthetic_run();
  const Folder folder;
  const fs::path path = folder / "run.h5", bad = folder / "bad.h5";
  auto writer = RunFileWriter::create(path, run.info, run.mesh);
  ASSERT_TRUE(writer.ok() && writer->append(std::span(run.steps)).ok() && writer->flush().ok());
  const std::string growing = content_of(path);
  ASSERT_TRUE(writer->close().ok());
  const std::string ended = content_of(path);
  constexpr std::size_t mark = 11;  // marks a file that is being written; must differ between the two cases
  EXPECT_NE(growing.at(mark), ended.at(mark));
  for (const std::string& whole : {growing, ended}) {
    write_file(bad, whole);
    EXPECT_TRUE(read_recording(bad).ok());
    for (const std::size_t at : {12, 16, 24, 60, 100}) {  // in the superblock, then in the root group
      std::string bytes = whole;
      bytes.at(at) ^= 64;
      write_file(bad, bytes);
      const auto back = read_recording(bad);
      ASSERT_FALSE(back.ok()) << at;
      EXPECT_EQ(back.error().kind, ErrorKind::input);
      EXPECT_NE(back.error().message().find("bad.h5"), std::string::npos);
      EXPECT_NE(back.error().what.find("damaged"), std::string::npos) << back.error().what;
    }
  }
}
