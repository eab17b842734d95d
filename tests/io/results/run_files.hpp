// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "results/recorder.hpp"
#include "results/run_file_format.hpp"
#include "stylet/io/recording_io.hpp"
#include "summary_json.hpp"
#include "support/folder.hpp"
#include "support/value_of.hpp"
#include "synthetic_run.hpp"

#include <gtest/gtest.h>

namespace stylet::testing {

inline results::StoredFrame stored(const Frame& frame) {
  const Eigen::VectorXf single = frame.displacement.cast<float>();
  return {frame, {single.data(), single.data() + single.size()}};
}

/// A small run, for tests that read it many times.
inline SyntheticRun small_run() { return synthetic_run({.cells = {4, 4, 5}, .step_s = 0.05, .frames = 4}); }

/// Writes a run: its steps, events and frames, what `more` appends and, if it is finished, the summary.
inline void write_run_file(const std::filesystem::path& path, const SyntheticRun& run, bool finished,
                           const RecordedPlan* plan = nullptr,
                           const std::function<bool(results::RunFileWriter&)>& more = {}) {
  auto writer = results::RunFileWriter::create(path, run.info, run.mesh, {}, plan);
  bool good =
      writer.ok() && writer->append(std::span(run.steps)).ok() && writer->append(std::span(run.summary.events)).ok();
  for (const Frame& frame : run.frames) good = good && writer->append_frame(stored(frame)).ok();
  good = good && (!more || more(*writer)) && writer->flush().ok() &&
         (!finished || (writer->append_summary(run.summary).ok() && writer->close().ok()));
  ASSERT_TRUE(good);
}

inline RunRecording read_back(const std::filesystem::path& path) { return test::value_of(read_recording(path)); }

/// A record as bytes, so that numbers are compared to the last bit.
template <class T>
std::string packed(const T& record) {
  std::string bytes;
  record::pack(bytes, record);
  return bytes;
}

template <class T>
void expect_same_rows(const std::vector<T>& a, const std::vector<T>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(packed(a[k]), packed(b[k])) << k;
}

/// @param b from a file, where displacements have single precision
inline void expect_same_frame(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.time_s, b.time_s);
  EXPECT_EQ(a.base_depth_mm, b.base_depth_mm);
  EXPECT_EQ(a.label, b.label);
  ASSERT_EQ(a.displacement.size(), b.displacement.size());
  EXPECT_EQ(VecX(a.displacement.cast<float>().cast<double>()), b.displacement);
  EXPECT_EQ(a.needle, b.needle);
  expect_same_rows(a.contacts, b.contacts);
}

inline void expect_same_run(const RunRecording& a, const RunRecording& b) {
  EXPECT_EQ(results::start_digest(a.info, a.mesh), results::start_digest(b.info, b.mesh));
  expect_same_rows(a.steps, b.steps);
  expect_same_rows(a.events, b.events);
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t k = 0; k < a.frames.size(); ++k) expect_same_frame(a.frames[k], b.frames[k]);
  ASSERT_EQ(a.summary.has_value(), b.summary.has_value());
  if (a.summary) {
    EXPECT_EQ(results::summary_json(*a.summary), results::summary_json(*b.summary));
  }
}

}  // namespace stylet::testing
