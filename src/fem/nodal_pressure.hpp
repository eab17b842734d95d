// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "linear_tetrahedra.hpp"

namespace stylet::detail {

/// Linear tetrahedra whose relative change of volume is averaged around each node a:
///   θ_a = Σ_e (V_e/4) div u_e / Σ_e V_e/4,    energy Σ_e V_e μ ε:ε + Σ_a V_a ½ λ θ_a²,
/// summed over the elements e at the node that are of one material. Averages never include two materials, because
/// pressure jumps between them.
/// @cite Bonet1998
class NodalPressure final : public LinearTetrahedra {
 public:
  using LinearTetrahedra::LinearTetrahedra;

  void stiffness(std::span<const Index> tets, const MaterialOf& material, const Add& add) const override;
  void parts(std::span<const Index> tets, const MaterialOf& material, const Visit& visit) const override;
  [[nodiscard]] MatX stress(const MaterialOf& material, const VecX& u) const override;

 private:
  /// The elements of one material around a node.
  struct Group {
    std::span<const Index> tets;
    std::span<const Index> nodes;  ///< of these elements, ascending
    Material material;
    double volume;  ///< [mm³] Σ V_e / 4
  };
  void for_each_group(std::span<const Index> tets, const MaterialOf& material,
                      const std::function<void(const Group&)>& visit) const;
};

}  // namespace stylet::detail
