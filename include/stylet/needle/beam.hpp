// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "stylet/needle/rod_chain.hpp"

namespace stylet {

/// Kirchhoff rod: geometrically exact, inextensible and unshearable, with piecewise constant curvature. Element e turns
/// the frame by the rotation vector l κ_e, so the centreline is a chain of circular helices with a continuous tangent.
/// The energy is ½ Σ l κᵀ diag(EI, EI, GJ) κ − Σ f·r.
/// @cite Bertails2006
class BeamNeedle final : public RodChain {
 public:
  /// Builds a needle; errors are those of check_needle().
  /// @param elements number of elements, 4…500
  /// @param load_capacity largest number of loads in any call
  static Result<std::unique_ptr<BeamNeedle>> build(const NeedleSection& section, int elements, int load_capacity);

  [[nodiscard]] std::string model() const override { return "beam"; }

 private:
  using RodChain::RodChain;
};

}  // namespace stylet
