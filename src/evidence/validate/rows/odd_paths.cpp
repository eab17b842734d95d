// SPDX-License-Identifier: GPL-3.0-or-later
// Needles off the beaten track: every step must have a balance, and the time step must not decide what happens.
#include "../hand_loops.hpp"
#include "../rows.hpp"
#include "stylet/geom/tet_mesh.hpp"
#include "stylet/io/label_image_io.hpp"
#include "stylet/mesher/mesher.hpp"
#include "stylet/phantom/phantom.hpp"
#include "stylet/sim/simulation.hpp"

#include <fmt/format.h>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

namespace stylet::validate {

namespace {

constexpr std::array kSteps_ms{0.25, 0.5, 1.0, 2.0, 5.0};
/// Events, forces and work are compared up to this step.
constexpr double kLargestCompared_ms = 2.0;
constexpr double kMostFlagged = 1e-4;  // of all steps
constexpr double kSameDepth_mm = 0.5;  // of an event
constexpr double kSameForce = 0.03;    // RMS of the axial force over its peak
constexpr double kMostGained = 1e-3;   // of the work that the hand puts in
constexpr double kAboveEuler = 1.2;
constexpr double kApproach_mm = 3.0;
constexpr double kBeyond_mm = 15.0;  // of a path through the base, beyond the gland
constexpr double kSpeed_mm_per_s = 20.0;

/// Where the hand is. Lengths of time follow from the speed.
struct Place {
  double depth_mm = 0.0;  ///< of the base, from skin contact
  double roll_deg = 0.0;
};

struct Path {
  std::string name;
  Vec3 through = Vec3::Zero();  ///< [mm] from the gland's centre, in half widths of the gland: a point of the line
  double tilt_deg = 0.0;        ///< towards anterior, in the sagittal plane
  bool beyond = false;          ///< goes on beyond the gland
  double outer_mm = 1.27, lumen_mm = 1.0;
  double speed_mm_per_s = kSpeed_mm_per_s;
  double half_out = 0.0;    ///< the needle is drawn out by this share of its depth, and goes in again
  double turned_deg = 0.0;  ///< turned about its axis at two thirds of its depth
  double tremor_mm = 0.0;   ///< amplitude in each direction
};

std::vector<Path> paths() {
  return {
      {.name = "through the base", .through = {0.5, 0.0, 0.0}, .beyond = true},
      {.name = "tangential to the gland", .through = {1.0, 0.0, 0.0}},
      {.name = "through the urethra", .through = {0.0, 0.0, 0.0}},
      {.name = "along the rectum", .through = {0.0, 1.1, 0.0}},
      {.name = "to the pubic arch", .through = {0.3, -1.1, 0.0}},
      {.name = "oblique by 20°", .through = {0.3, 0.0, 0.0}, .tilt_deg = 20.0},
      {.name = "oblique by 24°", .through = {0.3, 0.0, 0.0}, .tilt_deg = 24.0},
      {.name = "half out and in again", .through = {0.4, 0.2, 0.0}, .half_out = 0.5},
      {.name = "turned by 180°", .through = {0.4, 0.2, 0.0}, .turned_deg = 180.0},
      {.name = "500 mm/s", .through = {0.4, 0.2, 0.0}, .speed_mm_per_s = 500.0},
      {.name = "14 gauge", .through = {0.4, 0.2, 0.0}, .outer_mm = 2.11, .lumen_mm = 1.6},
      {.name = "17 gauge", .through = {0.4, 0.2, 0.0}, .outer_mm = 1.47, .lumen_mm = 1.07},
      {.name = "22 gauge", .through = {0.4, 0.2, 0.0}, .outer_mm = 0.72, .lumen_mm = 0.41},
      {.name = "25 gauge", .through = {0.4, 0.2, 0.0}, .outer_mm = 0.51, .lumen_mm = 0.26},
      {.name = "a hand that trembles", .through = {0.4, 0.2, 0.0}, .tremor_mm = 0.3},
  };
}

/// A patient of the row, with the gland's box and the skin.
struct OddPatient {
  std::string name;
  TetMesh mesh;
  std::string source;  ///< file of a mask; empty: a phantom
  Eigen::AlignedBox3d gland;
  double skin_mm = 0.0;  ///< z at which a needle along z enters
};

MeshOptions mesh_options(const Scenario& scenario) {
  MeshOptions options;
  options.nodes = scenario.mesh.nodes;
  options.cull_tolerance_mm = scenario.mesh.cull_mm;
  options.layers = scenario.anatomy;
  return options;
}

/// @param mask a file of the shared data; empty: the phantom
OddPatient patient(Context& context, const std::string& mask) {
  Scenario scenario = measure::demo_scenario();
  OddPatient result;
  result.source = mask;
  if (mask.empty()) {
    result.name = "phantom 11";
    result.mesh = need(mesh_contours(demo_patient({.seed = 11}), mesh_options(scenario), context.progress())).mesh;
  } else {
    result.name = std::filesystem::path(mask).stem().stem().string();
    const auto image = need(read_label_image(need_file(context, mask)));
    result.mesh = need(mesh_labels(image, mesh_options(scenario), context.progress())).mesh;
    scenario.patient.source = mask;
    scenario.insertions.front().hole = "e4";
  }
  const auto model = need(Model::compile(scenario, result.mesh, result.name, {}, context.progress()));
  const std::set<int> target(model->target_regions().begin(), model->target_regions().end());
  const TetMesh& mesh = model->mesh();
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!target.contains(mesh.tet_region[t])) continue;
    for (const Index node : mesh.tets[t]) result.gland.extend(mesh.nodes[static_cast<std::size_t>(node)]);
  }
  result.skin_mm = model->insertions().front().entry.z();
  return result;
}

