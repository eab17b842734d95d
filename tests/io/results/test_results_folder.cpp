// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of the result folder: its content after a successful run and after a failed one, and errors of writing.
#include "record/csv.hpp"
#include "record/run_columns.hpp"
#include "report_page.hpp"
#include "results/output_folder.hpp"
#include "results/summary_json.hpp"
#include "stylet/io/mesh_io.hpp"
#include "stylet/io/recording_io.hpp"
#include "stylet/io/results_writer.hpp"
#include "support/folder.hpp"
#include "support/value_of.hpp"
#include "synthetic_run.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <random>
#include <thread>

using namespace stylet;
using namespace stylet::test;
using namespace stylet::testing;
namespace fs = std::filesystem;

namespace {

constexpr double kStress = 0.002;  // MPa

MatX some_stress(const TetMesh& mesh) {
  MatX stress = MatX::Zero(6, mesh.tet_count());
  stress.row(2).setConstant(kStress);
  return stress;
}

/// Prevents EGL from finding a driver, as on a machine without one. Then there are no pictures, which makes tests fast.
void take_drivers_away() { setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent/vendor.json", 1); }

Result<> write_run(const fs::path& folder, const SyntheticRun& run) {
  auto writer = ResultsWriter::open(folder, run.info, run.mesh, [&](const VecX&) { return some_stress(run.mesh); });
  if (!writer) return writer.error();
  for (const auto& step : run.steps) {
    if (auto added = (*writer)->add_step(step); !added) return added;
  }
  for (const auto& frame : run.frames) {
    if (auto added = (*writer)->add_frame(frame); !added) return added;
  }
  return (*writer)->finish(run.summary);
}

/// Runs `work` in a child process and returns its result; limits that it sets for its process do not affect the test.
template <class Work>
int in_child(Work work) {
  const pid_t child = fork();
  if (child == 0) _exit(work());
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

bool is_png(const std::string& bytes) {
  return bytes.starts_with("\x89PNG\r\n\x1a\n") && bytes.find("IEND") != std::string::npos;
}

}  // namespace

TEST(ResultFolder, holds_every_file_with_the_numbers_of_the_run) {
  const auto run = synthetic_run();
  const Folder place;
  const fs::path folder = place / "new" / "OUT";  // parents are created
  std::vector<std::string> stages;
  {
    auto writer =
        value_of(ResultsWriter::open(folder, run.info, run.mesh, [&](const VecX&) { return some_stress(run.mesh); }));
    for (const auto& step : run.steps) ASSERT_TRUE(writer->add_step(step).ok());
    for (const auto& frame : run.frames) ASSERT_TRUE(writer->add_frame(frame).ok());
    const auto done = writer->finish(run.summary, [&](std::string_view stage, double share) {
      EXPECT_TRUE(share >= 0 && share <= 1);
      if (stages.empty() || stages.back() != stage) stages.emplace_back(stage);
    });
    ASSERT_TRUE(done.ok()) << done.error().message();
  }
  EXPECT_EQ(stages, (std::vector<std::string>{"tissue files", "pictures", "report"}));

  std::vector<std::string> expected{"forces.csv",  "gland.csv", "needle.pvd",   "needle.vtp", "pictures",
                                    "report.html", "run.h5",    "summary.json", "tissue.pvd"};
  for (std::size_t f = 0; f < run.frames.size(); ++f) {
    expected.push_back(results::series_name("tissue", f, ".vtu"));
    expected.push_back(results::series_name("needle", f, ".vtp"));
  }
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(names_in(folder), expected);

  EXPECT_EQ(content_of(folder / "forces.csv"), record::csv_of(run.steps));
  EXPECT_EQ(content_of(folder / "gland.csv"), record::csv_of(run.summary.gland_path));
  EXPECT_EQ(content_of(folder / "summary.json"), results::summary_json(run.summary));
  const auto recording = value_of(read_recording(folder / "run.h5"));
  EXPECT_EQ(recording.steps.size(), run.steps.size());

  EXPECT_EQ(names_in(folder / "pictures"),
            (std::vector<std::string>{"sagittal_after.png", "sagittal_before.png", "sagittal_deepest.png",
                                      "sagittal_displacement.png", "transverse_after.png", "transverse_before.png",
                                      "transverse_deepest.png", "transverse_displacement.png", "view_after.png",
                                      "view_before.png", "view_deepest.png"}));
  for (const auto& name : names_in(folder / "pictures"))
    EXPECT_TRUE(is_png(content_of(folder / "pictures" / name))) << name;
  const std::string page = content_of(folder / "report.html");
  EXPECT_EQ(count(page, "<img "), 11U);
  EXPECT_EQ(page.find("could not be drawn"), std::string::npos);
}

TEST(ResultFolder, tissue_files_carry_displacement_region_and_stress) {
  take_drivers_away();
  const auto run = synthetic_run();
  const Folder folder;
  ASSERT_TRUE(write_run(folder.path(), run).ok());
  const auto mesh = value_of(read_tet_mesh(folder / "tissue_0000.vtu"));
  EXPECT_EQ(mesh.tets, run.mesh.tets);
  EXPECT_EQ(mesh.nodes, run.mesh.nodes);

  const std::size_t frame = run.frames.size() / 2;
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->SetFileName((folder / results::series_name("tissue", frame, ".vtu")).c_str());
  reader->Update();
  vtkUnstructuredGrid* grid = reader->GetOutput();
  vtkDataArray* displacement = grid->GetPointData()->GetArray("displacement_mm");
  vtkDataArray* region = grid->GetCellData()->GetArray("region");
  vtkDataArray* stress = grid->GetCellData()->GetArray("stress_kPa");
  ASSERT_TRUE(displacement != nullptr && region != nullptr && stress != nullptr);
  ASSERT_EQ(displacement->GetNumberOfTuples(), run.mesh.node_count());
  ASSERT_EQ(stress->GetNumberOfComponents(), 6);
  for (Index n = 0; n < run.mesh.node_count(); ++n) {
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(displacement->GetComponent(n, k), run.frames[frame].displacement[3 * n + k], 1e-6);
    }
  }
  for (Index t = 0; t < run.mesh.tet_count(); ++t) {
    EXPECT_EQ(static_cast<int>(region->GetTuple1(t)), run.mesh.tet_region[static_cast<std::size_t>(t)]);
    EXPECT_DOUBLE_EQ(stress->GetComponent(t, 2), 1000 * kStress);
  }
  const std::string collection = content_of(folder / "tissue.pvd");
  EXPECT_EQ(count(collection, "<DataSet "), run.frames.size());
  EXPECT_NE(collection.find("timestep=\"4.100000\""), std::string::npos);
}

TEST(ResultFolder, needle_vtp_is_the_needle_at_its_deepest_with_its_contacts) {
  take_drivers_away();
  const auto run = synthetic_run();
  const Folder folder;
  ASSERT_TRUE(write_run(folder.path(), run).ok());
  const auto deepest =
      std::find_if(run.frames.begin(), run.frames.end(), [](const Frame& f) { return f.label == "deepest"; });
  ASSERT_NE(deepest, run.frames.end());
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->SetFileName((folder / "needle.vtp").c_str());
  reader->Update();
  vtkPolyData* needle = reader->GetOutput();
  const auto shaft = static_cast<vtkIdType>(deepest->needle.size());
  EXPECT_EQ(needle->GetNumberOfLines(), 1);
  EXPECT_EQ(needle->GetNumberOfVerts(), static_cast<vtkIdType>(deepest->contacts.size()));
  ASSERT_EQ(needle->GetNumberOfPoints(), shaft + static_cast<vtkIdType>(deepest->contacts.size()));
  EXPECT_EQ(Vec3(needle->GetPoint(shaft - 1)), deepest->needle.back());
  vtkPointData* arrays = needle->GetPointData();
  for (const char* name : {"contact", "arc_length_mm", "radius_mm", "tangent", "force_N"}) {
    EXPECT_NE(arrays->GetArray(name), nullptr) << name;
  }
  EXPECT_NEAR(arrays->GetArray("arc_length_mm")->GetTuple1(shaft - 1), 200, 0.1);
  EXPECT_EQ(arrays->GetArray("contact")->GetTuple1(shaft), 3);  // the first synthetic contact is the tip
  EXPECT_NE(needle->GetFieldData()->GetAbstractArray("SPACE"), nullptr);
}

TEST(ResultFolder, without_a_graphics_driver_the_report_says_why_it_has_no_pictures) {
  const auto run = synthetic_run();
  const Folder folder;
  fs::create_directory(folder / "pictures");
  std::ofstream(folder / "pictures" / "view_deepest.png") << "of an earlier run";
  std::ofstream(folder / "pictures" / "mine.png") << "the user's own";
  take_drivers_away();
  const auto done = write_run(folder.path(), run);
  ASSERT_TRUE(done.ok()) << done.error().message();
  const std::string page = content_of(folder / "report.html");
  EXPECT_NE(page.find("could not be drawn on this machine: pictures: EGL"), std::string::npos);
  EXPECT_EQ(count(page, "<img "), 0U);
  EXPECT_EQ(names_in(folder / "pictures"), std::vector<std::string>{"mine.png"});
}

TEST(ResultFolder, a_second_run_replaces_the_first_file_by_file) {
  take_drivers_away();
  auto run = synthetic_run();
  const Folder folder;
  std::ofstream(folder / "notes.txt") << "the user's own";
  std::ofstream(folder / "tissue_new.vtu") << "the user's own";
  ASSERT_TRUE(write_run(folder.path(), run).ok());
  const auto first = names_in(folder.path());
  run.frames.erase(run.frames.begin() + 2, run.frames.end() - 2);
  run.summary.scenario = "second run";
  ASSERT_TRUE(write_run(folder.path(), run).ok());
  const auto second = names_in(folder.path());
  EXPECT_EQ(first.size() - second.size(), 2 * (synthetic_run().frames.size() - run.frames.size()));
  EXPECT_EQ(content_of(folder / "notes.txt"), "the user's own");
  EXPECT_EQ(content_of(folder / "tissue_new.vtu"), "the user's own");
  EXPECT_NE(content_of(folder / "summary.json").find("second run"), std::string::npos);
  for (const auto& name : second) EXPECT_FALSE(name.starts_with(".")) << name;
}

TEST(ResultFolder, an_unfinished_run_leaves_only_a_readable_recording) {
  const auto run = synthetic_run();
  const Folder folder;
  std::ofstream(folder / "summary.json") << "of an earlier run";
  {
    auto writer = value_of(ResultsWriter::open(folder.path(), run.info, run.mesh));
    for (const auto& step : run.steps) ASSERT_TRUE(writer->add_step(step).ok());
  }
  EXPECT_EQ(names_in(folder.path()), std::vector<std::string>{"run.h5"});
  const auto back = value_of(read_recording(folder / "run.h5"));
  EXPECT_EQ(back.steps.size(), run.steps.size());
  EXPECT_FALSE(back.summary.has_value());
}

TEST(ResultFolder, a_run_killed_at_any_moment_has_nothing_of_an_earlier_one_beside_its_recording) {
  take_drivers_away();
  const auto run = synthetic_run({.cells = {4, 4, 5}, .step_s = 0.02, .frames = 4});
  auto later = run;
  later.info.scenario_name = later.summary.scenario = "later";
  for (Step& step : later.steps) step.force_axial_N += 1.0;
  std::mt19937 random(20051026);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  int killed = 0;
  int begun = 0;
  for (int k = 0; k < 25; ++k) {
    const Folder folder;
    const auto start = std::chrono::steady_clock::now();
    ASSERT_TRUE(write_run(folder.path(), run).ok());
    const auto lasted = std::chrono::steady_clock::now() - start;  // the later run takes about as long
    const pid_t child = fork();
    if (child == 0) _exit(write_run(folder.path(), later).ok() ? 0 : 1);
    std::this_thread::sleep_for(share(random) * std::chrono::duration<double>(lasted));
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    killed += WIFSIGNALED(status) ? 1 : 0;
    const auto recording = read_recording(folder / "run.h5");
    ASSERT_TRUE(recording.ok()) << recording.error().message();
    if (recording->info.scenario_name != "later") {  // the later run was killed before it replaced the earlier one
      EXPECT_TRUE(recording->summary.has_value());
      continue;
    }
    ++begun;
    for (const auto& name : names_in(folder.path())) {
      if (name.starts_with(".")) continue;
      const std::string text = content_of(folder / name);
      if (name == "forces.csv") {
        EXPECT_EQ(text, record::csv_of(later.steps));
      } else if (name == "summary.json" || name == "report.html") {
        EXPECT_NE(text.find("later"), std::string::npos) << name;
      }
    }
  }
  EXPECT_GT(killed, 5);
  EXPECT_GT(begun, 5);
}

TEST(ResultFolder, what_an_earlier_run_left_goes_before_the_first_step) {
  take_drivers_away();
  const auto run = synthetic_run();
  const Folder folder;
  ASSERT_TRUE(write_run(folder.path(), run).ok());
  fs::create_directories(folder / "pictures");
  std::ofstream(folder / "pictures" / "view_deepest.png") << "of the earlier run";
  std::ofstream(folder / "notes.txt") << "the user's own";
  const auto writer = ResultsWriter::open(folder.path(), run.info, run.mesh);
  ASSERT_TRUE(writer.ok());
  EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{"notes.txt", "pictures", "run.h5"}));
  EXPECT_TRUE(names_in(folder / "pictures").empty());
}

