// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/geom/tet_part.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace stylet {

namespace {

/// Adds a prism as three tetrahedra. The corners a are on one of its triangles, the corners b on the other, in the same
/// order.
void add_prism(const std::array<Vec4, 3>& a, const std::array<Vec4, 3>& b, std::vector<TetPart>& parts) {
  TetPart part;
  part << a[0], a[1], a[2], b[2];
  parts.push_back(part);
  part << a[0], a[1], b[1], b[2];
  parts.push_back(part);
  part << a[0], b[0], b[1], b[2];
  parts.push_back(part);
}

/// Adds the part of `whole` in which the function is at most `level`. @param values of the function at the corners of
/// `whole`
void add_below(const TetPart& whole, const Vec4& values, double level, std::vector<TetPart>& parts) {
  std::array<int, 4> order{0, 1, 2, 3};
  std::sort(order.begin(), order.end(), [&](int i, int j) { return values[i] < values[j]; });
  const auto corner = [&](std::size_t i) -> Vec4 { return whole.col(order[i]); };
  const auto crossing = [&](std::size_t i, std::size_t j) -> Vec4 {
    const double from = values[order[i]];
    const double part = (level - from) / (values[order[j]] - from);
    return (1.0 - part) * corner(i) + part * corner(j);
  };
  TetPart tip;
  switch (std::count_if(values.begin(), values.end(), [&](double value) { return value <= level; })) {
    case 1:
      tip << corner(0), crossing(0, 1), crossing(0, 2), crossing(0, 3);
      parts.push_back(tip);
      break;
    case 2:
      add_prism({corner(0), crossing(0, 2), crossing(0, 3)}, {corner(1), crossing(1, 2), crossing(1, 3)}, parts);
      break;
    case 3:
      add_prism({corner(0), corner(1), corner(2)}, {crossing(0, 3), crossing(1, 3), crossing(2, 3)}, parts);
      break;
    case 4:
      parts.push_back(whole);
      break;
    default:
      break;
  }
}

}  // namespace

double share_of_tet(const TetPart& part) { return std::abs(part.determinant()); }

std::vector<TetPart> parts_between(const Vec4& values, double low, double high) {
  std::vector<TetPart> below;
  add_below(TetPart::Identity(), values, high, below);
  std::vector<TetPart> between;
  for (const TetPart& part : below) add_below(part, -part.transpose() * values, -low, between);
  return between;
}

}  // namespace stylet
