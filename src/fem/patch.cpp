// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/fem/patch.hpp"

#include "blas_threads.hpp"
#include "discretisation.hpp"

#include <algorithm>
#include <stdexcept>

extern "C" {
void dposv_(const char* uplo, const int* n, const int* nrhs, double* a, const int* lda, double* b, const int* ldb,
            int* info);
}

namespace stylet {

Patch make_patch(const Tissue& tissue, std::span<const Index> tets, std::span<const Index> nodes,
                 const std::vector<char>& moves, const Material& material) {
  Patch patch;
  std::vector<Eigen::Index> row(nodes.size());  // row in K of each node, in the given order
  for (const bool moving : {true, false}) {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if ((moves[k] != 0) != moving) continue;
      row[k] = 3 * static_cast<Eigen::Index>(patch.nodes.size());
      patch.nodes.push_back(nodes[k]);
      if (moving) ++patch.moving;
    }
  }
  const Eigen::Index inside = 3 * Eigen::Index{patch.moving};
  patch.K = MatX::Zero(inside, 3 * static_cast<Eigen::Index>(nodes.size()));
  std::vector<Eigen::Index> rows;
  tissue.discretisation().stiffness(
      tets, [&](Index /*tet*/) { return material; },
      [&](std::span<const Index> of_part, const MatX& part) {
        rows.resize(of_part.size());
        std::transform(of_part.begin(), of_part.end(), rows.begin(), [&](Index node) {
          return row[static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin())];
        });
        for (std::size_t a = 0; a < rows.size(); ++a) {
          for (std::size_t b = 0; b <= a; ++b) {
            // Blocks between two moving nodes are added once, below the diagonal; blocks between a moving node and a
            // held one go into the row of the moving node.
            const auto block = part.block<3, 3>(static_cast<Eigen::Index>(3 * a), static_cast<Eigen::Index>(3 * b));
            if (rows[a] < inside && (rows[b] >= inside || rows[b] <= rows[a])) {
              patch.K.block<3, 3>(rows[a], rows[b]) += block;
            } else if (rows[b] < inside) {
              patch.K.block<3, 3>(rows[b], rows[a]) += block.transpose();
            }
          }
        }
      });
  for (Eigen::Index column = 0; column < inside; ++column) {
    for (Eigen::Index i = 0; i < column; ++i) patch.K(i, column) = patch.K(column, i);
  }
  return patch;
}

MatX Patch::displacements(const MatX& given, MatX forces) const {
  const Eigen::Index inside = 3 * Eigen::Index{moving};
  if (inside == 0) return forces;
  forces.noalias() -= K.rightCols(K.cols() - inside) * given;
  MatX factor = K.leftCols(inside);
  const auto n = static_cast<int>(inside);
  const auto loads = static_cast<int>(forces.cols());
  int info = 0;
  const detail::OneBlasThread one_thread;
  dposv_("L", &n, &loads, factor.data(), &n, forces.data(), &n, &info);
  if (info != 0) throw std::logic_error("the stiffness of a patch is not positive definite");
  return forces;
}

}  // namespace stylet
