// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_file_writer.hpp"

#include "h5_mesh.hpp"
#include "output_folder.hpp"
#include "run_file_format.hpp"
#include "summary_json.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <system_error>

namespace stylet::results {
namespace fs = std::filesystem;

namespace {

// Rows per chunk: about 100 kB for steps. Displacements have one frame per chunk, so that a frame is read at once.
constexpr hsize_t kStepChunk = 1024, kTableChunk = 64, kPointChunk = 2048, kTextChunk = 4096;

void write_info(hid_t file, const RunInfo& info) {
  h5::write_attribute(file, "format", std::string(kRunFileFormat));
  h5::write_attribute(file, "format_version", std::array{kRunFileVersion});
  h5::write_attribute(file, "version", info.version);
  h5::write_attribute(file, "scenario_name", info.scenario_name);
  h5::write_attribute(file, "method", info.method);
  h5::write_attribute(file, "units", std::string("mm, N, s"));
  h5::write_attribute(file, "frame", std::string("LPS"));
  h5::write_attribute(file, "needle_diameter_mm", std::array{info.needle_diameter_mm});
  h5::write_attribute(file, "needle_length_mm", std::array{info.needle_length_mm});
  h5::write_attribute(file, "entry_mm", std::span<const double>(info.entry_mm.data(), 3));
  h5::write_attribute(file, "direction", std::span<const double>(info.direction.data(), 3));
  h5::write_attribute(file, "target_regions", std::span<const int>(info.target_regions));
  h5::write_text(file, "scenario", info.scenario_text);
  h5::write_texts(file, "supports", info.supports);
  h5::write_texts(file, "warnings", info.warnings);
  std::vector<std::vector<std::string>> rows;
  for (const ParameterRow& p : info.parameters) rows.push_back({p.name, p.value, p.unit, p.source});
  h5::write_text_table(file, "parameters", kParameterColumns, rows);
}

fs::path hidden_name(const fs::path& path, const std::string& process) {
  return path.parent_path() / fmt::format(".{}.{}.part{}", path.stem().string(), process, path.extension().string());
}

/// Removes temporary files of processes that ended before they could rename them.
void remove_abandoned(const fs::path& path) {
  const std::string before = fmt::format(".{}.", path.stem().string());
  std::vector<fs::path> abandoned;
  std::error_code code;
  for (fs::directory_iterator entry(path.parent_path(), code), end; !code && entry != end; entry.increment(code)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(before)) continue;
    const std::string process = name.substr(before.size(), name.find('.', before.size()) - before.size());
    int number = 0;
    const auto parsed = std::from_chars(process.data(), process.data() + process.size(), number);
    if (parsed.ec != std::errc{} || number <= 0 || entry->path() != hidden_name(path, process)) continue;
    if (::kill(number, 0) != 0 && errno == ESRCH) abandoned.push_back(entry->path());
  }
  for (const fs::path& file : abandoned) fs::remove(file, code);
}

}  // namespace

template <class Action>
Result<> RunFileWriter::guarded(Action action) const {
  const h5::LibraryTurn turn;
  try {
    action();
    return Ok{};
  } catch (const h5::Failure& e) {
    return write_error(path_, e.what());
  }
}

Result<RunFileWriter> RunFileWriter::create(const fs::path& path, const RunInfo& info, const TetMesh& mesh,
                                            const std::function<Result<>()>& make_way, const RecordedPlan* plan) {
  // The new file gets another name first: truncating an earlier file in place would break processes that read it.
  remove_abandoned(path);
  const fs::path hidden = hidden_name(path, std::to_string(::getpid()));
  RunFileWriter w(path);
  Result<> done = w.guarded([&] {
    w.file_ = h5::create_file(hidden.c_str());
    h5::write_mesh(w.file_, mesh);
    write_info(w.file_, info);
    h5::write_attribute(w.file_, "start_sha256", start_digest(info, mesh));

    w.step_type_ = step_row_type();
    w.frame_type_ = frame_row_type();
    w.contact_type_ = contact_row_type();
    w.event_type_ = event_row_type();
    w.probe_type_ = probe_row_type();
    w.end_type_ = end_row_type();
    const StepRow no_step;
    const FrameRow no_frame;
    const ContactRow no_contact;
    const EventRow no_event;
    const ProbeRow no_move;
    const EndRow no_end;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::array<hsize_t, 2> per_node{mesh.nodes.size(), 3};
    const std::array<hsize_t, 1> point{3};
    const h5::Handle frames = h5::group(w.file_, "frames");
    w.steps_ = h5::growing_dataset(w.file_, "steps", w.step_type_, {}, kStepChunk, &no_step);
    w.frame_table_ = h5::growing_dataset(frames, "table", w.frame_type_, {}, kTableChunk, &no_frame);
    w.displacement_ = h5::growing_dataset(frames, "displacement_mm", H5T_NATIVE_FLOAT, per_node, 1, &nan);
    w.needle_ = h5::growing_dataset(frames, "needle_mm", H5T_NATIVE_DOUBLE, point, kPointChunk, &kMissing);
    w.contacts_ = h5::growing_dataset(frames, "contacts", w.contact_type_, {}, kPointChunk, &no_contact);
    w.events_ = h5::growing_dataset(w.file_, "events", w.event_type_, {}, kTableChunk, &no_event);
    w.probe_ = h5::growing_dataset(w.file_, "probe", w.probe_type_, {}, kTableChunk, &no_move);
    w.summary_ = h5::growing_dataset(w.file_, "summary_json", H5T_NATIVE_UINT8, {}, kTextChunk, nullptr);
    w.end_ = h5::growing_dataset(w.file_, "end", w.end_type_, {}, 1, &no_end);
    if (plan != nullptr) w.seeds_.emplace(w.file_, *plan);
    h5::check(H5Fstart_swmr_write(w.file_), "start recording");
  });
  if (done && make_way) done = make_way();
  std::error_code code;
  if (done) fs::rename(hidden, path, code);
  if (code) done = write_error(path, code.message());
  if (done) return w;
  const h5::LibraryTurn turn;
  w = RunFileWriter(path);
  fs::remove(hidden, code);
  return done.error();
}

