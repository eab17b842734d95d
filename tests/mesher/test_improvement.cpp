// SPDX-License-Identifier: GPL-3.0-or-later
#include "local_changes.hpp"
#include "stylet/geom/tet_mesh.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace stylet::meshing {
namespace {

/// A cube of n³ cells of six tetrahedra each, with inner nodes displaced at random; the left half has label 1, the
/// right half label 2.
RawMesh shaken_cube(int n, double by) {
  RawMesh m;
  std::mt19937 random(7);
  std::uniform_real_distribution<double> shake(-by, by);
  const auto at = [&](int i, int j, int k) { return static_cast<Index>((k * (n + 1) + j) * (n + 1) + i); };
  for (int k = 0; k <= n; ++k) {
    for (int j = 0; j <= n; ++j) {
      for (int i = 0; i <= n; ++i) {
        Vec3 p(i, j, k);
        const bool inner = i > 0 && i < n && j > 0 && j < n && k > 0 && k < n && i != n / 2;
        if (inner) p += Vec3(shake(random), shake(random), shake(random));
        m.nodes.push_back(10 * p);
      }
    }
  }
  constexpr int kPaths[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        for (const auto& path : kPaths) {
          std::array<int, 3> c{i, j, k};
          std::array<Index, 4> tet{at(i, j, k)};
          for (int s = 0; s < 3; ++s) {
            ++c[path[s]];
            tet[s + 1] = at(c[0], c[1], c[2]);
          }
          const Vec3& a = m.nodes[tet[0]];
          const double v = (m.nodes[tet[1]] - a).cross(m.nodes[tet[2]] - a).dot(m.nodes[tet[3]] - a);
          if (v < 0) std::swap(tet[2], tet[3]);
          m.tets.push_back(tet);
          m.label.push_back(i < n / 2 ? 1 : 2);
        }
      }
    }
  }
  return m;
}

/// The half space x < `at`.
class HalfSpace : public Shape {
 public:
  explicit HalfSpace(double at) : at_(at) {}
  [[nodiscard]] double distance(const Vec3& p) const override { return p.x() - at_; }
  [[nodiscard]] Eigen::AlignedBox3d box() const override { return {Vec3::Constant(-1e3), Vec3::Constant(1e3)}; }
  [[nodiscard]] double volume(double) const override { return 1; }
  [[nodiscard]] double inner_radius() const override { return 100; }

 private:
  double at_;
};

/// The cube as an anatomy: label 1 is x < middle, label 2 is the rest of the box.
class Box : public HalfSpace {
 public:
  explicit Box(double side) : HalfSpace(0), side_(side) {}
  [[nodiscard]] double distance(const Vec3& p) const override {
    return std::max((-p).maxCoeff(), (p.array() - side_).maxCoeff());
  }

 private:
  double side_;
};

Anatomy cube_anatomy(int n) {
  Anatomy a;
  Structure left, right;
  left.name = "prostate";
  left.shape = std::make_shared<HalfSpace>(10.0 * (n / 2));
  right.name = "body";
  right.shape = std::make_shared<Box>(10.0 * n);
  a.add(left);
  a.add(right);
  a.layers[0].clipped = true;
  return a;
}

double volume_of(const RawMesh& m, int label) {
  double sum = 0;
  for (std::size_t t = 0; t < m.tets.size(); ++t) {
    if (m.label[t] != label) continue;
    const auto& n = m.tets[t];
    const Vec3& a = m.nodes[n[0]];
    sum += (m.nodes[n[1]] - a).cross(m.nodes[n[2]] - a).dot(m.nodes[n[3]] - a) / 6;
  }
  return sum;
}

TEST(TetQuality, is_the_angle_in_twelfths_of_a_degree_for_flat_and_largest_for_the_regular_tetrahedron) {
  const Vec3 a(1, 1, 1), b(1, -1, -1), c(-1, 1, -1), d(-1, -1, 1);
  const double regular = tet_quality(a, c, b, d) > 0 ? tet_quality(a, c, b, d) : tet_quality(a, b, c, d);
  EXPECT_NEAR(regular, 70.5288 / 12, 1e-4);
  EXPECT_EQ(tet_quality(a, b, c, d) > 0, tet_quality(a, c, b, d) == 0) << "inverted has quality 0";
  EXPECT_EQ(tet_quality(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0)), 0);
}

TEST(Improvement, raises_the_worst_element_and_keeps_volumes_and_surfaces) {
  const int n = 6;
  EditableMesh m(shaken_cube(n, 0.33));
  const RawMesh before = m.result();
  const double worst_before = m.worst_quality();
  ASSERT_LT(worst_before, 0.5);
  improve(m, cube_anatomy(n), 1.6);
  EXPECT_GT(m.worst_quality(), 1.2);
  const RawMesh after = m.result();
  EXPECT_EQ(after.nodes.size(), before.nodes.size());
  for (const int label : {1, 2}) {
    EXPECT_NEAR(volume_of(after, label), volume_of(before, label), 0.02 * volume_of(before, label));
  }
  TetMesh checked;
  checked.nodes = after.nodes;
  checked.tets = after.tets;
  checked.regions = {"prostate", "body"};
  for (const int l : after.label) checked.tet_region.push_back(l - 1);
  const auto ok = check_mesh(checked, "improved");
  EXPECT_TRUE(ok.ok()) << (ok.ok() ? "" : ok.error().message());
}

}  // namespace
}  // namespace stylet::meshing
