// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/fem/tissue.hpp"

#include "assembly.hpp"
#include "cholesky.hpp"
#include "supports.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <new>

namespace stylet {

struct Tissue::Parts {
  TetMesh mesh;
  std::vector<Material> materials;
  Element element = Element::p1;
  std::unique_ptr<detail::Discretisation> discretisation;
  std::vector<Index> fixed;      // sorted
  std::vector<Index> first_dof;  // (n) first degree of freedom, -1 for a fixed node
  Index free_dofs = 0;
  std::vector<Index> corridor;  // displacement nodes of the corridor that are free
  Eigen::SparseMatrix<double> K;
  detail::Cholesky factor;
  Statistics statistics;
  std::once_flag factor_made;
  std::atomic<bool> has_factor = false;

  /// Assembles K and computes its factor.
  Result<> factorise(const Progress& progress);

  /// Ensures that K and its factor exist. May be called by several threads at once.
  void need_factor() {
    std::call_once(factor_made, [this] {
      if (has_factor) return;
      // It was factorised when its compliance was computed.
      if (auto made = factorise({}); !made) throw std::bad_alloc();
    });
  }

  [[nodiscard]] detail::Discretisation::MaterialOf material_of() const {
    return [this](Index tet) { return materials[mesh.tet_region[tet]]; };
  }
};

namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

Result<> check_materials(const TetMesh& mesh, const std::vector<Material>& materials) {
  if (materials.size() != mesh.regions.size()) {
    return input_error("materials",
                       std::to_string(materials.size()) + " materials are given for " +
                           std::to_string(mesh.regions.size()) + " regions",
                       "Give one material for each region of the mesh, in the same order");
  }
  for (std::size_t r = 0; r < materials.size(); ++r) {
    const std::string where = "material of region '" + mesh.regions[r] + "'";
    const Material& material = materials[r];
    if (!(material.young_MPa > 0.0) || !std::isfinite(material.young_MPa)) {
      return input_error(where, "Young's modulus is " + number(1e3 * material.young_MPa) + " kPa, expected above 0",
                         "Give a modulus above 0; soft tissue has 1 to 500 kPa");
    }
    if (!(material.poisson > -1.0 && material.poisson < 0.5)) {
      return input_error(where, "Poisson ratio is " + number(material.poisson) + ", expected above -1 and below 0.5",
                         "Use 0.45 to 0.49 for nearly incompressible tissue; exactly 0.5 has no finite stiffness");
    }
  }
  return Ok{};
}

// The part of check_mesh() without which assembly would read out of bounds or divide by zero.
Result<> check_usable(const TetMesh& mesh) {
  const auto bad = [](std::string what) {
    return input_error("mesh", std::move(what), "Pass the mesh through check_mesh() first; it names every such fault");
  };
  if (mesh.tets.empty() || mesh.tet_region.size() != mesh.tets.size()) return bad("no tetrahedra, or no regions");
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const std::string name = "tetrahedron " + std::to_string(t);
    for (const Index a : mesh.tets[t]) {
      if (a < 0 || a >= mesh.node_count()) return bad(name + " names node " + std::to_string(a));
    }
    if (mesh.tet_region[t] < 0 || mesh.tet_region[t] >= static_cast<int>(mesh.regions.size())) {
      return bad(name + " names region " + std::to_string(mesh.tet_region[t]));
    }
    if (!(tet_volume(mesh, t) > 0.0)) return bad(name + " has a volume of " + number(tet_volume(mesh, t)) + " mm³");
  }
  return Ok{};
}

}  // namespace

