// SPDX-License-Identifier: GPL-3.0-or-later
#include "assembly.hpp"

#include <algorithm>
#include <numeric>

namespace stylet::detail {
namespace {

// Pattern of neighbouring free nodes including the diagonal, with ascending rows in each column.
Eigen::SparseMatrix<double> compressed(std::vector<std::vector<Index>>& neighbours) {
  const auto free_nodes = static_cast<Index>(neighbours.size());
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

// A zero matrix with a 3 × 3 block for every entry of the pattern.
Eigen::SparseMatrix<double> expanded(const Eigen::SparseMatrix<double>& pattern) {
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
  return K;
}

}  // namespace

Assembled assemble(const Discretisation& discretisation, Index tets, const Discretisation::MaterialOf& material,
                   const std::vector<Index>& first_dof, Index free_dofs) {
  std::vector<Index> all(tets);
  std::iota(all.begin(), all.end(), 0);

  std::vector<std::vector<Index>> neighbours(free_dofs / 3);
  discretisation.parts(all, material, [&](std::span<const Index> nodes) {
    for (const Index a : nodes) {
      if (first_dof[a] < 0) continue;
      auto& list = neighbours[first_dof[a] / 3];
      for (const Index b : nodes) {
        if (first_dof[b] >= 0) list.push_back(first_dof[b] / 3);
      }
    }
  });
  Assembled result;
  result.pattern = compressed(neighbours);
  result.K = expanded(result.pattern);

  const auto* begin = result.pattern.outerIndexPtr();
  const auto* rows = result.pattern.innerIndexPtr();
  const auto add = [&](Index row, Index column, const Mat3& block) {
    const Index count = begin[column + 1] - begin[column];
    const auto position = static_cast<Index>(std::lower_bound(rows + begin[column], rows + begin[column + 1], row) -
                                             (rows + begin[column]));
    double* value = result.K.valuePtr() + 9 * begin[column] + 3 * position;
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) value[3 * j * count + i] += block(i, j);
    }
  };
  // Each pair of nodes is summed once and then mirrored, so K is symmetric to the last bit.
  discretisation.stiffness(all, material, [&](std::span<const Index> nodes, const Eigen::Ref<const MatX>& part) {
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const Index row = first_dof[nodes[a]];
      if (row < 0) continue;
      const auto i = static_cast<Eigen::Index>(3 * a);
      const Mat3 own = part.block<3, 3>(i, i);
      add(row / 3, row / 3, own);
      for (std::size_t b = 0; b < a; ++b) {
        const Index column = first_dof[nodes[b]];
        if (column < 0) continue;
        const Mat3 block = part.block<3, 3>(i, static_cast<Eigen::Index>(3 * b));
        add(row / 3, column / 3, block);
        add(column / 3, row / 3, block.transpose());
      }
    }
  });
  return result;
}

}  // namespace stylet::detail
