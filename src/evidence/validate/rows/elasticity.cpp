// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the tissue with closed-form solutions of linear elasticity and with CalculiX.
#include "../rows.hpp"
#include "../solids.hpp"
#include "stylet/evidence/validate/calculix.hpp"
#include "stylet/fem/tissue.hpp"
#include "stylet/geom/box_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <random>

namespace stylet::validate {

namespace {

const Material kGland{0.040, 0.45};

/// Nodal forces [N] of a uniform stress on all outer faces.
VecX uniform_traction(const Tissue& tissue, const Mat3& stress) {
  return traction(tissue, [&](const Vec3&, int) { return stress; });
}

/// The jittered box of the patch test with its floor held.
Tissue jittered_box(const Material& material) {
  TetMesh mesh = box_mesh({-20, 10, 30}, {20, 50, 90}, {4, 5, 6}, 0.15);
  const auto floor = nodes_where(mesh, [](const Vec3& x) { return x.z() == 30.0; });
  return need(Tissue::build(std::move(mesh), {material}, floor));
}

Finding patch_test(Context&) {
  const auto tissue = jittered_box(kGland);
  const TetMesh& mesh = tissue.mesh();
  Finding finding{.value = 0.0};
  for (const Vec3& c : {Vec3(0.03, 0, 0), Vec3(0, -0.02, 0), Vec3(0, 0, 0.01), Vec3(0.01, 0.02, -0.03)}) {
    const Mat3 gradient = c * Vec3::UnitZ().transpose();
    const VecX expected = sample(tissue, [&](const Vec3& x) { return Vec3(c * (x.z() - 30.0)); });
    const VecX u = tissue.solve(uniform_traction(tissue, stress_of(kGland, gradient)));
    finding.value = worse(finding.value, relative_error(u, expected));
  }
  finding.note =
      fmt::format("An irregular mesh of {} nodes whose floor is held; four linear fields.", mesh.node_count());
  return finding;
}

Finding rigid_motions(Context&) {
  const auto tissue = jittered_box(kGland);
  Finding finding{.value = 0.0};
  for (int mode = 0; mode < 6; ++mode) {
    const Vec3 axis = Vec3::Unit(mode % 3);
    const VecX u = sample(tissue, [&](const Vec3& x) { return mode < 3 ? axis : Vec3(axis.cross(x) / 60.0); });
    // The scale is the stress of a strain that has the size of the displacement over a length of 1 mm.
    const double scale = kGland.lambda() * u.cwiseAbs().maxCoeff();
    finding.value = worse(finding.value, tissue.stress(u).cwiseAbs().maxCoeff() / scale);
  }
  finding.note =
      "Three translations and three infinitesimal rotations; the value is the largest stress in any element.";
  return finding;
}

Finding uniaxial_bar(Context&) {
  // With ν = 0 there is no lateral contraction, so the held end does not disturb the field.
  const Material material{0.020, 0.0};
  TetMesh mesh = box_mesh({0, 0, 0}, {10, 15, 100}, {2, 3, 20}, 0.15);
  const auto floor = nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; });
  const auto tissue = need(Tissue::build(std::move(mesh), {material}, floor));
  constexpr double force = 0.6;
  constexpr double area = 150.0;
  Mat3 stress = Mat3::Zero();
  stress(2, 2) = force / area;
  const VecX u = tissue.solve(uniform_traction(tissue, stress));
  const double strain = force / (material.young_MPa * area);
  Finding finding;
  finding.value = relative_error(u, sample(tissue, [&](const Vec3& x) { return Vec3(0, 0, strain * x.z()); }));
  finding.note = fmt::format("A bar 100 mm long of 20 kPa under {:g} N on {:g} mm² stretches by {:.4g} mm.", force,
                             area, 100.0 * strain);
  return finding;
}

