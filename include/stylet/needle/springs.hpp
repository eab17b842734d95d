// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/rod_chain.hpp"

namespace stylet {

/// Rigid rods joined by angular springs. The joint at the start of each rod turns the frame by a rotation vector φ
/// about all three axes and stores ½ φᵀ diag(EI, EI, GJ) φ / l. The joint at the clamp stores twice as much, because it
/// stands for half a rod only. The centreline is a smooth curve through the joints; loads act on the joints with the
/// curve's weights. Contacts that slide along it therefore do not feel the joints.
/// @cite Dehghan2006
class SpringsNeedle final : public RodChain {
 public:
  /// Builds a needle; errors are those of check_needle().
  /// @param rods number of rods, 4…500
  /// @param load_capacity largest number of loads in any call
  static Result<std::unique_ptr<SpringsNeedle>> build(const NeedleSection& section, int rods, int load_capacity);

  [[nodiscard]] std::string model() const override { return "springs"; }

 private:
  using RodChain::RodChain;
};

}  // namespace stylet
