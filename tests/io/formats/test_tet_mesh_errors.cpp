// SPDX-License-Identifier: GPL-3.0-or-later
#include "files.hpp"
#include "mesh_files.hpp"
#include "stylet/io/mesh_io.hpp"

#include <fmt/format.h>

#include <algorithm>

using namespace stylet;
using namespace stylet::test;

namespace {

Result<TetMesh> read_mesh(const std::string& name, const std::string& text) {
  const Folder folder;
  return read_tet_mesh(write_file(folder / name, text));
}

/// Reads a changed mesh, written as legacy VTK.
Result<TetMesh> changed(const std::function<void(TetMesh&)>& change) {
  TetMesh mesh = two_region_box();
  change(mesh);
  return read_mesh("m.vtk", vtk_text(mesh));
}

/// Changes a gmsh file of tetrahedra so that the eighth element has the number of the seventh.
std::string with_seven_twice(std::string content, bool binary, bool of_version_4) {
  if (!binary) {
    const auto list = content.find(content.starts_with("$NOD") ? "$ELM" : "$Elements");
    return content.substr(0, list) + replaced(content.substr(list), "\n8 ", "\n7 ");
  }
  std::size_t at = content.find("$Elements\n") + std::string("$Elements\n").size();
  if (of_version_4) {
    at += 4 * 8 + 3 * 4 + 8 + 7 * 5 * 8;  // head of the section, head of the block, seven elements
  } else {
    at = content.find('\n', at) + 1 + 7 * 10 * 4 + 3 * 4;  // announced number, seven elements, head of the eighth
  }
  EXPECT_EQ(content[at], 8) << "not where the number of the eighth element is";
  content[at] = 7;
  return content;
}

/// Binary MSH 2.2, in the byte order of this machine or the other one.
std::string msh22_binary(const TetMesh& mesh, bool swapped) {
  std::string text = "$MeshFormat\n2.2 1 8\n";
  const auto put = [&](auto value) {
    std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
    if (swapped) std::reverse(bytes.begin(), bytes.end());
    text += bytes;
  };
  put(1);
  text += "\n$EndMeshFormat\n$Nodes\n" + std::to_string(mesh.nodes.size()) + "\n";
  for (Index a = 0; a < mesh.node_count(); ++a) {
    put(static_cast<int>(a + 1));
    for (int i = 0; i < 3; ++i) put(mesh.nodes[a][i]);
  }
  text += "\n$EndNodes\n$Elements\n" + std::to_string(mesh.tets.size()) + "\n";
  for (const int head : {4, static_cast<int>(mesh.tets.size()), 2}) put(head);
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    put(static_cast<int>(t == 7 ? 7 : t + 1));
    for (int k = 0; k < 2; ++k) put(mesh.tet_region[t] + 1);
    for (const Index a : mesh.tets[t]) put(static_cast<int>(a + 1));
  }
  return text + "\n$EndElements\n";
}

}  // namespace

TEST(TetMeshErrors, gmsh_elements_that_share_a_number_are_named) {
  const Folder folder;
  int files = 0;
  for (const MeshFile& file : write_all_formats(two_region_box(), folder.path())) {
    if (file.path.extension() != ".msh") continue;
    SCOPED_TRACE(file.what);
    const bool binary = file.what.starts_with("binary");
    const bool of_version_4 = file.what.find("41") != std::string::npos;
    const std::string content = with_seven_twice(content_of(file.path), binary, of_version_4);
    expect_refused(read_tet_mesh(write_file(folder / "twice.msh", content)),
                   {"twice.msh, element 7", "two elements have this number", "a different number"});
    ++files;
  }
  EXPECT_EQ(files, 6);
  for (const bool swapped : {false, true}) {
    expect_refused(read_tet_mesh(write_file(folder / "block.msh", msh22_binary(two_region_box(), swapped))),
                   {"block.msh, element 7"});
  }
}

