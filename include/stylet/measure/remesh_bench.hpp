// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/geom/topology.hpp"
#include "stylet/measure/remesh_cost.hpp"

#include <string>
#include <vector>

namespace stylet::measure {

/// A cube of tissue of 100 mm, held at its far face, with a needle's way into it. Used to time changes of a mesh of any
/// size.
class Block {
 public:
  /// @param cells number of cells along each edge, 3 … 20; the mesh has (cells + 1)³ nodes
  static Result<std::unique_ptr<Block>> build(int cells, const Progress& progress = {});

  [[nodiscard]] const NeedleWay& way() const { return way_; }

 private:
  explicit Block(std::shared_ptr<const Tissue> tissue);
  Topology topology_;
  Locator locator_;
  NeedleWay way_;
};

/// Processor time of one change of the mesh with everything that it needs, for one size and one method.
struct RemeshRow {
  int nodes = 0;
  std::string method;  ///< shortcut, bordered, woodbury, bcs, inverse
  double median_us = 0.0;
};

/// Times a change of the mesh against the number of nodes. Methods: shortcut, a node inside an element, as by default;
/// bordered, a node on a face with the default's compliance; woodbury, bcs and inverse, a node on a face with the full
/// inverse.
/// @param cells sizes of the block, see Block::build
Result<std::vector<RemeshRow>> bench_remeshing(const std::vector<int>& cells, const Progress& progress = {});

}  // namespace stylet::measure
