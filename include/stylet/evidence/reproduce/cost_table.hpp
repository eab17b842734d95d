// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/evidence/reproduce/figure6.hpp"
#include "stylet/geom/quality.hpp"
#include "stylet/measure/remesh_cost.hpp"

#include <string>
#include <variant>
#include <vector>

namespace stylet::reproduce {

/// A cell of the table: empty, a number in the row's unit, or text.
using TableCell = std::variant<std::monostate, double, std::string>;

/// A row of the table: a quantity as the paper states it, as measured here with the paper's methods, and as measured
/// with this program's default.
struct TableRow {
  std::string group;  ///< heading; the rows of a group are consecutive
  std::string quantity;
  std::string unit;
  TableCell paper;
  TableCell reproduced;
  TableCell ours;
  std::string note;
};

/// Computing time and memory before the first iteration.
struct Preparation {
  double factor_s = 0.0;   ///< assembling the stiffness and factorising it; all variants need it
  double factor_mb = 0.0;  ///< memory of the factor
  double inverse_s = 0.0;  ///< computing all of K⁻¹ from the factor
  double store_s = 0.0;    ///< computing the blocks of K⁻¹ that the default stores from the factor
};

/// The measurements that the table is made from.
struct TableInput {
  const Figure6& figure6;
  const MeshQuality& quality;
  const measure::RemeshCost& on_faces;  ///< with the paper's rule: nodes on faces
  const measure::RemeshCost& inside;    ///< with the default's rule: nodes inside elements
  const measure::CountedCost& counted;  ///< at the size of the paper's mesh
  const Preparation& preparation;
};

/// Makes the table. All numbers are measured or computed, except those that the paper states (paper_numbers.hpp).
std::vector<TableRow> cost_table(const TableInput& input);

}  // namespace stylet::reproduce
