// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/fem/tissue.hpp"

#include "cholesky.hpp"
#include "supports.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace stylet {

struct Tissue::Parts {
  TetMesh mesh;
  std::vector<Material> materials;
  std::vector<Index> fixed;      // sorted
  std::vector<Index> first_dof;  // (n), -1 fixed
  Index free_dofs = 0;
  Eigen::SparseMatrix<double> K;
  detail::Cholesky factor;
  Statistics statistics;
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
                       "Give one material for each region of the mesh, in the same order.");
  }
  for (std::size_t r = 0; r < materials.size(); ++r) {
    const std::string where = "material of region '" + mesh.regions[r] + "'";
    const Material& material = materials[r];
    if (!(material.young_MPa > 0.0) || !std::isfinite(material.young_MPa)) {
      return input_error(where, "Young's modulus is " + number(1e3 * material.young_MPa) + " kPa, expected above 0",
                         "Soft tissue has 1 to 500 kPa.");
    }
    if (!(material.poisson > -1.0 && material.poisson < 0.5)) {
      return input_error(where, "Poisson ratio is " + number(material.poisson) + ", expected above -1 and below 0.5",
                         "Use 0.45 to 0.49 for nearly incompressible tissue; exactly 0.5 has no finite stiffness.");
    }
  }
  return Ok{};
}

// The little of check_mesh() without which assembly would read out of bounds or divide by zero.
Result<> check_usable(const TetMesh& mesh) {
  const auto bad = [](std::string what) {
    return input_error("mesh", std::move(what), "Pass the mesh through check_mesh() first; it names every such fault.");
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

// Pattern of neighbouring free nodes, diagonal included, in free-node numbers; rows ascending in each column.
Eigen::SparseMatrix<double> node_pattern(const TetMesh& mesh, const std::vector<Index>& first_dof, Index free_nodes) {
  std::vector<std::vector<Index>> neighbours(free_nodes);
  for (const auto& tet : mesh.tets) {
    for (const Index a : tet) {
      if (first_dof[a] < 0) continue;
      auto& list = neighbours[first_dof[a] / 3];
      for (const Index b : tet) {
        if (first_dof[b] >= 0) list.push_back(first_dof[b] / 3);
      }
    }
  }
  Eigen::SparseMatrix<double> pattern(free_nodes, free_nodes);
  Index total = 0;
  for (auto& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    total += static_cast<Index>(list.size());
  }
  pattern.resizeNonZeros(total);
  Index at = 0;
  for (Index column = 0; column < free_nodes; ++column) {
    pattern.outerIndexPtr()[column] = at;
    for (const Index row : neighbours[column]) {
      pattern.innerIndexPtr()[at] = row;
      pattern.valuePtr()[at++] = 1.0;
    }
  }
  pattern.outerIndexPtr()[free_nodes] = at;
  return pattern;
}

// K on the free degrees of freedom. Each pair of nodes is summed once and mirrored, so K is symmetric to the last bit.
Eigen::SparseMatrix<double> assemble(const TetMesh& mesh, const std::vector<Material>& materials,
                                     const std::vector<Index>& first_dof, const Eigen::SparseMatrix<double>& pattern) {
  const auto* begin = pattern.outerIndexPtr();
  const auto* rows = pattern.innerIndexPtr();
  const auto free_nodes = static_cast<Index>(pattern.cols());

  Eigen::SparseMatrix<double> K(3 * free_nodes, 3 * free_nodes);
  const Eigen::Index entries = 9 * pattern.nonZeros();
  K.resizeNonZeros(entries);
  for (Index column = 0; column < free_nodes; ++column) {
    const Index count = begin[column + 1] - begin[column];
    for (int axis = 0; axis < 3; ++axis) {
      const Index at = 9 * begin[column] + 3 * axis * count;
      K.outerIndexPtr()[3 * column + axis] = at;
      for (Index i = 0; i < count; ++i) {
        for (int k = 0; k < 3; ++k) K.innerIndexPtr()[at + 3 * i + k] = 3 * rows[begin[column] + i] + k;
      }
    }
  }
  K.outerIndexPtr()[3 * free_nodes] = static_cast<int>(entries);
  std::fill_n(K.valuePtr(), entries, 0.0);

  const auto add = [&](Index row, Index column, const Mat3& block) {
    const Index count = begin[column + 1] - begin[column];
    const auto position = static_cast<Index>(std::lower_bound(rows + begin[column], rows + begin[column + 1], row) -
                                             (rows + begin[column]));
    double* value = K.valuePtr() + 9 * begin[column] + 3 * position;
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) value[3 * j * count + i] += block(i, j);
    }
  };
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const auto gradients = barycentric_gradients(mesh, t);
    const double volume = tet_volume(mesh, t);
    const Material& material = materials[mesh.tet_region[t]];
    for (int a = 0; a < 4; ++a) {
      const Index row = first_dof[mesh.tets[t][a]];
      if (row < 0) continue;
      add(row / 3, row / 3, element_block(gradients, volume, material, a, a));
      for (int b = a + 1; b < 4; ++b) {
        const Index column = first_dof[mesh.tets[t][b]];
        if (column < 0) continue;
        const Mat3 block = element_block(gradients, volume, material, a, b);
        add(row / 3, column / 3, block);
        add(column / 3, row / 3, block.transpose());
      }
    }
  }
  return K;
}

