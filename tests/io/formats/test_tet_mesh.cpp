// SPDX-License-Identifier: GPL-3.0-or-later
#include "files.hpp"
#include "mesh_files.hpp"
#include "stylet/io/mesh_io.hpp"
#include "support/says.hpp"

#include <numeric>

using namespace stylet;
using namespace stylet::test;

namespace {

double volume(const TetMesh& mesh, int region) {
  double sum = 0.0;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    if (mesh.tet_region[t] == region) sum += tet_volume(mesh, t);
  }
  return sum;
}

double extent(const TetMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& x : mesh.nodes) box.extend(x);
  return box.sizes().maxCoeff();
}

}  // namespace

TEST(TetMesh, every_format_gives_the_same_mesh_with_its_regions) {
  const Folder folder;
  const TetMesh mesh = two_region_box();
  for (const MeshFile& file : write_all_formats(mesh, folder.path())) {
    SCOPED_TRACE(file.what);
    std::vector<std::string> notes;
    const auto read = value_of(read_tet_mesh(file.path, {.scale = 0.0, .notes = &notes}));
    EXPECT_EQ(read.node_count(), mesh.node_count());
    EXPECT_EQ(read.tet_count(), mesh.tet_count());
    ASSERT_EQ(read.regions.size(), 2U);
    for (int region = 0; region < 2; ++region) {
      EXPECT_NEAR(volume(read, region), volume(mesh, region), 1e-3);
      if (file.names) {
        EXPECT_EQ(read.regions[region], mesh.regions[region]);
      }
    }
    EXPECT_NEAR(extent(read), 40.0, 1e-4);
    EXPECT_TRUE(notes.empty()) << notes[0];
  }
}

TEST(TetMesh, the_scale_turns_metres_into_mm) {
  const Folder folder;
  TetMesh mesh = two_region_box();
  for (Vec3& x : mesh.nodes) x *= 1e-3;
  const fs::path path = write_file(folder / "metres.msh", msh22_text(mesh));
  expect_refused(read_tet_mesh(path), {"0.04 mm across", "metres", "--scale 1000"});
  const auto read = value_of(read_tet_mesh(path, {.scale = 1000.0}));
  EXPECT_NEAR(extent(read), 40.0, 1e-9);
}

TEST(TetMesh, a_size_that_cannot_be_mm_is_refused_with_the_scale_to_pass) {
  const Folder folder;
  const auto scaled = [&](double factor) {
    TetMesh mesh = two_region_box();
    for (Vec3& x : mesh.nodes) x *= factor;
    return read_tet_mesh(write_file(folder / "m.msh", msh22_text(mesh)));
  };
  expect_refused(scaled(0.1), {"4 mm across", "--scale 10"});
  expect_refused(scaled(1e3), {"4e+04 mm across", "--scale 0.001"});
  expect_refused(read_tet_mesh(folder / "m.msh", {.scale = 1.0}), {"4e+04 mm across"});
}

