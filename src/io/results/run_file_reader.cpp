// SPDX-License-Identifier: GPL-3.0-or-later
#include "detail/guard.hpp"
#include "detail/input_file.hpp"
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

/// Number of valid rows: the rows before the first incomplete one. Throws Changed if a complete row follows an
/// incomplete one, or if the number differs from `said`.
/// @param whole function that says whether row k is complete @param said number of rows according to /end
std::size_t rows_of(std::size_t count, const std::function<bool(std::size_t)>& whole, std::optional<std::int64_t> said,
                    const char* what) {
  std::size_t rows = 0;
  while (rows < count && whole(rows)) ++rows;
  for (std::size_t k = rows; k < count; ++k) demand(!whole(k), what);
  demand(!said || *said == static_cast<std::int64_t>(rows), what);
  return rows;
}

/// The parts of one frame in the datasets of all frames; all empty if the row refers to rows that do not exist.
struct FrameParts {
  std::span<const float> displacement;
  std::span<const Vec3> needle;
  std::span<const ContactRow> contacts;
  bool inside = false;
};

FrameParts parts_of(const StoredRun& run, std::size_t frame) {
  const auto inside = [](std::int64_t first, std::int64_t count, std::size_t size) {
    return first >= 0 && count >= 0 && static_cast<std::uint64_t>(first) <= size &&
           static_cast<std::uint64_t>(count) <= size - static_cast<std::uint64_t>(first);
  };
  const FrameRow& row = run.frames[frame];
  const std::size_t numbers = 3 * run.mesh.nodes.size();
  if (!inside(row.needle_first, row.needle_count, run.needle.size()) ||
      !inside(row.contact_first, row.contact_count, run.contacts.size()))
    return {};
  const auto part = [](const auto& all, std::int64_t first, std::int64_t count) {
    return std::span(all).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(count));
  };
  return {std::span(run.displacement).subspan(frame * numbers, numbers),
          part(run.needle, row.needle_first, row.needle_count),
          part(run.contacts, row.contact_first, row.contact_count), true};
}

/// Decides which rows are complete: by their checks or, in files of earlier versions, by the absence of NaN.
class Wholeness {
 public:
  explicit Wholeness(const StoredRun& run) : run_(run), checks_(run.format_version >= kFirstWithChecks) {}

  [[nodiscard]] bool step(std::size_t k) const {
    const StepRow& row = run_.steps[k];
    return checks_ ? row.check == check_of(row) : !std::isnan(row.time_s);
  }
  [[nodiscard]] bool event(std::size_t k) const {
    const EventRow& row = run_.events[k];
    return checks_ ? row.check == check_of(row) : !std::isnan(row.time_s);
  }
  [[nodiscard]] bool frame(std::size_t k) const {
    const FrameRow& row = run_.frames[k];
    const FrameParts parts = parts_of(run_, k);
    if (!parts.inside) return false;
    if (checks_) return row.check == check_of(row, parts.displacement, parts.needle, parts.contacts);
    return !std::isnan(row.time_s) &&
           std::none_of(parts.displacement.begin(), parts.displacement.end(), [](float u) { return std::isnan(u); }) &&
           std::none_of(parts.needle.begin(), parts.needle.end(), [](const Vec3& p) { return p.hasNaN(); }) &&
           std::none_of(parts.contacts.begin(), parts.contacts.end(),
                        [](const ContactRow& c) { return std::isnan(c.arc_length_mm); });
  }

 private:
  const StoredRun& run_;
  bool checks_;
};

/// Whether the steps at rest between two records take the time between them.
bool rest_fits(const StepRow& before, const StepRow& row) {
  if (row.rest_steps == 0) return true;
  constexpr double tolerance_s = 1e-8;
  const double rest_s = row.time_s - row.dt_s - before.time_s;
  return row.rest_steps > 0 && std::abs(static_cast<double>(row.rest_steps) * before.dt_s - rest_s) <= tolerance_s;
}

Frame frame_of(const StoredRun& run, std::size_t k) {
  const FrameRow& row = run.frames[k];
  const FrameParts parts = parts_of(run, k);
  Frame frame;
  frame.time_s = row.time_s;
  frame.base_depth_mm = row.base_depth_mm;
  frame.label = get_text(row.label);
  frame.displacement =
      Eigen::Map<const Eigen::VectorXf>(parts.displacement.data(), static_cast<Eigen::Index>(parts.displacement.size()))
          .cast<double>();
  frame.needle.assign(parts.needle.begin(), parts.needle.end());
  for (const ContactRow& contact : parts.contacts) frame.contacts.push_back(from_row(contact));
  return frame;
}

/// The row of /end, if the writer has written it.
std::optional<EndRow> end_of(const StoredRun& run) {
  if (run.end.empty()) return std::nullopt;
  demand(run.end.size() == 1 && run.end[0].check == check_of(run.end[0], run.format_version), "/end");
  return run.end[0];
}

