// SPDX-License-Identifier: GPL-3.0-or-later
// A block of soft tissue hangs from its upper face and is pulled at its lowest corner.
#include <stylet/core/version.hpp>
#include <stylet/fem/tissue.hpp>
#include <stylet/geom/box_mesh.hpp>

#include <iostream>

int main() {
  const stylet::TetMesh mesh = stylet::box_mesh({0, 0, 0}, {40, 40, 40}, {4, 4, 4});
  std::vector<stylet::Index> fixed;
  for (stylet::Index node = 0; node < mesh.node_count(); ++node) {
    if (mesh.nodes[node].z() == 40.0) fixed.push_back(node);
  }

  const auto tissue = stylet::Tissue::build(mesh, {{.young_MPa = 0.02, .poisson = 0.45}}, fixed);
  if (!tissue) {
    std::cerr << tissue.error().message() << '\n';
    return 1;
  }

  stylet::VecX force = stylet::VecX::Zero(3 * mesh.node_count());
  force[2] = -0.1;
  const stylet::VecX displacement = tissue->solve(force);
  std::cout << "stylet " << stylet::version() << ": the corner moves " << displacement[2] << " mm\n";
  return displacement[2] < 0 ? 0 : 1;
}
