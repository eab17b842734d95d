// SPDX-License-Identifier: GPL-3.0-or-later
// Compares the gland's motion with a solid with large displacements. In the model the motion is linear in the forces,
// except for the gland's rotation, which is exact.
#include "../quadrature.hpp"
#include "../rows.hpp"
#include "stylet/evidence/validate/calculix.hpp"
#include "stylet/fem/volume_motion.hpp"
#include "stylet/sim/simulation.hpp"
#include "stylet/sim/target_motion.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace stylet::validate {

namespace {

constexpr std::array<const char*, 3> kHoles{"e3.5", "c3.5", "D4.5"};
constexpr double kFurthest_mm = 6.0;
constexpr Index kNodes = 1000;
/// Standard deviation of the distribution over which a force is spread. Under a point force, the displacement of
/// neo-Hookean tissue is unbounded.
constexpr double kSpread_mm = 3.0;

struct PointForce {
  MaterialPoint at;
  Vec3 force;  ///< [N]
};

Vec3 position(const TetMesh& mesh, const MaterialPoint& point) {
  Vec3 x = Vec3::Zero();
  for (int i = 0; i < 4; ++i)
    x += point.weights[i] * mesh.nodes[static_cast<std::size_t>(
                                mesh.tets[static_cast<std::size_t>(point.tet)][static_cast<std::size_t>(i)])];
  return x;
}

/// Spreads a force with a normal distribution around its point. The part outside the tissue is left out and the rest is
/// scaled to the whole force.
std::vector<PointForce> spread(const TetMesh& mesh, const MaterialPoint& at, const Vec3& force) {
  static const auto rule = tetrahedron_rule(3);
  const Vec3 centre = position(mesh, at);
  std::vector<PointForce> cloud;
  double sum = 0.0;
  for (Index t = 0; t < mesh.tet_count(); ++t) {
    const double volume = tet_volume(mesh, t);
    for (const TetrahedronPoint& point : rule) {
      const MaterialPoint here{t, point.weights};
      const double distance = (position(mesh, here) - centre).norm() / kSpread_mm;
      if (distance > 4.0) continue;
      const double share = volume * point.factor * std::exp(-0.5 * distance * distance);
      sum += share;
      cloud.push_back({here, share * force});
    }
  }
  for (PointForce& part : cloud) part.force /= sum;
  return cloud;
}

/// The forces on the tissue at the largest shift of the gland on the way in.
std::vector<TissueForce> forces_at_largest_shift(const std::shared_ptr<const Model>& model) {
  auto motion = need(TargetMotion::of(*model));
  Simulation simulation(model);
  const PlannedInsertion& plan = model->insertions().front();
  simulation.place(plan);
  constexpr double dt_s = 2e-3;
  constexpr long every = 5;
  double furthest = 0.0;
  std::vector<TissueForce> forces;
  const auto steps = std::lround(plan.motion.duration_s() / dt_s);
  for (long k = 1; k <= steps; ++k) {
    simulation.prepare();
    simulation.step(plan.motion.at(static_cast<double>(k) * dt_s), dt_s);
    if (k % every != 0) continue;
    const double shift = motion.now(simulation.insertion()).motion.shift_mm.norm();
    if (shift <= furthest) continue;
    furthest = shift;
    forces = simulation.insertion().tissue_forces();
  }
  if (forces.empty())
    throw Failed{failure("large motion", "the needle did not move the gland", "Run stylet insert to see why")};
  return forces;
}

/// Mean shift [mm] of a volume and of its thirds along z, computed from the displacements of nodes.
struct Seen {
  Vec3 shift = Vec3::Zero();
  std::array<Vec3, 3> third{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
};

class GlandOf {
 public:
  GlandOf(const Tissue& tissue, const std::vector<int>& regions) : tissue_(&tissue) {
    const TetMesh& mesh = tissue.mesh();
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (Index t = 0; t < mesh.tet_count(); ++t) {
      const auto k = static_cast<std::size_t>(t);
      if (std::find(regions.begin(), regions.end(), mesh.tet_region[k]) == regions.end()) continue;
      tets_.push_back(t);
      for (const Index node : mesh.tets[k]) {
        low = std::min(low, mesh.nodes[static_cast<std::size_t>(node)].z());
        high = std::max(high, mesh.nodes[static_cast<std::size_t>(node)].z());
      }
    }
    low_ = low;
    height_ = high - low;
  }

