// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of the run.h5 of an implant.
#include "record/implant_columns.hpp"
#include "record/rows.hpp"
#include "record/run_columns.hpp"
#include "stylet/implant/seed_errors.hpp"
#include "stylet/io/implant_record_io.hpp"
#include "stylet/io/recording_io.hpp"
#include "support/folder.hpp"
#include "synthetic_implant.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <random>

using namespace stylet;
using namespace stylet::test;
using namespace stylet::testing;

namespace fs = std::filesystem;

namespace {

const ImplantRecord& invented_record() {
  static const ImplantRecord record = implant_record(synthetic_implant(6.0, 2.0));
  return record;
}

/// The rows of a table as bytes, so that numbers are compared to the last bit.
template <class T>
std::string bytes_of(const std::vector<T>& rows) {
  std::string bytes;
  for (const T& row : rows) record::pack(bytes, row);
  return bytes;
}

void expect_same_needle(const NeedleHistory& a, const NeedleHistory& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.steps, b.steps);
  EXPECT_EQ(a.record.group, b.record.group);
  EXPECT_EQ(a.entry_mm, b.entry_mm);
  EXPECT_TRUE(a.gland_shift_mm == b.gland_shift_mm || (a.gland_shift_mm.hasNaN() && b.gland_shift_mm.hasNaN()));
  EXPECT_EQ(a.peak_force_N, b.peak_force_N);
  EXPECT_EQ(bytes_of(a.record.steps), bytes_of(b.record.steps));
  EXPECT_EQ(bytes_of(a.events), bytes_of(b.events));
  EXPECT_EQ(bytes_of(a.record.shapes), bytes_of(b.record.shapes));
  for (std::size_t k = 0; k < a.record.shapes.size(); ++k)
    EXPECT_EQ(a.record.shapes[k].points_mm, b.record.shapes[k].points_mm);
}

/// The record after it was written and read again.
ImplantRecord again(const ImplantRecord& wrote) {
  const Folder folder;
  EXPECT_TRUE(write_implant_record(wrote, folder / "run.h5").ok());
  EXPECT_TRUE(is_implant_record(folder / "run.h5"));
  return read_implant_record(folder / "run.h5").value();
}

void expect_same_dose(const RecordedDose& a, const RecordedDose& b) {
  EXPECT_EQ(a.grid.size, b.grid.size);
  EXPECT_EQ(a.grid.origin_mm, b.grid.origin_mm);
  EXPECT_EQ(a.grid.spacing_mm, b.grid.spacing_mm);
  EXPECT_EQ(a.grid.dose_Gy, b.grid.dose_Gy);
  EXPECT_EQ(a.dose_Gy, b.dose_Gy);
  EXPECT_EQ(a.percent, b.percent);
}

}  // namespace

TEST(ImplantRecord, written_and_read_again_is_the_same) {
  const ImplantRecord& wrote = invented_record();
  const ImplantRecord read = again(wrote);
  EXPECT_EQ(read.version, wrote.version);
  EXPECT_EQ(read.scenario_text, wrote.scenario_text);
  EXPECT_EQ(read.source, wrote.source);
  EXPECT_EQ(read.prescription_Gy, wrote.prescription_Gy);
  EXPECT_EQ(read.seed_length_mm, wrote.seed_length_mm);
  EXPECT_EQ(read.mesh.nodes, wrote.mesh.nodes);
  EXPECT_EQ(read.mesh.tets, wrote.mesh.tets);
  EXPECT_EQ(read.mesh.regions, wrote.mesh.regions);
  EXPECT_EQ(read.warnings, wrote.warnings);
  EXPECT_EQ(read.summary, wrote.summary);
  ASSERT_EQ(read.needles.size(), wrote.needles.size());
  for (std::size_t k = 0; k < wrote.needles.size(); ++k) expect_same_needle(read.needles[k], wrote.needles[k]);
  ASSERT_EQ(read.stabilising.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) expect_same_needle(read.stabilising[k], wrote.stabilising[k]);
  ASSERT_EQ(read.structures.size(), wrote.structures.size());
  for (std::size_t k = 0; k < wrote.structures.size(); ++k) {
    EXPECT_EQ(read.structures[k].name, wrote.structures[k].name);
    EXPECT_EQ(read.structures[k].volume_cc, wrote.structures[k].volume_cc);
    EXPECT_EQ(read.structures[k].colour, wrote.structures[k].colour);
    EXPECT_EQ(read.structures[k].cloud_mm, wrote.structures[k].cloud_mm);
    ASSERT_EQ(read.structures[k].contours.size(), wrote.structures[k].contours.size());
    for (std::size_t c = 0; c < wrote.structures[k].contours.size(); ++c)
      EXPECT_EQ(read.structures[k].contours[c].points, wrote.structures[k].contours[c].points);
  }
  expect_same_dose(read.planned, wrote.planned);
  expect_same_dose(read.delivered, wrote.delivered);
}

