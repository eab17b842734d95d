// SPDX-License-Identifier: GPL-3.0-or-later
// The axial stiffness of a needle whose contacts all stick, against a rod meshed explicitly with quadratic elements.
#include "coupling/needle_in_block.hpp"
#include "evidence/validate/solids.hpp"
#include "stylet/coupling/near_field/near_field_compliance.hpp"
#include "stylet/coupling/track_compliance.hpp"
#include "support/sanitized.hpp"

#include <Eigen/Cholesky>

#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>
#include <vector>

namespace stylet {
namespace {

/// Stiffnesses along the axis [N/mm] of a rigid rod in tissue of 30 kPa, by finite elements.
struct StuckRod {
  double poisson;
  double length_mm;
  double bonded;           ///< rod bonded along its shaft and at its end
  double bonded_end_free;  ///< rod bonded along its shaft only
  double behind;           ///< rod bonded up to three radii behind its end, and at its end
  double behind_end_free;  ///< rod bonded up to three radii behind its end only
};
constexpr StuckRod kRods[] = {
#include "stuck_rod.inc"
};

constexpr double kSide_mm = 50.0;
constexpr double kHeight_mm = 100.0;
constexpr double kYoung_MPa = 30e-3;
/// A line that does not coincide with lines of the mesh.
const Vec3 kEntry(1.3, 0.7, 0.0);

/// Turns a box, whose horizontal sections are squares of 100 mm, into a cylinder 100 mm wide.
void round_off(TetMesh& mesh) {
  for (Vec3& x : mesh.nodes) {
    const double radius = std::hypot(x.x(), x.y());
    if (radius < 1e-9) continue;
    const double outwards = std::max(std::abs(x.x()), std::abs(x.y())) / kSide_mm;  // 1 on the box's sides
    const double factor = 1.0 - outwards + outwards * outwards * kSide_mm / radius;
    x.x() *= factor;
    x.y() *= factor;
  }
}

bool is_held(const Vec3& x) { return std::hypot(x.x(), x.y()) > kSide_mm - 0.1 || x.z() > kHeight_mm - 0.1; }

/// Stiffness of a straight shaft that is held over its whole length, with the tip or without it.
double held_line(const std::shared_ptr<const Tissue>& tissue, double length, double spacing, bool with_tip) {
  const Topology topology(tissue->mesh());
  const Locator locator(tissue->mesh(), topology);
  const auto store = std::make_shared<ComplianceStore>(tissue);
  const auto kernel = std::make_shared<MeshKernel>(tissue, topology);
  const auto count = static_cast<int>(std::lround(length / spacing));
  std::vector<Vec3> points{kEntry + length * Vec3::UnitZ()};
  for (int k = 0; k < count; ++k) points.push_back(kEntry + (k + 0.5) * spacing * Vec3::UnitZ());
  std::vector<MaterialPoint> at;
  std::vector<Index> nodes;
  for (const Vec3& x : points) {
    at.push_back(locator.find(x, -1, Vec3::UnitZ()).value());
    const auto corners = tissue->nodes_of(at.back().tet);
    nodes.insert(nodes.end(), corners.begin(), corners.end());
  }
  store->add_nodes(nodes);
  kernel->add_nodes(nodes);
  NearFieldCompliance contacts(std::make_unique<TrackCompliance>(store, locator, count), tissue, kernel,
                               {.segment_mm = spacing}, count);
  EXPECT_TRUE(contacts.move_tip(at[0], points[0]));
  for (std::size_t k = 1; k < points.size(); ++k) contacts.add(at[k], points[k], Placement::embedded, Vec3::UnitZ());
  const int first = with_tip ? 0 : 1;
  const int size = count + 1 - first;
  MatX axial(size, size);
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) axial(i, j) = contacts(first + i, first + j)(2, 2);
  }
  return axial.ldlt().solve(VecX::Ones(size)).sum();
}

