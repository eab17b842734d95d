// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/evidence/validate/calculix.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>

namespace stylet::validate {
namespace fs = std::filesystem;

namespace {

/// A temporary folder that is removed by its destructor.
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

/// Reads the increments of a .dat file. Each has a heading that ends in its time, 0…1, then lines with a node number
/// and three values. Missing displacements are NaN.
std::vector<LoadedMoment> read_moments(const fs::path& file, Index nodes) {
  std::vector<LoadedMoment> moments;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    constexpr std::string_view time = "and time";
    if (const auto at = line.find(time); at != std::string::npos) {
      std::istringstream rest(line.substr(at + time.size()));
      LoadedMoment moment{.share = 0.0, .u = VecX::Constant(3 * Eigen::Index{nodes}, std::nan(""))};
      if (rest >> moment.share) moments.push_back(std::move(moment));
      continue;
    }
    std::istringstream words(line);
    Index node = 0;
    Vec3 value;
    if (!moments.empty() && words >> node >> value[0] >> value[1] >> value[2] && node >= 1 && node <= nodes)
      moments.back().u.segment<3>(3 * Eigen::Index{node - 1}) = value;
  }
  return moments;
}

/// Solves a deck with ccx. The exit status is ignored. @return the increments that it printed completely
Result<std::vector<LoadedMoment>> run_calculix(const Tissue& tissue, const std::string& deck) {
  if (!calculix_installed())
    return failure("CalculiX", "the program ccx is not installed", "Install the Debian package calculix-ccx");
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "case.inp";
  std::ofstream(file) << deck << std::flush;
  const std::string command =
      fmt::format("cd '{}' && OMP_NUM_THREADS=1 ccx -i case >case.log 2>&1 </dev/null", folder.path().string());
  std::vector<LoadedMoment> moments;
  if (!folder.path().empty() && fs::exists(file) && std::system(command.c_str()) != -1)
    moments = read_moments(folder.path() / "case.dat", tissue.displacement_nodes());
  while (!moments.empty() && !moments.back().u.allFinite()) moments.pop_back();
  if (moments.empty())
    return failure("CalculiX", "ccx did not print all displacements",
                   "Run ccx on the input of calculix_deck() to see why");
  return moments;
}

std::string material_text(const Material& material, Geometry geometry) {
  if (geometry == Geometry::linear)
    return fmt::format("*ELASTIC\n{}, {}\n", digits(material.young_MPa), digits(material.poisson));
  const double bulk_MPa = material.lambda() + 2.0 / 3.0 * material.mu();
  return fmt::format("*HYPERELASTIC, NEO HOOKE\n{}, {}\n", digits(0.5 * material.mu()), digits(2.0 / bulk_MPa));
}

/// Increments of 1/8 of the load; where they do not converge, CalculiX reduces them to 1/500 at least.
constexpr const char* kFiniteStep = "*STEP, NLGEOM, INC=60\n*STATIC\n0.125, 1., 0.002, 0.125\n";

}  // namespace

bool calculix_installed() { return std::system("command -v ccx >/dev/null 2>&1") == 0; }

std::string calculix_deck(const Tissue& tissue, const VecX& f, Geometry geometry) {
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
    deck += fmt::format("*MATERIAL, NAME=M{0}\n{1}*SOLID SECTION, ELSET=R{0}, MATERIAL=M{0}\n", r,
                        material_text(material, geometry));
  }
  deck += "*BOUNDARY\n";
  for (const Index a : tissue.fixed_nodes()) deck += fmt::format("{}, 1, 3\n", a + 1);
  deck += geometry == Geometry::linear ? "*STEP\n*STATIC\n" : kFiniteStep;
  deck += "*CLOAD\n";
  for (Eigen::Index i = 0; i < f.size(); ++i)
    if (f[i] != 0.0) deck += fmt::format("{}, {}, {}\n", i / 3 + 1, i % 3 + 1, digits(f[i]));
  return deck + "*NODE PRINT, NSET=ALL\nU\n*END STEP\n";
}

Result<VecX> solve_with_calculix(const Tissue& tissue, const VecX& f) {
  auto moments = run_calculix(tissue, calculix_deck(tissue, f));
  if (!moments) return moments.error();
  return std::move(moments->back().u);
}

Result<std::vector<LoadedMoment>> load_with_calculix(const Tissue& tissue, const VecX& f) {
  return run_calculix(tissue, calculix_deck(tissue, f, Geometry::finite));
}

}  // namespace stylet::validate
