// SPDX-License-Identifier: GPL-3.0-or-later
#include "implant/stored_implant.hpp"

#include "h5_mesh.hpp"
#include "model/digest.hpp"
#include "run_file_format.hpp"
#include "stored_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace stylet::results {
namespace {

std::array<double, 3> numbers_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 vector_from(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

/// Names of the columns with the parts of a seed's error, in the order of SeedCause.
constexpr std::array<const char*, kAllCauses> kCauseColumns{"bend_mm",    "motion_mm", "relaxation_mm", "strand_mm",
                                                            "release_mm", "aim_mm",    "probe_mm",      "wait_mm"};

std::string member_name(std::size_t number) { return fmt::format("{:03}", number); }

void write_vector(hid_t object, const char* name, const Vec3& v) {
  h5::write_attribute(object, name, std::span<const double>(v.data(), 3));
}
void write_number(hid_t object, const char* name, double value) {
  h5::write_attribute(object, name, std::span<const double>(&value, 1));
}

/// @param values rows of `width` numbers
template <class Value>
void write_matrix(hid_t parent, const char* name, hid_t type, const std::vector<Value>& values, hsize_t width) {
  const std::array<hsize_t, 2> shape{values.size() * sizeof(Value) / (H5Tget_size(type) * width), width};
  h5::write_array(parent, name, type, shape, values.data());
}
template <class Row>
void write_rows_of(hid_t parent, const char* name, hid_t type, const std::vector<Row>& rows) {
  const hsize_t count = rows.size();
  h5::write_array(parent, name, type, {&count, 1}, rows.data());
}

void write_needle(hid_t parent, std::size_t number, const NeedleHistory& needle) {
  const h5::Handle group = h5::group(parent, member_name(number).c_str());
  h5::write_attribute(group, "name", needle.name);
  h5::write_attribute(group, "together", std::array{static_cast<int>(needle.record.group)});
  write_vector(group, "entry_mm", needle.entry_mm);
  write_vector(group, "direction", needle.direction);
  write_number(group, "depth_mm", needle.depth_mm);
  write_number(group, "peak_force_N", needle.peak_force_N);
  write_number(group, "deflection_mm", needle.deflection_mm);
  write_vector(group, "gland_shift_mm", needle.gland_shift_mm);
  write_number(group, "seconds", needle.seconds);
  h5::write_attribute(group, "step_count", std::array{static_cast<int>(needle.steps)});
  std::vector<StepRow> steps;
  for (const Step& step : needle.record.steps) steps.push_back(to_row(step));
  write_rows_of(group, "steps", step_row_type(), steps);
  std::vector<EventRow> events;
  for (const Event& event : needle.events) events.push_back(to_row(event));
  write_rows_of(group, "events", event_row_type(), events);
  std::vector<ShapeRow> shapes;
  std::vector<Vec3> points;
  for (const NeedleShape& shape : needle.record.shapes) {
    ShapeRow& row = shapes.emplace_back();
    row.time_s = shape.time_s;
    row.base_depth_mm = shape.base_depth_mm;
    put_text(row.when, shape.when);
    points.insert(points.end(), shape.points_mm.begin(), shape.points_mm.end());
  }
  write_rows_of(group, "shapes", shape_row_type(), shapes);
  const std::array<hsize_t, 3> shape{shapes.size(), kNeedleShapePoints, 3};
  h5::write_array(group, "shapes_mm", H5T_NATIVE_DOUBLE, shape, points.data());
}

void write_structure(hid_t parent, std::size_t number, const RecordedStructure& structure) {
  const h5::Handle group = h5::group(parent, member_name(number).c_str());
  h5::write_attribute(group, "name", structure.name);
  h5::write_attribute(group, "region", structure.region);
  h5::write_attribute(group, "type", structure.type);
  h5::write_attribute(group, "colour", std::span<const int>(structure.colour));
  write_number(group, "volume_cc", structure.volume_cc);
  std::vector<Vec3> points;
  std::vector<std::int64_t> counts;
  for (const Contour& contour : structure.contours) {
    points.insert(points.end(), contour.points.begin(), contour.points.end());
    counts.push_back(static_cast<std::int64_t>(contour.points.size()));
  }
  write_matrix(group, "contour_points_mm", H5T_NATIVE_DOUBLE, points, 3);
  write_rows_of(group, "contour_sizes", H5T_NATIVE_INT64, counts);
  write_matrix(group, "cloud_mm", H5T_NATIVE_DOUBLE, structure.cloud_mm, 3);
}

void write_dose(hid_t file, const char* name, const RecordedDose& dose) {
  const h5::Handle group = h5::group(file, name);
  write_vector(group, "origin_mm", dose.grid.origin_mm);
  write_vector(group, "spacing_mm", dose.grid.spacing_mm);
  const auto& size = dose.grid.size;
  const std::array<hsize_t, 3> shape{static_cast<hsize_t>(size[2]), static_cast<hsize_t>(size[1]),
                                     static_cast<hsize_t>(size[0])};
  h5::write_array(group, "dose_Gy", H5T_NATIVE_FLOAT, shape, dose.grid.dose_Gy.data());
  write_rows_of(group, "dvh_dose_Gy", H5T_NATIVE_DOUBLE, dose.dose_Gy);
  std::vector<double> percent;
  for (const std::vector<double>& curve : dose.percent) percent.insert(percent.end(), curve.begin(), curve.end());
  const std::array<hsize_t, 2> curves{dose.percent.size(), dose.dose_Gy.size()};
  h5::write_array(group, "dvh_percent", H5T_NATIVE_DOUBLE, curves, percent.data());
}

void write_all_of(hid_t file, ImplantRecord& record) {
  h5::write_attribute(file, "format", std::string(kImplantFileFormat));
  h5::write_attribute(file, "format_version", std::array{kImplantFileVersion});
  h5::write_attribute(file, "content_sha256", content_digest(record));
  h5::write_attribute(file, "version", record.version);
  h5::write_attribute(file, "scenario_name", record.scenario_name);
  h5::write_attribute(file, "source", record.source);
  h5::write_attribute(file, "units", std::string("mm, N, s, Gy"));
  h5::write_attribute(file, "frame", std::string("LPS"));
  write_number(file, "prescription_Gy", record.prescription_Gy);
  write_number(file, "needle_diameter_mm", record.needle_diameter_mm);
  write_number(file, "needle_length_mm", record.needle_length_mm);
  write_number(file, "seed_length_mm", record.seed_length_mm);
  h5::write_text(file, "scenario", record.scenario_text);
  h5::write_texts(file, "warnings", record.warnings);
  write_rows_of(file, "summary_json", H5T_NATIVE_UINT8,
                std::vector<char>(record.summary.begin(), record.summary.end()));
  h5::write_mesh(file, record.mesh);
  const h5::Handle needles = h5::group(file, "needles"), stabilising = h5::group(file, "stabilising"),
                   structures = h5::group(file, "structures");
  for (std::size_t k = 0; k < record.needles.size(); ++k) write_needle(needles, k, record.needles[k]);
  for (std::size_t k = 0; k < record.stabilising.size(); ++k) write_needle(stabilising, k, record.stabilising[k]);
  std::vector<SeedRow> seeds;
  for (const SeedHistory& seed : record.seeds) seeds.push_back(to_row(seed));
  write_rows_of(file, "seeds", seed_row_type(), seeds);
  for (std::size_t k = 0; k < record.structures.size(); ++k) write_structure(structures, k, record.structures[k]);
  write_dose(file, "planned", record.planned);
  write_dose(file, "delivered", record.delivered);
}

void demand_shape(bool fits, const std::string& what) {
  if (!fits) throw h5::Failure(what + " has the wrong shape");
}

template <class Row>
std::vector<Row> rows_in(hid_t parent, const char* name, hid_t type) {
  const h5::Handle set = h5::dataset(parent, name);
  const auto shape = h5::extents(set);
  demand_shape(shape.size() == 1, name);
  std::vector<Row> rows(shape[0]);
  h5::read_rows(set, type, 0, rows.size(), rows.data());
  return rows;
}

std::vector<Vec3> points_in(hid_t parent, const char* name) {
  const h5::Handle set = h5::dataset(parent, name);
  const auto shape = h5::extents(set);
  demand_shape(shape.size() >= 2 && shape.back() == 3, name);
  std::size_t count = 1;
  for (std::size_t k = 0; k + 1 < shape.size(); ++k) count *= shape[k];
  std::vector<Vec3> points(count);
  h5::read_rows(set, H5T_NATIVE_DOUBLE, 0, shape[0], points.data());
  return points;
}

Vec3 vector_attribute(hid_t object, const char* name) {
  const std::vector<double> values = h5::read_double_attribute(object, name);
  demand_shape(values.size() == 3, name);
  return Vec3(values.data());
}
double number_attribute(hid_t object, const char* name) {
  const std::vector<double> values = h5::read_double_attribute(object, name);
  demand_shape(values.size() == 1, name);
  return values[0];
}
int integer_attribute(hid_t object, const char* name) {
  const std::vector<int> values = h5::read_int_attribute(object, name);
  demand_shape(values.size() == 1, name);
  return values[0];
}

NeedleHistory needle_in(hid_t parent, std::size_t number) {
  const h5::Handle group = h5::open_group(parent, member_name(number).c_str());
  NeedleHistory needle;
  needle.name = h5::read_text_attribute(group, "name");
  needle.record.group = static_cast<std::size_t>(std::max(0, integer_attribute(group, "together")));
  needle.entry_mm = vector_attribute(group, "entry_mm");
  needle.direction = vector_attribute(group, "direction");
  needle.depth_mm = number_attribute(group, "depth_mm");
  needle.peak_force_N = number_attribute(group, "peak_force_N");
  needle.deflection_mm = number_attribute(group, "deflection_mm");
  needle.gland_shift_mm = vector_attribute(group, "gland_shift_mm");
  needle.seconds = number_attribute(group, "seconds");
  needle.steps = integer_attribute(group, "step_count");
  for (const StepRow& row : rows_in<StepRow>(group, "steps", step_row_type())) {
    demand_shape(row.tip_state >= 0 && row.tip_state <= static_cast<std::int8_t>(TipState::exited), "tip_state");
    needle.record.steps.push_back(from_row(row));
  }
  for (const EventRow& row : rows_in<EventRow>(group, "events", event_row_type())) {
    demand_shape(row.kind >= 0 && row.kind <= static_cast<std::int8_t>(EventKind::grazed), "kind of an event");
    needle.events.push_back(from_row(row));
  }
  const std::vector<Vec3> points = points_in(group, "shapes_mm");
  const auto rows = rows_in<ShapeRow>(group, "shapes", shape_row_type());
  demand_shape(points.size() == rows.size() * kNeedleShapePoints, "shapes_mm");
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const auto first = points.begin() + static_cast<std::ptrdiff_t>(k * kNeedleShapePoints);
    needle.record.shapes.push_back(
        {get_text(rows[k].when), rows[k].time_s, rows[k].base_depth_mm, {first, first + kNeedleShapePoints}});
  }
  return needle;
}

RecordedStructure structure_in(hid_t parent, std::size_t number) {
  const h5::Handle group = h5::open_group(parent, member_name(number).c_str());
  RecordedStructure structure;
  structure.name = h5::read_text_attribute(group, "name");
  structure.region = h5::read_text_attribute(group, "region");
  structure.type = h5::read_text_attribute(group, "type");
  const std::vector<int> colour = h5::read_int_attribute(group, "colour");
  demand_shape(colour.size() == 3, "colour");
  std::copy(colour.begin(), colour.end(), structure.colour.begin());
  structure.volume_cc = number_attribute(group, "volume_cc");
  const std::vector<Vec3> points = points_in(group, "contour_points_mm");
  std::size_t first = 0;
  for (const std::int64_t count : rows_in<std::int64_t>(group, "contour_sizes", H5T_NATIVE_INT64)) {
    demand_shape(count >= 0 && static_cast<std::size_t>(count) <= points.size() - first, "contour_sizes");
    const auto begin = points.begin() + static_cast<std::ptrdiff_t>(first);
    structure.contours.push_back({.points = {begin, begin + static_cast<std::ptrdiff_t>(count)}});
    first += static_cast<std::size_t>(count);
  }
  structure.cloud_mm = points_in(group, "cloud_mm");
  return structure;
}

RecordedDose dose_in(hid_t file, const char* name) {
  const h5::Handle group = h5::open_group(file, name);
  RecordedDose dose;
  dose.grid.origin_mm = vector_attribute(group, "origin_mm");
  dose.grid.spacing_mm = vector_attribute(group, "spacing_mm");
  const h5::Handle set = h5::dataset(group, "dose_Gy");
  const auto shape = h5::extents(set);
  demand_shape(shape.size() == 3, "dose_Gy");
  for (std::size_t k = 0; k < 3; ++k) dose.grid.size[k] = static_cast<Index>(shape[2 - k]);
  dose.grid.dose_Gy.resize(shape[0] * shape[1] * shape[2]);
  h5::read_rows(set, H5T_NATIVE_FLOAT, 0, shape[0], dose.grid.dose_Gy.data());
  dose.dose_Gy = rows_in<double>(group, "dvh_dose_Gy", H5T_NATIVE_DOUBLE);
  const h5::Handle percent = h5::dataset(group, "dvh_percent");
  const auto curves = h5::extents(percent);
  demand_shape(curves.size() == 2 && curves[1] == dose.dose_Gy.size(), "dvh_percent");
  for (hsize_t s = 0; s < curves[0]; ++s)
    h5::read_rows(percent, H5T_NATIVE_DOUBLE, s, 1, dose.percent.emplace_back(curves[1]).data());
  return dose;
}

template <class Item, class Read>
std::vector<Item> members_of(hid_t file, const char* name, const Read& read) {
  const h5::Handle group = h5::open_group(file, name);
  H5G_info_t info{};
  h5::check(H5Gget_info(group, &info), name);
  std::vector<Item> items;
  for (std::size_t k = 0; k < info.nlinks; ++k) items.push_back(read(group, k));
  return items;
}

ImplantRecord whole_implant_in(hid_t file) {
  if (!h5::has_attribute(file, "format") || h5::read_text_attribute(file, "format") != kImplantFileFormat)
    throw h5::Failure("an HDF5 file, but not that of an implant");
  if (integer_attribute(file, "format_version") > kImplantFileVersion)
    throw h5::Failure("written by a newer version of stylet");
  if (integer_attribute(file, "format_version") < kImplantFileVersion)
    throw h5::Failure("written by an older version of stylet, whose seeds have fewer causes");
  ImplantRecord r;
  r.version = h5::read_text_attribute(file, "version");
  r.scenario_name = h5::read_text_attribute(file, "scenario_name");
  r.scenario_text = h5::read_text(file, "scenario");
  r.source = h5::read_text_attribute(file, "source");
  r.prescription_Gy = number_attribute(file, "prescription_Gy");
  r.needle_diameter_mm = number_attribute(file, "needle_diameter_mm");
  r.needle_length_mm = number_attribute(file, "needle_length_mm");
  r.seed_length_mm = number_attribute(file, "seed_length_mm");
  r.mesh = h5::read_mesh(file);
  r.needles = members_of<NeedleHistory>(file, "needles", needle_in);
  r.stabilising = members_of<NeedleHistory>(file, "stabilising", needle_in);
  for (const SeedRow& row : rows_in<SeedRow>(file, "seeds", seed_row_type())) {
    demand_shape(row.number >= 1 && row.needle >= 0 && static_cast<std::size_t>(row.needle) < r.needles.size(),
                 "/seeds: needle");
    r.seeds.push_back(from_row(row));
  }
  r.structures = members_of<RecordedStructure>(file, "structures", structure_in);
  r.planned = dose_in(file, "planned");
  r.delivered = dose_in(file, "delivered");
  r.warnings = h5::read_texts(file, "warnings");
  const auto summary = rows_in<char>(file, "summary_json", H5T_NATIVE_UINT8);
  r.summary.assign(summary.begin(), summary.end());
  if (h5::read_text_attribute(file, "content_sha256") != content_digest(r))
    throw h5::Failure("damaged: its content has changed since it was written");
  return r;
}

}  // namespace

