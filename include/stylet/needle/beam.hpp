// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/rod_chain.hpp"

namespace stylet {

/// Inextensible, unshearable, geometrically exact rod with piecewise constant curvature: element e turns the frame by
/// the rotation vector l κ_e, so the centreline is a chain of circular helices with a continuous tangent.
/// Energy ½ Σ l κᵀ diag(EI, EI, GJ) κ − Σ f·r.
/// @cite Bertails2006
class BeamNeedle final : public RodChain {
 public:
  /// @param elements number of elements, ≥ 4
  /// @param load_capacity largest number of loads in any call
  static Result<std::unique_ptr<BeamNeedle>> build(const NeedleSection& section, int elements, int load_capacity);

  [[nodiscard]] std::string model() const override { return "beam"; }

 private:
  using RodChain::RodChain;
};

}  // namespace stylet
