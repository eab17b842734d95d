// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/input_file.hpp"
#include "run_file_format.hpp"
#include "stylet/io/recording_io.hpp"
#include "summary_json.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {
namespace fs = std::filesystem;
using namespace results;

namespace {

struct NotARun : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void demand(bool condition, const char* what) {
  if (!condition) throw NotARun(what);
}

TetMesh read_mesh(hid_t file) {
  const h5::Handle group = h5::open_group(file, "mesh");
  const h5::Handle nodes = h5::dataset(group, "nodes_mm"), tets = h5::dataset(group, "tets"),
                   region = h5::dataset(group, "tet_region");
  const auto node_shape = h5::extents(nodes), tet_shape = h5::extents(tets);
  demand(node_shape.size() == 2 && node_shape[1] == 3, "/mesh/nodes_mm must be (n, 3)");
  demand(tet_shape.size() == 2 && tet_shape[1] == 4, "/mesh/tets must be (m, 4)");
  demand(h5::extents(region) == std::vector<hsize_t>{tet_shape[0]}, "/mesh/tet_region must be (m)");
  TetMesh mesh;
  mesh.nodes.resize(node_shape[0]);
  mesh.tets.resize(tet_shape[0]);
  mesh.tet_region.resize(tet_shape[0]);
  h5::read_rows(nodes, H5T_NATIVE_DOUBLE, 0, node_shape[0], mesh.nodes.data());
  h5::read_rows(tets, H5T_NATIVE_INT32, 0, tet_shape[0], mesh.tets.data());
  h5::read_rows(region, H5T_NATIVE_INT, 0, tet_shape[0], mesh.tet_region.data());
  mesh.regions = h5::read_texts(group, "regions");
  return mesh;
}

std::vector<double> read_numbers(hid_t file, const char* name, std::size_t count) {
  auto values = h5::read_double_attribute(file, name);
  if (values.size() != count) throw NotARun(std::string("attribute ") + name + " has the wrong size");
  return values;
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

  const h5::Handle set = h5::dataset(file, "parameters");
  const h5::Handle type = parameter_row_type();
  std::vector<ParameterText> rows(h5::extents(set).at(0));
  h5::read_rows(set, type, 0, rows.size(), rows.data());
  for (const ParameterText& row : rows) {
    const auto text = [](const char* t) { return std::string(t == nullptr ? "" : t); };
    info.parameters.push_back({text(row.name), text(row.value), text(row.unit), text(row.source)});
  }
  if (!rows.empty()) {
    const h5::Handle space(h5::check(H5Dget_space(set), "parameters"), H5Sclose);
    H5Dvlen_reclaim(type, space, H5P_DEFAULT, rows.data());
  }
  return info;
}

/// Whether the steps at rest between two records take as long as there is between them.
bool rest_fits(const StepRow& before, const StepRow& row) {
  if (row.rest_steps == 0) return true;
  constexpr double tolerance_s = 1e-8;
  const double rest_s = row.time_s - row.dt_s - before.time_s;
  return row.rest_steps > 0 && std::abs(static_cast<double>(row.rest_steps) * before.dt_s - rest_s) <= tolerance_s;
}

/// Steps up to the first that had not reached the disk.
std::vector<StepRecord> read_steps(hid_t file) {
  const h5::Handle set = h5::dataset(file, "steps");
  std::vector<StepRow> rows(h5::extents(set).at(0));
  h5::read_rows(set, step_row_type(), 0, rows.size(), rows.data());
  std::vector<StepRecord> steps;
  steps.reserve(rows.size());
  for (const StepRow& row : rows) {
    if (std::isnan(row.time_s)) break;
    demand(row.tip_state >= 0 && row.tip_state <= static_cast<std::int8_t>(TipState::exited), "/steps: tip_state");
    demand(rest_fits(steps.empty() ? StepRow() : rows[steps.size() - 1], row), "/steps: rest_steps");
    steps.push_back(from_row(row));
  }
  return steps;
}

/// Frames up to the first that had not reached the disk whole.
std::vector<Frame> read_frames(hid_t file, hsize_t node_count) {
  const h5::Handle group = h5::open_group(file, "frames");
  const h5::Handle table = h5::dataset(group, "table"), displacement = h5::dataset(group, "displacement_mm"),
                   needle = h5::dataset(group, "needle_mm"), contacts = h5::dataset(group, "contacts");
  const auto shape = h5::extents(displacement);
  demand(shape.size() == 3 && shape[1] == node_count && shape[2] == 3, "/frames/displacement_mm must be (f, n, 3)");
  std::vector<FrameRow> rows(std::min(h5::extents(table).at(0), shape[0]));
  h5::read_rows(table, frame_row_type(), 0, rows.size(), rows.data());
  std::vector<Vec3> points(h5::extents(needle).at(0));
  h5::read_rows(needle, H5T_NATIVE_DOUBLE, 0, points.size(), points.data());
  std::vector<ContactRow> contact_rows(h5::extents(contacts).at(0));
  h5::read_rows(contacts, contact_row_type(), 0, contact_rows.size(), contact_rows.data());

  const auto inside = [](std::int64_t first, std::int64_t count, std::size_t size) {
    return first >= 0 && count >= 0 && static_cast<std::uint64_t>(first) <= size &&
           static_cast<std::uint64_t>(count) <= size - static_cast<std::uint64_t>(first);
  };
  std::vector<Frame> frames;
  Eigen::VectorXf values(static_cast<Eigen::Index>(3 * node_count));
  for (std::size_t f = 0; f < rows.size(); ++f) {
    const FrameRow& row = rows[f];
    if (std::isnan(row.time_s) || !inside(row.needle_first, row.needle_count, points.size()) ||
        !inside(row.contact_first, row.contact_count, contact_rows.size())) {
      break;
    }
    h5::read_rows(displacement, H5T_NATIVE_FLOAT, f, 1, values.data());
    Frame frame;
    frame.time_s = row.time_s;
    frame.base_depth_mm = row.base_depth_mm;
    frame.label = get_text(row.label);
    frame.displacement = values.cast<double>();
    frame.needle.assign(points.begin() + row.needle_first, points.begin() + row.needle_first + row.needle_count);
    bool whole = !values.hasNaN();
    for (const Vec3& p : frame.needle) whole = whole && !p.hasNaN();
    for (std::int64_t c = row.contact_first; c < row.contact_first + row.contact_count; ++c) {
      frame.contacts.push_back(from_row(contact_rows[static_cast<std::size_t>(c)]));
      whole = whole && !std::isnan(frame.contacts.back().s);
    }
    if (!whole) break;
    frames.push_back(std::move(frame));
  }
  return frames;
}

std::vector<Event> read_events(hid_t file) {
  const h5::Handle set = h5::dataset(file, "events");
  std::vector<EventRow> rows(h5::extents(set).at(0));
  h5::read_rows(set, event_row_type(), 0, rows.size(), rows.data());
  std::vector<Event> events;
  for (const EventRow& row : rows) {
    if (std::isnan(row.time_s)) break;  // had not reached the disk
    demand(row.kind >= 0 && row.kind <= static_cast<std::int8_t>(EventKind::grazed), "/events: kind");
    events.push_back(from_row(row));
  }
  return events;
}

std::string read_summary_text(hid_t file) {
  const h5::Handle set = h5::dataset(file, "summary_json");
  std::string text(h5::extents(set).at(0), '\0');
  h5::read_rows(set, H5T_NATIVE_UINT8, 0, text.size(), text.data());
  return text;
}

}  // namespace

