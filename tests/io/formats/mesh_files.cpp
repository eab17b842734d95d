// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh_files.hpp"

#include "stylet/geom/box_mesh.hpp"
#include "stylet/io/mesh_io.hpp"

#include <gmsh.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace stylet::test {

namespace fs = std::filesystem;

TetMesh two_region_box() {
  TetMesh mesh = box_mesh(Vec3(-20, -15, -15), Vec3(20, 15, 15), {3, 2, 4}, 0.1);
  assign_regions(mesh, {"gland", "body"}, [](const Vec3& x) { return x.z() < 0.0 ? 0 : 1; });
  return mesh;
}

std::string msh22_text(const TetMesh& mesh) {
  std::ostringstream text;
  text.precision(17);
  text << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n" << mesh.regions.size() << '\n';
  for (std::size_t r = 0; r < mesh.regions.size(); ++r) text << "3 " << r + 1 << " \"" << mesh.regions[r] << "\"\n";
  text << "$EndPhysicalNames\n$Nodes\n" << mesh.nodes.size() << '\n';
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) text << a + 1 << ' ' << mesh.nodes[a].transpose() << '\n';
  text << "$EndNodes\n$Elements\n" << mesh.tets.size() << '\n';
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    text << t + 1 << " 4 2 " << mesh.tet_region[t] + 1 << ' ' << mesh.tet_region[t] + 1;
    for (const Index a : mesh.tets[t]) text << ' ' << a + 1;
    text << '\n';
  }
  text << "$EndElements\n";
  return text.str();
}

std::string vtk_text(const TetMesh& mesh) {
  std::ostringstream text;
  text.precision(17);
  text << "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " << mesh.nodes.size()
       << " double\n";
  for (const Vec3& x : mesh.nodes) text << x.transpose() << '\n';
  text << "CELLS " << mesh.tets.size() << ' ' << 5 * mesh.tets.size() << '\n';
  for (const auto& tet : mesh.tets) text << "4 " << tet[0] << ' ' << tet[1] << ' ' << tet[2] << ' ' << tet[3] << '\n';
  text << "CELL_TYPES " << mesh.tets.size() << '\n';
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) text << "10\n";
  text << "CELL_DATA " << mesh.tets.size() << "\nSCALARS region int 1\nLOOKUP_TABLE default\n";
  for (const int region : mesh.tet_region) text << region << '\n';
  return text.str();
}

std::pair<std::string, std::string> tetgen_texts(const TetMesh& mesh, int first) {
  std::ostringstream nodes, tets;
  nodes.precision(17);
  nodes << "# by hand\n" << mesh.nodes.size() << " 3 0 0\n";
  for (std::size_t a = 0; a < mesh.nodes.size(); ++a) nodes << a + first << "  " << mesh.nodes[a].transpose() << '\n';
  tets << mesh.tets.size() << " 4 1\n";
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    tets << t + first;
    for (const Index a : mesh.tets[t]) tets << ' ' << a + first;
    tets << ' ' << mesh.tet_region[t] + 1 << "  # tetrahedron\n";
  }
  return {nodes.str(), tets.str()};
}

namespace {

void write_text(const fs::path& path, const std::string& text) { std::ofstream(path, std::ios::binary) << text; }

/// Converts a file with gmsh.
void write_with_gmsh(const fs::path& from, const fs::path& to, double version, bool binary) {
  gmsh::initialize(0, nullptr, false);
  gmsh::option::setNumber("General.Terminal", 0);
  gmsh::merge(from.string());
  gmsh::option::setNumber("Mesh.MshFileVersion", version);
  gmsh::option::setNumber("Mesh.Binary", binary ? 1 : 0);
  gmsh::option::setNumber("Mesh.SaveElementTagType", 2);  // MEDIT references = physical groups
  gmsh::write(to.string());
  gmsh::finalize();
}

}  // namespace

std::vector<MeshFile> write_all_formats(const TetMesh& mesh, const fs::path& folder) {
  std::vector<MeshFile> files;
  const fs::path by_hand = folder / "hand22.msh";
  write_text(by_hand, msh22_text(mesh));
  files.push_back({"MSH 2.2 ASCII by hand", by_hand, true});
  for (const auto& [name, version, binary] :
       {std::tuple("msh1.msh", 1.0, false), std::tuple("ascii22.msh", 2.2, false),
        std::tuple("binary22.msh", 2.2, true), std::tuple("ascii41.msh", 4.1, false),
        std::tuple("binary41.msh", 4.1, true)}) {
    write_with_gmsh(by_hand, folder / name, version, binary);
    files.push_back({name, folder / name, version > 2.0});
  }
  write_with_gmsh(by_hand, folder / "medit.mesh", 4.1, false);
  files.push_back({"MEDIT", folder / "medit.mesh", false});
  write_text(folder / "legacy.vtk", vtk_text(mesh));
  files.push_back({"legacy VTK ASCII", folder / "legacy.vtk", false});
  write_with_gmsh(by_hand, folder / "binary.vtk", 4.1, true);
  files.push_back({"legacy VTK binary by gmsh", folder / "binary.vtk", false});
  const auto [nodes, tets] = tetgen_texts(mesh);
  write_text(folder / "tetgen.node", nodes);
  write_text(folder / "tetgen.ele", tets);
  files.push_back({"TetGen .ele", folder / "tetgen.ele", false});
  files.push_back({"TetGen .node", folder / "tetgen.node", false});
  if (!write_vtu(mesh, folder / "ours.vtu").ok()) throw std::runtime_error("VTU not written");
  files.push_back({"VTU", folder / "ours.vtu", true});
  return files;
}

}  // namespace stylet::test
