// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_file_writer.hpp"

#include "detail/disk.hpp"
#include "detail/unfinished.hpp"
#include "h5_mesh.hpp"
#include "record/attributes.hpp"
#include "run_file_format.hpp"
#include "summary_json.hpp"

#include <algorithm>

namespace stylet::results {
namespace fs = std::filesystem;

namespace {

// Rows per chunk: about 100 kB for steps. Displacements have one frame per chunk, so that a frame is read at once.
constexpr hsize_t kStepChunk = 1024, kTableChunk = 64, kPointChunk = 2048, kTextChunk = 4096;

void write_info(hid_t file, const RunInfo& info) {
  h5::write_attribute(file, "format", std::string(kRunFileFormat));
  h5::write_attribute(file, "format_version", std::array{run_file_version()});
  h5::write_attribute(file, "units", std::string("mm, N, s"));
  h5::write_attribute(file, "frame", std::string("LPS"));
  record::write_attributes(file, info);
  h5::write_text(file, "scenario", info.scenario_text);
  h5::write_texts(file, "supports", info.supports);
  h5::write_texts(file, "warnings", info.warnings);
  std::vector<std::vector<std::string>> rows;
  for (const ParameterRow& p : info.parameters) rows.push_back({p.name, p.value, p.unit, p.source});
  h5::write_text_table(file, "parameters", kParameterColumns, rows);
}

void write_plan(hid_t group, const RecordedPlan& plan) {
  const StoredPlan stored = stored_plan(plan);
  h5::write_attribute(group, "plan_sha256", plan_digest(stored));
  record::write_attributes(group, plan);
  record::write_rows(group, "needles", stored.needles);
  record::write_rows(group, "planned_seeds", stored.seeds);
}

}  // namespace

template <class Action>
Result<> RunFileWriter::guarded(Action action) const {
  return h5::written(path_, [&] {
    action();
    file_.check();
  });
}

Result<RunFileWriter> RunFileWriter::create(const fs::path& path, const RunInfo& info, const TetMesh& mesh,
                                            const std::function<Result<>()>& make_way, const RecordedPlan* plan) {
  // The new file gets another name first: truncating an earlier file in place would break processes that read it.
  auto hidden = detail::Unfinished::create(path, detail::Unfinished::Kind::file);
  if (!hidden) return hidden.error();
  RunFileWriter w(path);
  Result<> done = w.guarded([&] {
    w.file_ = h5::NewFile(hidden->path().c_str());
    h5::write_mesh(w.file_, mesh);
    write_info(w.file_, info);
    h5::write_attribute(w.file_, "start_sha256", start_digest(info, mesh));

    const float nan = std::numeric_limits<float>::quiet_NaN();
    const std::array<hsize_t, 2> per_node{mesh.nodes.size(), 3};
    const std::array<hsize_t, 1> point{3};
    const h5::Handle frames = h5::group(w.file_, "frames");
    w.table<Step>() = {w.file_, "steps", kStepChunk};
    w.table<FrameRow>() = {frames, "table", kTableChunk};
    w.displacement_ = h5::growing_dataset(frames, "displacement_mm", H5T_NATIVE_FLOAT, per_node, 1, &nan);
    w.needle_ = h5::growing_dataset(frames, "needle_mm", H5T_NATIVE_DOUBLE, point, kPointChunk, &record::kNotANumber);
    w.table<ContactView>() = {frames, "contacts", kPointChunk};
    w.table<Event>() = {w.file_, "events", kTableChunk};
    w.table<ProbeMove>() = {w.file_, "probe", kTableChunk};
    w.summary_ = h5::growing_dataset(w.file_, "summary_json", H5T_NATIVE_UINT8, {}, kTextChunk, nullptr);
    w.table<RunEnd>() = {w.file_, "end", 1};
    if (plan != nullptr) {
      const h5::Handle implant = h5::group(w.file_, "implant");
      write_plan(implant, *plan);
      w.table<SeedAct>() = {implant, "acts", kTableChunk};
      w.table<RecordedScore>() = {implant, "doses", kTableChunk};
    }
    h5::check(H5Fstart_swmr_write(w.file_), "start recording");
  });
  if (done && make_way) done = make_way();
  if (done) done = hidden->finish();
  if (done) return w;
  const h5::LibraryTurn turn;
  w = RunFileWriter(path);
  return done.error();
}

template <class T>
Result<> RunFileWriter::append(std::span<const T> records) {
  if (records.empty() || !table<T>().is_open()) return Ok{};
  return guarded([&] { table<T>().append(record::rows_of(records)); });
}
template Result<> RunFileWriter::append(std::span<const Step>);
template Result<> RunFileWriter::append(std::span<const Event>);
template Result<> RunFileWriter::append(std::span<const ProbeMove>);
template Result<> RunFileWriter::append(std::span<const SeedAct>);
template Result<> RunFileWriter::append(std::span<const RecordedScore>);

Result<> RunFileWriter::append_frame(const StoredFrame& stored) {
  const Frame& frame = stored.frame;
  const auto contacts = record::rows_of(std::span<const ContactView>(frame.contacts));
  record::Rows<FrameRow> row;
  row.add(
      {frame.time_s, frame.base_depth_mm, frame.label, needle_points_, static_cast<std::int64_t>(frame.needle.size()),
       table<ContactView>().count(), static_cast<std::int64_t>(contacts.size())},
      parts_of_frame(stored.displacement, frame.needle, contacts.bytes));
  return guarded([&] {
    h5::append_rows(displacement_, H5T_NATIVE_FLOAT, 1, stored.displacement.data());
    h5::append_rows(needle_, H5T_NATIVE_DOUBLE, frame.needle.size(), frame.needle.data());
    table<ContactView>().append(contacts);
    table<FrameRow>().append(row);
    needle_points_ += static_cast<std::int64_t>(frame.needle.size());
  });
}

Result<> RunFileWriter::append_summary(const Summary& summary) {
  const std::size_t there = std::min(static_cast<std::size_t>(table<Event>().count()), summary.events.size());
  if (auto done = append(std::span(summary.events).subspan(there)); !done) return done;
  const std::string text = summary_json(summary);
  return guarded([&] {
    h5::append_rows(summary_, H5T_NATIVE_UINT8, text.size(), text.data());
    written_.summary_bytes = static_cast<std::int64_t>(text.size());
    written_.summary_check = record::check_of(text.data(), text.size());
  });
}

Result<> RunFileWriter::flush() {
  return guarded([&] { h5::check(H5Fflush(file_, H5F_SCOPE_GLOBAL), "flush"); });
}

Result<> RunFileWriter::sync() { return detail::sync(path_); }

Result<> RunFileWriter::close() {
  Result<> ended = guarded([&] {
    h5::check(H5Fflush(file_, H5F_SCOPE_GLOBAL), "flush");  // all other data must reach the disk before /end
    written_.steps = table<Step>().count();
    written_.frames = table<FrameRow>().count();
    written_.events = table<Event>().count();
    written_.acts = table<SeedAct>().count();
    written_.doses = table<RecordedScore>().count();
    written_.probe_moves = table<ProbeMove>().count();
    table<RunEnd>().append(record::rows_of(std::span<const RunEnd>(&written_, 1)));
  });
  Result<> closed = guarded([&] {
    bool good = std::apply([](auto&... table) { return (table.close() & ...); }, tables_);
    for (h5::Handle* data : {&displacement_, &needle_, &summary_}) good = data->reset() && good;
    file_.close();
    if (!good) h5::fail("close");
  });
  if (!ended || !closed) return ended ? closed : ended;
  return sync();
}

}  // namespace stylet::results
