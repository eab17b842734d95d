// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/input_file.hpp"
#include "reading/ask.hpp"
#include "stored_checks.hpp"
#include "stylet/io/recording_io.hpp"
#include "stylet/io/scenario_io.hpp"
#include "summary_json.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <span>
#include <thread>

namespace stylet {
namespace fs = std::filesystem;
using namespace results;

namespace {

/// The parts of one frame in the datasets of all frames; all empty if the row refers to rows that do not exist.
struct FrameParts {
  std::span<const float> displacement;
  std::span<const Vec3> needle;
  std::size_t contact_first = 0, contact_count = 0;
  std::string_view contacts;  ///< bytes of their rows
  bool inside = false;
};

FrameParts parts_of(const StoredRun& run, std::size_t frame) {
  const auto inside = [](std::int64_t first, std::int64_t count, std::size_t size) {
    return first >= 0 && count >= 0 && static_cast<std::uint64_t>(first) <= size &&
           static_cast<std::uint64_t>(count) <= size - static_cast<std::uint64_t>(first);
  };
  const auto row = record_at(run.frames, frame, "/frames");
  const std::size_t numbers = 3 * run.mesh.nodes.size(), bytes = record::row_bytes<ContactView>();
  if (!inside(row.needle_first, row.needle_count, run.needle.size()) ||
      !inside(row.contact_first, row.contact_count, run.contacts.size()))
    return {};
  const auto first = static_cast<std::size_t>(row.contact_first), count = static_cast<std::size_t>(row.contact_count);
  return {std::span(run.displacement).subspan(frame * numbers, numbers),
          std::span(run.needle)
              .subspan(static_cast<std::size_t>(row.needle_first), static_cast<std::size_t>(row.needle_count)),
          first,
          count,
          std::string_view(run.contacts.bytes).substr(first * bytes, count * bytes),
          true};
}

/// Whether a frame with its parts is complete.
bool is_whole_frame(const StoredRun& run, std::size_t k) {
  const FrameParts parts = parts_of(run, k);
  if (!parts.inside) return false;
  if (run.format_version >= kFirstWithChecks)
    return run.frames.is_whole(k, parts_of_frame(parts.displacement, parts.needle, parts.contacts));
  for (std::size_t c = 0; c < parts.contact_count; ++c)
    if (std::isnan(record_at(run.contacts, parts.contact_first + c, "/frames/contacts").s)) return false;
  return wholeness(run.format_version, run.frames)(k) &&
         std::none_of(parts.displacement.begin(), parts.displacement.end(), [](float u) { return std::isnan(u); }) &&
         std::none_of(parts.needle.begin(), parts.needle.end(), [](const Vec3& p) { return p.hasNaN(); });
}

/// Whether the steps at rest between two records take the time between them.
bool rest_fits(const Step& before, const Step& row) {
  if (row.rest_steps == 0) return true;
  constexpr double tolerance_s = 1e-8;
  const double rest_s = row.time_s - row.dt_s - before.time_s;
  return row.rest_steps > 0 && std::abs(static_cast<double>(row.rest_steps) * before.dt_s - rest_s) <= tolerance_s;
}

Frame frame_of(const StoredRun& run, std::size_t k, const FrameRow& row) {
  const FrameParts parts = parts_of(run, k);
  Frame frame;
  frame.time_s = row.time_s;
  frame.base_depth_mm = row.base_depth_mm;
  frame.label = row.label;
  frame.displacement =
      Eigen::Map<const Eigen::VectorXf>(parts.displacement.data(), static_cast<Eigen::Index>(parts.displacement.size()))
          .cast<double>();
  frame.needle.assign(parts.needle.begin(), parts.needle.end());
  for (std::size_t c = 0; c < parts.contact_count; ++c)
    frame.contacts.push_back(record_at(run.contacts, parts.contact_first + c, "/frames/contacts"));
  return frame;
}

/// The summary's text; empty if there is none, or if the writer was killed before it was complete.
std::string summary_of(const StoredRun& run, const std::optional<RunEnd>& end) {
  if (run.format_version < kFirstWithChecks) return run.summary;
  if (!end) return {};
  expect(end->summary_bytes == static_cast<std::int64_t>(run.summary.size()) &&
             (run.summary.empty() || end->summary_check == record::check_of(run.summary.data(), run.summary.size())),
         "/summary_json");
  return run.summary;
}

/// Checks a stored run and converts it. Throws Changed if its data differ from what was written.
RunRecording checked(StoredRun run, const fs::path& path) {
  if (run.format_version >= kFirstWithChecks)
    expect(run.start_digest == start_digest(run.info, run.mesh), "scenario and mesh");
  for (const int region : run.info.target_regions)
    expect(region >= 0 && static_cast<std::size_t>(region) < run.mesh.regions.size(), "target_regions");
  const std::optional<RunEnd> end = end_of(run.end);
  const auto said = [&](std::int64_t RunEnd::*count) { return said_by(end, count); };
  RunRecording out;
  out.has_ended = end.has_value();
  out.steps = whole_records(run.steps, wholeness(run.format_version, run.steps), said(&RunEnd::steps), "/steps");
  for (std::size_t k = 0; k < out.steps.size(); ++k)
    expect(k == 0 ? out.steps[k].rest_steps == 0 : rest_fits(out.steps[k - 1], out.steps[k]), "/steps: rest_steps");
  const auto frames = whole_records(
      run.frames, [&](std::size_t k) { return is_whole_frame(run, k); }, said(&RunEnd::frames), "/frames");
  for (std::size_t k = 0; k < frames.size(); ++k) out.frames.push_back(frame_of(run, k, frames[k]));
  out.events = whole_records(run.events, wholeness(run.format_version, run.events), said(&RunEnd::events), "/events");
  const auto scenario = parse_scenario(run.info.scenario_text, path);
  expect(!scenario || !scenario->insertions.empty(), "/scenario: it has no insertion");
  if (run.probe_moves.size() > 0) {
    const ProbeMove planned{0.0, scenario ? scenario->probe : ProbeSettings{}};
    out.probe_moves = whole_records(run.probe_moves, wholeness(run.format_version, run.probe_moves),
                                    said(&RunEnd::probe_moves), "/probe", planned);
  } else {
    expect(!end || end->probe_moves == 0, "/probe");
  }
  out.implant = implant_of(run.seeds, end);
  if (const std::string summary = summary_of(run, end); !summary.empty()) {
    if (auto parsed = parse_summary_json(summary, path.string()); parsed.ok()) out.summary = std::move(*parsed);
  }
  out.info = std::move(run.info);
  out.mesh = std::move(run.mesh);
  return out;
}

/// Reads and checks a file once. Throws Changed as checked() does.
Result<RunRecording> read_once(const fs::path& path) {
  Result<StoredRun> stored = detail::ask(kRunFile, path);
  if (!stored) return stored.error();
  if (auto sound = check_mesh(stored->mesh, path.string() + ", /mesh"); !sound) return sound.error();
  return checked(std::move(*stored), path);
}

}  // namespace

Result<RunRecording> read_recording(const fs::path& path) {
  if (Result<> readable = detail::check_input_file(path); !readable)
    return input_error(path.string(), readable.error().what, kGiveARecording);
  // A file that is being written may be read in an inconsistent state; reading it again usually helps.
  constexpr int kAttempts = 3;
  std::string changed;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    try {
      return read_once(path);
    } catch (const Changed& e) {
      changed = e.what();
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return input_error(path.string(), "damaged: this part has changed since it was written: " + changed, kGiveARecording);
}

}  // namespace stylet
