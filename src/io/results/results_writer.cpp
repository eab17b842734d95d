// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/io/results_writer.hpp"

#include "output_folder.hpp"
#include "paraview.hpp"
#include "pictures/pictures.hpp"
#include "record/csv.hpp"
#include "record/run_columns.hpp"
#include "recorder.hpp"
#include "report/report_html.hpp"
#include "stylet/core/survive.hpp"
#include "stylet/io/files.hpp"
#include "stylet/io/hole_map_io.hpp"
#include "stylet/io/recording_io.hpp"
#include "summary_json.hpp"

#include <fmt/format.h>

#include <cmath>
#include <exception>

namespace stylet {
namespace fs = std::filesystem;
using namespace results;

namespace {

/// Writes the pictures into their folder. If there are none, the pictures of an earlier run are removed.
Result<> write_pictures(const Pictures& pictures, const fs::path& folder) {
  std::error_code code;
  if (pictures.png.empty()) {
    for (const char* name : picture_names()) fs::remove(folder / name, code);
    return Ok{};
  }
  if (auto made = make_folder(folder); !made) return made;
  for (const auto& [name, png] : pictures.png) {
    if (auto done = write_whole_file(folder / name, png); !done) return done;
  }
  return Ok{};
}

/// Removes all results of an earlier run except its run.h5. summary.json, which marks a finished run, is removed first.
Result<> remove_earlier_results(const fs::path& folder) {
  for (const char* name : {"summary.json", "report.html", "forces.csv", "gland.csv", "map.csv", "tissue.pvd",
                           "needle.pvd", "needle.vtp"}) {
    if (auto removed = remove_earlier(folder / name); !removed) return removed;
  }
  if (auto removed = remove_series_from(folder, "tissue", ".vtu", 0); !removed) return removed;
  if (auto removed = remove_series_from(folder, "needle", ".vtp", 0); !removed) return removed;
  for (const char* name : picture_names()) {
    if (auto removed = remove_earlier(folder / "pictures" / name); !removed) return removed;
  }
  return Ok{};
}

/// Writes all files except run.h5, from run.h5 and the summary. Therefore pictures and tables show only recorded data,
/// with three exceptions: the gland's path, which follows from the recorded forces, the map of the template's holes,
/// and the ultrasound probe.
Result<> write_from_recording(const fs::path& folder, const Summary& summary,
                              const std::function<MatX(const VecX&)>& stress_of, const Progress& progress,
                              bool with_pictures, const HoleMap* map, const ProbeReport* probe) {
  auto run = read_recording(folder / "run.h5");
  if (!run) return run.error();
  if (run->frames.empty()) {
    return failure(folder.string(), "the run has no frame to show", "Add at least one frame before finish()");
  }
  run->summary = summary;
  const Moments moments = find_moments(run->frames);
  const auto regions = region_views(run->mesh, run->info.target_regions);
  if (auto done = write_whole_file(folder / "forces.csv", record::csv_of(run->steps)); !done) return done;
  if (!summary.gland_path.empty()) {
    if (auto done = write_whole_file(folder / "gland.csv", record::csv_of(summary.gland_path)); !done) return done;
  }
  if (map) {
    if (auto done = write_whole_file(folder / "map.csv", hole_map_csv(*map)); !done) return done;
  }
  if (auto done = write_tissue(*run, stress_of, folder, progress); !done) return done;
  if (auto done = write_needle(*run, moments.deepest, folder); !done) return done;
  const Pictures pictures = with_pictures ? draw_pictures(*run, regions, moments, progress)
                                          : Pictures{.png = {}, .why_not = {}, .wanted = false};
  if (auto done = write_pictures(pictures, folder / "pictures"); !done) return done;
  report(progress, "report", 0.0);
  auto page = report_html(*run, regions, moments, pictures, map, probe);
  if (!page) return page.error();
  if (auto done = write_whole_file(folder / "report.html", *page); !done) return done;
  if (auto done = write_whole_file(folder / "summary.json", summary_json(summary, probe)); !done) return done;
  report(progress, "report", 1.0);
  return Ok{};
}

/// The error for a record with a number that is not finite, which a reader could not distinguish from a row that has
/// not reached the disk.
Error not_finite(const std::string& where, double time_s) {
  return failure(fmt::format("{} at {} s", where, time_s), "holds a number that is not finite",
                 "Look at the steps before this one; the simulation diverged earlier");
}

bool is_finite(const Frame& frame) {
  bool finite = std::isfinite(frame.time_s) && frame.displacement.allFinite();
  for (const Vec3& p : frame.needle) finite = finite && p.allFinite();
  for (const ContactView& c : frame.contacts) {
    finite = finite && c.position.allFinite() && c.force.allFinite() && std::isfinite(c.s);
  }
  return finite;
}

/// Public calls do not throw: exceptions of libraries (memory, threads) become errors.
template <class Work>
auto guarded(const fs::path& folder, Work work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::exception&) {
    return failure(folder.string(), fmt::format("cannot be written: {}", caught_exception("").what),
                   "Close other programs or use a smaller mesh, then run again");
  }
}

}  // namespace

