// SPDX-License-Identifier: GPL-3.0-or-later
#include "seed_tables.hpp"

#include "model/digest.hpp"
#include "row_check.hpp"
#include "run_file_format.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

namespace stylet::results {

namespace {

constexpr const char* kGroup = "implant";
constexpr hsize_t kActChunk = 64;
/// Names of the columns with the parts of a seed's error, in the order of SeedCause.
constexpr std::array<const char*, kActCauses> kPartColumns{"bend_mm",   "motion_mm",  "relaxation_mm",
                                                           "strand_mm", "release_mm", "aim_mm"};

std::array<double, 3> three(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 vector_of(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

h5::Handle plan_needle_type() {
  h5::Handle type = h5::compound_type(sizeof(PlanNeedleRow));
  const h5::Handle vector = h5::array_type(H5T_NATIVE_DOUBLE, 3);
  h5::insert_member(type, "name", offsetof(PlanNeedleRow, name), h5::string_type(sizeof(PlanNeedleRow::name)));
  h5::insert_member(type, "hole", offsetof(PlanNeedleRow, hole), h5::string_type(sizeof(PlanNeedleRow::hole)));
  h5::insert_member(type, "entry_mm", offsetof(PlanNeedleRow, entry_mm), vector);
  h5::insert_member(type, "direction", offsetof(PlanNeedleRow, direction), vector);
  h5::insert_member(type, "depth_mm", offsetof(PlanNeedleRow, depth_mm), H5T_NATIVE_DOUBLE);
  return type;
}

h5::Handle plan_seed_type() {
  h5::Handle type = h5::compound_type(sizeof(PlanSeedRow));
  const h5::Handle vector = h5::array_type(H5T_NATIVE_DOUBLE, 3);
  h5::insert_member(type, "number", offsetof(PlanSeedRow, number), H5T_NATIVE_INT64);
  h5::insert_member(type, "needle", offsetof(PlanSeedRow, needle), H5T_NATIVE_INT64);
  h5::insert_member(type, "planned_mm", offsetof(PlanSeedRow, planned_mm), vector);
  h5::insert_member(type, "axis", offsetof(PlanSeedRow, axis), vector);
  h5::insert_member(type, "drop_depth_mm", offsetof(PlanSeedRow, drop_depth_mm), H5T_NATIVE_DOUBLE);
  return type;
}

h5::Handle act_row_type() {
  h5::Handle kind(h5::check(H5Tenum_create(H5T_NATIVE_INT8), "create type"), H5Tclose);
  for (std::int8_t value = 0; value <= static_cast<std::int8_t>(SeedAct::Kind::settled); ++value)
    h5::check(H5Tenum_insert(kind, to_string(static_cast<SeedAct::Kind>(value)), &value), "create type");
  h5::Handle type = h5::compound_type(sizeof(ActRow));
  const h5::Handle vector = h5::array_type(H5T_NATIVE_DOUBLE, 3);
  h5::insert_member(type, "kind", offsetof(ActRow, kind), kind);
  h5::insert_member(type, "time_s", offsetof(ActRow, time_s), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "number", offsetof(ActRow, number), H5T_NATIVE_INT64);
  h5::insert_member(type, "needle", offsetof(ActRow, needle), H5T_NATIVE_INT64);
  h5::insert_member(type, "dropped_s", offsetof(ActRow, dropped_s), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "planned_mm", offsetof(ActRow, planned_mm), vector);
  h5::insert_member(type, "dropped_mm", offsetof(ActRow, dropped_mm), vector);
  h5::insert_member(type, "rest_mm", offsetof(ActRow, rest_mm), vector);
  h5::insert_member(type, "axis", offsetof(ActRow, axis), vector);
  for (std::size_t k = 0; k < kActCauses; ++k)
    h5::insert_member(type, kPartColumns[k], offsetof(ActRow, cause_mm) + k * sizeof(std::array<double, 3>), vector);
  h5::insert_member(type, "in_tissue", offsetof(ActRow, in_tissue), h5::bool_type());
  h5::insert_member(type, "lost", offsetof(ActRow, lost), h5::bool_type());
  h5::insert_member(type, "check", offsetof(ActRow, check), H5T_NATIVE_UINT32);
  return type;
}

h5::Handle dose_row_type() {
  h5::Handle type = h5::compound_type(sizeof(DoseRow));
  h5::insert_member(type, "acts", offsetof(DoseRow, acts), H5T_NATIVE_INT64);
  h5::insert_member(type, "seeds", offsetof(DoseRow, seeds), H5T_NATIVE_INT64);
  h5::insert_member(type, "d90_Gy", offsetof(DoseRow, d90_Gy), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "d90_percent", offsetof(DoseRow, d90_percent), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "v100_percent", offsetof(DoseRow, v100_percent), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "check", offsetof(DoseRow, check), H5T_NATIVE_UINT32);
  return type;
}

ActRow to_row(const SeedAct& act) {
  ActRow row;
  const SeedHistory& seed = act.seed;
  row.kind = static_cast<std::int8_t>(act.kind);
  row.time_s = act.time_s;
  row.number = static_cast<std::int64_t>(seed.number) + 1;
  row.needle = static_cast<std::int64_t>(seed.needle);
  row.dropped_s = seed.dropped_s;
  row.planned_mm = three(seed.planned_mm);
  row.dropped_mm = three(seed.dropped_mm);
  row.rest_mm = three(seed.rest_mm);
  row.axis = three(seed.axis);
  for (std::size_t k = 0; k < kActCauses; ++k) row.cause_mm[k] = three(seed.cause_mm[k]);
  row.in_tissue = seed.in_tissue ? 1 : 0;
  row.lost = seed.lost ? 1 : 0;
  row.check = check_of(row);
  return row;
}

DoseRow to_row(const RecordedScore& dose) {
  DoseRow row{dose.acts, dose.seeds, dose.d90_Gy, dose.d90_percent, dose.v100_percent, 0};
  row.check = check_of(row);
  return row;
}

StoredSeeds stored_plan(const RecordedPlan& plan) {
  StoredSeeds stored;
  for (const RecordedPlan::Needle& needle : plan.needles) {
    PlanNeedleRow& row = stored.needles.emplace_back();
    put_text(row.name, needle.name);
    put_text(row.hole, needle.hole);
    row.entry_mm = three(needle.entry_mm);
    row.direction = three(needle.direction);
    row.depth_mm = needle.depth_mm;
  }
  for (const RecordedPlan::Seed& seed : plan.seeds) {
    stored.planned.push_back({static_cast<std::int64_t>(seed.number) + 1, static_cast<std::int64_t>(seed.needle),
                              three(seed.planned_mm), three(seed.axis), seed.drop_depth_mm});
  }
  stored.current = plan.current;
  stored.seed_length_mm = plan.seed_length_mm;
  stored.seed_diameter_mm = plan.seed_diameter_mm;
  stored.prescription_Gy = plan.prescription_Gy;
  stored.source = plan.source;
  return stored;
}

template <class Row>
std::vector<Row> rows_in(hid_t group, const char* name, hid_t type) {
  const h5::Handle set = h5::dataset(group, name);
  const auto shape = h5::extents(set);
  if (shape.size() != 1) throw h5::Failure(std::string("/implant/") + name + " must have one axis");
  std::vector<Row> rows(shape[0]);
  h5::read_rows(set, type, 0, rows.size(), rows.data());
  return rows;
}

double number_in(hid_t group, const char* name) {
  const auto values = h5::read_double_attribute(group, name);
  if (values.size() != 1) throw h5::Failure(std::string("/implant: attribute ") + name + " has the wrong size");
  return values[0];
}

}  // namespace

std::uint32_t check_of(const ActRow& r) {
  return RowCheck()
      .numbers(r.kind, r.time_s, r.number, r.needle, r.dropped_s, r.planned_mm, r.dropped_mm, r.rest_mm, r.axis)
      .numbers(r.cause_mm, r.in_tissue, r.lost)
      .value();
}

std::uint32_t check_of(const DoseRow& r) {
  return RowCheck().numbers(r.acts, r.seeds, r.d90_Gy, r.d90_percent, r.v100_percent).value();
}

SeedAct from_row(const ActRow& row) {
  SeedAct act;
  act.kind = static_cast<SeedAct::Kind>(row.kind);
  act.time_s = row.time_s;
  SeedHistory& seed = act.seed;
  seed.number = static_cast<std::size_t>(row.number - 1);
  seed.needle = static_cast<std::size_t>(row.needle);
  seed.dropped_s = row.dropped_s;
  seed.planned_mm = vector_of(row.planned_mm);
  seed.dropped_mm = vector_of(row.dropped_mm);
  seed.rest_mm = vector_of(row.rest_mm);
  seed.axis = vector_of(row.axis);
  for (std::size_t k = 0; k < kActCauses; ++k) seed.cause_mm[k] = vector_of(row.cause_mm[k]);
  seed.in_tissue = row.in_tissue != 0;
  seed.lost = row.lost != 0;
  return act;
}

RecordedScore from_row(const DoseRow& row) {
  return {row.acts, row.seeds, row.d90_Gy, row.d90_percent, row.v100_percent};
}

std::string plan_digest(const StoredSeeds& stored) {
  detail::Digest digest;
  for (const PlanNeedleRow& row : stored.needles) {
    digest.add(get_text(row.name));
    digest.add(get_text(row.hole));
    for (const auto* v : {&row.entry_mm, &row.direction}) digest.add(std::span<const double>(*v));
    digest.add(std::span<const double>(&row.depth_mm, 1));
  }
  for (const PlanSeedRow& row : stored.planned) {
    digest.add_bytes(&row.number, sizeof row.number);
    digest.add_bytes(&row.needle, sizeof row.needle);
    for (const auto* v : {&row.planned_mm, &row.axis}) digest.add(std::span<const double>(*v));
    digest.add(std::span<const double>(&row.drop_depth_mm, 1));
  }
  digest.add(std::span<const int>(&stored.current, 1));
  digest.add(
      std::span<const double>(std::array{stored.seed_length_mm, stored.seed_diameter_mm, stored.prescription_Gy}));
  digest.add(stored.source);
  return digest.finish();
}

std::optional<RecordedPlan> plan_of(const StoredSeeds& stored) {
  RecordedPlan plan;
  const auto is_needle = [&](std::int64_t k) { return k >= 0 && k < static_cast<std::int64_t>(stored.needles.size()); };
  for (const PlanNeedleRow& row : stored.needles) {
    plan.needles.push_back(
        {get_text(row.name), get_text(row.hole), vector_of(row.entry_mm), vector_of(row.direction), row.depth_mm});
  }
  for (const PlanSeedRow& row : stored.planned) {
    if (!is_needle(row.needle) || row.number < 1) return std::nullopt;
    plan.seeds.push_back({static_cast<std::size_t>(row.number - 1), static_cast<std::size_t>(row.needle),
                          vector_of(row.planned_mm), vector_of(row.axis), row.drop_depth_mm});
  }
  if (stored.current != -1 && !is_needle(stored.current)) return std::nullopt;
  plan.current = stored.current;
  plan.seed_length_mm = stored.seed_length_mm;
  plan.seed_diameter_mm = stored.seed_diameter_mm;
  plan.prescription_Gy = stored.prescription_Gy;
  plan.source = stored.source;
  return plan;
}

StoredSeeds read_seed_tables(hid_t file) {
  StoredSeeds stored;
  if (h5::check(H5Lexists(file, kGroup, H5P_DEFAULT), "look for /implant") == 0) return stored;
  const h5::Handle group = h5::open_group(file, kGroup);
  stored.digest = h5::read_text_attribute(group, "plan_sha256");
  stored.needles = rows_in<PlanNeedleRow>(group, "needles", plan_needle_type());
  stored.planned = rows_in<PlanSeedRow>(group, "planned_seeds", plan_seed_type());
  const auto current = h5::read_int_attribute(group, "current");
  if (current.size() != 1) throw h5::Failure("/implant: attribute current has the wrong size");
  stored.current = current[0];
  stored.seed_length_mm = number_in(group, "seed_length_mm");
  stored.seed_diameter_mm = number_in(group, "seed_diameter_mm");
  stored.prescription_Gy = number_in(group, "prescription_Gy");
  stored.source = h5::read_text_attribute(group, "source");
  // A dose is written after its acts, so all acts of the doses are there if the doses are read first.
  stored.doses = rows_in<DoseRow>(group, "doses", dose_row_type());
  stored.acts = rows_in<ActRow>(group, "acts", act_row_type());
  return stored;
}

SeedTables::SeedTables(hid_t file, const RecordedPlan& plan) : act_type_(act_row_type()), dose_type_(dose_row_type()) {
  const StoredSeeds stored = stored_plan(plan);
  const h5::Handle group = h5::group(file, kGroup);
  h5::write_attribute(group, "plan_sha256", plan_digest(stored));
  h5::write_attribute(group, "current", std::array{stored.current});
  h5::write_attribute(group, "seed_length_mm", std::array{stored.seed_length_mm});
  h5::write_attribute(group, "seed_diameter_mm", std::array{stored.seed_diameter_mm});
  h5::write_attribute(group, "prescription_Gy", std::array{stored.prescription_Gy});
  h5::write_attribute(group, "source", stored.source);
  const hsize_t needles = stored.needles.size(), planned = stored.planned.size();
  h5::write_array(group, "needles", plan_needle_type(), {&needles, 1}, stored.needles.data());
  h5::write_array(group, "planned_seeds", plan_seed_type(), {&planned, 1}, stored.planned.data());
  const ActRow no_act;
  const DoseRow no_dose;
  acts_ = h5::growing_dataset(group, "acts", act_type_, {}, kActChunk, &no_act);
  doses_ = h5::growing_dataset(group, "doses", dose_type_, {}, kActChunk, &no_dose);
}

void SeedTables::append(std::span<const SeedAct> acts) {
  std::vector<ActRow> rows;
  for (const SeedAct& act : acts) rows.push_back(to_row(act));
  h5::append_rows(acts_, act_type_, rows.size(), rows.data());
}

void SeedTables::append(std::span<const RecordedScore> doses) {
  std::vector<DoseRow> rows;
  for (const RecordedScore& dose : doses) rows.push_back(to_row(dose));
  h5::append_rows(doses_, dose_type_, rows.size(), rows.data());
}

bool SeedTables::close() {
  const bool good = acts_.reset();
  const bool dose_good = doses_.reset();
  act_type_.reset();
  dose_type_.reset();
  return good && dose_good;
}

}  // namespace stylet::results