TEST(ResultFolder, an_earlier_file_that_cannot_be_removed_is_named_and_everything_stays) {
  take_drivers_away();
  const auto run = synthetic_run();
  const Folder folder;
  std::ofstream(folder / "run.h5") << "an earlier run";
  fs::create_directories(folder / "summary.json" / "in the way");
  const auto writer = ResultsWriter::open(folder.path(), run.info, run.mesh);
  ASSERT_FALSE(writer.ok());
  EXPECT_EQ(writer.error().kind, ErrorKind::input);
  EXPECT_NE(writer.error().where.find("summary.json"), std::string::npos);
  EXPECT_EQ(content_of(folder / "run.h5"), "an earlier run");
  EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{"run.h5", "summary.json"}));
}

TEST(ResultFolder, a_full_disk_fails_the_run_and_leaves_no_half_file) {
  take_drivers_away();
  const auto run = synthetic_run();
  const Folder folder;
  const int status = in_child([&] {
    auto writer = ResultsWriter::open(folder.path(), run.info, run.mesh);
    if (!writer) return 10;
    for (const auto& step : run.steps) {
      if (!(*writer)->add_step(step)) return 11;
    }
    for (const auto& frame : run.frames) {
      if (!(*writer)->add_frame(frame)) return 12;
    }
    // This limit on the size of files is sufficient for all files except the report, which contains script and tissue.
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{680000, 680000};
    setrlimit(RLIMIT_FSIZE, &limit);
    const auto done = (*writer)->finish(run.summary);
    if (done.ok()) return 13;
    return done.error().kind == ErrorKind::failed && done.error().where.find("report.html") != std::string::npos ? 0
                                                                                                                 : 14;
  });
  EXPECT_EQ(status, 0);
  for (const auto& name : names_in(folder.path())) {
    EXPECT_FALSE(name.starts_with(".")) << name;
    EXPECT_NE(name, "report.html");
    EXPECT_NE(name, "summary.json");
  }
  EXPECT_EQ(content_of(folder / "forces.csv"), record::csv_of(run.steps));
  const auto back = read_recording(folder / "run.h5");
  EXPECT_TRUE(back.ok()) << back.error().message();
}