Result<Tissue> Tissue::build_later(TetMesh mesh, std::vector<Material> materials, std::vector<Index> fixed,
                                   Element element, const std::vector<Index>& corridor) {
  if (auto result = check_usable(mesh); !result) return result.error();
  if (auto result = check_materials(mesh, materials); !result) return result.error();

  std::sort(fixed.begin(), fixed.end());
  fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());
  for (const Index a : fixed) {
    if (a < 0 || a >= mesh.node_count()) {
      return input_error("supports",
                         "fixed node number " + std::to_string(a) + " is out of range, expected 0 to " +
                             std::to_string(mesh.node_count() - 1),
                         "Give the numbers of nodes of this mesh");
    }
  }
  if (static_cast<Index>(fixed.size()) == mesh.node_count()) {
    return input_error("supports", "all " + std::to_string(fixed.size()) + " nodes are fixed, so nothing can move",
                       "Fix only the nodes that bone or the body's far surface holds");
  }
  std::vector<char> is_fixed(mesh.nodes.size(), 0);
  for (const Index a : fixed) is_fixed[a] = 1;
  if (auto result = detail::check_supports(mesh, is_fixed); !result) return result.error();

  auto parts = std::make_unique<Parts>();
  parts->mesh = std::move(mesh);
  parts->materials = std::move(materials);
  parts->element = element;
  parts->discretisation = detail::Discretisation::make(element, parts->mesh);
  const detail::Discretisation& discretisation = *parts->discretisation;
  parts->first_dof.assign(static_cast<std::size_t>(discretisation.nodes()), -1);
  for (Index a = 0; a < discretisation.nodes(); ++a) {
    const auto [one, other] = discretisation.ends(a);
    if (is_fixed[one] && is_fixed[other]) {
      parts->fixed.push_back(a);
      continue;
    }
    parts->first_dof[a] = parts->free_dofs;
    parts->free_dofs += 3;
  }

  std::vector<char> near = is_fixed;  // ComplianceStore treats fixed nodes as stored, too
  for (const Index a : corridor) {
    if (a < 0 || a >= parts->mesh.node_count() || near[a]) continue;
    near[a] = 1;
    parts->corridor.push_back(a);
  }
  for (Index a = parts->mesh.node_count(); a < discretisation.nodes(); ++a) {
    const auto [one, other] = discretisation.ends(a);
    if (parts->first_dof[a] >= 0 && near[one] && near[other]) parts->corridor.push_back(a);
  }
  return Tissue(std::move(parts));
}

Result<> Tissue::Parts::factorise(const Progress& progress) {
  report(progress, "assembling", 0.0);
  auto assembled = detail::assemble(*discretisation, mesh.tet_count(), material_of(), first_dof, free_dofs);
  K.swap(assembled.K);
  std::vector<int> last;
  for (const Index a : corridor) last.push_back(first_dof[a] / 3);

  const auto start = std::chrono::steady_clock::now();
  const auto failed = factor.factorise(K, assembled.pattern, last, progress);
  statistics.factor_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  switch (failed) {
    case detail::Cholesky::Failure::none:
      break;
    case detail::Cholesky::Failure::not_positive_definite: {
      const Index column = factor.failed_column() / 3 * 3;
      const auto loose = static_cast<Index>(std::find(first_dof.begin(), first_dof.end(), column) - first_dof.begin());
      const auto [one, other] = discretisation->ends(loose);
      return detail::loose_part(mesh, std::binary_search(fixed.begin(), fixed.end(), one) ? other : one);
    }
    case detail::Cholesky::Failure::out_of_memory:
      return failure("stiffness matrix",
                     "memory ran out while factorising " + std::to_string(free_dofs) + " degrees of freedom",
                     "Use a coarser mesh or a machine with more memory");
    case detail::Cholesky::Failure::too_large:
      return failure("stiffness matrix",
                     "the factor of " + std::to_string(free_dofs) + " degrees of freedom has more than 2³¹ entries",
                     "Use a coarser mesh");
    case detail::Cholesky::Failure::refused:
      return failure("stiffness matrix", "CHOLMOD could not factorise it, status " + std::to_string(factor.status()),
                     "Report this fault of the program together with the mesh");
  }
  statistics.factor_mb = factor.megabytes();
  statistics.factor_entries = factor.entries();
  has_factor = true;
  return Ok{};
}

Result<Tissue> Tissue::build(TetMesh mesh, std::vector<Material> materials, std::vector<Index> fixed,
                             const Progress& progress, Element element, const std::vector<Index>& corridor) {
  auto tissue = build_later(std::move(mesh), std::move(materials), std::move(fixed), element, corridor);
  if (!tissue) return tissue.error();
  if (auto made = tissue->parts_->factorise(progress); !made) return made.error();
  return tissue;
}