Result<> RunFileWriter::append_steps(std::span<const Step> steps) {
  std::vector<StepRow> rows;
  rows.reserve(steps.size());
  std::transform(steps.begin(), steps.end(), std::back_inserter(rows), [](const Step& s) { return to_row(s); });
  return guarded([&] {
    h5::append_rows(steps_, step_type_, rows.size(), rows.data());
    written_.steps += static_cast<std::int64_t>(rows.size());
  });
}

Result<> RunFileWriter::append_frame(const StoredFrame& stored) {
  const Frame& frame = stored.frame;
  std::vector<ContactRow> contacts;
  for (const ContactView& c : frame.contacts) contacts.push_back(to_row(c));
  FrameRow row;
  row.time_s = frame.time_s;
  row.base_depth_mm = frame.base_depth_mm;
  put_text(row.label, frame.label);
  row.needle_first = needle_points_;
  row.needle_count = static_cast<std::int64_t>(frame.needle.size());
  row.contact_first = contact_count_;
  row.contact_count = static_cast<std::int64_t>(contacts.size());
  row.check = check_of(row, stored.displacement, frame.needle, contacts);
  return guarded([&] {
    h5::append_rows(displacement_, H5T_NATIVE_FLOAT, 1, stored.displacement.data());
    h5::append_rows(needle_, H5T_NATIVE_DOUBLE, frame.needle.size(), frame.needle.data());
    h5::append_rows(contacts_, contact_type_, contacts.size(), contacts.data());
    h5::append_rows(frame_table_, frame_type_, 1, &row);
    needle_points_ += row.needle_count;
    contact_count_ += row.contact_count;
    ++written_.frames;
  });
}

Result<> RunFileWriter::append_events(std::span<const Event> events) {
  std::vector<EventRow> rows;
  for (const Event& e : events) rows.push_back(to_row(e));
  return guarded([&] {
    h5::append_rows(events_, event_type_, rows.size(), rows.data());
    written_.events += static_cast<std::int64_t>(rows.size());
  });
}

Result<> RunFileWriter::append_probe_moves(std::span<const ProbeMove> moves) {
  std::vector<ProbeRow> rows;
  for (const ProbeMove& move : moves) rows.push_back(to_row(move));
  return guarded([&] {
    h5::append_rows(probe_, probe_type_, rows.size(), rows.data());
    written_.probe_moves += static_cast<std::int64_t>(rows.size());
  });
}

Result<> RunFileWriter::append_seeds(std::span<const SeedAct> acts, std::span<const RecordedScore> doses) {
  if (!seeds_) return Ok{};
  return guarded([&] {
    seeds_->append(acts);
    seeds_->append(doses);
    written_.acts += static_cast<std::int64_t>(acts.size());
    written_.doses += static_cast<std::int64_t>(doses.size());
  });
}

Result<> RunFileWriter::append_summary(const Summary& summary) {
  const std::size_t there = std::min(static_cast<std::size_t>(written_.events), summary.events.size());
  if (auto done = append_events(std::span(summary.events).subspan(there)); !done) return done;
  const std::string text = summary_json(summary);
  return guarded([&] {
    h5::append_rows(summary_, H5T_NATIVE_UINT8, text.size(), text.data());
    written_.summary_bytes = static_cast<std::int64_t>(text.size());
    written_.summary_check = check_of(text);
  });
}

Result<> RunFileWriter::flush() {
  return guarded([&] { h5::check(H5Fflush(file_, H5F_SCOPE_GLOBAL), "flush"); });
}

Result<> RunFileWriter::close() {
  Result<> ended = guarded([&] {
    h5::check(H5Fflush(file_, H5F_SCOPE_GLOBAL), "flush");  // all other data must reach the disk before /end
    written_.check = check_of(written_);
    h5::append_rows(end_, end_type_, 1, &written_);
  });
  Result<> closed = guarded([&] {
    bool good = true;
    for (h5::Handle* data :
         {&steps_, &frame_table_, &displacement_, &needle_, &contacts_, &events_, &probe_, &summary_, &end_}) {
      good = data->reset() && good;
    }
    if (seeds_) good = seeds_->close() && good;
    for (h5::Handle* type : {&step_type_, &frame_type_, &contact_type_, &event_type_, &probe_type_, &end_type_})
      type->reset();
    if (!file_.reset() || !good) h5::fail("close");
  });
  return ended ? closed : ended;
}

}  // namespace stylet::results
