// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/measure/pictures_bench.hpp"

#include "driven_needle.hpp"
#include "stylet/geom/slice.hpp"
#include "stylet/imaging/fluoroscope.hpp"
#include "stylet/imaging/ultrasound_scanner.hpp"
#include "stylet/measure/demo.hpp"
#include "stylet/measure/timing.hpp"
#include "stylet/probe/patient_probe.hpp"
#include "stylet/sim/display_field.hpp"
#include "stylet/sim/display_near_field.hpp"
#include "stylet/sim/simulation.hpp"

#include <cmath>
#include <numbers>

namespace stylet::measure {

namespace {

constexpr int kContacts = 40;
constexpr int kPictures = 60;
constexpr double kWay_mm = 90.0;
constexpr double kPerStep_mm = 0.02;

/// Times pictures of one mesh and adds a row for each kind.
class Photographer {
 public:
  Photographer(std::shared_ptr<const Model> model, std::vector<PictureRow>& rows, const Progress& progress)
      : model_(std::move(model)), mesh_(model_->mesh()), rows_(rows), progress_(progress) {}

  Result<> display() {
    const double before = thread_cpu_s();
    const auto field = DisplayField::prepare(model_, {}, progress_);
    if (!field) return field.error();
    std::vector<SurfacePoint> points;
    for (const Index node : (*field)->surface()) points.push_back({{node, -1, -1}, {1.0, 0.0, 0.0}});
    DisplayNearField near(model_, points);
    DisplayField::Load load = (*field)->make_load();
    Slicer slicer(mesh_);
    Eigen::Matrix3Xf u(3, mesh_.node_count()), x(3, 2 * mesh_.tet_count());
    const double prepare_s = thread_cpu_s() - before;

    std::vector<double> surfaces_us, section_us;
    Simulation simulation(model_);
    const PlannedInsertion& plan = model_->insertions().front();
    const Vec3 across = plan.direction.unitOrthogonal();
    Pose base = plan.motion.at(0.0);
    simulation.place(base, plan.entry, plan.direction);
    const int steps = static_cast<int>((kWay_mm - simulation.last_step().base_depth_mm) / kPerStep_mm);
    for (int k = 1; k <= steps; ++k) {
      base.origin += kPerStep_mm * plan.direction;
      simulation.prepare();
      simulation.step(base, kDrivenStep_s);
      if (k % (steps / kPictures) != 0) continue;
      const std::vector<TissueForce> forces = simulation.insertion().tissue_forces();
      surfaces_us.push_back(1e6 * cpu_seconds([&] {
                              (*field)->set(forces, load);
                              auto shown = u.leftCols(static_cast<Eigen::Index>(points.size()));
                              (*field)->displacement((*field)->surface(), load, shown);
                              near.set(forces);
                              near.add(shown);
                            }));
      const double turn = 2.0 * std::numbers::pi * k / steps;
      section_us.push_back(1e6 * cpu_seconds([&] {
                             (*field)->set(forces, load);
                             slicer.cut(simulation.last_step().tip_mm,
                                        Eigen::AngleAxisd(turn, plan.direction) * across);
                             auto shown = u.leftCols(static_cast<Eigen::Index>(slicer.nodes().size()));
                             (*field)->displacement(slicer.nodes(), load, shown);
                             slicer.positions(shown, x.leftCols(static_cast<Eigen::Index>(slicer.vertices().size())));
                           }));
      report(progress_, "showing", static_cast<double>(k) / steps);
    }
    add("surfaces", std::move(surfaces_us), prepare_s);
    add("section", std::move(section_us), prepare_s);
    return Ok{};
  }

