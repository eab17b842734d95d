// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/display_bench.hpp"

#include "driven_needle.hpp"
#include "stylet/geom/slice.hpp"
#include "stylet/measure/demo.hpp"
#include "stylet/measure/timing.hpp"
#include "stylet/sim/display_field.hpp"
#include "stylet/sim/display_near_field.hpp"
#include "stylet/sim/simulation.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>

namespace stylet::measure {

namespace {

constexpr int kContacts = 40;
constexpr double kFrames = 60;
constexpr double kWay_mm = 90.0;
constexpr double kBeside_mm = 10.0;  ///< surfaces are refined along the planned path extended by this at both ends
constexpr double kDisplayedSpeed_mm_per_s = 20.0;
constexpr double kDt_s = 1e-3;
constexpr Index kNodalPressureFits = 50000;  ///< with more nodes, the factor for nodal pressure needs too much memory

Vec3 place_of(const TetMesh& mesh, const MaterialPoint& at) {
  Vec3 x = Vec3::Zero();
  for (std::size_t i = 0; i < 4; ++i)
    x += at.weights[static_cast<Eigen::Index>(i)] *
         mesh.nodes[static_cast<std::size_t>(mesh.tets[static_cast<std::size_t>(at.tet)][i])];
  return x;
}

/// The alternative to a DisplayField: the displacement is computed on a coarse mesh and interpolated at the nodes of
/// the fine mesh.
class CoarseMesh {
 public:
  CoarseMesh(std::shared_ptr<const Model> coarse, const TetMesh& fine) : coarse_(std::move(coarse)) {
    for (const Vec3& x : fine.nodes) {
      const auto at = coarse_->locator().find(x);
      at_.push_back(at ? *at : MaterialPoint{});
    }
  }

  /// Largest difference from `exact` [mm] at the nodes of the fine mesh that lie in the coarse mesh.
  [[nodiscard]] double error(const TetMesh& fine, std::span<const TissueForce> forces, const VecX& exact) const {
    const Tissue& tissue = coarse_->tissue();
    MatX f = MatX::Zero(3 * Eigen::Index{tissue.displacement_nodes()}, 1);
    for (const TissueForce& force : forces) {
      const auto at = coarse_->locator().find(place_of(fine, force.at));
      if (!at) continue;
      const Shape shape = tissue.shape(at->tet, at->weights);
      for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i)
        f.col(0).segment<3>(3 * Eigen::Index{shape.node[i]}) += shape.weight[i] * force.force;
    }
    const MatX u = tissue.solve(f);
    double worst = 0.0;
    for (std::size_t node = 0; node < at_.size(); ++node) {
      if (at_[node].tet < 0) continue;
      const Shape shape = tissue.shape(at_[node].tet, at_[node].weights);
      Vec3 here = Vec3::Zero();
      for (std::size_t i = 0; i < static_cast<std::size_t>(shape.count); ++i)
        here += shape.weight[i] * u.col(0).segment<3>(3 * Eigen::Index{shape.node[i]});
      worst = std::max(worst, (here - exact.segment<3>(3 * static_cast<Eigen::Index>(node))).norm());
    }
    return worst;
  }

 private:
  std::shared_ptr<const Model> coarse_;
  std::vector<MaterialPoint> at_;  ///< (fine nodes)
};

/// Points of all surfaces, refined along the needle's way.
std::vector<SurfacePoint> fine_surface(const Model& model, std::span<const Index> nodes) {
  std::vector<std::array<Index, 3>> triangles;
  for (const auto* faces : {&model.topology().boundary, &model.topology().interfaces}) {
    for (const Face& face : *faces) triangles.push_back(face.nodes);
  }
  const PlannedInsertion& plan = model.insertions().front();
  const LineSegment way{plan.entry - kBeside_mm * plan.direction,
                        plan.entry + (plan.depth_mm + kBeside_mm) * plan.direction};
  std::vector<int> patch(triangles.size(), 0);
  FineSurface fine = refine_surface(model.mesh().nodes, std::move(triangles), std::move(patch), std::span(&way, 1));
  std::vector<SurfacePoint> points;
  for (const Index node : nodes) points.push_back(fine.points[static_cast<std::size_t>(node)]);
  points.insert(points.end(), fine.points.begin() + model.mesh().node_count(), fine.points.end());
  return points;
}

/// A display of the deformed patient that times its frames.
class Display {
 public:
  Display(const std::shared_ptr<const Model>& model, const DisplayField& field)
      : field_(field),
        mesh_(field.model().mesh()),
        slicer_(mesh_),
        load_(field.make_load()),
        fine_(fine_surface(*model, field.surface())),
        near_(model, fine_),
        u_(3, mesh_.node_count()),
        x_(3, 2 * mesh_.tet_count()) {}