Tissue::Tissue(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Tissue::Tissue(Tissue&&) noexcept = default;
Tissue& Tissue::operator=(Tissue&&) noexcept = default;
Tissue::~Tissue() = default;

const TetMesh& Tissue::mesh() const { return parts_->mesh; }
Element Tissue::element() const { return parts_->element; }
const detail::Discretisation& Tissue::discretisation() const { return *parts_->discretisation; }
Index Tissue::displacement_nodes() const { return parts_->discretisation->nodes(); }
std::array<Index, 2> Tissue::ends_of(Index node) const { return parts_->discretisation->ends(node); }
Vec3 Tissue::node_position(Index node) const {
  const auto [one, other] = ends_of(node);
  return 0.5 * (parts_->mesh.nodes[one] + parts_->mesh.nodes[other]);
}
std::span<const Index> Tissue::nodes_of(Index tet) const { return parts_->discretisation->nodes_of(tet); }
Shape Tissue::shape(Index tet, const Vec4& weights) const { return parts_->discretisation->shape(tet, weights); }
ShapeGradients Tissue::shape_gradients(Index tet, const Vec4& weights) const {
  return parts_->discretisation->shape_gradients(tet, weights);
}

const Material& Tissue::material(int region) const { return parts_->materials[region]; }
const std::vector<Material>& Tissue::materials() const { return parts_->materials; }
bool Tissue::is_fixed(Index node) const { return parts_->first_dof[node] < 0; }
const std::vector<Index>& Tissue::fixed_nodes() const { return parts_->fixed; }
Index Tissue::free_dofs() const { return parts_->free_dofs; }
Index Tissue::first_dof(Index node) const { return parts_->first_dof[node]; }
const Eigen::SparseMatrix<double>& Tissue::stiffness() const {
  parts_->need_factor();
  return parts_->K;
}
const std::vector<Index>& Tissue::corridor() const { return parts_->corridor; }
bool Tissue::has_factor() const { return parts_->has_factor; }
MatX Tissue::compliance_of_corridor(const Progress& progress) const {
  parts_->need_factor();
  return parts_->factor.inverse_of_last(progress);
}
const Tissue::Statistics& Tissue::statistics() const { return parts_->statistics; }

MatX Tissue::solve(const MatX& f) const {
  assert(f.rows() == 3 * Eigen::Index{displacement_nodes()});
  parts_->need_factor();
  const auto& first = parts_->first_dof;
  MatX free(parts_->free_dofs, f.cols());
  for (Index a = 0; a < displacement_nodes(); ++a) {
    if (first[a] >= 0) free.middleRows<3>(first[a]) = f.middleRows<3>(3 * Eigen::Index{a});
  }
  free = parts_->factor.solve(free);
  MatX u = MatX::Zero(f.rows(), f.cols());
  for (Index a = 0; a < displacement_nodes(); ++a) {
    if (first[a] >= 0) u.middleRows<3>(3 * Eigen::Index{a}) = free.middleRows<3>(first[a]);
  }
  return u;
}

VecX Tissue::support_forces(const VecX& u) const {
  assert(u.size() == 3 * Eigen::Index{displacement_nodes()});
  std::vector<char> held(parts_->first_dof.size());
  for (std::size_t a = 0; a < held.size(); ++a) held[a] = parts_->first_dof[a] < 0 ? 1 : 0;
  return parts_->discretisation->forces(parts_->material_of(), u, held);
}

MatX Tissue::stress(const VecX& u) const {
  if (u.size() < 3 * Eigen::Index{displacement_nodes()}) {
    return detail::Discretisation::make(Element::nodal_pressure, mesh())->stress(parts_->material_of(), u);
  }
  assert(u.size() == 3 * Eigen::Index{displacement_nodes()});
  return parts_->discretisation->stress(parts_->material_of(), u);
}

}  // namespace stylet
