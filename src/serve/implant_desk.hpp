// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "implant_dose.hpp"
#include "interrupted_implant.hpp"
#include "needle_models.hpp"
#include "stylet/realtime/tissue_probe.hpp"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace stylet::serve {

/// An implant that a user carries out needle by needle: the plan to follow, the seeds that have been dropped, and their
/// dose. A dropped seed belongs to a point of the tissue and stays there, whichever needle comes next. For one thread.
class ImplantDesk {
 public:
  /// @param model of the patient with any needle @param where name of the case in messages
  /// Errors: those of needle_insertion() and ImplantDose::open().
  static Result<std::unique_ptr<ImplantDesk>> open(std::shared_ptr<const ImplantCase> implant,
                                                   const std::shared_ptr<const Model>& model, const std::string& where);

  [[nodiscard]] const RecordedPlan& plan() const { return plan_.plan; }
  /// The same with the needles that are ready.
  [[nodiscard]] const ShownPlan& shown_plan() const { return plan_; }
  [[nodiscard]] const Scenario::Seed& fate() const { return fate_; }
  [[nodiscard]] const LiveImplant& state() const { return state_; }
  [[nodiscard]] NeedleModels& models() { return *models_; }
  /// Ends the work on models at the next report of progress. done(): it has ended.
  void give_up() { models_->give_up(); }
  [[nodiscard]] bool done() const { return models_->done(); }
  /// The insertions of the plan's needles, in the order of the procedure.
  [[nodiscard]] const std::vector<InsertionPlan>& insertions() const { return insertions_; }
  /// The needle of the plan through a hole of the template; empty if the plan has none there.
  [[nodiscard]] std::optional<std::size_t> needle_through(const std::string& hole) const;
  /// The needle of the plan that a model was compiled for; empty if it is none.
  [[nodiscard]] std::optional<std::size_t> needle_of(const Model& model) const;

  /// Sets the needle that is in front of the patient; empty: one beside the plan.
  void set_current(std::optional<std::size_t> needle);
  /// Says that a recording of this needle begins. Its plan() then has the name of the implant, which the first
  /// recording gives it, and what the needles before have done.
  void begin_recording(const std::string& name);
  /// Adds an event of this needle to LiveImplant::tally.
  void count(const Event& event);
  /// Whether a needle is drawn back over its train of seeds instead of stopping at each.
  [[nodiscard]] bool is_preloaded() const { return plan_.technique == SeedTechnique::preloaded; }
  /// Distances [mm] of the seeds that the present needle still has behind its tip, from the tip on.
  [[nodiscard]] std::vector<double> train_mm() const;
  /// Says that a train is being left. @param from_mm depth of the base at which it was begun; empty: it has ended
  void set_train(std::optional<double> from_mm);

  /// The seed that the present needle drops next. Errors: the needle is beside the plan, or it is empty.
  [[nodiscard]] Result<LoadedSeed> next_seed() const;

  /// Adds the seed that the present needle has left. It jumps, keeps to its strand or is lost as `[seed]` of the
  /// scenario wants (settle_seeds()), with the same random numbers as in stylet implant.
  /// @return the seed; SeedHistory::in_tissue says whether the point of the tissue was found
  /// Error: the tip was not in the tissue, and nothing was dropped.
  Result<SeedHistory> add(const ProbedDrop& drop);
  /// Takes the last seed back, of a preloaded needle all its seeds: its train is loaded again. Error: there is none.
  Result<> take_back();
  /// Takes all seeds back. What follows is another implant, with a tally of its own.
  void clear();
  /// Takes an interrupted implant up: its seeds are in the tissue again where they were, to the last bits of their
  /// place. Error: they are not seeds that the needles of this plan can have dropped; then nothing changes.
  Result<> go_on_with(const InterruptedImplant& implant);

  /// Places [mm] LPS in the tissue at rest of all dropped seeds.
  [[nodiscard]] std::vector<Vec3> rest_mm() const;
  /// Indices in LiveImplant::seeds of the seeds that the present needle has dropped.
  [[nodiscard]] std::vector<std::size_t> seeds_of_current() const;

  /// Whether LiveImplant::now is the dose of all seeds that have been dropped, and of no others.
  [[nodiscard]] bool is_score_current() const { return state_.now && score_version_ == dose_version_; }
  /// Makes the next take_changes() return everything, because the viewers have seen another implant.
  void show_again();

  /// The changes since the last call.
  struct Changes {
    bool plan = false;
    bool state = false;
    std::shared_ptr<const LiveDose> dose;  ///< null: the dose has not changed
    std::optional<Error> problem;          ///< the dose cannot be computed
  };
  /// Takes over what the workers have done.
  [[nodiscard]] Changes take_changes();

 private:
  ImplantDesk() = default;
  void seeds_have_changed();
  void settle();
  [[nodiscard]] const NeedleLoad& present() const {
    return implant_->needles[static_cast<std::size_t>(plan().current)];
  }

  std::shared_ptr<const ImplantCase> implant_;
  std::vector<InsertionPlan> insertions_;
  Scenario::Seed fate_;  ///< the fate of seeds after their drop
  ShownPlan plan_;
  std::vector<SeedHistory> dropped_;  ///< as dropped, before they settle; in the order of the drops
  LiveImplant state_;
  TallyOfNeedle present_tally_;
  bool plan_changed_ = true;
  bool state_changed_ = true;
  std::unique_ptr<NeedleModels> models_;
  std::unique_ptr<ImplantDose> dose_;
  std::uint64_t dose_version_ = 0;   ///< of the seeds that `dose_` was given last
  std::uint64_t score_version_ = 0;  ///< of the seeds that LiveImplant::now is of
  std::shared_ptr<const LiveDose> grid_;
  bool grid_changed_ = false;
};

}  // namespace stylet::serve
