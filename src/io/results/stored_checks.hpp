// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stored_run.hpp"

#include <cmath>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

/// Checks of what a run.h5 has, and its conversion to records. They throw Changed if the data differ from those that
/// were written.
namespace stylet::results {

struct Changed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline void expect(bool condition, const char* what) {
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
  for (std::size_t k = 0; k < rows.size() && is_whole(k); ++k) expect(rows.get(k, records.emplace_back(start)), where);
  for (std::size_t k = records.size(); k < rows.size(); ++k) expect(!is_whole(k), where);
  expect(!said || *said == static_cast<std::int64_t>(records.size()), where);
  return records;
}

/// The only record of row k. Throws Changed if it has a number that means nothing.
template <class T>
T record_at(const record::Rows<T>& rows, std::size_t k, const char* where) {
  T record;
  expect(rows.get(k, record), where);
  return record;
}

/// Whether a row is complete: by its check or, in files of earlier versions, by a time that is not NaN.
template <class T>
auto wholeness(int format_version, const record::Rows<T>& rows) {
  return [format_version, &rows](std::size_t k) {
    if (format_version >= kFirstWithChecks) return rows.is_whole(k);
    T record;
    return rows.get(k, record) && !std::isnan(record.time_s);
  };
}

/// The row of /end, if the writer has written it.
std::optional<RunEnd> end_of(const record::Rows<RunEnd>& rows);

/// The number of rows according to /end; empty if the writer has not written it.
inline std::optional<std::int64_t> said_by(const std::optional<RunEnd>& end, std::int64_t RunEnd::*count) {
  return end ? std::optional((*end).*count) : std::nullopt;
}

/// The seeds of a live session; empty if the file has none.
std::optional<RecordedImplant> implant_of(const StoredSeeds& stored, const std::optional<RunEnd>& end);

}  // namespace stylet::results