  /// Computes and times the surfaces, a slice, and both; each starts with setting the forces.
  void show(std::span<const TissueForce> forces, const Vec3& origin, const Vec3& normal) {
    const auto timed = [&](std::vector<double>& us, auto&& picture) {
      const double started = measure::thread_cpu_s();
      field_.set(forces, load_);
      picture();
      us.push_back(1e6 * (measure::thread_cpu_s() - started));
    };
    timed(surface_us_, [&] { show_surface(); });
    timed(slice_us_, [&] { show_slice(origin, normal); });
    near_us_.push_back(time_near_field(forces));
    timed(both_us_, [&] {
      show_surface();
      show_slice(origin, normal);
    });
    triangles_ = std::max(triangles_, static_cast<int>(slicer_.triangles().size()));
  }

  /// Largest difference of all nodes from the exact displacement [mm].
  double error(std::span<const TissueForce> forces, const VecX& exact) {
    std::vector<Index> all(static_cast<std::size_t>(mesh_.node_count()));
    std::iota(all.begin(), all.end(), 0);
    field_.set(forces, load_);
    field_.displacement(all, load_, u_);
    return (u_.cast<double>() - exact.head(u_.size()).reshaped(3, u_.cols())).colwise().norm().maxCoeff();
  }

  [[nodiscard]] const DisplayField::Load& load() const { return load_; }
  void write(DisplayRow& row) {
    row.surface_nodes = static_cast<int>(field_.surface().size());
    row.slice_triangles = triangles_;
    row.surface_us = quantiles(std::move(surface_us_));
    row.slice_us = quantiles(std::move(slice_us_));
    row.fine_points = static_cast<int>(fine_.size());
    row.near_us = quantiles(std::move(near_us_));
    row.both_us = quantiles(std::move(both_us_));
  }

 private:
  double time_near_field(std::span<const TissueForce> forces) {
    const double started = measure::thread_cpu_s();
    near_.set(forces);
    near_.add(u_fine_);
    return 1e6 * (measure::thread_cpu_s() - started);
  }

  void show_surface() {
    const auto count = static_cast<Eigen::Index>(field_.surface().size());
    auto u = u_.leftCols(count);
    field_.displacement(field_.surface(), load_, u);
    for (Eigen::Index k = 0; k < count; ++k)
      x_.col(k) =
          mesh_.nodes[static_cast<std::size_t>(field_.surface()[static_cast<std::size_t>(k)])].cast<float>() + u.col(k);
  }

  void show_slice(const Vec3& origin, const Vec3& normal) {
    slicer_.cut(origin, normal);
    auto u = u_.leftCols(static_cast<Eigen::Index>(slicer_.nodes().size()));
    field_.displacement(slicer_.nodes(), load_, u);
    slicer_.positions(u, x_.leftCols(static_cast<Eigen::Index>(slicer_.vertices().size())));
  }

