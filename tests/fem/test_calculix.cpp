// SPDX-License-Identifier: GPL-3.0-or-later
#include "bodies.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include <unistd.h>

namespace stylet {
namespace {

namespace fs = std::filesystem;

// CalculiX reads at most 20 characters of a number.
std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12e", value);
  return text;
}

// The problem in CalculiX's input language, the same elements, materials, loads and supports; displacements are printed
// with *NODE PRINT, which keeps seven digits.
void write_input(const fs::path& file, const TetMesh& mesh, const std::vector<Material>& materials,
                 const std::vector<Index>& fixed, const VecX& f) {
  std::ofstream out(file);
  out << "*NODE, NSET=ALL\n";
  for (Index a = 0; a < mesh.node_count(); ++a) {
    const Vec3& x = mesh.nodes[a];
    out << a + 1 << ", " << digits(x[0]) << ", " << digits(x[1]) << ", " << digits(x[2]) << '\n';
  }
  for (std::size_t r = 0; r < materials.size(); ++r) {
    out << "*ELEMENT, TYPE=C3D4, ELSET=R" << r << '\n';
    for (Index t = 0; t < mesh.tet_count(); ++t) {
      if (mesh.tet_region[t] != static_cast<int>(r)) continue;
      out << t + 1;
      for (const Index a : mesh.tets[t]) out << ", " << a + 1;
      out << '\n';
    }
    out << "*MATERIAL, NAME=M" << r << "\n*ELASTIC\n"
        << digits(materials[r].young_MPa) << ", " << digits(materials[r].poisson) << "\n*SOLID SECTION, ELSET=R" << r
        << ", MATERIAL=M" << r << '\n';
  }
  out << "*BOUNDARY\n";
  for (const Index a : fixed) out << a + 1 << ", 1, 3\n";
  out << "*STEP\n*STATIC\n*CLOAD\n";
  for (Index a = 0; a < mesh.node_count(); ++a) {
    for (int axis = 0; axis < 3; ++axis) {
      const double force = f[3 * Eigen::Index{a} + axis];
      if (force != 0.0) out << a + 1 << ", " << axis + 1 << ", " << digits(force) << '\n';
    }
  }
  out << "*NODE PRINT, NSET=ALL\nU\n*END STEP\n";
}

// Displacements from the .dat file: after a heading, lines of node number and three values.
VecX read_displacements(const fs::path& file, Index nodes) {
  VecX u = VecX::Constant(3 * Eigen::Index{nodes}, std::nan(""));
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    Index node = 0;
    Vec3 value;
    if (words >> node >> value[0] >> value[1] >> value[2] && node >= 1 && node <= nodes) {
      u.segment<3>(3 * Eigen::Index{node - 1}) = value;
    }
  }
  return u;
}

TEST(CalculiX, ComputesTheSameDisplacements) {
  if (std::system("command -v ccx >/dev/null 2>&1") != 0) {
    GTEST_SKIP() << "CalculiX (ccx) is not installed; Debian package calculix-ccx";
  }
  TetMesh mesh = box_mesh({-30, -20, 40}, {30, 30, 110}, {8, 7, 9}, 0.15);
  assign_regions(mesh, {"fat", "gland"}, [](const Vec3& x) { return (x - Vec3(0, 5, 75)).norm() > 22 ? 0 : 1; });
  ASSERT_GT(std::count(mesh.tet_region.begin(), mesh.tet_region.end(), 1), 100);
  const std::vector<Material> materials{{0.008, 0.45}, {0.060, 0.40}};
  const auto fixed = test::nodes_where(mesh, [](const Vec3& x) { return x.z() == 40.0 || x.y() == -20.0; });

  // A press on the top and pushes and pulls at a third of the free nodes.
  VecX f = VecX::Zero(3 * Eigen::Index{mesh.node_count()});
  std::mt19937 random(11);
  for (Index a = 0; a < mesh.node_count(); ++a) {
    if (std::binary_search(fixed.begin(), fixed.end(), a)) continue;
    if (mesh.nodes[a].z() == 110.0) f[3 * Eigen::Index{a} + 2] -= 0.01;
    if (a % 3 != 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      f[3 * Eigen::Index{a} + axis] += 0.02 * (static_cast<double>(random()) / 4294967296.0 - 0.5);
    }
  }

  const fs::path folder = fs::temp_directory_path() / ("stylet-calculix-" + std::to_string(getpid()));
  fs::create_directories(folder);
  write_input(folder / "case.inp", mesh, materials, fixed, f);
  const std::string command = "cd '" + folder.string() + "' && OMP_NUM_THREADS=1 ccx -i case > case.log 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0) << "see " << folder / "case.log";
  const VecX theirs = read_displacements(folder / "case.dat", mesh.node_count());
  ASSERT_TRUE(theirs.allFinite()) << "see " << folder / "case.dat";

  const VecX ours = test::build(mesh, materials, fixed).solve(f);
  const double difference = (ours - theirs).norm() / ours.norm();
  std::printf("%d nodes, largest displacement %.3f mm, relative difference %.2g\n", mesh.node_count(),
              ours.cwiseAbs().maxCoeff(), difference);
  EXPECT_LT(difference, 1e-6);
  EXPECT_LT((ours - theirs).cwiseAbs().maxCoeff(), 1e-6 * ours.cwiseAbs().maxCoeff());
  fs::remove_all(folder);
}

}  // namespace
}  // namespace stylet
