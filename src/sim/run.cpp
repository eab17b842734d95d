// SPDX-License-Identifier: GPL-3.0-or-later
#include "stylet/sim/run.hpp"

#include "base_steps.hpp"
#include "needles_in_place.hpp"
#include "stylet/core/flush_denormals.hpp"
#include "stylet/core/version.hpp"
#include "stylet/sim/far_gland.hpp"
#include "stylet/sim/gland_watch.hpp"
#include "stylet/sim/harms.hpp"
#include "stylet/sim/prediction.hpp"
#include "stylet/sim/recorded_steps.hpp"
#include "stylet/sim/target_motion.hpp"
#include "stylet/sim/unbroken_surface.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

namespace stylet {

namespace {

double quantile(const std::vector<double>& sorted, double q) {
  if (sorted.empty()) return 0.0;
  const auto at = static_cast<std::size_t>(std::lround(q * static_cast<double>(sorted.size() - 1)));
  return sorted[std::min(at, sorted.size() - 1)];
}

class Runner {
 public:
  Runner(const std::shared_ptr<const Model>& model, RunObserver& observer, KnownTargets& targets,
         const Progress& progress)
      : model_(model),
        simulation_(model, needles_of(*model)),
        observer_(observer),
        targets_(targets),
        progress_(progress) {
    summary_.version = version();
    summary_.scenario = model->scenario().name;
    summary_.nodes = model->mesh().node_count();
    summary_.tets = model->mesh().tet_count();
    summary_.warnings = model->warnings();
  }

  Result<Summary> all() {
    const auto& insertions = model_->insertions();
    for (const PlannedInsertion& insertion : insertions) total_s_ += insertion.motion.duration_s();
    choose_frames();
    if (Result<> ready = put_in_place(); !ready) return ready.error();
    for (std::size_t i = 0; i < insertions.size(); ++i) {
      if (auto done = one(insertions[i], planned_steps(*model_, insertions[i])); !done) return done.error();
      if (i + 1 < insertions.size() && simulation_.last_step().tip_state != TipState::air) {
        return input_error(fmt::format("insertion[{}]", i),
                           "the needle is still in the tissue when the next insertion starts",
                           "Draw the needle out further: use a larger approach_mm, or a longer recorded motion");
      }
    }
    return sum_up();
  }

  Result<Summary> recorded(std::span<const Step> steps) {
    const RecordedSteps all(steps);
    BaseSteps motion;
    motion.count = static_cast<long>(all.count());
    motion.duration_s = steps.back().time_s;
    motion.base = [&all](long k) { return all.at(k - 1).base; };
    motion.dt_s = [&all](long k) { return all.at(k - 1).dt_s; };
    total_s_ = motion.duration_s;
    choose_frames();
    if (Result<> ready = put_in_place(); !ready) return ready.error();
    if (auto done = one(model_->insertions().front(), motion); !done) return done.error();
    return sum_up();
  }

 private:
  Result<> put_in_place() {
    auto remarks = put_in_staying_needles(simulation_, progress_);
    if (!remarks) return remarks.error();
    remarks_in_place_ = *std::move(remarks);
    summary_.warnings.insert(summary_.warnings.end(), remarks_in_place_.begin(), remarks_in_place_.end());
    return Ok{};
  }

  void choose_frames() {
    const auto& output = model_->scenario().output;
    const double by_count = total_s_ / std::max(1, output.max_frames);
    frame_every_s_ = output.frames_per_s > 0.0 ? std::max(1.0 / output.frames_per_s, by_count) : 1e30;
  }

  Summary sum_up() {
    if (peak_N_ > 0.0) {
      summary_.residual_force_balance /= peak_N_;
      summary_.residual_torque_balance /= peak_N_;
    }
    summary_.capacity = simulation_.insertion().capacities();
    std::sort(step_us_.begin(), step_us_.end());
    summary_.step_us_p50 = quantile(step_us_, 0.5);
    summary_.step_us_p99 = quantile(step_us_, 0.99);
    summary_.step_us_p999 = quantile(step_us_, 0.999);
    summary_.step_us_max = step_us_.empty() ? 0.0 : step_us_.back();
    if (model_->kernel()) {
      const MeshKernel::Blur blur = model_->kernel()->blur();
      summary_.mesh_blur = {blur.smallest_mm, blur.median_mm, blur.largest_mm, blur.nodes};
    }
    note_harms();
    note_condition();
    note_flags();
    return summary_;
  }