/// The motion of the hand along a path.
class OddMotion {
 public:
  OddMotion(const Path& path, const PlannedInsertion& plan, double length_mm)
      : path_(path), plan_(plan), length_mm_(length_mm) {
    const double depth = plan.depth_mm;
    go_to({-kApproach_mm, 0.0});
    if (path.turned_deg != 0.0) {
      go_to({2.0 * depth / 3.0, 0.0});
      go_to({2.0 * depth / 3.0, path.turned_deg});
    }
    go_to({depth, path.turned_deg});
    if (path.half_out > 0.0) {
      go_to({(1.0 - path.half_out) * depth, path.turned_deg});
      go_to({depth, path.turned_deg});
    }
    keys_.push_back({keys_.back().time_s + 0.3, keys_.back().at});
    go_to({-kApproach_mm, path.turned_deg});
  }

  [[nodiscard]] double duration_s() const { return keys_.back().time_s; }
  [[nodiscard]] Pose at(double time_s) const {
    std::size_t next = 1;
    while (next + 1 < keys_.size() && keys_[next].time_s < time_s) ++next;
    const Key &a = keys_[next - 1], &b = keys_[next];
    const double share = std::clamp((time_s - a.time_s) / (b.time_s - a.time_s), 0.0, 1.0);
    const double depth = std::lerp(a.at.depth_mm, b.at.depth_mm, share);
    const double roll = std::lerp(a.at.roll_deg, b.at.roll_deg, share) * std::numbers::pi / 180.0;
    Pose pose = pose_along(plan_.entry + (depth - length_mm_) * plan_.direction, plan_.direction);
    if (path_.tremor_mm > 0.0) {  // of 8 to 11 Hz, as a hand's; none at both ends, so that the loop closes
      const double ends = std::sin(std::numbers::pi * std::clamp(time_s / duration_s(), 0.0, 1.0));
      const double turns = 2.0 * std::numbers::pi * time_s;
      pose.origin += pose.rotation * Vec3(path_.tremor_mm * std::min(1.0, 4.0 * ends) *
                                          Vec3(std::sin(8.0 * turns), std::sin(9.5 * turns), std::sin(11.0 * turns)));
    }
    pose.rotation = pose.rotation * Eigen::AngleAxisd(roll, Vec3::UnitZ());
    return pose;
  }

 private:
  struct Key {
    double time_s;
    Place at;
  };
  void go_to(const Place& at) {
    if (keys_.empty()) {
      keys_.push_back({0.0, at});
      return;
    }
    constexpr double turn_deg_per_s = 180.0;
    const Place& from = keys_.back().at;
    const double time = std::max(std::abs(at.depth_mm - from.depth_mm) / path_.speed_mm_per_s,
                                 std::abs(at.roll_deg - from.roll_deg) / turn_deg_per_s);
    keys_.push_back({keys_.back().time_s + time, at});
  }

  const Path& path_;
  const PlannedInsertion& plan_;
  double length_mm_;
  std::vector<Key> keys_;
};