  const DisplayField& field_;
  const TetMesh& mesh_;
  Slicer slicer_;
  DisplayField::Load load_;
  std::vector<SurfacePoint> fine_;
  DisplayNearField near_;
  Eigen::Matrix3Xf u_fine_ = Eigen::Matrix3Xf::Zero(3, static_cast<Eigen::Index>(fine_.size()));
  Eigen::Matrix3Xf u_;
  Eigen::Matrix3Xf x_;
  std::vector<double> surface_us_;
  std::vector<double> slice_us_;
  std::vector<double> both_us_;
  std::vector<double> near_us_;
  int triangles_ = 0;
};

DisplayRow measure(const std::shared_ptr<const Model>& model, const DisplayField& field, const CoarseMesh* coarse,
                   const Progress& progress) {
  DisplayRow row;
  row.nodes = model->mesh().node_count();
  row.element = to_string(model->tissue().element());
  const auto& statistics = field.statistics();
  row.zone_dofs = statistics.zone_dofs;
  row.columns = statistics.columns;
  row.stated_error_mm_per_N = statistics.error_mm_per_N;
  row.prepare_s = statistics.seconds;
  row.megabytes = statistics.megabytes;

  Display display(model, field);
  Simulation simulation(model);
  const PlannedInsertion& plan = model->insertions().front();
  Pose base = plan.motion.at(0.0);
  simulation.place(base, plan.entry, plan.direction);
  const auto steps =
      static_cast<int>((kWay_mm - simulation.last_step().base_depth_mm) / (kDisplayedSpeed_mm_per_s * kDt_s));
  const int every = steps / static_cast<int>(kFrames);
  const Vec3 across = plan.direction.unitOrthogonal();
  std::vector<double> solve_us;
  if (coarse != nullptr) row.coarse_error_mm = 0.0;
  for (int k = 1; k <= steps; ++k) {
    base.origin += kDisplayedSpeed_mm_per_s * kDt_s * plan.direction;
    simulation.prepare();
    simulation.step(base, kDt_s);
    if (k % every != 0) continue;
    report(progress, "showing", static_cast<double>(k) / steps);
    const std::vector<TissueForce> forces = simulation.insertion().tissue_forces();
    const double turn = 2.0 * std::numbers::pi * row.frames / kFrames;
    display.show(forces, simulation.last_step().tip_mm, Eigen::AngleAxisd(turn, plan.direction) * across);
    ++row.frames;

    const double started = measure::thread_cpu_s();
    const VecX exact = simulation.insertion().mesh_displacement();
    solve_us.push_back(1e6 * (measure::thread_cpu_s() - started));
    row.largest_mm = std::max(row.largest_mm, exact.reshaped(3, exact.size() / 3).colwise().norm().maxCoeff());
    row.error_mm = std::max(row.error_mm, display.error(forces, exact));
    row.stated_error_mm = std::max(row.stated_error_mm, statistics.error_mm_per_N * display.load().shown_N());
    row.left_out_N = std::max(row.left_out_N, display.load().left_out_N());
    if (coarse != nullptr)
      row.coarse_error_mm = std::max(row.coarse_error_mm, coarse->error(model->mesh(), forces, exact));
  }
  row.solve_us = measure::median(std::move(solve_us));
  display.write(row);
  return row;
}

}  // namespace

Result<std::vector<DisplayRow>> bench_display(const DisplayBenchOptions& options, const Progress& progress) {
  std::vector<DisplayRow> rows;
  std::shared_ptr<const Model> coarsest;
  for (const Index nodes : {570, 5000, 20000, 100000}) {
    if (nodes > options.largest) continue;
    auto anatomy = mesh_demo(nodes, progress);
    if (!anatomy) return anatomy.error();
    Scenario scenario = driven_scenario(kContacts);
    if (nodes > kNodalPressureFits) scenario.tissue_model.element = ElementChoice::p1;
    const auto model = Model::compile(scenario, std::move(anatomy->mesh), "the demo", {}, progress);
    if (!model) return model.error();
    const auto field = DisplayField::prepare(*model, {}, progress);
    if (!field) return field.error();
    if (coarsest) {
      const CoarseMesh coarse(coarsest, (*model)->mesh());
      rows.push_back(measure(*model, **field, &coarse, progress));
    } else {
      coarsest = *model;
      rows.push_back(measure(*model, **field, nullptr, progress));
    }
  }
  return rows;
}

}  // namespace stylet::measure
