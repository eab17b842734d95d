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

TetMesh read_mesh(hid_t file) {
  const Handle mesh_group = open_group(file, "mesh");
  const Handle nodes = dataset(mesh_group, "nodes_mm"), tets = dataset(mesh_group, "tets"),
               region = dataset(mesh_group, "tet_region");
  const auto node_shape = extents(nodes), tet_shape = extents(tets);
  if (node_shape.size() != 2 || node_shape[1] != 3) throw Failure("/mesh/nodes_mm must be (n, 3)");
  if (tet_shape.size() != 2 || tet_shape[1] != 4) throw Failure("/mesh/tets must be (m, 4)");
  if (extents(region) != std::vector<hsize_t>{tet_shape[0]}) throw Failure("/mesh/tet_region must be (m)");
  TetMesh mesh;
  mesh.nodes.resize(node_shape[0]);
  mesh.tets.resize(tet_shape[0]);
  mesh.tet_region.resize(tet_shape[0]);
  read_rows(nodes, H5T_NATIVE_DOUBLE, 0, node_shape[0], std::as_writable_bytes(std::span(mesh.nodes)));
  read_rows(tets, H5T_NATIVE_INT32, 0, tet_shape[0], std::as_writable_bytes(std::span(mesh.tets)));
  read_rows(region, H5T_NATIVE_INT, 0, tet_shape[0], std::as_writable_bytes(std::span(mesh.tet_region)));
  mesh.regions = read_texts(mesh_group, "regions");
  return mesh;
}

}  // namespace stylet::h5