Result<RunRecording> read_recording(const fs::path& path) {
  const auto refuse = [&](const std::string& what) {
    return input_error(path.string(), what, "Give a run.h5 that `stylet insert` wrote.");
  };
  if (Result<> readable = detail::check_input_file(path); !readable) return refuse(readable.error().what);
  const h5::LibraryTurn turn;
  try {
    const h5::Handle file = h5::open_growing_file(path.c_str());
    demand(h5::has_attribute(file, "format") && h5::read_text_attribute(file, "format") == kRunFileFormat,
           "an HDF5 file, but not a recorded run");
    const auto version = h5::read_int_attribute(file, "format_version");
    demand(version.size() == 1 && version[0] <= kRunFileVersion, "written by a newer version of stylet");
    RunRecording run;
    run.mesh = read_mesh(file);
    if (auto checked = check_mesh(run.mesh, path.string() + ", /mesh"); !checked) return checked.error();
    run.info = read_info(file);
    for (const int region : run.info.target_regions) {
      demand(region >= 0 && static_cast<std::size_t>(region) < run.mesh.regions.size(), "target_regions out of range");
    }
    run.steps = read_steps(file);
    run.frames = read_frames(file, run.mesh.nodes.size());
    run.events = read_events(file);
    const std::string summary = read_summary_text(file);
    if (!summary.empty()) {
      // A writer killed between two flushes of its last words leaves a summary that is not whole: no summary.
      if (auto parsed = parse_summary_json(summary, path.string()); parsed.ok()) run.summary = std::move(*parsed);
    }
    return run;
  } catch (const h5::Failure& e) {
    return refuse(e.what());
  } catch (const NotARun& e) {
    return refuse(e.what());
  } catch (const std::exception& e) {
    return refuse(std::string("damaged: ") + e.what());
  }
}

}  // namespace stylet
