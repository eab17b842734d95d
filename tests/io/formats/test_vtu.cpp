// SPDX-License-Identifier: GPL-3.0-or-later
#include "files.hpp"
#include "mesh_files.hpp"
#include "stylet/io/mesh_io.hpp"

using namespace stylet;
using namespace stylet::test;

TEST(Vtu, what_is_written_comes_back_bit_for_bit) {
  const Folder folder;
  const TetMesh mesh = two_region_box();
  const MatX displacement = MatX::Random(3, mesh.node_count()), stress = MatX::Random(6, mesh.tet_count());
  ASSERT_TRUE(write_vtu(mesh, folder / "m.vtu", {{"displacement_mm", displacement}}, {{"stress_MPa", stress}}).ok());
  const auto back = value_of(read_tet_mesh(folder / "m.vtu"));
  EXPECT_EQ(back.nodes, mesh.nodes);
  EXPECT_EQ(back.tets, mesh.tets);
  EXPECT_EQ(back.tet_region, mesh.tet_region);
  EXPECT_EQ(back.regions, mesh.regions);
}

TEST(Vtu, the_same_mesh_gives_the_same_bytes_and_says_frame_and_unit) {
  const Folder folder;
  ASSERT_TRUE(write_vtu(two_region_box(), folder / "a.vtu").ok());
  ASSERT_TRUE(write_vtu(two_region_box(), folder / "b.vtu").ok());
  const std::string text = content_of(folder / "a.vtu");
  EXPECT_EQ(text, content_of(folder / "b.vtu"));
  for (const char* word :
       {"format=\"appended\"", "Name=\"region\"", "Name=\"region_names\"", "Name=\"SPACE\"", "Name=\"UNITS\""}) {
    EXPECT_NE(text.find(word), std::string::npos) << word;
  }
}

TEST(Vtu, a_mesh_smaller_than_believable_comes_back_because_its_unit_is_stated) {
  const Folder folder;
  TetMesh mesh = two_region_box();
  for (Vec3& x : mesh.nodes) x *= 0.2;
  ASSERT_TRUE(write_vtu(mesh, folder / "m.vtu").ok());
  EXPECT_TRUE(read_tet_mesh(folder / "m.vtu").ok()) << why(read_tet_mesh(folder / "m.vtu"));
}

TEST(Vtu, fields_of_the_wrong_shape_are_refused_and_nothing_is_written) {
  const Folder folder;
  const TetMesh mesh = two_region_box();
  EXPECT_FALSE(write_vtu(mesh, folder / "m.vtu", {{"u_mm", MatX::Zero(3, 5)}}).ok());
  EXPECT_FALSE(write_vtu(mesh, folder / "m.vtu", {{"u_mm", MatX::Zero(2, mesh.node_count())}}).ok());
  EXPECT_FALSE(write_vtu(mesh, folder / "m.vtu", {}, {{"s_MPa", MatX::Zero(6, mesh.node_count())}}).ok());
  EXPECT_FALSE(write_vtu(mesh, folder / "no/such/folder/m.vtu").ok());
  EXPECT_TRUE(fs::is_empty(folder.path()));
}
