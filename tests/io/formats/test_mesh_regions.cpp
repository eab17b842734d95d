// SPDX-License-Identifier: GPL-3.0-or-later
// From which array of a foreign mesh its regions come.
#include "files.hpp"
#include "mesh_files.hpp"
#include "stylet/io/contours_io.hpp"
#include "stylet/io/input.hpp"

#include <fmt/format.h>

#include <functional>
#include <sstream>

using namespace stylet;
using namespace stylet::test;

namespace {

/// An array of a file with its number for each tetrahedron.
struct NamedArray {
  std::string name;
  std::function<double(const TetMesh&, Index)> value;
};

double by_region(const TetMesh& mesh, Index t) { return 3.0 + 4.0 * mesh.tet_region[static_cast<std::size_t>(t)]; }
double by_other_numbers(const TetMesh& mesh, Index t) { return -2.0 * by_region(mesh, t); }
double by_parity(const TetMesh&, Index t) { return static_cast<double>(t % 2); }
double by_number(const TetMesh&, Index t) { return static_cast<double>(t); }
double by_fraction(const TetMesh&, Index t) { return 0.25 + static_cast<double>(t); }
double by_nothing(const TetMesh&, Index) { return 1.0; }

/// A legacy VTK file of the box with these arrays.
std::string vtk_with(const TetMesh& mesh, const std::vector<NamedArray>& arrays, const std::string& type = "double") {
  std::string text = vtk_text(mesh);
  text.resize(text.find("CELL_DATA"));
  text += fmt::format("CELL_DATA {}\nFIELD FieldData {}\n", mesh.tet_count(), arrays.size());
  for (const NamedArray& array : arrays) {
    text += fmt::format("{} 1 {} {}\n", array.name, mesh.tet_count(), type);
    for (Index t = 0; t < mesh.tet_count(); ++t) text += fmt::format("{}\n", array.value(mesh, t));
  }
  return text;
}

/// An MSH file of the box without names of groups.
std::string msh_with(const TetMesh& mesh, const std::vector<NamedArray>& arrays) {
  std::string text = msh22_text(mesh);
  const auto names = text.find("$PhysicalNames");
  text.erase(names, text.find("$Nodes") - names);
  for (const NamedArray& array : arrays) {
    text += fmt::format("$ElementData\n1\n\"{}\"\n1\n0.0\n3\n0\n1\n{}\n", array.name, mesh.tet_count());
    for (Index t = 0; t < mesh.tet_count(); ++t) text += fmt::format("{} {}\n", t + 1, array.value(mesh, t));
    text += "$EndElementData\n";
  }
  return text;
}

struct Read {
  Result<TetMesh> mesh;
  std::vector<std::string> notes;
};

Read read(const fs::path& path, const std::string& regions_from = {}) {
  Read out{input_error("", "", ""), {}};
  out.mesh = read_tet_mesh(path, {.notes = &out.notes, .regions_from = regions_from});
  EXPECT_TRUE(out.mesh.ok()) << why(out.mesh);
  if (!out.mesh.ok()) out.mesh = two_region_box();
  return out;
}

Result<TetMesh> refused(const fs::path& path, const std::string& regions_from) {
  return read_tet_mesh(path, {.regions_from = regions_from});
}

void expect_note(const Read& file, std::initializer_list<const char*> words) {
  ASSERT_EQ(file.notes.size(), 1U);
  for (const char* word : words) EXPECT_NE(file.notes[0].find(word), std::string::npos) << file.notes[0];
}

}  // namespace

TEST(MeshRegions, come_from_the_only_array_of_whole_numbers_and_a_note_names_it) {
  const Folder folder;
  const TetMesh mesh = two_region_box();
  for (const char* type : {"int", "float", "double", "short"}) {
    const Read file = read(write_file(folder / "m.vtk", vtk_with(mesh, {{"tissue", by_region}}, type)));
    EXPECT_EQ(file.mesh->regions, (std::vector<std::string>{"region 3", "region 7"}));
    EXPECT_EQ(file.mesh->tet_region, mesh.tet_region);
    expect_note(file, {"'tissue'", "2 regions"});
  }
}

TEST(MeshRegions, do_not_come_from_numbers_of_cells_fractions_or_constants) {
  const Folder folder;
  const TetMesh mesh = two_region_box();
  const auto path = write_file(folder / "m.vtk", vtk_with(mesh, {{"ids", by_number},
                                                                 {"vtkGhostType", by_parity},
                                                                 {"stress", by_fraction},
                                                                 {"one", by_nothing},
                                                                 {"tissue", by_region}}));
  const Read file = read(path);
  EXPECT_EQ(file.mesh->tet_region, mesh.tet_region);
  expect_note(file, {"'tissue'"});
}

TEST(MeshRegions, are_one_with_a_list_of_arrays_where_several_could_be_them) {
  const Folder folder;
  const TetMesh mesh = two_region_box();
  const auto path = write_file(folder / "m.vtk", vtk_with(mesh, {{"part", by_region}, {"half", by_parity}}));
  const Read file = read(path);
  EXPECT_EQ(file.mesh->regions.size(), 1U);
  expect_note(file, {"one region", "'part' (2 different numbers), 'half' (2 different numbers)",
                     "--regions-from \"part\"", "regions_from = \"part\""});
  const Read chosen = read(path, "part");
  EXPECT_EQ(chosen.mesh->tet_region, mesh.tet_region);
  EXPECT_TRUE(chosen.notes.empty());
  expect_refused(refused(path, "parts"), {"'parts'", "Did you mean 'part'?"});
  expect_refused(refused(path, "xyz"), {"\"part\", \"half\"", "Name one of these"});
}