h5::Handle seed_row_type() {
  h5::Handle type = h5::compound_type(sizeof(SeedRow));
  const h5::Handle vector = h5::array_type(H5T_NATIVE_DOUBLE, 3), yes_or_no = h5::bool_type();
  h5::insert_member(type, "number", offsetof(SeedRow, number), H5T_NATIVE_INT32);
  h5::insert_member(type, "needle", offsetof(SeedRow, needle), H5T_NATIVE_INT32);
  h5::insert_member(type, "lost", offsetof(SeedRow, lost), yes_or_no);
  h5::insert_member(type, "in_tissue", offsetof(SeedRow, in_tissue), yes_or_no);
  h5::insert_member(type, "dropped_s", offsetof(SeedRow, dropped_s), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "planned_mm", offsetof(SeedRow, planned_mm), vector);
  h5::insert_member(type, "dropped_mm", offsetof(SeedRow, dropped_mm), vector);
  h5::insert_member(type, "rest_mm", offsetof(SeedRow, rest_mm), vector);
  h5::insert_member(type, "axis", offsetof(SeedRow, axis), vector);
  for (std::size_t k = 0; k < kAllCauses; ++k)
    h5::insert_member(type, kCauseColumns[k], offsetof(SeedRow, cause_mm) + k * 3 * sizeof(double), vector);
  return type;
}

