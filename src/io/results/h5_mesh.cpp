// SPDX-License-Identifier: GPL-3.0-or-later
#include "h5_mesh.hpp"

#include <fmt/format.h>

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
  if (mesh.surfaces.empty()) return;
  const FlatSurfaces flat = flatten(mesh.surfaces);
  write_array(mesh_group, "surface_points_mm", H5T_NATIVE_FLOAT, std::array<hsize_t, 2>{flat.points_mm.size() / 3, 3},
              flat.points_mm.data());
  write_array(mesh_group, "surface_triangles", H5T_NATIVE_INT32, std::array<hsize_t, 2>{flat.triangles.size() / 3, 3},
              flat.triangles.data());
  write_array(mesh_group, "surface_sizes", H5T_NATIVE_INT32, std::array<hsize_t, 2>{flat.sizes.size() / 2, 2},
              flat.sizes.data());
}

namespace {

/// Reads a table of numbers. Throws Failure where it has another number of columns.
template <class Number>
std::vector<Number> read_table(hid_t group, const char* name, hid_t type, hsize_t columns) {
  const Handle table = dataset(group, name);
  const auto shape = extents(table);
  if (shape.size() != 2 || shape[1] != columns) throw Failure(fmt::format("/mesh/{} must be (n, {})", name, columns));
  std::vector<Number> numbers(shape[0] * columns);
  read_rows(table, type, 0, shape[0], std::as_writable_bytes(std::span(numbers)));
  return numbers;
}

/// The surfaces of a mesh; empty where the file has none, as those of meshes that were given.
std::vector<Surface> read_surfaces(hid_t group, const std::vector<std::string>& regions) {
  if (check(H5Lexists(group, "surface_sizes", H5P_DEFAULT), "look for /mesh/surface_sizes") == 0) return {};
  const FlatSurfaces flat{read_table<float>(group, "surface_points_mm", H5T_NATIVE_FLOAT, 3),
                          read_table<Index>(group, "surface_triangles", H5T_NATIVE_INT32, 3),
                          read_table<Index>(group, "surface_sizes", H5T_NATIVE_INT32, 2)};
  auto surfaces = unflatten(flat, regions);
  if (!surfaces) throw Failure("/mesh/surface_points_mm, surface_triangles and surface_sizes do not fit each other");
  return *std::move(surfaces);
}

}  // namespace

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
  mesh.surfaces = read_surfaces(mesh_group, mesh.regions);
  return mesh;
}

}  // namespace stylet::h5
