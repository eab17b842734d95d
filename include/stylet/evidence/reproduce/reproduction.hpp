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
  bool quick = false;   ///< fewer sizes and repeats, one shorter insertion: under a minute
  std::string command;  ///< what the page says it was made with
};

/// The paper's experiments, made again.
struct Reproduction {
  ReproduceOptions options;
  std::string version;
  measure::Machine machine;
  double seconds = 0.0;  ///< wall clock, everything
  Figure2 figure2;
  std::vector<Figure5Row> figure5;
  Figure6 figure6;
  measure::RemeshCost on_faces;  ///< the paper's rule
  measure::RemeshCost inside;    ///< the default's rule
  measure::CountedCost counted;  ///< of one update at the paper's size
  std::vector<TableRow> table;
  std::vector<std::string> notes;  ///< what a reader should know, in sentences
};

/// Runs everything: figures 2, 5 and 6 and the table. Times are processor times, BLAS with one thread.
Result<Reproduction> reproduce(const ReproduceOptions& options, const Progress& progress = {});

/// Everything but the curves, as JSON: fig2, fig5, fig6, table, machine, … (docs/results.md).
std::string reproduction_json(const Reproduction& reproduction);

/// The self-contained page. Errors: failed, when the program was built from files that do not belong together.
Result<std::string> reproduction_page(const Reproduction& reproduction);

/// Fills the folder: report.html, reproduce.json, figure2.json, figure5.csv, figure6_*.csv, table.csv. A new folder
/// appears whole or not at all; in one that exists the files are replaced one by one, reproduce.json goes first and
/// comes last.
Result<> write_reproduction(const Reproduction& reproduction, const std::filesystem::path& folder);

}  // namespace stylet::reproduce
