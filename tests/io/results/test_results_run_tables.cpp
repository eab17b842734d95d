// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of the tables that only some recordings have: of implants and moved probes; and of files of earlier versions.
#include "run_files.hpp"
#include "stylet/io/recorded_moments.hpp"
#include "stylet/io/scenario_io.hpp"

#include <array>
#include <cmath>

using namespace stylet;
using namespace stylet::results;
using namespace stylet::test;
using namespace stylet::testing;
namespace fs = std::filesystem;

namespace {

h5::Handle opened_to_change(const fs::path& path) {
  return {h5::check(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), "open"), H5Fclose};
}

void set_version(const h5::Handle& file, int version) {
  h5::check(H5Adelete(file, "format_version"), "delete");
  h5::write_attribute(file, "format_version", std::array{version});
}

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

RecordedPlan two_needles() {
  RecordedPlan plan;
  plan.needles = {{"B4", "B4", Vec3(1, 2, 3), Vec3::UnitZ(), 70.0}, {"beside", "", Vec3(4, 5, 6), Vec3::UnitX(), 60.0}};
  plan.seeds = {{7, 0, Vec3(1, 2, 60), Vec3::UnitZ(), 62.0}, {8, 1, Vec3(30, 5, 6), Vec3::UnitX(), 52.0}};
  plan.current = 1;
  plan.seed_length_mm = 4.5;
  plan.seed_diameter_mm = 0.8;
  plan.prescription_Gy = 145.0;
  plan.source = "i125_6711";
  plan.implant = "2026-11-29-170500-B4";
  plan.before = {.skin_punctures = 3, .organ_entries = 1, .bone_contacts = 2, .exits = 0};
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

const std::vector<RecordedScore> kScores{{RecordedScore::kOfPlan, 2, 160.0, 110.0, 97.0}, {2, 2, 20.0, 14.0, 3.0}};

void write_with_seeds(const fs::path& path, const SyntheticRun& run, bool finished) {
  const RecordedPlan plan = two_needles();
  write_run_file(path, run, finished, &plan, [](RunFileWriter& writer) {
    return writer.append(std::span<const SeedAct>(three_acts())).ok() && writer.append(std::span(kScores)).ok();
  });
}

}  // namespace

TEST(RunFile, of_a_live_session_holds_the_seeds_of_its_implant) {
  const auto run = small_run();
  const Folder folder;
  for (const bool finished : {true, false}) {
    write_with_seeds(folder / "run.h5", run, finished);
    const RunRecording back = read_back(folder / "run.h5");
    ASSERT_TRUE(back.implant);
    const RecordedPlan &plan = back.implant->plan, wrote = two_needles();
    expect_same_rows(plan.needles, wrote.needles);
    expect_same_rows(plan.seeds, wrote.seeds);
    EXPECT_EQ(plan.current, 1);
    EXPECT_EQ(plan.source, "i125_6711");
    EXPECT_EQ(plan.prescription_Gy, 145.0);
    EXPECT_EQ(plan.implant, wrote.implant);
    EXPECT_EQ(plan.before, wrote.before);
    EXPECT_EQ(back.has_ended, finished);
    expect_same_rows(back.implant->acts, three_acts());
    // The seeds that were in the tissue at each moment follow from the acts.
    EXPECT_EQ(back.implant->seeds_after(back.implant->acts_until(1.0)).size(), 1u);
    EXPECT_EQ(back.implant->seeds_after(back.implant->acts_until(1.25)).size(), 2u);
    ASSERT_EQ(back.implant->seeds_after(back.implant->acts_until(9.0)).size(), 1u);
    EXPECT_EQ(back.implant->seeds_after(3)[0].number, 7u);
    EXPECT_EQ(back.implant->dose_after(2)->d90_percent, 14.0);
    EXPECT_EQ(back.implant->dose_after(RecordedScore::kOfPlan)->d90_Gy, 160.0);
    EXPECT_FALSE(back.implant->dose_after(3)) << "it was not computed";
  }
}