Finding same_as_calculix(Element element, const std::array<int, 3>& cells) {
  if (!calculix_installed()) throw Skipped{"CalculiX (the program ccx, Debian package calculix-ccx) is not installed."};
  TetMesh mesh = box_mesh({-30, -20, 40}, {30, 30, 110}, cells, 0.15);
  assign_regions(mesh, {"fat", "gland"}, [](const Vec3& x) { return (x - Vec3(0, 5, 75)).norm() > 22 ? 0 : 1; });
  const auto fixed = nodes_where(mesh, [](const Vec3& x) { return x.z() == 40.0 || x.y() == -20.0; });
  const auto tissue = need(Tissue::build(std::move(mesh), {{0.008, 0.45}, {0.060, 0.40}}, fixed, {}, element));

  // Loads: a force on all nodes of the top, and random forces on a third of the free nodes.
  const Index nodes = tissue.displacement_nodes();
  VecX f = VecX::Zero(3 * Eigen::Index{nodes});
  std::mt19937 random(11);
  for (Index a = 0; a < nodes; ++a) {
    if (tissue.is_fixed(a)) continue;
    if (tissue.node_position(a).z() == 110.0) f[3 * a + 2] -= 0.01;
    if (a % 3 != 0) continue;
    for (int axis = 0; axis < 3; ++axis) f[3 * a + axis] += 0.02 * (static_cast<double>(random()) / 4294967296.0 - 0.5);
  }
  const auto theirs = need(solve_with_calculix(tissue, f));
  const VecX ours = tissue.solve(f);
  Finding finding;
  finding.value = relative_error(ours, theirs);
  finding.note = fmt::format(
      "{} nodes, two materials, loads on a third of the nodes; the largest displacement is {:.2f} mm. The value is the "
      "largest difference of any component, relative to the largest displacement.",
      nodes, ours.cwiseAbs().maxCoeff());
  finding.why_missed = "CalculiX prints only seven digits.";
  Curve curve{.label = "nodes", .kind = Curve::Kind::points};
  std::vector<Eigen::Index> by_size(static_cast<std::size_t>(nodes));
  for (std::size_t a = 0; a < by_size.size(); ++a) by_size[a] = static_cast<Eigen::Index>(a);
  const auto theirs_of = [&](Eigen::Index a) { return theirs.segment<3>(3 * a).norm(); };
  std::sort(by_size.begin(), by_size.end(), [&](auto a, auto b) { return theirs_of(a) < theirs_of(b); });
  for (const Eigen::Index a : by_size) {
    curve.add(theirs_of(a), ours.segment<3>(3 * a).norm());
  }
  finding.plot = {.x_label = "CalculiX [mm]", .y_label = "Stylet [mm]", .curves = {curve}};
  return finding;
}

}  // namespace

std::vector<RowSpec> elasticity_rows() {
  return {
      {"patch_test", Group::analysis, "A linear displacement field is reproduced under its tractions",
       "u = c z, σ from Hooke’s law", "", Accepted::at_most(1e-10), true, patch_test},
      {"rigid_motions", Group::analysis, "Rigid motions cause no stress", "σ = 0", "", Accepted::at_most(1e-10), true,
       rigid_motions},
      {"uniaxial_bar", Group::analysis, "A bar stretches by force × length / (modulus × area)", "ΔL = F L / (E A)", "",
       Accepted::at_most(1e-10), true, uniaxial_bar},
      {"calculix", Group::other_code, "The same mesh, materials, supports and loads give the same displacements",
       "CalculiX, C3D4 elements", "", Accepted::at_most(1e-6), true,
       [](Context&) {
         return same_as_calculix(Element::p1, {8, 7, 9});
       }},
      {"calculix_quadratic", Group::other_code,
       "The same mesh, materials, supports and loads give the same displacements with quadratic tetrahedra",
       "CalculiX, C3D10 elements", "", Accepted::at_most(1e-6), true,
       [](Context&) {
         return same_as_calculix(Element::p2, {4, 4, 5});
       }},
  };
}

}  // namespace stylet::validate
