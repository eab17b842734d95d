// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/evidence/reproduce/cost_table.hpp"
#include "stylet/evidence/reproduce/figure2.hpp"
#include "stylet/evidence/reproduce/figure5.hpp"
#include "stylet/evidence/reproduce/figure6.hpp"
#include "stylet/measure/timing.hpp"

#include <filesystem>

namespace stylet::reproduce {

struct ReproduceOptions {
  bool quick = false;   ///< fewer sizes and repeats, one shorter insertion; takes less than a minute
  std::string command;  ///< command line, shown on the page
};

/// Results of the reproduced experiments of the paper.
struct Reproduction {
  ReproduceOptions options;
  std::string version;
  measure::Machine machine;
  double seconds = 0.0;  ///< wall-clock time of the whole run
  Figure2 figure2;
  std::vector<Figure5Row> figure5;
  Figure6 figure6;
  measure::RemeshCost on_faces;  ///< with the paper's rule: nodes on faces
  measure::RemeshCost inside;    ///< with the default's rule: nodes inside elements
  measure::CountedCost counted;  ///< one update at the size of the paper's mesh
  std::vector<TableRow> table;
  std::vector<std::string> notes;  ///< remarks for the reader, in full sentences
};

/// Reproduces figures 2, 5 and 6 and the table. Times are processor times with one BLAS thread.
Result<Reproduction> reproduce(const ReproduceOptions& options, const Progress& progress = {});

/// Everything except the curves, as JSON with the keys fig2, fig5, fig6, table, machine, … (docs/results).
std::string reproduction_json(const Reproduction& reproduction);

/// The self-contained HTML page. Errors: failed, when the embedded template does not fit the program.
Result<std::string> reproduction_page(const Reproduction& reproduction);

/// Writes report.html, reproduce.json, figure2.json, figure5.csv, figure6_*.csv and table.csv into a folder. A new
/// folder appears complete or not at all. In an existing folder the files are replaced one by one: reproduce.json is
/// removed first and written last, so that it exists only with complete results.
Result<> write_reproduction(const Reproduction& reproduction, const std::filesystem::path& folder);

}  // namespace stylet::reproduce