TEST(RunFile, has_a_head_that_is_read_without_its_steps) {
  const auto run = small_run();
  const Folder folder;
  std::vector<fs::path> files;
  for (const bool finished : {true, false}) {
    files.push_back(folder / (finished ? "finished.h5" : "killed.h5"));
    write_with_seeds(files.back(), run, finished);
  }
  files.push_back(folder / "plain.h5");
  write_run_file(files.back(), run, true);
  files.push_back(folder / "none.h5");
  const auto heads = read_recording_heads(files);
  ASSERT_EQ(heads.size(), 4u);
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_TRUE(heads[k]) << heads[k].error().message();
    const RunRecording whole = read_back(files[k]);
    EXPECT_EQ(heads[k]->scenario_name, run.info.scenario_name);
    EXPECT_GE(heads[k]->duration_s, run.steps.back().time_s);
    EXPECT_EQ(heads[k]->has_ended, whole.has_ended);
    expect_same_rows(heads[k]->events, whole.events);
    ASSERT_EQ(heads[k]->implant.has_value(), whole.implant.has_value());
    if (!whole.implant) continue;
    expect_same_rows(heads[k]->implant->acts, whole.implant->acts);
    EXPECT_EQ(heads[k]->implant->dose_after(2)->d90_percent, 14.0);
    EXPECT_EQ(digest_of_plan(heads[k]->implant->plan), digest_of_plan(two_needles()));
  }
  EXPECT_EQ(heads[1]->has_ended, false);
  EXPECT_FALSE(heads[0]->most_N);
  double most_N = 0.0;
  for (const Step& step : run.steps) most_N = std::max(most_N, step.force_axial_N);
  EXPECT_EQ(heads[2]->most_N, most_N);
  EXPECT_FALSE(heads[3]) << "the others are read all the same";
}

TEST(RunFile, of_each_needle_of_an_implant_has_the_same_digest_of_its_plan) {
  const RecordedPlan plan = two_needles();
  RecordedPlan next = plan;
  next.current = 0;
  next.before.skin_punctures = 4;
  EXPECT_EQ(digest_of_plan(next), digest_of_plan(plan));
  next.seeds[1].planned_mm.x() += 1e-9;
  EXPECT_NE(digest_of_plan(next), digest_of_plan(plan));
}

TEST(Recorder, has_written_what_was_added_before_it_says_so) {
  const auto run = small_run();
  const Folder folder;
  const RecordedPlan plan = two_needles();
  Recorder recorder(value_of(RunFileWriter::create(folder / "run.h5", run.info, run.mesh, {}, &plan)));
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_TRUE(recorder.add(three_acts()[k]));
    recorder.write_now(std::chrono::seconds(60));
    EXPECT_EQ(read_back(folder / "run.h5").implant->acts.size(), k + 1);
  }
}

TEST(RunFile, of_a_live_session_holds_the_way_of_the_probe) {
  auto run = small_run();
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
  const Folder folder;
  for (const bool finished : {true, false}) {
    write_run_file(folder / "run.h5", run, finished, nullptr,
                   [&](RunFileWriter& writer) { return writer.append(std::span(moves)).ok(); });
    const RunRecording back = read_back(folder / "run.h5");
    ASSERT_EQ(back.probe_moves.size(), 2u);
    EXPECT_EQ(back.probe_moves[0].time_s, 0.0);
    EXPECT_EQ(back.probe_moves[0].probe, probe) << "without a depth: the middle of the gland";
    EXPECT_EQ(back.probe_moves[1].time_s, 1.5);
    EXPECT_EQ(back.probe_moves[1].probe, then);
    const RecordedMoments at(back);
    EXPECT_EQ(at.probe_at(0.0), probe);
    EXPECT_EQ(at.probe_at(1.49), probe) << "a place holds until the next one";
    EXPECT_EQ(at.probe_at(1.5), then);
    EXPECT_EQ(at.probe_at(99.0), then);
  }
}

