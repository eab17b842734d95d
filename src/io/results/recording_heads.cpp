// SPDX-License-Identifier: GPL-3.0-or-later
#include "reading/ask.hpp"
#include "stored_checks.hpp"
#include "stylet/core/printable.hpp"
#include "stylet/io/recording_io.hpp"

#include <algorithm>
#include <cmath>

namespace stylet {
namespace fs = std::filesystem;
using namespace results;

namespace {

/// Simulated time of the last step that is complete; 0 if there is none.
double last_time_s(const StoredHead& stored) {
  const auto is_whole = wholeness(stored.format_version, stored.last_steps);
  for (std::size_t k = stored.last_steps.size(); k-- > 0;)
    if (is_whole(k)) return record_at(stored.last_steps, k, "/steps").time_s;
  return 0.0;
}

/// Throws Changed.
RecordingHead head_of(const StoredHead& stored) {
  const std::optional<RunEnd> end = end_of(stored.end);
  RecordingHead head;
  head.scenario_name = printable(stored.scenario_name);
  head.has_ended = end.has_value();
  head.events = whole_records(stored.events, wholeness(stored.format_version, stored.events),
                              said_by(end, &RunEnd::events), "/events");
  head.implant = implant_of(stored.seeds, end);
  head.duration_s = last_time_s(stored);
  if (head.implant && !head.implant->acts.empty())
    head.duration_s = std::max(head.duration_s, head.implant->acts.back().time_s);
  if (!std::isnan(stored.most_N)) head.most_N = stored.most_N;
  return head;
}

Result<RecordingHead> checked_head(const StoredHead& stored, const fs::path& file) {
  if (!stored.problem.where.empty()) return input_error(file.string(), printable(stored.problem.what), kGiveARecording);
  try {
    return head_of(stored);
  } catch (const Changed& e) {
    return input_error(file.string(), std::string("this part has changed since it was written: ") + e.what(),
                       kGiveARecording);
  }
}

/// Reads files in one process. If it ends without an answer, because one of them crashes the library, it reads each
/// half in a process of its own.
void read_heads(std::span<const fs::path> files, std::vector<Result<RecordingHead>>& heads) {
  if (files.empty()) return;
  std::vector<std::string> others;
  for (const fs::path& file : files.subspan(1)) others.push_back(file.string());
  const Result<std::vector<StoredHead>> stored = detail::ask(kRunHeads, files.front(), others);
  if (stored && stored->size() == files.size()) {
    for (std::size_t k = 0; k < files.size(); ++k) heads.push_back(checked_head((*stored)[k], files[k]));
  } else if (files.size() == 1) {
    heads.emplace_back(stored ? input_error(files[0].string(), "no answer", kGiveARecording) : stored.error());
  } else {
    read_heads(files.first(files.size() / 2), heads);
    read_heads(files.subspan(files.size() / 2), heads);
  }
}

}  // namespace

std::vector<Result<RecordingHead>> read_recording_heads(std::span<const fs::path> files) {
  constexpr std::size_t kInOneProcess = 64;  // within its limits of time, which are those for one file
  std::vector<Result<RecordingHead>> heads;
  for (std::size_t from = 0; from < files.size(); from += kInOneProcess)
    read_heads(files.subspan(from, std::min(kInOneProcess, files.size() - from)), heads);
  return heads;
}

}  // namespace stylet
