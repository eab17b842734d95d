// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/evidence/reproduce/reproduction.hpp"

#include "fem/blas_threads.hpp"
#include "stylet/core/version.hpp"
#include "stylet/coupling/paper/dense_inverse.hpp"
#include "stylet/evidence/reproduce/paper_numbers.hpp"
#include "stylet/mesher/mesher.hpp"
#include "stylet/phantom/phantom.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <optional>

namespace stylet::reproduce {

namespace {

/// A number with a typographic minus sign.
std::string signed_text(double value, int digits) {
  const std::string text = fmt::format("{:.{}f}", std::abs(value), digits);
  return value < 0.0 && text.find_first_not_of("0.") != std::string::npos ? "−" + text : text;
}

std::string in_words(const PlannedInsertion& insertion, const Vec3& drift) {
  const auto list = [](const Vec3& v, int digits) {
    return fmt::format("({}, {}, {})", signed_text(v.x(), digits), signed_text(v.y(), digits),
                       signed_text(v.z(), digits));
  };
  const bool straight = insertion.direction.z() > 0.9999;
  return fmt::format("{}: entry at {} mm (LPS), {}, {:.0f} mm deep; the needle's base drifts {:.1f} mm sideways",
                     insertion.name, list(insertion.entry, 1),
                     straight ? std::string("straight along the template") : "along " + list(insertion.direction, 2),
                     insertion.depth_mm, drift.norm());
}

/// Runs the experiments one after the other; each stores its results in the reproduction.
class Experiments {
 public:
  Experiments(const ReproduceOptions& options, const Progress& progress) : progress_(progress) {
    out_.options = options;
    out_.version = version();
    out_.machine = measure::this_machine();
  }

  Result<Reproduction> all() {
    const auto started = std::chrono::steady_clock::now();
    if (auto done = patient(); !done) return done.error();
    if (auto done = figure6(); !done) return done.error();
    if (auto done = preparation(); !done) return done.error();
    if (auto done = remeshing(); !done) return done.error();
    auto rows = measure_figure5(figure5_dims(quick()), quick() ? 0.4 : 3.0, progress_);
    if (!rows) return rows.error();
    out_.figure5 = std::move(*rows);
    report(progress_, "counting multiplications", 0.0);
    out_.counted = measure::count_operations(paper_numbers::kOrder, paper_numbers::kChange);
    out_.table = cost_table({out_.figure6, quality_, out_.on_faces, out_.inside, out_.counted, preparation_});
    out_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
    return std::move(out_);
  }

 private:
  [[nodiscard]] bool quick() const { return out_.options.quick; }

  Result<> patient() {
    scenario_ = figure6_scenario(quick());
    const ContourSet contours = demo_patient();
    MeshOptions options;
    options.preset = MeshPreset::paper;
    options.cull_tolerance_mm = scenario_.mesh.cull_mm;
    auto meshed = mesh_contours(contours, options, progress_);
    if (!meshed) return meshed.error();
    mesh_ = std::move(meshed->mesh);
    quality_ = meshed->report.quality;
    out_.figure2 = make_figure2(contours, mesh_, options.cull_tolerance_mm);
    return Ok{};
  }

  Result<> figure6() {
    Figure6& figure = out_.figure6;
    figure.dt_ms = scenario_.run.dt_ms;
    figure.speed_mm_per_s = scenario_.insertions.front().speed_mm_per_s;
    figure.spacing_mm = scenario_.coupling.spacing_mm;
    figure.repeats = quick() ? 1 : 3;
    for (const Figure6Variant& variant : figure6_variants()) {
      const auto model = figure6_model(scenario_, variant, mesh_, progress_);
      if (!model) return model.error();
      auto run = run_insertions(*model, variant, figure.repeats, progress_);
      if (!run) return run.error();
      if (run->not_converged > 0) {
        out_.notes.push_back(fmt::format("{}: {} of {} iterations did not converge to the full tolerance.",
                                         variant.label, run->not_converged, run->steps.size()));
      }
      figure.runs.push_back(std::move(*run));
      default_ = *model;  // the default is the last variant
    }
    figure.nodes = default_->mesh().node_count();
    figure.tets = default_->mesh().tet_count();
    figure.free_dofs = default_->tissue().free_dofs();
    for (std::size_t i = 0; i < default_->insertions().size(); ++i)
      figure.insertions.push_back(in_words(default_->insertions()[i], figure6_drift_mm(i)));
    return Ok{};
  }

  /// Repeats the parts of Model::compile and times each of them.
  Result<> preparation() {
    const detail::OneBlasThread one_thread;
    const Tissue& tissue = default_->tissue();
    std::vector<Index> nodes;
    for (Index node = 0; node < tissue.mesh().node_count(); ++node)
      if (!tissue.is_fixed(node) && default_->store()->has(node)) nodes.push_back(node);
    std::vector<double> factor_s;
    std::vector<double> store_s;
    for (int i = 0; i < 3; ++i) {
      std::optional<Result<Tissue>> built;
      factor_s.push_back(measure::cpu_seconds(
          [&] { built = Tissue::build(tissue.mesh(), tissue.materials(), tissue.fixed_nodes()); }));
      if (!*built) return built->error();
      ComplianceStore store(default_->store()->shared_tissue());
      store_s.push_back(measure::cpu_seconds([&] { store.add_nodes(nodes); }));
    }
    MatX inverse;
    preparation_.inverse_s = measure::cpu_seconds([&] { inverse = paper::full_inverse(tissue, progress_); });
    inverse_ = std::make_shared<const MatX>(std::move(inverse));
    preparation_.factor_s = measure::median(std::move(factor_s));
    preparation_.store_s = measure::median(std::move(store_s));
    preparation_.factor_mb = tissue.statistics().factor_mb;
    return Ok{};
  }

  Result<> remeshing() {
    const PlannedInsertion& insertion = default_->insertions().front();
    measure::NeedleWay way{
        .store = default_->store(), .locator = &default_->locator(), .inverse = {}, .from = insertion.entry};
    way.to = insertion.entry + insertion.depth_mm * insertion.direction;
    way.inverse = inverse_;
    measure::RemeshCostOptions options{.rounds = quick() ? 5 : 25, .bcs_rounds = quick() ? 1 : 2};
    for (const Placement placement : {Placement::face, Placement::interior}) {
      options.placement = placement;
      options.spacing_mm = placement == Placement::face ? scenario_.needle.diameter_mm : 2.5;
      auto cost = measure::measure_remeshing(way, options, progress_);
      if (!cost) return cost.error();
      (placement == Placement::face ? out_.on_faces : out_.inside) = *cost;
    }
    return Ok{};
  }

  const Progress& progress_;
  Reproduction out_;
  Scenario scenario_;
  TetMesh mesh_;
  MeshQuality quality_;
  std::shared_ptr<const Model> default_;  ///< model of this program's default for node addition
  std::shared_ptr<const MatX> inverse_;   ///< K⁻¹ of the whole tissue
  Preparation preparation_;
};

}  // namespace

Result<Reproduction> reproduce(const ReproduceOptions& options, const Progress& progress) {
  return Experiments(options, progress).all();
}

}  // namespace stylet::reproduce