TEST(MeshRegions, of_arrays_with_the_same_borders_are_those_of_the_first) {
  const Folder folder;
  const TetMesh mesh = two_region_box();
  const Read file = read(write_file(folder / "m.vtk", vtk_with(mesh, {{"a", by_region}, {"b", by_other_numbers}})));
  EXPECT_EQ(file.mesh->regions, (std::vector<std::string>{"region 3", "region 7"}));
}

TEST(MeshRegions, with_a_known_name_come_first_and_a_note_names_other_arrays) {
  const Folder folder;
  const TetMesh mesh = two_region_box();
  const Read file =
      read(write_file(folder / "m.vtk", vtk_with(mesh, {{"half", by_parity}, {"MaterialID", by_region}})));
  EXPECT_EQ(file.mesh->tet_region, mesh.tet_region);
  expect_note(file, {"'MaterialID'", "'half'"});
  const Read constant =
      read(write_file(folder / "m.vtk", vtk_with(mesh, {{"MaterialID", by_nothing}, {"tissue", by_region}})));
  EXPECT_EQ(constant.mesh->tet_region, mesh.tet_region);
  expect_note(constant, {"'tissue'"});
}

TEST(MeshRegions, are_never_one_in_silence) {
  const Folder folder;
  TetMesh mesh = two_region_box();
  expect_note(read(write_file(folder / "m.vtk", vtk_with(mesh, {{"ids", by_number}}))), {"one region", "'ids'"});
  expect_note(read(write_file(folder / "m.vtk", vtk_with(mesh, {{"stress", by_fraction}}))), {"one region"});
  std::fill(mesh.tet_region.begin(), mesh.tet_region.end(), 0);
  expect_note(read(write_file(folder / "m.msh", msh_with(mesh, {}))), {"one region"});
  // A file that names its only region says so itself.
  mesh.regions = {"prostate"};
  ASSERT_TRUE(write_vtu(mesh, folder / "m.vtu").ok());
  EXPECT_TRUE(read(folder / "m.vtu").notes.empty());
}

TEST(MeshRegions, from_a_chosen_array_must_be_whole_numbers) {
  const Folder folder;
  const TetMesh mesh = two_region_box();
  const auto path = write_file(folder / "m.vtk", vtk_with(mesh, {{"density", by_fraction}, {"ids", by_number}}));
  expect_refused(refused(path, "density"), {"cell 0", "0.25", "'density'"});
  EXPECT_EQ(read(path, "ids").mesh->regions.size(), mesh.tets.size());
}

TEST(MeshRegions, of_gmsh_may_come_from_its_element_data) {
  const Folder folder;
  TetMesh mesh = two_region_box();
  const std::vector<int> right = mesh.tet_region;
  const auto colour = [&](const TetMesh&, Index t) { return 1.0 + right[static_cast<std::size_t>(t)]; };
  std::fill(mesh.tet_region.begin(), mesh.tet_region.end(), 0);  // one group for all
  const Read file = read(write_file(folder / "m.msh", msh_with(mesh, {{"color", colour}, {"q", by_fraction}})));
  EXPECT_EQ(file.mesh->regions, (std::vector<std::string>{"region 1", "region 2"}));
  EXPECT_EQ(file.mesh->tet_region, right);
  expect_note(file, {"'color'", "$ElementData"});
  const auto two = write_file(folder / "n.msh", msh_with(mesh, {{"color", colour}, {"half", by_parity}}));
  expect_note(read(two), {"'color'", "'half'", "--regions-from"});
  EXPECT_EQ(read(two, "COLOR").mesh->tet_region, right);
  expect_refused(refused(two, "colour"), {"$ElementData 'colour'", "Did you mean 'color'?"});
}

TEST(MeshRegions, of_tetgen_may_come_from_another_attribute) {
  const Folder folder;
  const TetMesh mesh = two_region_box();
  const auto [nodes, tets] = tetgen_texts(mesh);
  write_file(folder / "m.node", nodes);
  std::istringstream lines(tets);
  std::string line;
  std::getline(lines, line);
  std::string more = fmt::format("{} 4 2\n", mesh.tet_count());
  for (int k = 0; std::getline(lines, line); ++k)
    more += fmt::format("{} {}\n", line.substr(0, line.find('#')), 5 + k % 3);
  const auto path = write_file(folder / "m.ele", more);
  EXPECT_EQ(read(path).mesh->tet_region, mesh.tet_region);
  EXPECT_EQ(read(path, "attribute 2").mesh->regions, (std::vector<std::string>{"region 5", "region 6", "region 7"}));
  expect_refused(refused(path, "attribute 3"), {"'attribute 3'", "Did you mean 'attribute 1'?"});
}

TEST(MeshRegions, cannot_be_chosen_in_a_file_that_is_no_mesh) {
  const Folder folder;
  ASSERT_TRUE(write_contour_json(two_organs(), folder / "c.json").ok());
  expect_refused(read_input(folder / "c.json", {.regions_from = "a"}), {"'a'", "--regions-from"});
}