/// One run of a path.
struct Run {
  double dt_ms = 0.0;
  long steps = 0, flagged = 0;
  bool two_in_a_row = false;
  std::vector<std::pair<EventKind, double>> events;  ///< with the depth of the base
  std::vector<double> force_N;                       ///< axial, every kLargestCompared_ms
  double most_N = 0.0;
  double work_Nmm = 0.0, put_in_Nmm = 0.0;
  double above_euler = 0.0;  ///< largest axial force over what the needle can bear
};

/// [N] The load that the needle bears between the hand, which clamps it, and the skin: Euler's with both ends clamped.
double euler_N(const Scenario::NeedleChoice& needle, double free_mm) {
  const double d4 = std::pow(needle.diameter_mm, 4) - std::pow(*needle.lumen_diameter_mm, 4);
  const double stiffness = 1e3 * needle.young_GPa * std::numbers::pi / 64.0 * d4;  // [N mm²]
  return 4.0 * std::numbers::pi * std::numbers::pi * stiffness / (free_mm * free_mm);
}

Run run(const std::shared_ptr<const Model>& model, const OddMotion& motion, double dt_ms) {
  const PlannedInsertion& plan = model->insertions().front();
  const Scenario::NeedleChoice& needle = model->scenario().needle;
  const double dt_s = 1e-3 * dt_ms;
  const auto every = std::max(1L, std::lround(kLargestCompared_ms / dt_ms));
  Run result{.dt_ms = dt_ms};
  Simulation simulation(model);
  simulation.place(motion.at(0.0), plan.entry, plan.direction);
  Step before = simulation.last_step();
  bool was_flagged = false;
  const long count = std::lround(motion.duration_s() / dt_s);
  for (long k = 1; k <= count; ++k) {
    simulation.prepare();
    const Step& step = simulation.step(motion.at(static_cast<double>(k) * dt_s), dt_s);
    ++result.steps;
    const bool is_flagged = step.flags != 0;
    result.flagged += is_flagged ? 1 : 0;
    result.two_in_a_row = result.two_in_a_row || (is_flagged && was_flagged);
    was_flagged = is_flagged;
    result.most_N = std::max(result.most_N, std::abs(step.force_axial_N));
    const double free_mm = std::max(1.0, needle.length_mm - std::max(0.0, step.base_depth_mm));
    result.above_euler = std::max(result.above_euler, step.force_axial_N / euler_N(needle, free_mm));
    if (k % every == 0) result.force_N.push_back(step.force_axial_N);
    const double work = work_of_hand(before, step);
    result.work_Nmm += work;
    result.put_in_Nmm += std::max(0.0, work);
    before = step;
    for (const Event& event : simulation.new_events()) {
      if (event.kind != EventKind::slip_start && event.kind != EventKind::retraction_start)
        result.events.emplace_back(event.kind, event.depth_mm);
    }
  }
  return result;
}

/// The RMS difference of the axial forces of two runs, over the peak of the second.
double apart_in_force(const Run& run, const Run& finest) {
  double squares = 0.0;
  const std::size_t count = std::min(run.force_N.size(), finest.force_N.size());
  for (std::size_t k = 0; k < count; ++k) squares += std::pow(run.force_N[k] - finest.force_N[k], 2);
  return std::sqrt(squares / static_cast<double>(count)) / finest.most_N;
}

