// SPDX-License-Identifier: GPL-3.0-or-later
#include "h5_mesh.hpp"

#include <array>

namespace stylet::h5 {

void write_mesh(hid_t file, const TetMesh& mesh) {
  const Handle mesh_group = group(file, "mesh");
  const std::array<hsize_t, 2> nodes{mesh.nodes.size(), 3};
  const std::array<hsize_t, 2> tets{mesh.tets.size(), 4};
  write_array(mesh_group, "nodes_mm", H5T_NATIVE_DOUBLE, nodes, mesh.nodes.data());
  write_array(mesh_group, "tets", H5T_NATIVE_INT32, tets, mesh.tets.data());
  write_array(mesh_group, "tet_region", H5T_NATIVE_INT, {tets.data(), 1}, mesh.tet_region.data());
  write_texts(mesh_group, "regions", mesh.regions);
}

}  // namespace stylet::h5