TEST(ResultFolder, a_folder_that_cannot_be_written_is_refused_before_the_run) {
  const auto run = synthetic_run();
  const Folder folder;
  std::ofstream(folder / "file") << "in the way";
  for (const fs::path& path : {folder / "file", folder / "file" / "OUT"}) {
    const auto writer = ResultsWriter::open(path, run.info, run.mesh);
    ASSERT_FALSE(writer.ok());
    EXPECT_EQ(writer.error().kind, ErrorKind::input);
    EXPECT_NE(writer.error().where.find(path.string()), std::string::npos);
  }
  fs::create_directory(folder / "locked");
  fs::permissions(folder / "locked", fs::perms::owner_read | fs::perms::owner_exec | fs::perms::others_exec);
  fs::permissions(folder.path(), fs::perms::all);
  const int status = in_child([&] {
    constexpr uid_t kNobody = 65534;  // permissions do not apply to root
    if (geteuid() == 0 && seteuid(kNobody) != 0) return 10;
    const auto writer = ResultsWriter::open(folder / "locked", run.info, run.mesh);
    return !writer.ok() && writer.error().kind == ErrorKind::input &&
                   writer.error().what.find("Permission denied") != std::string::npos
               ? 0
               : 11;
  });
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(names_in(folder / "locked").empty());
}