/// Describes which requirements the runs of a path do not meet. The text is empty if they meet all of them.
std::string broken(const std::vector<Run>& runs) {
  std::string text;
  const auto add = [&](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  const Run& finest = runs.front();
  for (const Run& run : runs) {
    if (run.two_in_a_row ||
        static_cast<double>(run.flagged) > std::max(1.0, kMostFlagged * static_cast<double>(run.steps)))
      add(fmt::format("{} of {} steps of {} ms flagged{}", run.flagged, run.steps, run.dt_ms,
                      run.two_in_a_row ? ", some in a row" : ""));
    if (run.above_euler > kAboveEuler)
      add(fmt::format("{:.2f} times Euler’s load at {} ms", run.above_euler, run.dt_ms));
    if (run.work_Nmm < -kMostGained * run.put_in_Nmm)
      add(fmt::format("{:.2g} of {:.3g} N mm gained at {} ms", -run.work_Nmm, run.put_in_Nmm, run.dt_ms));
    if (run.dt_ms > kLargestCompared_ms || &run == &finest) continue;
    bool same = run.events.size() == finest.events.size();
    double apart_mm = 0.0;
    for (std::size_t k = 0; same && k < run.events.size(); ++k) {
      same = run.events[k].first == finest.events[k].first;
      apart_mm = std::max(apart_mm, std::abs(run.events[k].second - finest.events[k].second));
    }
    if (!same) {
      add(fmt::format("other events at {} ms ({} for {})", run.dt_ms, run.events.size(), finest.events.size()));
    } else if (apart_mm > kSameDepth_mm) {
      add(fmt::format("an event {:.2f} mm apart at {} ms", apart_mm, run.dt_ms));
    }
    if (const double off = apart_in_force(run, finest); !(off <= kSameForce))
      add(fmt::format("forces {:.1f} % apart at {} ms", 100.0 * off, run.dt_ms));
  }
  return text;
}

Scenario scenario_of(const OddPatient& patient, const Path& path) {
  Scenario scenario = measure::demo_scenario();
  scenario.output.frames_per_s = 0.0;
  if (!patient.source.empty()) scenario.patient.source = patient.source;
  scenario.needle.diameter_mm = path.outer_mm;
  scenario.needle.lumen_diameter_mm = path.lumen_mm;
  const Vec3 half = 0.5 * patient.gland.sizes();
  const Vec3 through = patient.gland.center() + path.through.cwiseProduct(half);
  const double tilt = path.tilt_deg * std::numbers::pi / 180.0;
  const Vec3 direction(0.0, -std::sin(tilt), std::cos(tilt));
  InsertionPlan& plan = scenario.insertions.front();
  plan.hole.reset();
  plan.entry_mm = {through.x(), through.y(), through.z()};
  plan.direction = {direction.x(), direction.y(), direction.z()};
  const double way = (patient.gland.max().z() - patient.skin_mm) / direction.z();
  plan.depth_mm = std::min(way + (path.beyond ? kBeyond_mm : 0.0), scenario.needle.length_mm - 20.0);
  return scenario;
}

Finding odd_paths(Context& context) {
  Finding finding;
  finding.value = 0.0;
  long steps = 0, flagged = 0, count = 0;
  double peaks_apart = 0.0;
  std::string misses;
  for (const char* mask : {"", "msd_prostate_masks/prostate_00.nii.gz", "msd_prostate_masks/prostate_25.nii.gz"}) {
    const OddPatient who = patient(context, mask);
    for (const Path& path : paths()) {
      const Scenario scenario = scenario_of(who, path);
      const auto model = need(Model::compile(scenario, who.mesh, who.name, {}, context.progress()));
      const OddMotion motion(path, model->insertions().front(), scenario.needle.length_mm);
      std::vector<Run> runs;
      for (const double dt_ms : kSteps_ms) {
        runs.push_back(run(model, motion, dt_ms));
        steps += runs.back().steps;
        flagged += runs.back().flagged;
        if (dt_ms <= kLargestCompared_ms)
          peaks_apart = worse(peaks_apart, std::abs(runs.back().most_N / runs.front().most_N - 1.0));
      }
      ++count;
      if (const std::string what = broken(runs); !what.empty()) {
        finding.value += 1.0;
        misses += fmt::format("{}, {}: {}. ", who.name, path.name, what);
      }
      report(context.progress(), fmt::format("{}, {}", who.name, path.name), static_cast<double>(count) / 45.0);
    }
  }
  finding.note = fmt::format(
      "{} paths in three patients with steps of 0.25 to 5 ms: {} of {} steps without a balance. A path counts where "
      "more "
      "than one step in 10,000 is flagged, or two in a row; where up to 2 ms events come in another order or more than "
      "{} mm apart, or forces differ by more than {:g} % of their peak (RMS); where the hand gains work; or where a "
      "force is above {} times Euler’s load. The largest forces of the runs up to 2 ms differ by up to {:.0f} %.",
      count, flagged, steps, kSameDepth_mm, 100.0 * kSameForce, kAboveEuler, 100.0 * peaks_apart);
  finding.why_missed = misses;
  return finding;
}

}  // namespace

std::vector<RowSpec> odd_path_rows() {
  return {{"odd_paths", Group::independence, "A balance in every step on odd paths, whatever the time step",
           "the same path with steps of 0.25 ms; paths with a broken promise", "", Accepted::at_most(0.0), false,
           odd_paths}};
}

}  // namespace stylet::validate