TEST(StuckRod, a_shaft_held_over_its_whole_length_is_as_stiff_as_one_that_is_meshed) {
  if (test::kSanitized) GTEST_SKIP() << test::kTooLongSanitized;
  for (const int cells : {6, 12}) {
    for (const double poisson : {0.45, 0.49}) {
      TetMesh mesh = box_mesh({-kSide_mm, -kSide_mm, 0}, {kSide_mm, kSide_mm, kHeight_mm}, {cells, cells, cells}, 0.1);
      round_off(mesh);
      const auto fixed = validate::nodes_where(mesh, is_held);
      auto built = Tissue::build(std::move(mesh), {{kYoung_MPa, poisson}}, fixed, {}, Element::nodal_pressure);
      ASSERT_TRUE(built) << built.error().message();
      const auto tissue = std::make_shared<const Tissue>(std::move(*built));
      // The patches of the mesh kernel end after three rings, and the resulting error grows with Poisson's ratio.
      const double allowed = poisson < 0.47 ? 0.025 : 0.045;
      for (const StuckRod& rod : kRods) {
        if (rod.poisson != poisson) continue;
        for (const double spacing : {2.0, 4.0, 8.0}) {
          SCOPED_TRACE(testing::Message() << cells << "³ cells, " << rod.length_mm << " mm, ν = " << poisson
                                          << ", spacing " << spacing << " mm");
          const double with = held_line(tissue, rod.length_mm, spacing, true) / rod.bonded;
          const double without = held_line(tissue, rod.length_mm, spacing, false) / rod.bonded_end_free;
          std::printf("held line, %2d^3 cells, nu %.2f, %g mm, spacing %g mm: with the tip %.3f, without %.3f\n", cells,
                      poisson, rod.length_mm, spacing, with, without);
          EXPECT_NEAR(with, 1.0, allowed);
          EXPECT_NEAR(without, 1.0, allowed);
        }
      }
    }
  }
}

/// Stiffness of a needle that was pushed in to `length` and has come to rest, for a very small motion of the base
/// backwards: all contacts stick, and the tip presses a little less.
double inserted(int cells, double poisson, double length, double spacing) {
  test::BlockOptions options;
  options.cells = {cells, cells, cells};
  options.regions = {"body"};
  options.region_at = [](const Vec3& /*x*/) { return 0; };
  options.materials = {{kYoung_MPa, poisson}};
  // Almost no friction while sliding, and an almost unlimited static friction.
  options.laws = {{5e-3, 0.0, {1e3, 1e-7, 1e-9}, false, true, -1}};
  options.edit = round_off;
  options.held = is_held;
  options.element = Element::nodal_pressure;
  options.coupling.spacing_mm = spacing;
  options.coupling.tip_viscosity_Ns_per_mm = 1e-5;
  options.coupling.axial_compliance_mm_per_N = 0.0;
  test::NeedleInBlock block(options);
  block.aim(kEntry);
  block.go(length, 200.0);
  block.wait(0.05, 5e-3);
  for (const ContactState& contact : block.insertion->contacts()) EXPECT_TRUE(contact.tip || contact.sticking);
  constexpr double way = 1e-4;
  const double before = block.forces.back();
  block.depth -= way;
  block.step(1.0);
  return (before - block.forces.back()) / way;
}

TEST(StuckRod, an_inserted_needle_holds_the_tissue_up_to_three_radii_behind_its_tip) {
  if (test::kSanitized) GTEST_SKIP() << test::kTooLongSanitized;
  for (const StuckRod& rod : kRods) {
    for (const double spacing : {2.0, 4.0}) {
      SCOPED_TRACE(testing::Message() << rod.length_mm << " mm, ν = " << rod.poisson << ", spacing " << spacing
                                      << " mm");
      const double stiffness = inserted(8, rod.poisson, rod.length_mm, spacing);
      std::printf(
          "inserted, nu %.2f, %g mm, spacing %g mm: of the rod bonded up to three radii behind its end %.3f, "
          "up to its end %.3f\n",
          rod.poisson, rod.length_mm, spacing, stiffness / rod.behind, stiffness / rod.bonded);
      EXPECT_NEAR(stiffness / rod.behind, 1.0, rod.poisson < 0.47 ? 0.035 : 0.045);
      EXPECT_LT(stiffness / rod.bonded, 0.98);
    }
  }
}

}  // namespace
}  // namespace stylet