Eigen::Matrix<double, 3, 4> nodal_values(const TetMesh& mesh, Index t, const VecX& u) {
  Eigen::Matrix<double, 3, 4> values;
  for (int a = 0; a < 4; ++a) values.col(a) = u.segment<3>(3 * Eigen::Index{mesh.tets[t][a]});
  return values;
}

// Cauchy stress from the nodal displacements of one element: λ tr(ε) I + 2 μ ε.
Mat3 element_stress(const Eigen::Matrix<double, 3, 4>& gradients, const Eigen::Matrix<double, 3, 4>& u,
                    const Material& material) {
  const Mat3 grad = u * gradients.transpose();
  const Mat3 strain = 0.5 * (grad + grad.transpose());
  return material.lambda() * strain.trace() * Mat3::Identity() + 2.0 * material.mu() * strain;
}

}  // namespace

Mat3 element_block(const Eigen::Matrix<double, 3, 4>& gradients, double volume, const Material& material, int a,
                   int b) {
  const Vec3 ga = gradients.col(a);
  const Vec3 gb = gradients.col(b);
  const double lambda = volume * material.lambda();
  const double mu = volume * material.mu();
  // Products of gradients first: then exchanging a and b transposes the block to the last bit.
  Mat3 block;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) block(i, j) = lambda * (ga[i] * gb[j]) + mu * (gb[i] * ga[j]);
  }
  block.diagonal().array() += mu * ga.dot(gb);
  return block;
}

Result<Tissue> Tissue::build(TetMesh mesh, std::vector<Material> materials, std::vector<Index> fixed,
                             const Progress& progress) {
  if (auto result = check_usable(mesh); !result) return result.error();
  if (auto result = check_materials(mesh, materials); !result) return result.error();

  std::sort(fixed.begin(), fixed.end());
  fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());
  for (const Index a : fixed) {
    if (a < 0 || a >= mesh.node_count()) {
      return input_error("supports",
                         "fixed node number " + std::to_string(a) + " is out of range, expected 0 to " +
                             std::to_string(mesh.node_count() - 1),
                         "Name nodes of this mesh.");
    }
  }
  if (static_cast<Index>(fixed.size()) == mesh.node_count()) {
    return input_error("supports", "all " + std::to_string(fixed.size()) + " nodes are fixed, so nothing can move",
                       "Fix only the nodes that bone or the body's far surface holds.");
  }
  std::vector<char> is_fixed(mesh.nodes.size(), 0);
  for (const Index a : fixed) is_fixed[a] = 1;
  if (auto result = detail::check_supports(mesh, is_fixed); !result) return result.error();

  auto parts = std::make_unique<Parts>();
  parts->first_dof.assign(mesh.nodes.size(), -1);
  for (Index a = 0; a < mesh.node_count(); ++a) {
    if (is_fixed[a]) continue;
    parts->first_dof[a] = parts->free_dofs;
    parts->free_dofs += 3;
  }

  report(progress, "assembling", 0.0);
  const auto pattern = node_pattern(mesh, parts->first_dof, parts->free_dofs / 3);
  parts->K = assemble(mesh, materials, parts->first_dof, pattern);

  const auto start = std::chrono::steady_clock::now();
  const auto failed = parts->factor.factorise(parts->K, pattern, progress);
  parts->statistics.factor_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  switch (failed) {
    case detail::Cholesky::Failure::none:
      break;
    case detail::Cholesky::Failure::not_positive_definite: {
      const Index column = parts->factor.failed_column() / 3 * 3;
      const auto& dofs = parts->first_dof;
      return detail::loose_part(mesh, static_cast<Index>(std::find(dofs.begin(), dofs.end(), column) - dofs.begin()));
    }
    case detail::Cholesky::Failure::out_of_memory:
      return failure("stiffness matrix",
                     "memory ran out while factorising " + std::to_string(parts->free_dofs) + " degrees of freedom",
                     "Use a coarser mesh or a machine with more memory.");
    case detail::Cholesky::Failure::too_large:
      return failure(
          "stiffness matrix",
          "the factor of " + std::to_string(parts->free_dofs) + " degrees of freedom has more than 2³¹ entries",
          "Use a coarser mesh.");
    case detail::Cholesky::Failure::refused:
      return failure("stiffness matrix", "CHOLMOD refused it with status " + std::to_string(parts->factor.status()),
                     "This is a fault of the program: please report it with the mesh.");
  }
  parts->statistics.factor_mb = parts->factor.megabytes();
  parts->statistics.factor_entries = parts->factor.entries();
  parts->mesh = std::move(mesh);
  parts->materials = std::move(materials);
  parts->fixed = std::move(fixed);
  return Tissue(std::move(parts));
}

