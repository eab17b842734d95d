// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/coupling/compliance_supply.hpp"

namespace stylet {

/// Finds the nodes whose compliance a needle needs next. Keeps its memory between calls; for one thread at a time.
class NodesAhead {
 public:
  NodesAhead(std::shared_ptr<const Tissue> tissue, const Locator& locator);

  /// Displacement nodes of the elements within `radius_mm` of the way from the tip to `ahead_mm` in front of it, each
  /// once, in the order in which the needle reaches them. Empty where a tip in the air meets no surface on that way.
  [[nodiscard]] const std::vector<Index>& find(const NeedleWhereabouts& needle, double radius_mm, double ahead_mm);

 private:
  std::shared_ptr<const Tissue> tissue_;
  const Locator& locator_;
  unsigned round_ = 0;
  std::vector<unsigned> tet_seen_;   ///< (elements) round in which the element was last found
  std::vector<unsigned> node_seen_;  ///< (displacement nodes) the same
  struct Near {
    double reached_mm = 0.0;
    Index tet = -1;
  };
  std::vector<Near> tets_;
  std::vector<Index> nodes_;
};

}  // namespace stylet