  Result<> images(PatientProbe& probe) {
    std::vector<TissueEcho> echoes;
    for (const std::string& region : mesh_.regions) echoes.push_back(default_echo(region));
    double before = thread_cpu_s();
    Result<UltrasoundScanner> scanner = UltrasoundScanner::create(mesh_, echoes, UltrasoundSettings{});
    if (!scanner) return scanner.error();
    const double prepare_s = thread_cpu_s() - before;
    const Vec3 gland(0.0, 0.0, probe.seat().gland_mm);
    for (const UltrasoundArray array : {UltrasoundArray::transverse, UltrasoundArray::sagittal}) {
      const ProbePlace place = probe.place({.kind = ProbeKind::biplane});
      time_moments(array == UltrasoundArray::sagittal ? "ultrasound, sagittal" : "ultrasound, transverse", gland,
                   prepare_s, [&](const Moment& moment) { scanner->scan(moment, ProbeKind::biplane, place, array); });
    }
    before = thread_cpu_s();
    const auto unit = Fluoroscope::create(mesh_, {.angle_deg = 35.0});
    if (!unit) return unit.error();
    time_moments("X-ray", gland, thread_cpu_s() - before, [&](const Moment& moment) { (*unit)->expose(moment); });
    return Ok{};
  }

  void press(PatientProbe& probe, double prepare_s) {
    std::vector<double> us;
    ProbeSettings at{.kind = ProbeKind::biplane};
    for (int k = 0; k < kPictures; ++k) {
      at.depth_mm = probe.seat().gland_mm - 7.5 + 0.25 * k;
      at.lift_mm = 8.0;
      us.push_back(1e6 * cpu_seconds([&] { probe.press(at); }));
    }
    add("probe", std::move(us), prepare_s);
  }

 private:
  /// Times pictures of a gland that is dragged by a needle in it, with the needle's forces and 20 seeds.
  template <class Picture>
  void time_moments(const char* name, const Vec3& gland, double prepare_s, Picture&& picture) {
    Moment moment = moment_at_rest(mesh_);
    const Vec3 tip = gland + Vec3(15.0, 5.0, 10.0);
    moment.needles.push_back({{tip - Vec3(0, 0, 120), tip}, 1.27});
    for (int k = 0; k < 15; ++k)
      moment.forces.push_back({tip - Vec3(0, 0, 4.0 * k), {0, 0, 0.2}, Vec3::UnitZ(), 4.0, 1.05, 0.004, 0.49});
    for (int k = 0; k < 20; ++k)
      moment.seeds.push_back({gland + Vec3(8.0 * (k % 4) - 12.0, 6.0 * (k / 4 % 3) - 6.0, 5.0 * (k % 5) - 10.0)});
    std::vector<double> us;
    for (int k = 0; k < kPictures; ++k) {
      for (Index node = 0; node < mesh_.node_count(); ++node) {
        const double from2 = (mesh_.nodes[static_cast<std::size_t>(node)] - tip).squaredNorm();
        moment.displacement(2, node) = static_cast<float>((3.0 + 0.05 * k) * std::exp(-from2 / 900.0));
      }
      us.push_back(1e6 * cpu_seconds([&] { picture(moment); }));
      report(progress_, "making pictures", (k + 1.0) / kPictures);
    }
    add(name, std::move(us), prepare_s);
  }

  void add(const char* picture, std::vector<double> us, double prepare_s) {
    rows_.push_back({mesh_.node_count(), picture, quantiles(std::move(us)), prepare_s});
  }

  std::shared_ptr<const Model> model_;
  const TetMesh& mesh_;
  std::vector<PictureRow>& rows_;
  const Progress& progress_;
};

}  // namespace

Result<std::vector<PictureRow>> bench_pictures(const PicturesBenchOptions& options, const Progress& progress) {
  std::vector<PictureRow> rows;
  for (const Index nodes : {3000, 20000}) {
    if (nodes > options.largest) continue;
    auto anatomy = mesh_demo(nodes, progress);
    if (!anatomy) return anatomy.error();
    Scenario scenario = driven_scenario(kContacts);
    scenario.probe.kind = ProbeKind::biplane;
    const auto model = Model::compile(scenario, std::move(anatomy->mesh), "the demo", {}, progress);
    if (!model) return model.error();
    Photographer photographer(*model, rows, progress);
    if (auto done = photographer.display(); !done) return done.error();
    const double before = thread_cpu_s();
    auto probe = PatientProbe::prepare(**model, "the demo", progress);
    if (!probe) return probe.error();
    const double prepare_s = thread_cpu_s() - before;
    if (auto done = photographer.images(*probe); !done) return done.error();
    photographer.press(*probe, prepare_s);
  }
  return rows;
}

}  // namespace stylet::measure
