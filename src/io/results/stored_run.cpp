// SPDX-License-Identifier: GPL-3.0-or-later
#include "stored_run.hpp"

#include "h5_mesh.hpp"

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

std::vector<double> read_numbers(hid_t file, const char* name, std::size_t count) {
  auto values = h5::read_double_attribute(file, name);
  if (values.size() != count) throw NotARun(std::string("attribute ") + name + " has the wrong size");
  return values;
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
  info.version = h5::read_text_attribute(file, "version");
  info.scenario_name = h5::read_text_attribute(file, "scenario_name");
  info.method = h5::read_text_attribute(file, "method");
  info.needle_diameter_mm = read_numbers(file, "needle_diameter_mm", 1)[0];
  info.needle_length_mm = read_numbers(file, "needle_length_mm", 1)[0];
  info.entry_mm = Vec3(read_numbers(file, "entry_mm", 3).data());
  info.direction = Vec3(read_numbers(file, "direction", 3).data());
  info.target_regions = h5::read_int_attribute(file, "target_regions");
  info.scenario_text = h5::read_text(file, "scenario");
  info.supports = h5::read_texts(file, "supports");
  info.warnings = h5::read_texts(file, "warnings");
  info.parameters = read_parameters(file);
  return info;
}

/// All rows of a dataset with one axis.
template <class Row>
std::vector<Row> read_table(hid_t parent, const char* name, hid_t type) {
  const h5::Handle set = h5::dataset(parent, name);
  const auto shape = h5::extents(set);
  demand(shape.size() == 1, name);
  std::vector<Row> rows(shape[0]);
  h5::read_rows(set, type, 0, rows.size(), rows.data());
  return rows;
}

void read_frames(hid_t file, StoredRun& run) {
  const h5::Handle group = h5::open_group(file, "frames");
  const h5::Handle displacement = h5::dataset(group, "displacement_mm"), needle = h5::dataset(group, "needle_mm");
  // The writer adds a frame's row after its data, so all data of the rows are there if the table is read first.
  run.frames = read_table<FrameRow>(group, "table", frame_row_type());
  const auto shape = h5::extents(displacement);
  demand(shape.size() == 3 && shape[1] == run.mesh.nodes.size() && shape[2] == 3,
         "/frames/displacement_mm must be (f, n, 3)");
  run.frames.resize(std::min<std::size_t>(run.frames.size(), shape[0]));
  run.displacement.resize(run.frames.size() * shape[1] * 3);
  h5::read_rows(displacement, H5T_NATIVE_FLOAT, 0, run.frames.size(), run.displacement.data());
  const auto points = h5::extents(needle);
  demand(points.size() == 2 && points[1] == 3, "/frames/needle_mm must be (p, 3)");
  run.needle.resize(points[0]);
  h5::read_rows(needle, H5T_NATIVE_DOUBLE, 0, points[0], run.needle.data());
  run.contacts = read_table<ContactRow>(group, "contacts", contact_row_type());
}

StoredRun read_all(hid_t file) {
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
  demand(version.size() == 1 && version[0] <= kRunFileVersion, "written by a newer version of stylet");
  StoredRun run;
  run.format_version = version[0];
  const bool checks = run.format_version >= kFirstWithChecks;
  if (checks) {
    run.start_digest = h5::read_text_attribute(file, "start_sha256");
    run.end = read_table<EndRow>(file, "end", end_row_type());  // read first, since the writer adds it last
  }
  run.mesh = h5::read_mesh(file);
  run.info = read_info(file);
  run.steps = read_table<StepRow>(file, "steps", step_row_type());
  read_frames(file, run);
  run.events = read_table<EventRow>(file, "events", event_row_type());
  if (run.format_version >= kFirstWithSeeds) run.seeds = read_seed_tables(file);
  if (run.format_version >= kFirstWithProbe) run.probe_moves = read_table<ProbeRow>(file, "probe", probe_row_type());
  const auto summary = read_table<char>(file, "summary_json", H5T_NATIVE_UINT8);
  run.summary.assign(summary.begin(), summary.end());
  return run;
}

}  // namespace

Result<StoredRun> parse_run_file(const fs::path& path) {
  try {
    return read_all(h5::open_growing_file(path.c_str()));
  } catch (const h5::Failure& e) {
    return input_error(path.string(), e.what(), kGiveARecording);
  } catch (const NotARun& e) {
    return input_error(path.string(), e.what(), e.cure);
  }
}

}  // namespace stylet::results
