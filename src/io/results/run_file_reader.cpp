// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/input_file.hpp"
#include "reading/ask.hpp"
#include "stored_run.hpp"
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

struct Changed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void demand(bool condition, const char* what) {
  if (!condition) throw Changed(what);
}

/// The records before the first incomplete one. Throws Changed if a complete row follows an incomplete one, if the
/// number of records differs from `said`, or if a record has a number that means nothing.
/// @param is_whole function that says whether row k is complete @param said number of rows according to /end
/// @param start a record with what the rows do not have
template <class T, class IsWhole>
std::vector<T> whole_records(const record::Rows<T>& rows, const IsWhole& is_whole, std::optional<std::int64_t> said,
                             const char* where, const T& start = {}) {
  std::vector<T> records;
  for (std::size_t k = 0; k < rows.size() && is_whole(k); ++k) demand(rows.get(k, records.emplace_back(start)), where);
  for (std::size_t k = records.size(); k < rows.size(); ++k) demand(!is_whole(k), where);
  demand(!said || *said == static_cast<std::int64_t>(records.size()), where);
  return records;
}

/// The only record of row k. Throws Changed if it has a number that means nothing.
template <class T>
T record_at(const record::Rows<T>& rows, std::size_t k, const char* where) {
  T record;
  demand(rows.get(k, record), where);
  return record;
}

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

/// Whether a row is complete: by its check or, in files of earlier versions, by a time that is not NaN.
template <class T>
auto wholeness(const StoredRun& run, const record::Rows<T>& rows) {
  return [&](std::size_t k) {
    if (run.format_version >= kFirstWithChecks) return rows.is_whole(k);
    T record;
    return rows.get(k, record) && !std::isnan(record.time_s);
  };
}

/// The same of a frame with its parts.
bool is_whole_frame(const StoredRun& run, std::size_t k) {
  const FrameParts parts = parts_of(run, k);
  if (!parts.inside) return false;
  if (run.format_version >= kFirstWithChecks)
    return run.frames.is_whole(k, parts_of_frame(parts.displacement, parts.needle, parts.contacts));
  for (std::size_t c = 0; c < parts.contact_count; ++c)
    if (std::isnan(record_at(run.contacts, parts.contact_first + c, "/frames/contacts").s)) return false;
  return wholeness(run, run.frames)(k) &&
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

/// The row of /end, if the writer has written it.
std::optional<RunEnd> end_of(const StoredRun& run) {
  if (run.end.size() == 0) return std::nullopt;
  demand(run.end.size() == 1 && run.end.is_whole(0), "/end");
  return record_at(run.end, 0, "/end");
}

/// The summary's text; empty if there is none, or if the writer was killed before it was complete.
std::string summary_of(const StoredRun& run, const std::optional<RunEnd>& end) {
  if (run.format_version < kFirstWithChecks) return run.summary;
  if (!end) return {};
  demand(end->summary_bytes == static_cast<std::int64_t>(run.summary.size()) &&
             (run.summary.empty() || end->summary_check == record::check_of(run.summary.data(), run.summary.size())),
         "/summary_json");
  return run.summary;
}

/// The seeds of a live session; empty if the file has none.
/// @param end the row of /end, if the writer has written it
std::optional<RecordedImplant> implant_of(const StoredRun& run, const std::optional<RunEnd>& end) {
  const StoredSeeds& stored = run.seeds;
  if (stored.plan.needles.size() == 0) {
    demand(!end || (end->acts == 0 && end->doses == 0), "/implant");
    return std::nullopt;
  }
  demand(stored.digest == plan_digest(stored.plan), "/implant: the plan");
  RecordedImplant out{stored.plan.head, {}, {}};
  RecordedPlan& plan = out.plan;
  for (std::size_t k = 0; k < stored.plan.needles.size(); ++k)
    plan.needles.push_back(record_at(stored.plan.needles, k, "/implant/needles"));
  for (std::size_t k = 0; k < stored.plan.seeds.size(); ++k) {
    plan.seeds.push_back(record_at(stored.plan.seeds, k, "/implant/planned_seeds"));
    demand(plan.seeds.back().needle < plan.needles.size(), "/implant/planned_seeds: needle");
  }
  demand(plan.current >= -1 && plan.current < static_cast<int>(plan.needles.size()), "/implant: current");
  out.acts = whole_records(
      stored.acts, [&](std::size_t k) { return stored.acts.is_whole(k); },
      end ? std::optional(end->acts) : std::nullopt, "/implant/acts");
  for (const SeedAct& act : out.acts) demand(act.seed.needle < plan.needles.size(), "/implant/acts: needle");
  out.doses = whole_records(
      stored.doses, [&](std::size_t k) { return stored.doses.is_whole(k); },
      end ? std::optional(end->doses) : std::nullopt, "/implant/doses");
  return out;
}

/// Checks a stored run and converts it. Throws Changed if its data differ from what was written.
RunRecording checked(StoredRun run, const fs::path& path) {
  if (run.format_version >= kFirstWithChecks)
    demand(run.start_digest == start_digest(run.info, run.mesh), "scenario and mesh");
  for (const int region : run.info.target_regions)
    demand(region >= 0 && static_cast<std::size_t>(region) < run.mesh.regions.size(), "target_regions");
  const std::optional<RunEnd> end = end_of(run);
  const auto said = [&](std::int64_t RunEnd::*count) {
    return end ? std::optional((*end).*count) : std::optional<std::int64_t>();
  };
  RunRecording out;
  out.steps = whole_records(run.steps, wholeness(run, run.steps), said(&RunEnd::steps), "/steps");
  for (std::size_t k = 0; k < out.steps.size(); ++k)
    demand(k == 0 ? out.steps[k].rest_steps == 0 : rest_fits(out.steps[k - 1], out.steps[k]), "/steps: rest_steps");
  const auto frames = whole_records(
      run.frames, [&](std::size_t k) { return is_whole_frame(run, k); }, said(&RunEnd::frames), "/frames");
  for (std::size_t k = 0; k < frames.size(); ++k) out.frames.push_back(frame_of(run, k, frames[k]));
  out.events = whole_records(run.events, wholeness(run, run.events), said(&RunEnd::events), "/events");
  const auto scenario = parse_scenario(run.info.scenario_text, path);
  demand(!scenario || !scenario->insertions.empty(), "/scenario: it has no insertion");
  if (run.probe_moves.size() > 0) {
    const ProbeMove planned{0.0, scenario ? scenario->probe : ProbeSettings{}};
    out.probe_moves =
        whole_records(run.probe_moves, wholeness(run, run.probe_moves), said(&RunEnd::probe_moves), "/probe", planned);
  } else {
    demand(!end || end->probe_moves == 0, "/probe");
  }
  out.implant = implant_of(run, end);
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