TEST(RunFile, with_a_changed_seed_or_place_of_the_probe_is_refused) {
  const auto run = small_run();
  const Folder folder;
  const fs::path path = folder / "run.h5";
  for (const auto& [table, name] : {std::pair("/implant/acts", "time_s"), std::pair("/probe", "lift_mm")}) {
    const RecordedPlan plan = two_needles();
    write_run_file(path, run, true, &plan, [](RunFileWriter& writer) {
      return writer.append(std::span<const SeedAct>(three_acts())).ok() &&
             writer.append(std::span<const ProbeMove>(std::vector<ProbeMove>(2))).ok();
    });
    ASSERT_TRUE(read_recording(path).ok());
    {
      const h5::Handle file = opened_to_change(path);
      const h5::Handle column = h5::compound_type(sizeof(double));
      h5::insert_member(column, name, 0, H5T_NATIVE_DOUBLE);
      const std::array<double, 1> more{1.5};
      h5::write_rows(h5::dataset(file, table), column, 1, 1, more.data());
    }
    const auto back = read_recording(path);
    ASSERT_FALSE(back.ok()) << table;
    EXPECT_NE(back.error().message().find(table), std::string::npos) << back.error().message();
  }
}

TEST(RunFile, of_the_first_version_has_its_steps_without_what_they_were_given) {
  auto run = small_run();
  const auto steps = record::rows_of(std::span<const Step>(run.steps));
  const Folder folder;
  {
    auto writer = value_of(RunFileWriter::create(folder / "run.h5", run.info, run.mesh));
    Recorder recorder(std::move(writer));
    ASSERT_TRUE(recorder.close(nullptr).ok());
  }
  {  // in earlier versions the table of steps had no columns dt_s, base_x_mm … base_qz and flags
    const h5::Handle file = opened_to_change(folder / "run.h5");
    const h5::Handle then = type_without<Step>([&](const std::string& name) {
      return name == "dt_s" || name == "flags" || (name.starts_with("base_") && name != "base_depth_mm");
    });
    ASSERT_EQ(H5Tget_nmembers(then), 27 - 9);
    h5::check(H5Ldelete(file, "steps", H5P_DEFAULT), "delete");
    set_version(file, 1);
    h5::append_rows(h5::growing_dataset(file, "steps", then, {}, 1024, nullptr), then, steps.size(),
                    steps.bytes.data());
  }
  const RunRecording back = read_back(folder / "run.h5");
  ASSERT_EQ(back.steps.size(), run.steps.size());
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    EXPECT_EQ(back.steps[k].force_axial_N, run.steps[k].force_axial_N);
    EXPECT_EQ(back.steps[k].flags, 0U);
    EXPECT_TRUE(std::isnan(back.steps[k].dt_s) && std::isnan(back.steps[k].base.origin.x()));
  }
}

TEST(RunFile, of_the_version_before_seeds_is_read_with_its_checks) {
  const auto run = small_run();
  const Folder folder;
  write_run_file(folder / "run.h5", run, true);
  {
    const h5::Handle file = opened_to_change(folder / "run.h5");
    set_version(file, 4);
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
  const RunRecording back = read_back(folder / "run.h5");
  EXPECT_FALSE(back.implant);
  EXPECT_TRUE(back.probe_moves.empty());
  EXPECT_EQ(back.steps.size(), run.steps.size());
}

TEST(RunFile, of_earlier_versions_is_read_without_checks) {
  const auto run = small_run();
  const Folder folder;
  write_run_file(folder / "run.h5", run, true);
  {  // with texts of variable length, as in earlier versions
    const h5::Handle file = opened_to_change(folder / "run.h5");
    set_version(file, 2);
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
  const RunRecording back = read_back(folder / "run.h5");
  EXPECT_EQ(back.info.scenario_name, "an earlier name");
  EXPECT_EQ(back.info.supports, (std::vector<std::string>{"held here", "and there"}));
  EXPECT_EQ(back.steps.size(), run.steps.size());
  EXPECT_EQ(back.frames.size(), run.frames.size());
  EXPECT_TRUE(back.summary.has_value());
}
