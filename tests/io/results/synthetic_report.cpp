// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the result folder of the synthetic run, for work on the report: synthetic_report OUT/ [CELLS]
#include "stylet/io/results_writer.hpp"
#include "synthetic_run.hpp"

#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: synthetic_report OUT/ [CELLS]\n");
    return 2;
  }
  const int cells = argc > 2 ? std::atoi(argv[2]) : 14;
  const auto run = stylet::testing::synthetic_run({{cells, cells - 2, cells + 1}, 0.001, 50});
  auto writer = stylet::ResultsWriter::open(argv[1], run.info, run.mesh, [&](const stylet::VecX&) {
    return stylet::MatX(stylet::MatX::Zero(6, run.mesh.tet_count()));
  });
  const auto fail = [](const stylet::Error& e) {
    std::fprintf(stderr, "%s\n", e.message().c_str());
    return 1;
  };
  if (!writer) return fail(writer.error());
  for (const auto& step : run.steps) {
    if (auto added = (*writer)->add_step(step); !added) return fail(added.error());
  }
  for (const auto& frame : run.frames) {
    if (auto added = (*writer)->add_frame(frame); !added) return fail(added.error());
  }
  (*writer)->add_map(stylet::testing::synthetic_map());
  const auto done = (*writer)->finish(run.summary, [](std::string_view stage, double share) {
    std::printf("%.*s %.0f %%\n", static_cast<int>(stage.size()), stage.data(), 100 * share);
  });
  return done ? 0 : fail(done.error());
}