  [[nodiscard]] Seen motion(const VecX& u) const {
    static const auto rule = tetrahedron_rule(6);
    const TetMesh& mesh = tissue_->mesh();
    Seen seen;
    double volume = 0.0;
    std::array<double, 3> volumes{};
    for (const Index t : tets_) {
      const double v = tet_volume(mesh, t);
      for (const TetrahedronPoint& point : rule) {
        const Shape shape = tissue_->shape(t, point.weights);
        Vec3 moved = Vec3::Zero();
        for (int i = 0; i < shape.count; ++i) {
          const auto k = static_cast<std::size_t>(i);
          moved += shape.weight[k] * u.segment<3>(3 * Eigen::Index{shape.node[k]});
        }
        const double from_top = (low_ + height_ - position(mesh, {t, point.weights}).z()) / height_;
        const auto third = static_cast<std::size_t>(std::clamp(static_cast<int>(3.0 * from_top), 0, 2));
        const double share = v * point.factor;
        seen.shift += share * moved;
        seen.third[third] += share * moved;
        volume += share;
        volumes[third] += share;
      }
    }
    seen.shift /= volume;
    for (std::size_t k = 0; k < 3; ++k) seen.third[k] /= volumes[k];
    return seen;
  }

 private:
  const Tissue* tissue_;
  std::vector<Index> tets_;
  double low_ = 0.0;
  double height_ = 1.0;
};

/// The largest error of the shift and of the thirds' shifts, divided by the allowed error: 0.5 mm or a tenth of the
/// shift, whichever is larger.
double error_of(const VolumeMotion& ours, const Seen& theirs) {
  const auto one = [](const Vec3& value, const Vec3& expected) {
    return (value - expected).norm() / std::max(0.5, 0.1 * expected.norm());
  };
  double worst = one(ours.shift_mm, theirs.shift);
  for (std::size_t k = 0; k < 3; ++k) worst = worse(worst, one(ours.third_mm[k], theirs.third[k]));
  return worst;
}

VolumeMotion times(VolumeMotion motion, double share) {
  motion.shift_mm *= share;
  motion.rotation_rad *= share;
  for (Vec3& third : motion.third_mm) third *= share;
  motion.dilation *= share;
  return motion;
}

struct HoleResult {
  double at_points_mm = 0.0;  ///< the gland's shift under the needle's forces, which act at points
  double factor = 1.0;        ///< factor of the forces that gives a shift of kFurthest_mm
  double worst = 0.0;         ///< largest error_of() of all increments
  double worst_linear = 0.0;  ///< the same without the exact rotation
  double worst_needle = 0.0;  ///< largest error_of() of the increments up to the needle's own forces
  double reached_mm = 0.0;    ///< shift at the last increment
  double turn_deg = 0.0;      ///< rotation at the last increment
  Curve ours, theirs;
};

HoleResult through(const TetMesh& mesh, const char* hole, const Progress& progress) {
  Scenario scenario = measure::demo_scenario();
  scenario.mesh.nodes = kNodes;
  scenario.output.frames_per_s = 0.0;
  scenario.insertions.front().hole = hole;
  scenario.insertions.front().dwell_s = 0.0;
  scenario.insertions.front().retract = false;
  const auto model = need(Model::compile(scenario, mesh, "the demo", {}, progress));
  const auto forces = forces_at_largest_shift(model);

  std::vector<Index> fixed;
  for (const Index node : model->tissue().fixed_nodes()) {
    if (node < mesh.node_count()) fixed.push_back(node);
  }
  const auto tissue = need(Tissue::build(mesh, model->tissue().materials(), fixed, {}, Element::p2));
  const auto response =
      need(VolumeResponse::solve(model->tissue(), model->target_regions(), VolumeResponse::Accuracy::quadratic));
  VecX load = VecX::Zero(3 * Eigen::Index{tissue.displacement_nodes()});
  VolumeMotion at_points;
  VolumeMotion linear;
  for (const TissueForce& tissue_force : forces) {
    response.add(tissue_force.at, tissue_force.force, at_points);
    for (const PointForce& part : spread(mesh, tissue_force.at, tissue_force.force)) {
      response.add(part.at, part.force, linear);
      const Shape shape = tissue.shape(part.at.tet, part.at.weights);
      for (int i = 0; i < shape.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        if (!tissue.is_fixed(shape.node[k]))
          load.segment<3>(3 * Eigen::Index{shape.node[k]}) += shape.weight[k] * part.force;
      }
    }
  }
  HoleResult result;
  result.at_points_mm = at_points.shift_mm.norm();
  result.factor = kFurthest_mm / linear.shift_mm.norm();
  const auto moments = need(load_with_calculix(tissue, result.factor * load));
  const GlandOf gland(tissue, model->target_regions());
  result.ours = {.label = fmt::format("hole {}", hole), .x = {0.0}, .y = {0.0}};
  result.theirs = {
      .label = fmt::format("hole {}, neo-Hookean", hole), .x = {0.0}, .y = {0.0}, .kind = Curve::Kind::reference};
  for (const LoadedMoment& moment : moments) {
    const double factor = result.factor * moment.share;
    const VolumeMotion without_turn = times(linear, factor);
    const VolumeMotion ours = response.finite(without_turn);
    const Seen theirs = gland.motion(moment.u);
    const double error = error_of(ours, theirs);
    result.worst = worse(result.worst, error);
    if (factor <= 1.0) result.worst_needle = worse(result.worst_needle, error);
    result.worst_linear = worse(result.worst_linear, error_of(without_turn, theirs));
    result.reached_mm = ours.shift_mm.norm();
    result.turn_deg = 180.0 / M_PI * ours.rotation_rad.norm();
    result.ours.add(factor, ours.third_mm[VolumeMotion::superior].norm());
    result.theirs.add(factor, theirs.third[VolumeMotion::superior].norm());
  }
  return result;
}

Finding large_motion(Context& context) {
  if (!calculix_installed()) throw Skipped{"CalculiX (the program ccx, Debian package calculix-ccx) is not installed."};
  const auto meshed = need(measure::mesh_demo(kNodes, context.progress()));
  Finding finding{.value = 0.0};
  finding.plot = {.x_label = "forces / needle’s own forces", .y_label = "shift of the gland’s base [mm]"};
  for (const char* hole : kHoles) {
    const auto result = through(meshed.mesh, hole, context.progress());
    constexpr double enough = 0.9 * kFurthest_mm;
    finding.value = worse(finding.value, result.reached_mm >= enough ? result.worst : std::nan(""));
    finding.note += fmt::format(
        "Hole {}: a shift of {:.1f} mm and a turn of {:.0f}° are reached with {:.2f} times the needle’s own forces, "
        "which move the gland by {:.1f} mm. The largest error is {:.2f} of the allowed one, {:.2f} without the exact "
        "rotation, {:.2f} up to the needle’s own forces. ",
        hole, result.reached_mm, result.turn_deg, result.factor, result.at_points_mm, result.worst, result.worst_linear,
        result.worst_needle);
    finding.plot.curves.push_back(result.ours);
    finding.plot.curves.push_back(result.theirs);
  }
  finding.note += fmt::format(
      "The forces on the tissue at the largest shift of the gland, including those kept by creep, are each spread over "
      "{:g} mm and increased in proportion until the gland’s shift is {:g} mm. The mean shifts of the gland and of its "
      "thirds are compared; the allowed error is 0.5 mm or a tenth of the shift, whichever is larger. Both use the "
      "same mesh of {} nodes with quadratic elements.",
      kSpread_mm, kFurthest_mm, meshed.mesh.node_count());
  return finding;
}

}  // namespace

std::vector<RowSpec> large_motion_rows() {
  return {
      {"large_motion", Group::other_code,
       "The gland moves as in a solid with large displacements, up to 6 mm, through three holes",
       "CalculiX, neo-Hookean C3D10 elements, large displacements", "of the allowed error", Accepted::at_most(1.0),
       false, large_motion},
  };
}

}  // namespace stylet::validate
