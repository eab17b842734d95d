// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/validate/calculix.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace stylet::validate {
namespace fs = std::filesystem;

namespace {

/// A folder that goes when its owner does.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "stylet-calculix-XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// CalculiX reads at most 20 characters of a number.
std::string digits(double value) { return fmt::format("{:.12e}", value); }

/// Displacements from the .dat file: after a heading, lines of node number and three values; NaN where there is none.
VecX read_displacements(const fs::path& file, Index nodes) {
  VecX u = VecX::Constant(3 * Eigen::Index{nodes}, std::nan(""));
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    Index node = 0;
    Vec3 value;
    if (words >> node >> value[0] >> value[1] >> value[2] && node >= 1 && node <= nodes)
      u.segment<3>(3 * Eigen::Index{node - 1}) = value;
  }
  return u;
}

}  // namespace

bool calculix_installed() { return std::system("command -v ccx >/dev/null 2>&1") == 0; }

std::string calculix_deck(const Tissue& tissue, const VecX& f) {
  const TetMesh& mesh = tissue.mesh();
  std::string deck = "*NODE, NSET=ALL\n";
  for (Index a = 0; a < tissue.displacement_nodes(); ++a) {
    const Vec3 x = tissue.node_position(a);
    deck += fmt::format("{}, {}, {}, {}\n", a + 1, digits(x[0]), digits(x[1]), digits(x[2]));
  }
  const char* type = tissue.element() == Element::p2 ? "C3D10" : "C3D4";
  for (std::size_t r = 0; r < tissue.materials().size(); ++r) {
    deck += fmt::format("*ELEMENT, TYPE={}, ELSET=R{}\n", type, r);
    for (Index t = 0; t < mesh.tet_count(); ++t) {
      if (mesh.tet_region[static_cast<std::size_t>(t)] != static_cast<int>(r)) continue;
      deck += std::to_string(t + 1);
      for (const Index a : tissue.nodes_of(t)) deck += fmt::format(", {}", a + 1);
      deck += '\n';
    }
    const Material& material = tissue.material(static_cast<int>(r));
    deck += fmt::format("*MATERIAL, NAME=M{0}\n*ELASTIC\n{1}, {2}\n*SOLID SECTION, ELSET=R{0}, MATERIAL=M{0}\n", r,
                        digits(material.young_MPa), digits(material.poisson));
  }
  deck += "*BOUNDARY\n";
  for (const Index a : tissue.fixed_nodes()) deck += fmt::format("{}, 1, 3\n", a + 1);
  deck += "*STEP\n*STATIC\n*CLOAD\n";
  for (Eigen::Index i = 0; i < f.size(); ++i)
    if (f[i] != 0.0) deck += fmt::format("{}, {}, {}\n", i / 3 + 1, i % 3 + 1, digits(f[i]));
  return deck + "*NODE PRINT, NSET=ALL\nU\n*END STEP\n";
}

Result<VecX> solve_with_calculix(const Tissue& tissue, const VecX& f) {
  if (!calculix_installed())
    return failure("CalculiX", "the program ccx is not there", "Install the Debian package calculix-ccx");
  const TemporaryFolder folder;
  const fs::path deck = folder.path() / "case.inp";
  std::ofstream(deck) << calculix_deck(tissue, f) << std::flush;
  const std::string command =
      fmt::format("cd '{}' && OMP_NUM_THREADS=1 ccx -i case >case.log 2>&1 </dev/null", folder.path().string());
  if (folder.path().empty() || !fs::exists(deck) || std::system(command.c_str()) != 0)
    return failure("CalculiX", "ccx did not end well", "Run a deck of its own to see why");
  VecX u = read_displacements(folder.path() / "case.dat", tissue.displacement_nodes());
  if (!u.allFinite())
    return failure("CalculiX", "ccx printed no displacement for some nodes",
                   "Check that its version knows *NODE PRINT");
  return u;
}

}  // namespace stylet::validate