Tissue::Tissue(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Tissue::Tissue(Tissue&&) noexcept = default;
Tissue& Tissue::operator=(Tissue&&) noexcept = default;
Tissue::~Tissue() = default;

const TetMesh& Tissue::mesh() const { return parts_->mesh; }
Index Tissue::displacement_nodes() const { return parts_->mesh.node_count(); }
Vec3 Tissue::node_position(Index node) const { return parts_->mesh.nodes[node]; }
std::span<const Index> Tissue::nodes_of(Index tet) const { return parts_->mesh.tets[tet]; }

Shape Tissue::shape(Index tet, const Vec4& weights) const {
  Shape shape;
  shape.count = 4;
  for (int i = 0; i < 4; ++i) {
    shape.node[i] = parts_->mesh.tets[tet][i];
    shape.weight[i] = weights[i];
  }
  return shape;
}

ShapeGradients Tissue::shape_gradients(Index tet, const Vec4& /*weights*/) const {
  ShapeGradients shape;
  shape.count = 4;
  shape.gradient.leftCols<4>() = barycentric_gradients(parts_->mesh, tet);
  for (int i = 0; i < 4; ++i) shape.node[i] = parts_->mesh.tets[tet][i];
  return shape;
}

const Material& Tissue::material(int region) const { return parts_->materials[region]; }
const std::vector<Material>& Tissue::materials() const { return parts_->materials; }
bool Tissue::is_fixed(Index node) const { return parts_->first_dof[node] < 0; }
const std::vector<Index>& Tissue::fixed_nodes() const { return parts_->fixed; }
Index Tissue::free_dofs() const { return parts_->free_dofs; }
Index Tissue::first_dof(Index node) const { return parts_->first_dof[node]; }
const Eigen::SparseMatrix<double>& Tissue::stiffness() const { return parts_->K; }
const Tissue::Statistics& Tissue::statistics() const { return parts_->statistics; }

MatX Tissue::solve(const MatX& f) const {
  assert(f.rows() == 3 * Eigen::Index{mesh().node_count()});
  const auto& first = parts_->first_dof;
  MatX free(parts_->free_dofs, f.cols());
  for (Index a = 0; a < mesh().node_count(); ++a) {
    if (first[a] >= 0) free.middleRows<3>(first[a]) = f.middleRows<3>(3 * Eigen::Index{a});
  }
  free = parts_->factor.solve(free);
  MatX u = MatX::Zero(f.rows(), f.cols());
  for (Index a = 0; a < mesh().node_count(); ++a) {
    if (first[a] >= 0) u.middleRows<3>(3 * Eigen::Index{a}) = free.middleRows<3>(first[a]);
  }
  return u;
}

VecX Tissue::support_forces(const VecX& u) const {
  VecX forces = VecX::Zero(u.size());
  for (Index t = 0; t < mesh().tet_count(); ++t) {
    const auto& tet = mesh().tets[t];
    if (std::none_of(tet.begin(), tet.end(), [this](Index a) { return is_fixed(a); })) continue;
    const auto gradients = barycentric_gradients(mesh(), t);
    const Mat3 stress = element_stress(gradients, nodal_values(mesh(), t, u), material(mesh().tet_region[t]));
    // Nodal forces of a linear tetrahedron are V σ g_a: K's rows times u.
    const double volume = tet_volume(mesh(), t);
    for (int a = 0; a < 4; ++a) {
      if (is_fixed(tet[a])) forces.segment<3>(3 * Eigen::Index{tet[a]}) += volume * stress * gradients.col(a);
    }
  }
  return forces;
}

MatX Tissue::stress(const VecX& u) const {
  MatX stresses(6, mesh().tet_count());
  for (Index t = 0; t < mesh().tet_count(); ++t) {
    const Mat3 s =
        element_stress(barycentric_gradients(mesh(), t), nodal_values(mesh(), t, u), material(mesh().tet_region[t]));
    stresses.col(t) << s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(2, 0);
  }
  return stresses;
}

}  // namespace stylet