struct ResultsWriter::Parts {
  fs::path folder;
  Index nodes;
  std::function<MatX(const VecX&)> stress_of;
  Recorder recorder;
  std::optional<HoleMap> map{};  ///< map of the template's holes
  std::optional<ProbeReport> probe{};
  bool finished = false;
};

ResultsWriter::ResultsWriter(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
ResultsWriter::~ResultsWriter() = default;

Result<std::unique_ptr<ResultsWriter>> ResultsWriter::open(const fs::path& folder, const RunInfo& info,
                                                           const TetMesh& mesh,
                                                           std::function<MatX(const VecX&)> stress_of) {
  return guarded(folder, [&]() -> Result<std::unique_ptr<ResultsWriter>> {
    if (auto ready = prepare_folder(folder); !ready) return ready.error();
    // Even if this run is killed, its recording must never be in one folder with other results of an earlier run.
    auto file = RunFileWriter::create(folder / "run.h5", info, mesh, [&] { return remove_earlier_results(folder); });
    if (!file) return file.error();
    auto parts =
        std::unique_ptr<Parts>(new Parts{folder, mesh.node_count(), std::move(stress_of), Recorder(std::move(*file))});
    return std::unique_ptr<ResultsWriter>(new ResultsWriter(std::move(parts)));
  });
}

Result<> ResultsWriter::add_step(const Step& step) {
  if (!std::isfinite(step.time_s)) return not_finite("step", step.time_s);
  return parts_->recorder.add(step);
}

Result<> ResultsWriter::add_frame(const Frame& frame) {
  if (frame.displacement.size() != 3 * static_cast<Eigen::Index>(parts_->nodes)) {
    return failure(
        "frame",
        fmt::format("{} displacement components, the mesh has {} nodes", frame.displacement.size(), parts_->nodes),
        "Give three components per node of the mesh passed to open()");
  }
  if (!is_finite(frame)) return not_finite("frame", frame.time_s);
  StoredFrame stored{frame, {}};
  stored.frame.displacement.resize(0);
  stored.displacement.reserve(static_cast<std::size_t>(frame.displacement.size()));
  for (const double u : frame.displacement) stored.displacement.push_back(static_cast<float>(u));
  return parts_->recorder.add(std::move(stored));
}

void ResultsWriter::add_probe(const ProbeReport& probe) { parts_->probe = probe; }

void ResultsWriter::add_map(HoleMap map) { parts_->map = std::move(map); }

Result<> ResultsWriter::finish(const Summary& summary, const Progress& progress, bool pictures) {
  if (parts_->finished) return failure("results", "finish() has already been called", "Call it once");
  parts_->finished = true;
  return guarded(parts_->folder, [&]() -> Result<> {
    if (auto closed = parts_->recorder.close(&summary); !closed) return closed;
    return write_from_recording(parts_->folder, summary, parts_->stress_of, progress, pictures,
                                parts_->map ? &*parts_->map : nullptr, parts_->probe ? &*parts_->probe : nullptr);
  });
}

}  // namespace stylet