TEST(TetMesh, a_scale_that_is_no_length_is_refused) {
  const Folder folder;
  const fs::path path = write_file(folder / "m.msh", msh22_text(two_region_box()));
  for (const double scale : {-1.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    expect_refused(read_tet_mesh(path, {.scale = scale}), {"--scale", "above 0"});
  }
}

TEST(TetMesh, other_elements_and_their_nodes_are_passed_over_with_a_note) {
  const Folder folder;
  const TetMesh mesh = two_region_box();
  const std::string tets = std::to_string(mesh.tets.size());
  std::string text = msh22_text(mesh);
  const std::string count = std::to_string(mesh.nodes.size());
  const std::string more = std::to_string(mesh.nodes.size() + 1);
  text = replaced(text, "$Nodes\n" + count, "$Nodes\n" + more);
  text = replaced(text, "$EndNodes", more + " 90 0 0\n$EndNodes");
  text = replaced(text, "$Elements\n" + tets, "$Elements\n" + std::to_string(mesh.tets.size() + 2));
  text = replaced(text, "$EndElements", "1001 2 2 9 9 1 2 " + more + "\n1002 1 2 9 9 1 2\n$EndElements");
  std::vector<std::string> notes;
  const auto read = value_of(read_tet_mesh(write_file(folder / "mixed.msh", text), {.scale = 0.0, .notes = &notes}));
  EXPECT_EQ(read.node_count(), mesh.node_count());
  const std::string all = std::accumulate(notes.begin(), notes.end(), std::string());
  expect_says(all, {"Triangle", "Line", "1 node that no tetrahedron uses"});
}

TEST(TetMesh, a_mesh_numbered_the_other_way_round_is_put_right) {
  const Folder folder;
  TetMesh mesh = two_region_box();
  for (auto& tet : mesh.tets) std::swap(tet[0], tet[1]);
  std::vector<std::string> notes;
  const auto read =
      value_of(read_tet_mesh(write_file(folder / "m.vtk", vtk_text(mesh)), {.scale = 0.0, .notes = &notes}));
  for (Index t = 0; t < read.tet_count(); ++t) EXPECT_GT(tet_volume(read, t), 0.0);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("other way round"), std::string::npos);
}

TEST(TetMesh, quadratic_tetrahedra_give_their_corners) {
  const Folder folder;
  const std::string text =
      "# vtk DataFile Version 3.0\nquadratic\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 10 double\n"
      "0 0 0  20 0 0  0 20 0  0 0 20  10 0 0  10 10 0  0 10 0  0 0 10  10 0 10  0 10 10\n"
      "CELLS 1 11\n10 0 1 2 3 4 5 6 7 8 9\nCELL_TYPES 1\n24\n";
  std::vector<std::string> notes;
  const auto read = value_of(read_tet_mesh(write_file(folder / "q.vtk", text), {.scale = 0.0, .notes = &notes}));
  EXPECT_EQ(read.node_count(), 4);
  EXPECT_NEAR(tet_volume(read, 0), 8000.0 / 6.0, 1e-9);
  ASSERT_FALSE(notes.empty());
  EXPECT_NE(notes[0].find("quadratic"), std::string::npos);
}

TEST(TetMesh, tetgen_counts_from_0_or_1) {
  const TetMesh mesh = two_region_box();
  for (const int first : {0, 1}) {
    const Folder folder;
    const auto [nodes, tets] = tetgen_texts(mesh, first);
    write_file(folder / "m.node", nodes);
    const auto read = value_of(read_tet_mesh(write_file(folder / "m.ele", tets)));
    EXPECT_EQ(read.nodes, mesh.nodes);
    EXPECT_EQ(read.tets, mesh.tets);
  }
}

TEST(TetMesh, ras_meshes_of_3d_slicer_are_turned_into_lps) {
  const Folder folder;
  const TetMesh mesh = two_region_box();
  const auto read = value_of(
      read_tet_mesh(write_file(folder / "m.vtk", replaced(vtk_text(mesh), "by hand", "3D Slicer output. SPACE=RAS"))));
  EXPECT_EQ(read.nodes[0], Vec3(-mesh.nodes[0].x(), -mesh.nodes[0].y(), mesh.nodes[0].z()));
}

TEST(TetMesh, volumes_in_one_nameless_group_are_regions_of_their_own) {
  const Folder folder;
  std::string text = msh22_text(two_region_box());
  text.erase(text.find("$PhysicalNames"), text.find("$Nodes") - text.find("$PhysicalNames"));
  for (std::size_t at = 0; (at = text.find(" 4 2 2 2 ", at)) != std::string::npos;) text.replace(at, 9, " 4 2 1 2 ");
  const auto read = value_of(read_tet_mesh(write_file(folder / "m.msh", text)));
  EXPECT_EQ(read.regions, (std::vector<std::string>{"region 1", "region 2"}));
}