SeedRow to_row(const SeedHistory& seed) {
  SeedRow row;
  row.number = static_cast<std::int32_t>(seed.number + 1);
  row.needle = static_cast<std::int32_t>(seed.needle);
  row.lost = seed.lost ? 1 : 0;
  row.in_tissue = seed.in_tissue ? 1 : 0;
  row.dropped_s = seed.dropped_s;
  row.planned_mm = numbers_of(seed.planned_mm);
  row.dropped_mm = numbers_of(seed.dropped_mm);
  row.rest_mm = numbers_of(seed.rest_mm);
  row.axis = numbers_of(seed.axis);
  for (std::size_t k = 0; k < kAllCauses; ++k) row.cause_mm[k] = numbers_of(seed.cause_mm[k]);
  return row;
}

SeedHistory from_row(const SeedRow& row) {
  SeedHistory seed;
  seed.number = static_cast<std::size_t>(row.number - 1);
  seed.needle = static_cast<std::size_t>(row.needle);
  seed.lost = row.lost != 0;
  seed.in_tissue = row.in_tissue != 0;
  seed.dropped_s = row.dropped_s;
  seed.planned_mm = vector_from(row.planned_mm);
  seed.dropped_mm = vector_from(row.dropped_mm);
  seed.rest_mm = vector_from(row.rest_mm);
  seed.axis = vector_from(row.axis);
  for (std::size_t k = 0; k < kAllCauses; ++k) seed.cause_mm[k] = vector_from(row.cause_mm[k]);
  return seed;
}

h5::Handle shape_row_type() {
  h5::Handle type = h5::compound_type(sizeof(ShapeRow));
  h5::insert_member(type, "time_s", offsetof(ShapeRow, time_s), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "base_depth_mm", offsetof(ShapeRow, base_depth_mm), H5T_NATIVE_DOUBLE);
  h5::insert_member(type, "when", offsetof(ShapeRow, when), h5::string_type(sizeof(ShapeRow::when)));
  return type;
}

std::string content_digest(ImplantRecord& record) {
  detail::WireWriter wire;
  wire(record);
  detail::Digest digest;
  digest.add_bytes(wire.bytes.data(), wire.bytes.size());
  return digest.finish();
}

void write_stored_implant(const char* path, ImplantRecord& record) {
  h5::Handle file = h5::create_file(path);
  write_all_of(file, record);
  if (!file.reset()) h5::fail("close");
}

Result<ImplantRecord> parse_implant_file(const std::filesystem::path& path) {
  try {
    return whole_implant_in(h5::open_growing_file(path.c_str()));
  } catch (const h5::Failure& e) {
    return input_error(path.string(), e.what(), kGiveAnImplant);
  }
}

}  // namespace stylet::results