  Result<> one(const PlannedInsertion& insertion, const BaseSteps& motion) {
    const FlushDenormals flush;  // as in the real-time loop, so that the results are equal
    const double start = simulation_.time_s();
    const long deepest = deepest_step(*model_, insertion, motion);
    simulation_.place(insertion);
    UnbrokenSurface unbroken;
    FarGland far_gland;
    std::optional<GlandWatch> gland;
    if (!model_->target_regions().empty()) {
      if (auto ready = prepare_target_motion(); !ready) return ready;
      gland.emplace(target_names());
    }
    std::optional<BesideNeedles> beside;
    if (!model_->staying().empty()) {
      beside.emplace(simulation_, target_motion_ ? &*target_motion_ : nullptr, target_names(), motion.base(deepest),
                     remarks_in_place_);
    }
    if (auto r = take_frame("before"); !r) return r;
    double next_frame = start + frame_every_s_;  // the frame "before" is the first of the series
    auto watch = [&](long k, const Step& step, double cpu_us) -> Result<> {
      Step record = step;
      record.step_us = cpu_us;
      if (auto r = account(record, insertion); !r) return r;
      unbroken.add(simulation_);
      if (gland) {
        const TargetMotion::Moment now = target_motion_->now(simulation_.insertion());
        summary_.gland_path.push_back(
            gland->add(record, simulation_.new_events(), now.motion, now.at_rest, k == deepest));
        far_gland.add(record, now.motion);
        if (beside) beside->add(record, simulation_.new_events(), now.motion, now.at_rest, k == deepest);
      }
      if (k == deepest) {
        const std::optional<Vec3> tip_error = tip_error_mm(simulation_.insertion(), simulation_.last_step());
        if (keep_largest(tip_error) || !summary_.in_place) {
          if (beside) summary_.in_place = beside->result(tip_error);
        }
      }
      std::string label;
      for (const Event& event : simulation_.new_events()) {
        summary_.events.push_back(event);
        if (event.kind != EventKind::region_entered && event.kind != EventKind::retraction_start)
          label = to_string(event.kind);
      }
      if (k == deepest) label = "deepest";
      if (!label.empty() && label != "withdrawn") {
        if (auto r = take_frame(label); !r) return r;
      } else if (record.time_s >= next_frame) {
        next_frame += frame_every_s_ * std::max(1.0, std::ceil((record.time_s - next_frame) / frame_every_s_ + 1e-9));
        if (auto r = take_frame({}); !r) return r;
      }
      if (k % 64 == 0) report(progress_, "inserting " + insertion.name, record.time_s / total_s_);
      return Ok{};
    };
    if (auto done = drive(simulation_, motion, motion.count, watch); !done) return done;
    if (gland) keep(gland->result());
    for (std::string& warning : unbroken.warnings()) summary_.warnings.push_back(std::move(warning));
    if (auto warning = far_gland.warning()) summary_.warnings.push_back(std::move(*warning));
    return take_frame("after");
  }

  void keep(const GlandMotion& motion) {
    summary_.gland_motions.push_back(motion);
    const auto& shifts = summary_.target_shifts;
    if (!shifts.empty() && shifts.back().largest_mm >= summary_.target_shift_max_mm) summary_.gland = motion;
  }

  /// @return whether it is the largest so far
  bool keep_largest(const std::optional<Vec3>& tip_error) {
    if (!tip_error) return false;
    if (summary_.tip_error_mm && tip_error->norm() <= summary_.tip_error_mm->norm()) return false;
    summary_.tip_error_mm = tip_error;
    return true;
  }

  [[nodiscard]] std::vector<std::string> target_names() const {
    std::vector<std::string> names;
    for (const int region : model_->target_regions())
      names.push_back(model_->mesh().regions[static_cast<std::size_t>(region)]);
    return names;
  }

  Result<> account(const Step& record, const PlannedInsertion& insertion) {
    ++summary_.steps;
    summary_.peak_axial_N = std::max(summary_.peak_axial_N, std::abs(record.force_axial_N));
    summary_.peak_sagittal_N = std::max(summary_.peak_sagittal_N, std::abs(record.force_sagittal_N));
    summary_.peak_lateral_N = std::max(summary_.peak_lateral_N, std::abs(record.force_lateral_N));
    peak_N_ = std::max(peak_N_, Vec3(record.force_axial_N, record.force_sagittal_N, record.force_lateral_N).norm());
    summary_.contacts_max = std::max(summary_.contacts_max, record.contacts);
    const Vec3 off = record.tip_mm - insertion.entry;
    summary_.tip_deflection_mm =
        std::max(summary_.tip_deflection_mm, (off - insertion.direction * insertion.direction.dot(off)).norm());
    step_us_.push_back(record.step_us);
    const auto changes = simulation_.insertion().compliance().remeshing();
    for (const RemeshEvent& change : changes.last(static_cast<std::size_t>(simulation_.last_step().remeshings)))
      summary_.mesh_changes.push_back({record.time_s, record.base_depth_mm, change});
    const unsigned flags = simulation_.last_step().flags;
    for (std::size_t bit = 0; bit < flag_counts_.size(); ++bit) {
      if (flags & (1u << bit)) ++flag_counts_[bit];
    }
    return observer_.on_step(record);
  }