TEST(TetMeshErrors, gmsh_elements_of_two_kinds_that_share_a_number_are_named) {
  const TetMesh mesh = two_region_box();
  const std::string count = std::to_string(mesh.tets.size());
  const std::string more = std::to_string(mesh.tets.size() + 1);
  std::string text = replaced(msh22_text(mesh), "$Elements\n" + count, "$Elements\n" + more);
  text = replaced(text, "$EndElements", "9 2 2 3 3 1 2 3\n$EndElements");
  expect_refused(read_mesh("m.msh", text), {"m.msh, element 9", "triangles"});
}

TEST(TetMeshErrors, some_inverted_tetrahedra_are_refused) {
  expect_refused(changed([](TetMesh& m) { std::swap(m.tets[7][0], m.tets[7][1]); }),
                 {"m.vtk", "tetrahedron 7", "inverted"});
}

TEST(TetMeshErrors, duplicate_tetrahedra_are_refused) {
  expect_refused(changed([](TetMesh& m) {
                   m.tets.push_back(m.tets[3]);
                   m.tet_region.push_back(0);
                 }),
                 {"m.vtk", "duplicate"});
}

TEST(TetMeshErrors, unreferenced_nodes_are_refused) {
  expect_refused(changed([](TetMesh& m) { m.nodes.emplace_back(1, 2, 3); }), {"m.vtk", "node"});
}

TEST(TetMeshErrors, nan_is_refused) {
  expect_refused(changed([](TetMesh& m) { m.nodes[4].y() = NAN; }), {"m.vtk"});
  const auto [nodes, tets] = tetgen_texts(two_region_box());
  const Folder folder;
  write_file(folder / "m.node", replaced(nodes, "\n5  ", "\n5  nan "));
  expect_refused(read_tet_mesh(write_file(folder / "m.ele", tets)), {"m.node, line 7", "'nan' is not a finite number"});
}

TEST(TetMeshErrors, node_numbers_out_of_range_are_refused) {
  expect_refused(read_mesh("m.vtk", replaced(vtk_text(two_region_box()), "\n4 ", "\n4 9999 1 2 3\n4 ")), {"m.vtk"});
  expect_refused(read_mesh("m.msh", replaced(msh22_text(two_region_box()), "\n1 4 2 1 1 1 ", "\n1 4 2 1 1 9999 ")),
                 {"m.msh"});
  const auto [nodes, tets] = tetgen_texts(two_region_box());
  const Folder folder;
  write_file(folder / "m.node", nodes);
  expect_refused(read_tet_mesh(write_file(folder / "m.ele", replaced(tets, "\n2 ", "\n2 999 "))),
                 {"m.ele, line 3", "999", "out of range"});
}

TEST(TetMeshErrors, truncated_files_are_refused) {
  const Folder folder;
  for (const MeshFile& file : write_all_formats(two_region_box(), folder.path())) {
    SCOPED_TRACE(file.what);
    const std::string whole = content_of(file.path);
    for (const double share : {0.3, 0.8}) {
      const std::string name = "cut" + file.path.extension().string();
      write_file(folder / name, whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size()))));
      if (file.path.extension() == ".ele")
        fs::copy_file(folder / "tetgen.node", folder / "cut.node", fs::copy_options::overwrite_existing);
      if (file.path.extension() == ".node")
        fs::copy_file(folder / "tetgen.ele", folder / "cut.ele", fs::copy_options::overwrite_existing);
      expect_refused(read_tet_mesh(folder / name), {"cut"});
    }
  }
}

TEST(TetMeshErrors, meshes_without_tetrahedra_are_refused) {
  const std::string surface =
      "# vtk DataFile Version 3.0\ntriangle\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 3 double\n0 0 0 20 0 0 0 20 0\n"
      "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n";
  expect_refused(read_mesh("s.vtk", surface), {"no tetrahedra", "vtkTriangle", "volume mesh"});
  expect_refused(
      read_mesh("s.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\n"),
      {"no unstructured grid"});
}

