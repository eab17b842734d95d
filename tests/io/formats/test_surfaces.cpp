// SPDX-License-Identifier: GPL-3.0-or-later
#include "files.hpp"
#include "stylet/io/mesh_io.hpp"

#include <nlohmann/json.hpp>

#include <cstring>
#include <sstream>

using namespace stylet;
using namespace stylet::test;

namespace {

/// Corners and faces (outward) of a tetrahedron with legs of `size`.
const std::array<Vec3, 4> corners{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
constexpr std::array<std::array<int, 3>, 4> faces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};

std::string stl(double size, bool inward = false) {
  std::ostringstream text;
  text << "solid thing\n";
  for (const auto& f : faces) {
    text << "facet normal 0 0 0\nouter loop\n";
    for (const int i : inward ? std::array<int, 3>{f[0], f[2], f[1]} : f)
      text << "vertex " << (size * corners[i]).transpose() << '\n';
    text << "endloop\nendfacet\n";
  }
  return text.str() + "endsolid thing\n";
}

std::string binary_stl(double size) {
  std::string bytes(80, ' ');
  const std::uint32_t count = 4;
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  for (const auto& f : faces) {
    bytes.append(12, '\0');
    for (const int i : f) {
      const Eigen::Vector3f p = (size * corners[i]).cast<float>();
      bytes.append(reinterpret_cast<const char*>(p.data()), 12);
    }
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string obj(double size) {
  std::ostringstream text;
  text << "# by hand\n";
  for (const Vec3& p : corners) text << "v " << (size * p).transpose() << '\n';
  for (const auto& f : faces) text << "f " << f[0] + 1 << ' ' << f[1] + 1 << ' ' << f[2] + 1 << '\n';
  return text.str();
}

std::string ply(double size, const std::string& comment = "by hand") {
  std::ostringstream text;
  text << "ply\nformat ascii 1.0\ncomment " << comment
       << "\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 4\n"
          "property list uchar int vertex_indices\nend_header\n";
  for (const Vec3& p : corners) text << (size * p).transpose() << '\n';
  for (const auto& f : faces) text << "3 " << f[0] << ' ' << f[1] << ' ' << f[2] << '\n';
  return text.str();
}

std::string vtp(double size) {
  std::ostringstream text;
  text << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
          "byte_order=\"LittleEndian\">\n<PolyData>\n"
          "<Piece NumberOfPoints=\"4\" NumberOfPolys=\"4\">\n<Points><DataArray type=\"Float64\" "
          "NumberOfComponents=\"3\" format=\"ascii\">";
  for (const Vec3& p : corners) text << (size * p).transpose() << ' ';
  text << "</DataArray></Points>\n<Polys><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">";
  for (const auto& f : faces) text << f[0] << ' ' << f[1] << ' ' << f[2] << ' ';
  text << "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">3 6 9 "
          "12</DataArray></Polys>\n</Piece>\n</PolyData>\n</VTKFile>\n";
  return text.str();
}

/// A GLB file with two nodes: "left", and "right", which is moved by 1 along x. Every triangle has its own vertices.
std::string glb(double size) {
  std::string binary;
  for (const auto& f : faces) {
    for (const int i : f) {
      const Eigen::Vector3f p = (size * corners[i]).cast<float>();
      binary.append(reinterpret_cast<const char*>(p.data()), 12);
    }
  }
  for (std::uint16_t i = 0; i < 12; ++i) binary.append(reinterpret_cast<const char*>(&i), 2);
  const nlohmann::json json = {{"asset", {{"version", "2.0"}}},
                               {"scene", 0},
                               {"scenes", {{{"nodes", {0}}}}},
                               {"nodes",
                                {{{"name", "both"}, {"children", {1, 2}}},
                                 {{"name", "left"}, {"mesh", 0}},
                                 {{"name", "right"}, {"mesh", 0}, {"translation", {1.0, 0.0, 0.0}}}}},
                               {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
                               {"buffers", {{{"byteLength", binary.size()}}}},
                               {"bufferViews",
                                {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 144}},
                                 {{"buffer", 0}, {"byteOffset", 144}, {"byteLength", 24}}}},
                               {"accessors",
                                {{{"bufferView", 0},
                                  {"componentType", 5126},
                                  {"count", 12},
                                  {"type", "VEC3"},
                                  {"min", {0, 0, 0}},
                                  {"max", {size, size, size}}},
                                 {{"bufferView", 1}, {"componentType", 5123}, {"count", 12}, {"type", "SCALAR"}}}}};
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  const auto put = [&](std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    bytes.append(reinterpret_cast<const char*>(&number), 4);
  };
  put(2);
  put(12 + 8 + text.size() + 8 + binary.size());
  put(text.size());
  bytes += "JSON" + text;
  put(binary.size());
  bytes += std::string("BIN\0", 4) + binary;
  return bytes;
}

double volume(const Surface& s) {
  double six = 0.0;
  for (const auto& t : s.triangles) six += s.points[t[0]].cross(s.points[t[1]]).dot(s.points[t[2]]);
  return six / 6.0;
}

Result<std::vector<Surface>> read(const std::string& name, const std::string& bytes, double scale = 0.0) {
  const Folder folder;
  return read_surfaces(write_file(folder / name, bytes), {.scale = scale});
}

void expect_tetrahedron(const Result<std::vector<Surface>>& surfaces, const std::string& what) {
  ASSERT_TRUE(surfaces.ok()) << what << ": " << why(surfaces);
  ASSERT_EQ(surfaces->size(), 1U) << what;
  EXPECT_EQ(surfaces->front().name, "thing") << what;
  EXPECT_EQ(surfaces->front().points.size(), 4U) << what;
  EXPECT_EQ(surfaces->front().triangles.size(), 4U) << what;
  EXPECT_NEAR(volume(surfaces->front()), 27000.0 / 6.0, 1e-2) << what;
}

}  // namespace

TEST(Surfaces, every_format_gives_the_same_closed_surface) {
  expect_tetrahedron(read("thing.stl", stl(30)), "STL");
  expect_tetrahedron(read("thing.stl", binary_stl(30)), "binary STL");
  expect_tetrahedron(read("thing.obj", obj(30)), "OBJ");
  expect_tetrahedron(read("thing.ply", ply(30)), "PLY");
  expect_tetrahedron(read("thing.vtp", vtp(30)), "VTP");
}

TEST(Surfaces, normals_of_a_closed_surface_are_turned_outward) {
  expect_tetrahedron(read("thing.stl", stl(30, true)), "inward STL");
}

TEST(Surfaces, glb_nodes_become_named_surfaces_in_lps_mm) {
  const auto surfaces = value_of(read("scene.glb", glb(0.03)));
  ASSERT_EQ(surfaces.size(), 2U);
  EXPECT_EQ(surfaces[0].name, "left");
  EXPECT_EQ(surfaces[1].name, "right");
  for (const Surface& s : surfaces) {
    EXPECT_EQ(s.points.size(), 4U) << "welded by position";
    EXPECT_NEAR(volume(s), 27000.0 / 6.0, 1e-1);
  }
  Eigen::AlignedBox3d left, right;
  for (const Vec3& p : surfaces[0].points) left.extend(p);
  for (const Vec3& p : surfaces[1].points) right.extend(p);
  // (x, y, z) in m, y up, becomes (1000 x, -1000 z, 1000 y) in mm.
  EXPECT_LT((left.min() - Vec3(0, -30, 0)).norm() + (left.max() - Vec3(30, 0, 30)).norm(), 1e-3);
  EXPECT_LT((right.min() - Vec3(1000, -30, 0)).norm(), 1e-3);
}

TEST(Surfaces, a_scale_is_applied_and_wrong_units_are_refused) {
  expect_refused(read("thing.stl", stl(0.03)), {"0.03 mm across", "--scale 1000"});
  expect_tetrahedron(read("thing.stl", stl(0.03), 1000.0), "scaled");
  expect_refused(read("thing.obj", obj(30000)), {"3e+04 mm across", "--scale"});
  expect_refused(read("scene.glb", glb(30)), {"mm across", "--scale"});
}

TEST(Surfaces, ras_surfaces_of_3d_slicer_are_turned_into_lps) {
  const auto s = value_of(read("thing.ply", ply(30, "SPACE=RAS")));
  Eigen::AlignedBox3d box;
  for (const Vec3& p : s.front().points) box.extend(p);
  EXPECT_LT((box.min() - Vec3(-30, -30, 0)).norm(), 1e-4);
}

TEST(Surfaces, surfaces_without_triangles_or_area_are_refused) {
  expect_refused(read("thing.obj", "v 0 0 0\nv 30 0 0\nv 0 30 0\n"), {"no triangles"});
  expect_refused(read("thing.obj", "v 0 0 0\nv 30 0 0\nv 0 30 0\nf 1 2 2\n"), {"no area"});
}

TEST(Surfaces, damaged_files_are_refused) {
  expect_refused(read("thing.stl", binary_stl(30).substr(0, 200)), {"thing.stl", "200 bytes", "4 triangles"});
  expect_refused(read("thing.stl", stl(30).substr(0, 300)), {"thing.stl", "endsolid"});
  expect_refused(read("thing.ply", ply(30).substr(0, 230)), {"thing.ply"});
  expect_refused(read("thing.vtp", vtp(30).substr(0, 400)), {"thing.vtp"});
  expect_refused(read("scene.glb", glb(0.03).substr(0, 700)), {"scene.glb"});
  expect_refused(read("thing.obj", "v 0 0 0\nv 30 0 0\nv 0 30 0\nf 1 2 9\n"), {"thing.obj"});
  expect_refused(read("thing.obj", "v 0 0 0\nv nan 0 0\nv 0 30 0\nf 1 2 3\n"), {"thing.obj"});
}

TEST(Surfaces, triangles_that_begin_outside_the_list_of_points_are_refused) {
  for (const char* offsets : {">-3 6 9 ", ">3 3000 9 ", ">3 2 9 "})
    expect_refused(read("thing.vtp", replaced(vtp(30), ">3 6 9 ", offsets)), {"thing.vtp", "damaged"});
}

TEST(Surfaces, glb_with_a_word_where_a_number_belongs_is_refused_as_damaged) {
  std::string bytes = glb(0.03);
  bytes.replace(bytes.find("[1.0,"), 5, "[\"a\",");
  expect_refused(read("scene.glb", bytes), {"scene.glb", "do not fit their description"});
}
