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

void Patch::assemble(const Tissue& tissue, std::span<const Index> tets, std::span<const Index> nodes,
                     const std::vector<char>& moves, const Material& material) {
  nodes_.clear();
  moving_ = 0;
  row_.resize(nodes.size());
  for (const bool moving : {true, false}) {
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if ((moves[k] != 0) != moving) continue;
      row_[k] = 3 * static_cast<Eigen::Index>(nodes_.size());
      nodes_.push_back(nodes[k]);
      if (moving) ++moving_;
    }
  }
  const Eigen::Index inside = 3 * Eigen::Index{moving_};
  K_.assign(static_cast<std::size_t>(inside) * 3 * nodes.size(), 0.0);
  Eigen::Map<MatX> K(K_.data(), inside, 3 * static_cast<Eigen::Index>(nodes.size()));
  tissue.discretisation().stiffness(
      tets, [&](Index /*tet*/) { return material; },
      [&](std::span<const Index> of_part, const Eigen::Ref<const MatX>& part) {
        rows_.resize(of_part.size());
        std::transform(of_part.begin(), of_part.end(), rows_.begin(), [&](Index node) {
          return row_[static_cast<std::size_t>(std::lower_bound(nodes.begin(), nodes.end(), node) - nodes.begin())];
        });
        for (std::size_t a = 0; a < rows_.size(); ++a) {
          for (std::size_t b = 0; b <= a; ++b) {
            // Blocks between two moving nodes are added once, below the diagonal; blocks between a moving node and a
            // held one go into the row of the moving node.
            const auto block = part.block<3, 3>(static_cast<Eigen::Index>(3 * a), static_cast<Eigen::Index>(3 * b));
            if (rows_[a] < inside && (rows_[b] >= inside || rows_[b] <= rows_[a])) {
              K.block<3, 3>(rows_[a], rows_[b]) += block;
            } else if (rows_[b] < inside) {
              K.block<3, 3>(rows_[b], rows_[a]) += block.transpose();
            }
          }
        }
      });
}

MatX Patch::displacements(const MatX& given, MatX forces) {
  const Eigen::Index inside = 3 * Eigen::Index{moving_};
  if (inside == 0) return forces;
  forces.noalias() -= K().rightCols(K().cols() - inside) * given;
  factor_.assign(K_.begin(), K_.begin() + inside * inside);
  const auto n = static_cast<int>(inside);
  const auto loads = static_cast<int>(forces.cols());
  int info = 0;
  const detail::OneBlasThread one_thread;
  dposv_("L", &n, &loads, factor_.data(), &n, forces.data(), &n, &info);
  if (info != 0) throw std::logic_error("the stiffness of a patch is not positive definite");
  return forces;
}

}  // namespace stylet