TEST(ResultFolder, wrong_use_is_an_error_not_a_crash) {
  take_drivers_away();
  auto run = synthetic_run();
  const Folder folder;
  auto writer = value_of(ResultsWriter::open(folder.path(), run.info, run.mesh));
  Frame bad = run.frames.front();
  bad.displacement.conservativeResize(bad.displacement.size() - 3);
  EXPECT_FALSE(writer->add_frame(bad).ok());
  Frame nan = run.frames.front();
  nan.displacement[5] = std::nan("");
  EXPECT_NE(writer->add_frame(nan).error().what.find("not finite"), std::string::npos);
  Step step;
  step.time_s = std::nan("");
  EXPECT_FALSE(writer->add_step(step).ok());
  EXPECT_FALSE(writer->finish(run.summary).ok());  // there is no frame to show
  EXPECT_FALSE(writer->finish(run.summary).ok());  // finish() can be called only once
}

TEST(ResultFolder, a_needle_that_never_touches_anything_still_gives_a_report) {
  take_drivers_away();
  auto run = synthetic_run();
  run.steps.resize(3);
  run.frames.resize(1);
  run.frames[0].needle.clear();
  run.summary.events.clear();
  run.info.target_regions.clear();
  run.info.parameters.clear();
  const Folder folder;
  const auto done = write_run(folder.path(), run);
  ASSERT_TRUE(done.ok()) << done.error().message();
  EXPECT_NE(content_of(folder / "report.html").find("met no tissue"), std::string::npos);
}
