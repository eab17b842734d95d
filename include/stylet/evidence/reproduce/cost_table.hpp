// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/evidence/reproduce/figure6.hpp"
#include "stylet/geom/quality.hpp"
#include "stylet/measure/remesh_cost.hpp"

#include <string>
#include <variant>
#include <vector>

namespace stylet::reproduce {

/// A number in the row's unit, words, or nothing.
using TableCell = std::variant<std::monostate, double, std::string>;

/// A quantity as the paper states it, as its methods come out here, and as this program does by default.
struct TableRow {
  std::string group;  ///< rows of one group follow each other
  std::string quantity;
  std::string unit;
  TableCell paper;
  TableCell reproduced;
  TableCell ours;
  std::string note;
};

/// What has to be there before the first iteration.
struct Preparation {
  double factor_s = 0.0;   ///< assembling the stiffness and factorising it; all variants need it
  double factor_mb = 0.0;  ///< memory of the factor
  double inverse_s = 0.0;  ///< from there to all of K⁻¹
  double store_s = 0.0;    ///< from there to the blocks of K⁻¹ that the default holds
};

/// What the table is made from.
struct TableInput {
  const Figure6& figure6;
  const MeshQuality& quality;
  const measure::RemeshCost& on_faces;  ///< the paper's rule
  const measure::RemeshCost& inside;    ///< the default's
  const measure::CountedCost& counted;  ///< at the paper's size
  const Preparation& preparation;
};

/// Every number is computed but the paper's own (paper_numbers.hpp).
std::vector<TableRow> cost_table(const TableInput& input);

}  // namespace stylet::reproduce
