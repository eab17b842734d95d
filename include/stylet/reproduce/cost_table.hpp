// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/quality.hpp"
#include "stylet/reproduce/figure6.hpp"
#include "stylet/reproduce/remesh_cost.hpp"

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

/// What the table is made from.
struct TableInput {
  const Figure6& figure6;
  const MeshQuality& quality;
  const RemeshCost& on_faces;  ///< the paper's rule
  const RemeshCost& inside;    ///< the default's
  double store_mb = 0.0;       ///< of the default in figure 6
  double inverse_mb = 0.0;     ///< of the paper's engines in figure 6
  double inverse_s = 0.0;      ///< time to invert the initial stiffness
};

/// Every number is computed but the paper's own.
std::vector<TableRow> cost_table(const TableInput& input);

}  // namespace stylet::reproduce