TEST(ImplantRecord, has_the_seeds_of_the_summary) {
  const ImplantRecord read = again(invented_record());
  const auto summary = nlohmann::json::parse(read.summary);
  const auto& seeds = summary["implant"]["seeds"];
  ASSERT_EQ(read.seeds.size(), seeds.size());
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    const SeedHistory& seed = read.seeds[k];
    EXPECT_EQ(seed.number + 1, seeds[k]["number"].get<std::size_t>());
    EXPECT_EQ(read.needles[seed.needle].name, seeds[k]["needle"].get<std::string>());
    EXPECT_EQ(seed.lost, seeds[k]["lost"].get<bool>());
    EXPECT_EQ(seed.in_tissue, seeds[k]["in_tissue"].get<bool>());
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(seed.planned_mm[axis], seeds[k]["planned_mm"][static_cast<std::size_t>(axis)].get<double>());
      EXPECT_EQ(seed.rest_mm[axis], seeds[k]["rest_mm"][static_cast<std::size_t>(axis)].get<double>());
    }
    for (const SeedCause cause : causes_of(Implant::permanent))
      EXPECT_EQ(seed.by(cause).z(), seeds[k]["why"][to_string(cause)][2].get<double>());
  }
}

TEST(ImplantRecord, keeps_all_causes_of_seeds_and_of_dwell_positions) {
  ImplantRecord wrote = invented_record();
  for (std::size_t c = 0; c < kSeedCauses.size(); ++c)
    wrote.seeds[1].cause_mm[c] = Vec3(1.0, 2.0, static_cast<double>(c));
  const ImplantRecord read = again(wrote);
  EXPECT_TRUE(read.seeds[1].cause_mm == wrote.seeds[1].cause_mm);
}

TEST(ImplantRecord, of_a_temporary_implant_says_so_and_has_the_places_at_planning) {
  ImplantRecord wrote = invented_record();
  EXPECT_EQ(wrote.implant, Implant::permanent);
  wrote.implant = Implant::temporary;
  wrote.seeds[0].at_planning = DwellAtPlanning{Vec3(1, 2, 3), Vec3(4, 5, 6)};
  const ImplantRecord read = again(wrote);
  EXPECT_EQ(read.implant, Implant::temporary);
  ASSERT_TRUE(read.seeds[0].at_planning);
  EXPECT_EQ(read.seeds[0].at_planning->room_mm, Vec3(1, 2, 3));
  EXPECT_EQ(read.seeds[0].at_planning->tissue_mm, Vec3(4, 5, 6));
  EXPECT_FALSE(read.seeds[1].at_planning);
}

TEST(ImplantRecord, is_no_recording_of_an_insertion_and_says_what_to_do) {
  const Folder folder;
  ASSERT_TRUE(write_implant_record(invented_record(), folder / "run.h5").ok());
  const auto run = read_recording(folder / "run.h5");
  ASSERT_FALSE(run.ok());
  EXPECT_EQ(run.error().kind, ErrorKind::input);
  EXPECT_NE(run.error().what.find("record of an implant"), std::string::npos) << run.error().message();
  EXPECT_NE(run.error().cure.find("stylet implant"), std::string::npos);
}

TEST(ImplantRecord, that_is_truncated_or_something_else_is_refused) {
  const Folder folder;
  const fs::path file = folder / "run.h5";
  ASSERT_TRUE(write_implant_record(invented_record(), file).ok());
  const std::string whole = content_of(file);
  for (const double part : {0.02, 0.3, 0.9, 0.999}) {
    write_file(file, whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
    const auto read = read_implant_record(file);
    ASSERT_FALSE(read.ok()) << part;
    EXPECT_EQ(read.error().kind, ErrorKind::input);
    EXPECT_NE(read.error().cure.find("`stylet implant` wrote"), std::string::npos) << read.error().message();
  }
  write_file(file, "seeds");
  EXPECT_FALSE(read_implant_record(file).ok());
  EXPECT_FALSE(is_implant_record(file));
  fs::remove(file);
  EXPECT_FALSE(read_implant_record(file).ok());
  EXPECT_FALSE(is_implant_record(file));
}

// A bit that nobody reads, such as one of the room that HDF5 leaves free, may change.
TEST(ImplantRecord, with_a_bit_changed_is_refused_or_read_as_it_was) {
  const Folder folder;
  const fs::path file = folder / "run.h5";
  ASSERT_TRUE(write_implant_record(invented_record(), file).ok());
  const std::string whole = content_of(file);
  const ImplantRecord before = read_implant_record(file).value();
  std::mt19937 random(7);
  int refused = 0;
  constexpr int kFlips = 40;
  for (int k = 0; k < kFlips; ++k) {
    std::string changed = whole;
    const std::size_t at = random() % whole.size();
    changed[at] = static_cast<char>(changed[at] ^ (1 << (random() % 8)));
    write_file(file, changed);
    const auto read = read_implant_record(file);
    if (!read) {
      ++refused;
      continue;
    }
    EXPECT_EQ(read->summary, before.summary) << at;
    EXPECT_EQ(read->delivered.grid.dose_Gy, before.delivered.grid.dose_Gy) << at;
    EXPECT_EQ(read->seeds.back().rest_mm, before.seeds.back().rest_mm) << at;
  }
  EXPECT_GT(refused, kFlips / 2);
}

TEST(ImplantRecord, is_not_written_into_a_folder_that_does_not_exist) {
  const Folder folder;
  const auto none = write_implant_record(invented_record(), folder / "missing" / "run.h5");
  ASSERT_FALSE(none.ok());
  EXPECT_NE(none.error().message().find("does not exist"), std::string::npos) << none.error().message();
  EXPECT_TRUE(fs::is_empty(folder.path()));
}
