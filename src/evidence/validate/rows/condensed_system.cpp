// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the paper's condensed system x = K_W y with a direct solution of the mixed problem.
#include "stylet/coupling/paper/condensed_system.hpp"
#include "../rows.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <random>

namespace stylet::validate {

namespace {

constexpr int kPoints = 12;
constexpr int kSize = 3 * kPoints;
constexpr int kChanges = 3000;
constexpr int kEvery = 50;

/// Solves the mixed problem: gives the forces where displacements are prescribed (B) and the displacements where forces
/// are prescribed (F), from A_BB f_B = u_B − A_BF f_F.
VecX solve_mixed(const MatX& A, const paper::CondensedSystem& system, const VecX& y) {
  std::vector<int> given;  // rows with prescribed displacement
  std::vector<int> free;
  for (int i = 0; i < kSize; ++i) (system.is_displacement(i) ? given : free).push_back(i);
  VecX force(kSize);
  for (const int i : free) force[i] = y[i];
  if (!given.empty()) {
    VecX u = y(given);
    if (!free.empty()) u -= A(given, free) * y(free);
    const MatX among = A(given, given);
    const VecX held = among.partialPivLu().solve(u);
    force(given) = held;
  }
  VecX x = A * force;
  for (const int i : given) x[i] = force[i];
  return x;
}

Finding switches_and_rotations(Context&) {
  std::mt19937_64 random(4);
  std::normal_distribution<double> normal;
  const auto fill = [&](auto&& matrix) {
    for (double& x : matrix.reshaped()) x = normal(random);
  };
  MatX root(kSize, kSize);
  fill(root);
  MatX A = root * root.transpose() / kSize + 0.05 * MatX::Identity(kSize, kSize);

  paper::CondensedSystem system(kPoints);
  for (int p = 0; p < kPoints; ++p) system.add(A.block(0, 3 * p, 3 * p, 3), A.block<3, 3>(3 * p, 3 * p));
  Finding finding{.value = 0.0};
  Curve curve{.label = "K_W"};
  int rotations = 0;
  for (int k = 1; k <= kChanges; ++k) {
    const int point = static_cast<int>(random() % kPoints);
    if (random() % 3 == 0) {
      const Vec3 axis = Vec3(normal(random), normal(random), normal(random)).normalized();
      const Mat3 turn = Eigen::AngleAxisd(0.3, axis).toRotationMatrix();
      system.rotate(point, turn);
      A.middleRows<3>(3 * point) = (turn * A.middleRows<3>(3 * point)).eval();
      A.middleCols<3>(3 * point) = (A.middleCols<3>(3 * point) * turn.transpose()).eval();
      ++rotations;
    } else {
      const int row = 3 * point + static_cast<int>(random() % 3);
      system.control_displacement(row, !system.is_displacement(row));
    }
    if (k % kEvery != 0) continue;
    VecX y(kSize);
    fill(y);
    const VecX x = solve_mixed(A, system, y);
    const double error = (system.matrix() * y - x).cwiseAbs().maxCoeff() / x.cwiseAbs().maxCoeff();
    finding.value = worse(finding.value, error);
    curve.add(k, error);
  }
  finding.note = fmt::format("{} points, {} switches and {} rotations in random order; the largest error of {} checks.",
                             kPoints, kChanges - rotations, rotations, kChanges / kEvery);
  finding.plot = {.x_label = "switches and rotations", .y_label = "relative error", .log_y = true, .curves = {curve}};
  return finding;
}

}  // namespace

std::vector<RowSpec> condensed_system_rows() {
  return {{"condensed_system", Group::analysis,
           "K_W stays correct after boundary condition switches and rotations of its frames",
           "direct solution of the mixed problem", "", Accepted::at_most(1e-9), true, switches_and_rotations}};
}

}  // namespace stylet::validate
