// SPDX-License-Identifier: GPL-3.0-or-later
#include "stored_run.hpp"

#include "h5_mesh.hpp"
#include "record/attributes.hpp"

#include <cmath>

namespace stylet::results {
namespace fs = std::filesystem;

namespace {

struct NotARun : std::runtime_error {
  explicit NotARun(const std::string& what, const char* its_cure = kGiveARecording)
      : std::runtime_error(what), cure(its_cure) {}
  const char* cure;
};

void demand(bool condition, const char* what) {
  if (!condition) throw NotARun(what);
}

std::vector<ParameterRow> read_parameters(hid_t file) {
  const auto column = [&](std::size_t k) { return h5::read_text_column(file, "parameters", kParameterColumns[k]); };
  auto names = column(0), values = column(1), units = column(2), sources = column(3);
  std::vector<ParameterRow> rows;
  for (std::size_t k = 0; k < names.size(); ++k)
    rows.push_back({std::move(names[k]), std::move(values[k]), std::move(units[k]), std::move(sources[k])});
  return rows;
}

RunInfo read_info(hid_t file) {
  RunInfo info;
  record::read_attributes(file, info);
  info.scenario_text = h5::read_text(file, "scenario");
  info.supports = h5::read_texts(file, "supports");
  info.warnings = h5::read_texts(file, "warnings");
  info.parameters = read_parameters(file);
  return info;
}

void read_frames(hid_t file, StoredRun& run) {
  const h5::Handle group = h5::open_group(file, "frames");
  const h5::Handle displacement = h5::dataset(group, "displacement_mm"), needle = h5::dataset(group, "needle_mm");
  // The writer adds a frame's row after its data, so all data of the rows are there if the table is read first.
  run.frames = record::read_rows<FrameRow>(group, "table");
  const auto shape = h5::extents(displacement);
  demand(shape.size() == 3 && shape[1] == run.mesh.nodes.size() && shape[2] == 3,
         "/frames/displacement_mm must be (f, n, 3)");
  const std::size_t frames = std::min<std::size_t>(run.frames.size(), shape[0]);
  run.frames.bytes.resize(frames * record::row_bytes<FrameRow>());
  run.displacement.resize(frames * shape[1] * 3);
  h5::read_rows(displacement, H5T_NATIVE_FLOAT, 0, frames, std::as_writable_bytes(std::span(run.displacement)));
  const auto points = h5::extents(needle);
  demand(points.size() == 2 && points[1] == 3, "/frames/needle_mm must be (p, 3)");
  run.needle.resize(points[0]);
  h5::read_rows(needle, H5T_NATIVE_DOUBLE, 0, points[0], std::as_writable_bytes(std::span(run.needle)));
  run.contacts = record::read_rows<ContactView>(group, "contacts");
}

void read_seeds(hid_t file, StoredSeeds& seeds) {
  if (h5::check(H5Lexists(file, "implant", H5P_DEFAULT), "look for /implant") == 0) return;
  const h5::Handle group = h5::open_group(file, "implant");
  seeds.digest = h5::read_text_attribute(group, "plan_sha256");
  record::read_attributes(group, seeds.plan.head);
  seeds.plan.needles = record::read_rows<RecordedPlan::Needle>(group, "needles");
  seeds.plan.seeds = record::read_rows<RecordedPlan::Seed>(group, "planned_seeds");
  // A dose is written after its acts, so all acts of the doses are there if the doses are read first.
  seeds.doses = record::read_rows<RecordedScore>(group, "doses");
  seeds.acts = record::read_rows<SeedAct>(group, "acts");
}

/// Throws NotARun for anything but a recording of a version that is known.
int version_of(hid_t file) {
  demand(h5::has_attribute(file, "format"), "an HDF5 file, but not a recorded run");
  const std::string format = h5::read_text_attribute(file, "format");
  demand(format != "stylet-model",
         "a saved model without the seal at its end: it is damaged, or an earlier version of stylet saved it");
  if (format == kImplantFileFormat) {
    throw NotARun("the record of an implant, which has many needles and is not a recording of an insertion",
                  "Look at it with stylet info, or repeat it with stylet implant and its scenario");
  }
  demand(format == kRunFileFormat, "an HDF5 file, but not a recorded run");
  const auto version = h5::read_int_attribute(file, "format_version");
  demand(version.size() == 1 && version[0] <= run_file_version(), "written by a newer version of stylet");
  return version[0];
}

StoredRun read_all(hid_t file) {
  StoredRun run;
  run.format_version = version_of(file);
  const bool checks = run.format_version >= kFirstWithChecks;
  if (checks) {
    run.start_digest = h5::read_text_attribute(file, "start_sha256");
    run.end = record::read_rows<RunEnd>(file, "end");  // read first, since the writer adds it last
  }
  run.mesh = h5::read_mesh(file);
  run.info = read_info(file);
  run.steps = record::read_rows<Step>(file, "steps");
  read_frames(file, run);
  run.events = record::read_rows<Event>(file, "events");
  if (run.format_version >= kFirstWithSeeds) read_seeds(file, run.seeds);
  if (run.format_version >= kFirstWithProbe) run.probe_moves = record::read_rows<ProbeMove>(file, "probe");
  const h5::Handle summary = h5::dataset(file, "summary_json");
  const auto length = h5::extents(summary);
  demand(length.size() == 1, "/summary_json must have one axis");
  run.summary.resize(length[0]);
  h5::read_rows(summary, H5T_NATIVE_UINT8, 0, length[0], std::as_writable_bytes(std::span(run.summary)));
  return run;
}

/// The largest axial force of a file with at most kMostSearched steps.
double largest_force(hid_t file) {
  constexpr hsize_t kMostSearched = 60'000;  // a minute in motion, some megabytes
  const h5::Handle steps = h5::dataset(file, "steps");
  const auto shape = h5::extents(steps);
  demand(shape.size() == 1, "/steps must have one axis");
  if (shape[0] == 0 || shape[0] > kMostSearched) return record::kNotANumber;
  const h5::Handle column = h5::compound_type(sizeof(double));
  h5::insert_member(column, "force_axial_N", 0, H5T_NATIVE_DOUBLE);
  std::vector<double> forces(shape[0]);
  h5::read_rows(steps, column, 0, shape[0], std::as_writable_bytes(std::span(forces)));
  double most_N = record::kNotANumber;
  for (const double force_N : forces) most_N = std::fmax(most_N, force_N);
  return most_N;
}

StoredHead read_head(hid_t file) {
  constexpr hsize_t kLastSteps = 256;  // more than may be announced and not yet written
  StoredHead head;
  head.format_version = version_of(file);
  if (head.format_version >= kFirstWithChecks) head.end = record::read_rows<RunEnd>(file, "end");
  head.scenario_name = h5::read_text_attribute(file, "scenario_name");
  head.last_steps = record::read_rows<Step>(file, "steps", kLastSteps);
  head.events = record::read_rows<Event>(file, "events");
  if (head.format_version >= kFirstWithSeeds) read_seeds(file, head.seeds);
  if (head.seeds.plan.needles.size() == 0) head.most_N = largest_force(file);
  return head;
}

}  // namespace

Result<std::vector<StoredHead>> parse_run_heads(const fs::path& first, const std::vector<std::string>& others) {
  const h5::LibraryTurn turn;
  std::vector<std::string> files{first.string()};
  files.insert(files.end(), others.begin(), others.end());
  std::vector<StoredHead> heads;
  for (const std::string& file : files) {
    StoredHead& head = heads.emplace_back();
    try {
      head = read_head(h5::open_growing_file(file.c_str()));
    } catch (const h5::Failure& e) {
      head.problem = input_error(file, e.what(), kGiveARecording);
    } catch (const NotARun& e) {
      head.problem = input_error(file, e.what(), e.cure);
    }
  }
  return heads;
}

Result<StoredRun> parse_run_file(const fs::path& path) {
  const h5::LibraryTurn turn;
  try {
    return read_all(h5::open_growing_file(path.c_str()));
  } catch (const h5::Failure& e) {
    return input_error(path.string(), e.what(), kGiveARecording);
  } catch (const NotARun& e) {
    return input_error(path.string(), e.what(), e.cure);
  }
}

}  // namespace stylet::results