  Result<> take_frame(const std::string& label) {
    Simulation::Balance balance;
    const Frame frame = simulation_.frame(label, &balance);
    // sum_up() divides by the peak force.
    summary_.residual_force_balance = std::max(summary_.residual_force_balance, balance.force_N);
    summary_.residual_torque_balance = std::max(summary_.residual_torque_balance, balance.torque_N);
    summary_.compliance_condition =
        std::max(summary_.compliance_condition, simulation_.insertion().compliance_condition());
    if (label == "deepest" && target_motion_) {
      const TargetShift shift = target_motion_->shift(simulation_.insertion());
      summary_.target_shifts.push_back(shift);
      if (shift.largest_mm >= summary_.target_shift_max_mm) {
        summary_.target_shift_centroid_mm = shift.centroid_mm;
        summary_.target_shift_max_mm = shift.largest_mm;
      }
    }
    return observer_.on_frame(frame);
  }

  Result<> prepare_target_motion() {
    if (target_motion_) return Ok{};
    auto motion = targets_.of(model_, progress_);
    if (!motion) return motion.error();
    target_motion_ = std::move(*motion);
    return Ok{};
  }

  void note_harms() {
    for (std::string& harm : harms(summary_.events)) summary_.warnings.push_back(std::move(harm));
  }

  /// Warns about a lossy update of K⁻¹: the Woodbury formula loses log₁₀(condition number) digits.
  void note_condition() {
    constexpr double digits_lost = 1e8;
    double worst = 0.0;
    for (const MeshChange& m : summary_.mesh_changes) {
      if (m.change.condition > worst) worst = m.change.condition;
    }
    if (worst > digits_lost) {
      summary_.warnings.push_back(fmt::format(
          "The inverse stiffness was updated for a change of the mesh by a matrix with the condition number {:.0e}, "
          "and has lost half of its digits. Use coupling.engine = \"condensed\" or a better mesh.",
          worst));
    }
  }

  void note_flags() {
    static const std::array<const char*, kFlags> texts{
        "the solver did not converge to the full tolerance; a smaller run.dt_ms helps",
        "the stick/slip state of a contact was frozen for one sub-step",
        "compliance was missing, because the needle had left the prepared corridor; the compliance at the tip's last "
        "place was used instead, or, at the skin, the tissue did not resist the tip; raise coupling.corridor_mm or "
        "coupling.spare_nodes",
        "there was no room for another contact; raise coupling.contacts",
        "the base moved further in one step than the sub-steps can follow; a smaller run.dt_ms helps",
        "the pose of the base was not finite, so the step was not taken",
        "the tip was inside the tissue and no force acted on it, because it started there, entered too flat to the "
        "skin, slipped off it, or had gone through the far side; start the needle outside of the tissue, and enter it "
        "less flat to the skin",
        "the program's own law of cutting gave a number that is negative or not finite, so the built-in law was used "
        "instead; correct the law"};
    for (std::size_t bit = 0; bit < texts.size(); ++bit) {
      if (flag_counts_[bit] > 0)
        summary_.warnings.push_back(
            fmt::format("In {} of {} steps: {}.", flag_counts_[bit], summary_.steps, texts[bit]));
    }
  }

  std::shared_ptr<const Model> model_;
  Simulation simulation_;
  std::optional<TargetMotion> target_motion_;  ///< solved for before the first step; empty without a target
  RunObserver& observer_;
  KnownTargets& targets_;
  const Progress& progress_;
  double peak_N_ = 0.0;  ///< largest magnitude of the hand's force
  double total_s_ = 0.0;
  double frame_every_s_ = 0.0;
  std::vector<double> step_us_;
  std::vector<std::string> remarks_in_place_;
  static constexpr std::size_t kFlags = 8;  ///< number of values of Step::Flag
  std::array<long, kFlags> flag_counts_{};
  Summary summary_;
};

}  // namespace

Result<Summary> run(const std::shared_ptr<const Model>& model, RunObserver& observer, const Progress& progress) {
  KnownTargets none;
  return run(model, observer, none, progress);
}

Result<Summary> run(const std::shared_ptr<const Model>& model, RunObserver& observer, KnownTargets& targets,
                    const Progress& progress) {
  return Runner(model, observer, targets, progress).all();
}

Result<Summary> run_recorded(const std::shared_ptr<const Model>& model, std::span<const Step> steps,
                             RunObserver& observer, const Progress& progress) {
  if (steps.empty()) return input_error("recording", "it has no steps", "Record one with `stylet serve`");
  if (model->insertions().size() != 1)
    return input_error(
        "recording",
        fmt::format("its scenario has {} insertions, but only a single insertion can be repeated step by step",
                    model->insertions().size()),
        "Run the scenario itself");
  for (std::size_t k = 0; k < steps.size(); ++k) {
    if (!steps[k].base.origin.allFinite() || !steps[k].base.rotation.coeffs().allFinite() || !(steps[k].dt_s > 0.0))
      return input_error(fmt::format("recording, step {}", k),
                         "it has no pose of the base, because an earlier version wrote the file",
                         "Record it again, or run its scenario");
    if (steps[k].rest_steps < 0 || (k == 0 && steps[k].rest_steps != 0))
      return input_error(fmt::format("recording, step {}", k),
                         fmt::format("there cannot be {} steps at rest before it", steps[k].rest_steps),
                         "Give 0 or more, and 0 before the first step");
  }
  KnownTargets none;
  return Runner(model, observer, none, progress).recorded(steps);
}

}  // namespace stylet