/// The summary's text; empty if there is none, or if the writer was killed before it was complete.
std::string summary_of(const StoredRun& run, const std::optional<EndRow>& end) {
  if (run.format_version < kFirstWithChecks) return run.summary;
  if (!end) return {};
  demand(end->summary_bytes == static_cast<std::int64_t>(run.summary.size()) &&
             (run.summary.empty() || end->summary_check == check_of(run.summary)),
         "/summary_json");
  return run.summary;
}

/// The seeds of a live session; empty if the file has none.
/// @param end the row of /end, if the writer has written it
std::optional<RecordedImplant> implant_of(const StoredSeeds& stored, const std::optional<EndRow>& end) {
  if (stored.needles.empty()) {
    demand(!end || (end->acts == 0 && end->doses == 0), "/implant");
    return std::nullopt;
  }
  demand(stored.digest == plan_digest(stored), "/implant: the plan");
  std::optional<RecordedPlan> plan = plan_of(stored);
  demand(plan.has_value(), "/implant: the plan");
  RecordedImplant out{*std::move(plan), {}, {}};
  const auto said = [&](std::int64_t EndRow::*count) {
    return end ? std::optional((*end).*count) : std::optional<std::int64_t>();
  };
  const std::size_t acts = rows_of(
      stored.acts.size(), [&](std::size_t k) { return stored.acts[k].check == check_of(stored.acts[k]); },
      said(&EndRow::acts), "/implant/acts");
  for (std::size_t k = 0; k < acts; ++k) {
    const ActRow& row = stored.acts[k];
    demand(row.kind >= 0 && row.kind <= static_cast<std::int8_t>(SeedAct::Kind::settled), "/implant/acts: kind");
    demand(row.number >= 1 && row.needle >= 0 && static_cast<std::uint64_t>(row.needle) < stored.needles.size(),
           "/implant/acts: number, needle");
    out.acts.push_back(from_row(row));
  }
  const std::size_t doses = rows_of(
      stored.doses.size(), [&](std::size_t k) { return stored.doses[k].check == check_of(stored.doses[k]); },
      said(&EndRow::doses), "/implant/doses");
  for (std::size_t k = 0; k < doses; ++k) out.doses.push_back(from_row(stored.doses[k]));
  return out;
}

/// Checks a stored run and converts it. Throws Changed if its data differ from what was written.
RunRecording checked(StoredRun run, const fs::path& path) {
  if (run.format_version >= kFirstWithChecks)
    demand(run.start_digest == start_digest(run.info, run.mesh), "scenario and mesh");
  for (const int region : run.info.target_regions)
    demand(region >= 0 && static_cast<std::size_t>(region) < run.mesh.regions.size(), "target_regions");
  const std::optional<EndRow> end = end_of(run);
  const auto said = [&](std::int64_t EndRow::*count) {
    return end ? std::optional((*end).*count) : std::optional<std::int64_t>();
  };
  const Wholeness whole(run);
  RunRecording out;
  const std::size_t steps = rows_of(
      run.steps.size(), [&](std::size_t k) { return whole.step(k); }, said(&EndRow::steps), "/steps");
  for (std::size_t k = 0; k < steps; ++k) {
    const std::int8_t state = run.steps[k].tip_state;
    demand(state >= 0 && state <= static_cast<std::int8_t>(TipState::exited), "/steps: tip_state");
    demand(rest_fits(k == 0 ? StepRow() : run.steps[k - 1], run.steps[k]), "/steps: rest_steps");
    out.steps.push_back(from_row(run.steps[k]));
  }
  const std::size_t frames = rows_of(
      run.frames.size(), [&](std::size_t k) { return whole.frame(k); }, said(&EndRow::frames), "/frames");
  for (std::size_t k = 0; k < frames; ++k) out.frames.push_back(frame_of(run, k));
  const std::size_t events = rows_of(
      run.events.size(), [&](std::size_t k) { return whole.event(k); }, said(&EndRow::events), "/events");
  for (std::size_t k = 0; k < events; ++k) {
    const std::int8_t kind = run.events[k].kind;
    demand(kind >= 0 && kind <= static_cast<std::int8_t>(EventKind::grazed), "/events: kind");
    out.events.push_back(from_row(run.events[k]));
  }
  const std::size_t moves = rows_of(
      run.probe_moves.size(), [&](std::size_t k) { return run.probe_moves[k].check == check_of(run.probe_moves[k]); },
      said(&EndRow::probe_moves), "/probe");
  if (moves > 0) {
    const auto scenario = parse_scenario(run.info.scenario_text, path);
    const ProbeSettings planned = scenario ? scenario->probe : ProbeSettings{};
    for (std::size_t k = 0; k < moves; ++k) out.probe_moves.push_back(from_row(run.probe_moves[k], planned));
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
  Result<StoredRun> stored = [&] {
    const h5::LibraryTurn turn;  // no other thread may be in HDF5 when the child process is created
    return detail::guarded<StoredRun>(
        path, [&] { return parse_run_file(path); }, kGiveARecording);
  }();
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
