// SPDX-License-Identifier: GPL-3.0-or-later
// Computing time of a step here and in other software, on the same meshes.
#include "../rows.hpp"
#include "stylet/io/mesh_io.hpp"
#include "stylet/measure/timing.hpp"
#include "stylet/sim/simulation.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

namespace stylet::validate {

namespace {

/// CPU time of a step of other software on the two meshes [ms]: SOFA v26.06.00 with one thread. It was measured for the
/// shared data (sphere_in_box/SOURCE.md) on another machine.
struct Other {
  const char* name;
  double small_ms;
  double large_ms;
};
constexpr Other kOthers[] = {{"SOFA: tissue alone, direct", 10.8, 2941},
                             {"SOFA: tissue alone, 25 CG iterations", 0.76, 8.4},
                             {"SOFA: precomputed inverse", 1.54, 121},
                             {"SOFA: flexible needle tied at 17 points", 19.6, 4397},
                             {"SOFA: needle plugin, insertion", 12.5, 4100}};

struct Timed {
  double nodes = 0.0;
  double median_ms = 0.0;
  double worst_ms = 0.0;
  int contacts = 0;
};

/// Times a needle through the ball, from the face opposite to the held face. Steps count from half of the depth on.
Timed time_steps(const std::filesystem::path& file, const Progress& progress) {
  auto mesh = need(read_tet_mesh(file, {.scale = 1000.0}));
  Eigen::AlignedBox3d box;
  for (const Vec3& x : mesh.nodes) box.extend(x);
  Scenario scenario;
  scenario.patient.source = file.filename().string();
  scenario.tissue_model.preset = TissuePreset::linear;
  for (const std::string& region : mesh.regions) {
    TissueParameters tissue = default_tissue("body", TissuePreset::linear);
    tissue.young_kPa = 20.0;
    tissue.poisson = 0.45;
    tissue.puncture_N = region == mesh.regions.front() ? tissue.puncture_N : 0.0;
    scenario.tissue[region] = tissue;
  }
  scenario.fixed.outer = OuterSupport::none;
  const Vec3 lo = box.min();
  const Vec3 hi = box.max();
  scenario.fixed.box_mm = {lo.x() - 1, lo.y() - 1, lo.z() - 1, hi.x() + 1, hi.y() + 1, lo.z() + 0.01};
  InsertionPlan plan;
  const Vec3 entry(box.center().x() + 2.0, box.center().y() + 1.0, hi.z());
  plan.entry_mm = {entry.x(), entry.y(), entry.z()};
  plan.direction = {0.0, 0.0, -1.0};
  plan.depth_mm = 0.8 * (hi.z() - lo.z());
  scenario.insertions.push_back(plan);
  Timed timed;
  timed.nodes = mesh.node_count();
  const auto model = need(Model::compile(scenario, std::move(mesh), file.filename().string(), {}, progress));

  Simulation simulation(model);
  const PlannedInsertion& insertion = model->insertions().front();
  simulation.place(insertion.motion.at(0.0), insertion.entry, insertion.direction);
  std::vector<double> ms;
  constexpr double dt = 1e-3;
  for (double t = dt; t < insertion.motion.duration_s(); t += dt) {
    simulation.prepare();
    const Pose base = insertion.motion.at(t);
    const double seconds = measure::cpu_seconds([&] { simulation.step(base, dt); });
    if (simulation.last_step().base_depth_mm < 0.5 * plan.depth_mm) continue;
    ms.push_back(1e3 * seconds);
    timed.worst_ms = std::max(timed.worst_ms, ms.back());
    timed.contacts = std::max(timed.contacts, simulation.last_step().contacts);
  }
  timed.median_ms = measure::median(std::move(ms));
  return timed;
}

Finding step_time(Context& context) {
  Finding finding;
  Curve ours{.label = "Stylet on this machine: insertion"};
  std::string each;
  for (const char* name : {"sphere_in_box_573.msh", "sphere_in_box_5037.msh"}) {
    const std::string file = std::string("sphere_in_box/") + name;
    const auto path = need_file(context, file);
    const auto timed = time_steps(path, context.progress());
    ours.add(timed.nodes, timed.median_ms);
    finding.value = timed.median_ms;
    each += fmt::format(" {:.0f} nodes: median {:.3f} ms, worst {:.2f} ms, {} contacts.", timed.nodes, timed.median_ms,
                        timed.worst_ms, timed.contacts);
  }
  finding.note =
      "Processor time of a step from half of the depth on." + each +
      " The times of the other software are from another machine and for other models, elastic and dynamic; only their "
      "order of magnitude can be compared.";
  finding.plot = {
      .x_label = "nodes", .y_label = "processor time of a step [ms]", .log_x = true, .log_y = true, .curves = {ours}};
  for (const Other& other : kOthers)
    finding.plot.curves.push_back(
        {.label = other.name, .x = ours.x, .y = {other.small_ms, other.large_ms}, .kind = Curve::Kind::reference});
  return finding;
}

}  // namespace

std::vector<RowSpec> other_software_rows() {
  return {{"step_time", Group::other_code, "The time of a step hardly grows with the mesh",
           "SOFA v26.06.00 on the same two meshes (573 and 5,037 nodes)", "ms", Accepted::information(), true,
           step_time}};
}

}  // namespace stylet::validate
