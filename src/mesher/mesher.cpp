// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/mesher/mesher.hpp"

#include "anatomy.hpp"
#include "local_changes.hpp"
#include "seeds.hpp"
#include "sizing.hpp"
#include "surface_distance.hpp"
#include "tetrahedraliser.hpp"
#include "volume_fit.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <cmath>

namespace stylet {
namespace meshing {
namespace {

constexpr double kNodeTolerance = 0.02;
constexpr int kMostMeshings = 10;

TetrahedraliserInput input_for(const Anatomy& a, const SizeField& size, double scale, Index nodes) {
  TetrahedraliserInput in;
  in.label = [&a](const Vec3& p) { return a.label(p); };
  in.size = [&size, scale](const Vec3& p) { return size(p, scale); };
  in.box = a.box();
  in.box.min().array() -= 5;
  in.box.max().array() += 5;
  in.seeds = surface_seeds(a, size, scale, 2.0);
  in.most_nodes = static_cast<std::size_t>(nodes) * 6 + 20000;
  return in;
}

TetMesh to_mesh(const RawMesh& raw, const Anatomy& a) {
  TetMesh m;
  m.nodes = raw.nodes;
  m.tets = raw.tets;
  std::vector<int> region(a.structures.size(), -1);
  for (std::size_t s = 0; s < a.structures.size(); ++s) {
    if (std::find(raw.label.begin(), raw.label.end(), static_cast<int>(s) + 1) == raw.label.end()) continue;
    region[s] = static_cast<int>(m.regions.size());
    m.regions.push_back(a.structures[s].name);
  }
  for (const int l : raw.label) m.tet_region.push_back(region[l - 1]);
  return m;
}

Result<MeshedAnatomy> mesh(Anatomy a, const MeshOptions& options, const Progress& progress,
                           std::chrono::steady_clock::time_point start) {
  settle_overlaps(a);
  add_surroundings(a, options);
  const Index wanted = options.nodes > 0 ? options.nodes : options.preset == MeshPreset::paper ? 570 : 3000;
  const SizeField size(a, options.preset);
  double scale = size.scale_for(wanted);
  const double c00 = static_cast<double>(clock()) * 1e-6;
  // log(nodes) is nearly linear in log(scale): secant steps.
  std::vector<std::pair<double, double>> tried;
  std::unique_ptr<Tetrahedraliser> best;
  double best_error = HUGE_VAL;
  for (int i = 0; i < kMostMeshings; ++i) {
    report(progress, "searching element size", static_cast<double>(i) / kMostMeshings);
    auto t = std::make_unique<Tetrahedraliser>(input_for(a, size, scale, wanted));
    if (auto r = t->refine(); !r) return r.error();
    const double n = static_cast<double>(t->mesh().nodes.size());
    const double error = std::abs(n / wanted - 1);
    if (error < best_error) {
      best_error = error;
      best = std::move(t);
    }
    if (error < kNodeTolerance) break;
    tried.emplace_back(std::log(scale), std::log(n));
    double slope = -2.5;
    if (tried.size() > 1) {
      const auto& [x0, y0] = tried[tried.size() - 2];
      const auto& [x1, y1] = tried.back();
      slope = std::clamp((y1 - y0) / (x1 - x0), -4.0, -1.0);
    }
    scale = std::exp(tried.back().first + (std::log(static_cast<double>(wanted)) - tried.back().second) / slope);
  }
  report(progress, "optimising elements", 0);
  const double c0 = static_cast<double>(clock()) * 1e-6;
  best->optimise(15);
  EditableMesh editable(best->mesh());
  const double c1 = static_cast<double>(clock()) * 1e-6;
  improve(editable, a, 1.35);
  const double c2 = static_cast<double>(clock()) * 1e-6;
  fit_volumes(editable, a);
  const double c3 = static_cast<double>(clock()) * 1e-6;
  improve(editable, a, 1.35);
  const double c4 = static_cast<double>(clock()) * 1e-6;
  if (getenv("TM"))
    fprintf(stderr, "prep %.2f search %.2f (%zu) opt %.2f imp %.2f fit %.2f imp %.2f\n", c00, c0 - c00,
            tried.size() + 1, c1 - c0, c2 - c1, c3 - c2, c4 - c3);
  MeshedAnatomy out;
  out.mesh = to_mesh(editable.result(), a);
  MeshReport& r = out.report;
  r.notes = a.notes;
  r.contour_points = a.contour_points;
  r.contour_points_kept = a.contour_points_kept;
  r.quality = mesh_quality(out.mesh);
  DistanceSummary total;
  for (std::size_t k = 0; k < out.mesh.regions.size(); ++k) {
    RegionReport region;
    region.name = out.mesh.regions[k];
    region.tets = r.quality.region_tets[k];
    region.volume_cc = r.quality.region_volume_cc[k];
    const Structure& s = *a.find(region.name);
    region.input_volume_cc = s.input_volume / 1000;
    const DistanceSummary d = distance_to_boundary(out.mesh, static_cast<int>(k), s.boundary);
    if (d.count > 0) {
      region.surface_mean_mm = d.sum / static_cast<double>(d.count);
      region.surface_max_mm = d.max;
      total.sum += d.sum;
      total.count += d.count;
      total.max = std::max(total.max, d.max);
    }
    r.regions.push_back(region);
  }
  if (total.count > 0) r.surface_mean_mm = total.sum / static_cast<double>(total.count);
  r.surface_max_mm = total.max;
  r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return out;
}

}  // namespace
}  // namespace meshing

Result<MeshedAnatomy> mesh_contours(const ContourSet& contours, const MeshOptions& options, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  auto a = meshing::anatomy_of(contours, options, progress);
  if (!a) return a.error();
  return meshing::mesh(*std::move(a), options, progress, start);
}

Result<MeshedAnatomy> mesh_labels(const LabelImage& image, const MeshOptions& options, const Progress& progress) {
  const auto start = std::chrono::steady_clock::now();
  auto a = meshing::anatomy_of(image, options, progress);
  if (!a) return a.error();
  return meshing::mesh(*std::move(a), options, progress, start);
}

}  // namespace stylet
