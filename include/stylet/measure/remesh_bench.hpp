// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/topology.hpp"
#include "stylet/measure/remesh_cost.hpp"

#include <string>
#include <vector>

namespace stylet::measure {

/// A cube of tissue, 100 mm, held at its far face, and a needle's way into it: changes of the mesh at any size.
class Block {
 public:
  /// @param cells along each edge, 3 … 20: (cells + 1)³ nodes
  static Result<std::unique_ptr<Block>> build(int cells, const Progress& progress = {});

  [[nodiscard]] const NeedleWay& way() const { return way_; }

 private:
  explicit Block(std::shared_ptr<const Tissue> tissue);
  Topology topology_;
  Locator locator_;
  NeedleWay way_;
};

/// One size, one method: processor time of one change of the mesh, everything included.
struct RemeshRow {
  int nodes = 0;
  std::string method;  ///< shortcut, bordered, woodbury, bcs, inverse
  double median_us = 0.0;
};

/// Times a change of the mesh against the number of nodes. shortcut: a node inside an element, the default; bordered: a
/// node on a face by the default's compliance; woodbury, bcs, inverse: that node in the full inverse.
/// @param cells sizes of the block
Result<std::vector<RemeshRow>> bench_remeshing(const std::vector<int>& cells, const Progress& progress = {});

}  // namespace stylet::measure