TEST(TetMeshErrors, cells_that_begin_outside_the_list_of_nodes_are_refused) {
  expect_refused(
      read_mesh("m.vtk",
                "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n"
                "0 0 0 20 0 0 0 20 0 0 0 20\nCELLS 3 11\n-5\n4 0 1 2 3\n4 0 1 2 3\nCELL_TYPES 3\n10 10 10\n"),
      {"m.vtk", "do not fit their description"});
  for (const char* offsets : {"-4 4 8", "4 3000 8", "4 8 3000", "40000000 4 8"}) {
    SCOPED_TRACE(offsets);
    const std::string xml = fmt::format(
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" "
        "NumberOfCells=\"3\"><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">"
        "0 0 0 20 0 0 0 20 0 0 0 20</DataArray></Points><Cells><DataArray type=\"Int64\" Name=\"connectivity\" "
        "format=\"ascii\">0 1 2 3 0 1 2 3</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">{}"
        "</DataArray><DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10 10 10</DataArray></Cells></Piece>"
        "</UnstructuredGrid></VTKFile>",
        offsets);
    expect_refused(read_mesh("m.vtu", xml), {"m.vtu", "do not fit their description"});
  }
}

TEST(TetMeshErrors, half_a_tetgen_mesh_is_refused) {
  expect_refused(read_mesh("m.ele", tetgen_texts(two_region_box()).second),
                 {"'m.node'", "no such file", "in the same folder"});
  expect_refused(read_mesh("m.node", tetgen_texts(two_region_box()).first), {"'m.ele'", "no such file"});
}

TEST(TetMeshErrors, tetgen_files_in_disorder_are_refused_with_the_line) {
  const auto [nodes, tets] = tetgen_texts(two_region_box());
  const auto read_pair = [](const std::string& n, const std::string& t) {
    const Folder folder;
    write_file(folder / "m.node", n);
    return read_tet_mesh(write_file(folder / "m.ele", t));
  };
  expect_refused(read_pair(replaced(nodes, " 3 0 0", " 2 0 0"), tets), {"m.node, line 2", "first line"});
  expect_refused(read_pair(replaced(nodes, "\n7  ", "\n70  "), tets),
                 {"m.node, line 9", "out of order", "7 is expected"});
  expect_refused(read_pair(nodes, replaced(tets, " 4 1\n", " 5 1\n")), {"m.ele, line 1", "4 or 10"});
  expect_refused(read_pair(nodes, replaced(tets, " 1  # tet", " 1.5  # tet")),
                 {"m.ele, line 2", "1.5", "whole number"});
  expect_refused(read_pair(nodes, replaced(tets, " 1  # tet", " # tet")),
                 {"m.ele, line 2", "5 numbers, 6 are expected"});
}

TEST(TetMeshErrors, scripts_are_never_run) {
  const Folder folder;
  const std::string touch = "SystemCall \"touch " + (folder / "harm").string() + "\";\n";
  const std::string mesh = msh22_text(two_region_box());
  // gmsh would run unknown content as a script.
  for (const auto& [name, text] :
       {std::pair("a.msh", touch + mesh), std::pair("b.geo", touch), std::pair("c.mesh", touch),
        std::pair("d.msh", "$Nonsense\n" + touch), std::pair("e.msh", " " + mesh + touch),
        std::pair("f.msh", std::string("MeshVersionFormatted 2\n") + touch)}) {
    EXPECT_FALSE(read_tet_mesh(write_file(folder / name, text)).ok()) << name;
  }
  write_file(folder / "g.msh.opt", touch);
  expect_refused(read_tet_mesh(write_file(folder / "g.msh", mesh)), {"script 'g.msh.opt'", "Move"});
  EXPECT_FALSE(fs::exists(folder / "harm"));
}

TEST(TetMeshErrors, regions_that_are_no_numbers_are_refused) {
  std::string text = vtk_text(two_region_box());
  text = replaced(text, "SCALARS region int 1", "SCALARS region double 1");
  text = replaced(text, "default\n0\n", "default\n0.5\n");
  expect_refused(read_mesh("m.vtk", text), {"cell 0", "0.5", "whole number"});
}

TEST(TetMeshErrors, other_files_are_named) {
  expect_refused(read_mesh("m.msh", "solid x\nendsolid x\n"), {"an STL surface", "a tetrahedral mesh"});
}
